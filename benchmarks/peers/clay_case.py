"""A stiff pipe pressed into a block of clay: the case as numbers, and as a scene of riser_soil."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from riser_soil.core.arrays import Array

DIAMETER, HALF_LENGTH = 0.30, 0.20  # of the pipe, which lies along x and juts out of the block [m]
BLOCK: dict[str, Any] = {"x": [-0.15, 0.15], "y": [-0.9, 0.9], "depth": 0.9}  # m
SU, E_OVER_SU, NU = 5.0e3, 300.0, 0.49  # su [Pa]; von Mises, perfectly plastic, without weight
DEPTHS = 0.008, 0.004  # to which the undersides of the pipe's ends go [m]
STEPS = 12


@dataclass(frozen=True)
class Mesh:
    """Hexahedra under the pipe: their length along it, and their size across it and downwards [m]."""

    along: float
    across: float


@dataclass(frozen=True, eq=False)
class Pressed:
    """Vertical force on the pipe (STEPS,) [N] at the end of each step, nan where a run did not get; Newton iterations;
    processor seconds.
    """

    force: Array
    iterations: int
    seconds: float


MESHES = {
    "coarse": Mesh(0.075, 0.0375),
    "middle": Mesh(0.05, 0.025),
    "fine": Mesh(0.0375, 0.01875),
    "finest": Mesh(0.03, 0.015),
}


def scene_of(mesh: Mesh) -> dict[str, Any]:
    """The case as a scene: the pipe's ends held where its underside touches, then moved down in equal load steps."""
    radius = 0.5 * DIAMETER
    ends = {"start": -HALF_LENGTH, "end": HALF_LENGTH}
    moved = {name: [x, 0.0, radius - depth] for (name, x), depth in zip(ends.items(), DEPTHS, strict=True)}
    return {
        "title": "Pipe on clay, beside another program",
        "dimension": 2,
        "line_types": {
            "pipe": {"outer_diameter": DIAMETER, "submerged_weight": 500.0, "mass": 120.0, "EA": 2e8, "EI": 1e7}
        },
        "riser": {
            "segments": [{"line_type": "pipe", "length": 2.0 * HALF_LENGTH, "elements": 1}],
            "initial": "straight",
            **{name: {"position": [x, 0.0, radius], "rotation": "free"} for name, x in ends.items()},
        },
        "soil": {
            "block": BLOCK,
            "symmetry": "whole",  # as CalculiX has it
            "mesh": {
                "kind": "hex",
                "size_at_riser": {"along": mesh.along, "across": mesh.across},
                "size_far": 8.0 * mesh.across,
            },
            "law": {"kind": "von-mises", "su": SU, "E_over_su": E_OVER_SU, "nu": NU},
        },
        "contact": {"method": "surface"},
        "stages": [{"name": "touch", "kind": "static"}, {"name": "press", "kind": "static", "move": moved}],
        "solver": {"load_steps": STEPS},
    }
