"""A pipe that lies on a block of soil and is lifted at one end: a touchdown zone without a riser above it."""

from __future__ import annotations

from copy import deepcopy
from typing import Any

from tests.support.coupled_scenes import Mapping

ELASTIC: Mapping = {"kind": "linear-elastic", "E": 1.2e6, "nu": 0.49}
D, LENGTH = 0.3, 8.0
PRESSED = 2e-3  # m, by which the pipe begins in the soil: Newton's method finds its rest from there


def lifted_pipe(law: Mapping, weight: float = 717.0, height: float = 0.05, elements: int = 16, **soil: Any) -> Mapping:
    """It rests, then its end is lifted by `height` [m]. weight: submerged [N/m]. soil: its keys beside the law."""
    pipe = {"outer_diameter": D, "mass": 120.0, "EA": 3.0e8, "EI": 5.0e4, "GJ": 4.0e4, "submerged_weight": weight}
    z = 0.5 * D - PRESSED
    ends = {end: {"position": [x, 0.0, z], "rotation": "free"} for end, x in (("start", 0.0), ("end", LENGTH))}
    block = {"x": [-1.0, 9.0], "y": [-2.4, 2.4], "depth": 2.4}
    return {
        "title": "Pipe lifted at one end",
        "gravity": 9.81,
        "dimension": 2,
        "line_types": {"pipe": pipe},
        "riser": {
            "segments": [{"line_type": "pipe", "length": LENGTH, "elements": elements}],
            **ends,
            "initial": "straight",
        },
        "seabed": {"kind": "spring", "level": 0.0, "stiffness": 1.0e5},
        "soil": {"block": block, "mesh": "auto", "law": deepcopy(law), **soil},
        "contact": {"method": "surface"},
        "stages": [
            {"name": "rest", "kind": "static"},
            {"name": "lift", "kind": "static", "move": {"end": [LENGTH, 0.0, z + height]}},
        ],
    }
