"""Small coupled scenes as mappings: a 30 m riser of 36 elements comes down on a block of clay and heaves."""

from __future__ import annotations

from copy import deepcopy
from pathlib import Path
from typing import Any

Mapping = dict[str, Any]

DEMO = Path(__file__).parents[2] / "demos" / "touchdown_clay" / "scene.yaml"
ON_BLOCK = Path(__file__).parents[1] / "scenes" / "touchdown_on_block.yaml"

LINE = {
    "outer_diameter": 0.30,
    "inner_diameter": 0.20,
    "mass": 120.0,
    "EA": 3.0e8,
    "EI": 5.0e4,
    "GJ": 4.0e4,
    "drag": {"normal": 1.1, "tangential": 0.05},
    "added_mass": {"normal": 1.0, "tangential": 0.0},
}
LAY: Mapping = {"name": "lay", "kind": "static"}


def heave(duration: float, time_step: float = 0.1, amplitude: float = 0.3) -> Mapping:
    """A dynamic stage in which the upper end moves up and down [m] with a period of 3 s."""
    harmonic = {"amplitude": [0.0, 0.0, amplitude], "period": 3.0, "ramp": 1.5}
    motion = {"end": {"harmonic": harmonic}}
    return {"name": "heave", "kind": "dynamic", "duration": duration, "time_step": time_step, "motion": motion}


def touchdown(
    *stages: Mapping, kind: str = "hex", su: float = 600.0, dimension: int = 2, tolerance: float = 1e-7
) -> Mapping:
    """The riser touches down at about 8 m on a block that reaches from 2 to 9 m; su [Pa] at the surface.

    A su of 600 Pa yields below the touchdown point, as the riser's submerged weight is 717 N/m.
    """
    return {
        "title": "Touchdown on a small block",
        "gravity": 9.81,
        "dimension": dimension,
        "water": {"density": 1025.0},
        "line_types": {"flexible": deepcopy(LINE)},
        "riser": {
            "contents": {"density": 850.0},
            "segments": [
                {"line_type": "flexible", "length": 12.0, "elements": 24},
                {"line_type": "flexible", "length": 18.0, "elements": 12},
            ],
            "start": {"position": [0.0, 0.0, 0.15], "rotation": "free"},
            "end": {"position": [22.5, 0.0, 15.0], "rotation": "free"},
            "initial": "catenary",
        },
        "seabed": {"kind": "spring", "level": 0.0, "stiffness": 1.0e5},
        "soil": {
            "block": {"x": [2.0, 9.0], "y": [-1.0, 1.0], "depth": 1.0},
            "mesh": {"kind": kind, "size_at_riser": 0.5, "size_far": 1.0},
            "law": {"kind": "von-mises", "su": su, "su_gradient": 500.0, "E_over_su": 300.0, "nu": 0.49},
            "submerged_unit_weight": 5.0e3,
        },
        "stages": [deepcopy(stage) for stage in (stages or (LAY,))],
        "solver": {"tolerance": tolerance},
    }


def lying_pipe(su: float) -> Mapping:
    """8 m of pipe, 717 N/m, pinned at its start, on a block of clay of strength su [Pa] and on nothing else."""
    scene = touchdown(LAY, su=su)
    del scene["seabed"]
    segments = [{"line_type": "flexible", "length": 8.0, "elements": 16}]
    scene["riser"] |= {"segments": segments, "end": "free", "initial": "straight"}
    scene["soil"]["block"]["x"] = [-1.0, 9.0]
    scene["soil"]["law"]["su_gradient"] = 0.0
    return scene
