"""Scenes of bodies on a seabed: a clump between two chains, and bodies on which no line pulls."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

DEPTH, G = 30.0, 9.81
WET = 600.0  # N/m, of the chain
CHAIN: dict[str, Any] = {
    "EA": 2.0e8, "EI": 0.0, "GJ": 1.0e3, "mass": 70.0, "outer_diameter": 0.08, "submerged_weight": WET,
}  # fmt: skip
CLUMP: dict[str, Any] = {"kind": "point", "mass": 4000.0, "volume": 0.5}
RHO = 1025.0
NET = G * (CLUMP["mass"] - RHO * CLUMP["volume"])  # N
BED = 5.0e5  # N/m2
LIES = {"radius": 0.04, "stiffness": NET / (WET / BED)}  # of a clump that sinks in as its chains do beside it


def between_chains(
    *stages: Mapping[str, Any], span: float, length: float, elements: int = 30, contact: Mapping[str, Any] | None = None
) -> dict[str, Any]:
    """A clump on the bed amid two chains of a length, whose tops are at z = 0 and that far to its sides."""
    chain = {"segments": [{"line_type": "chain", "length": length, "elements": elements}]}
    touch = {} if contact is None else {"contact": dict(contact)}
    return {
        "title": "A clump between two chains",
        "water": {"density": RHO},
        "seabed": {"kind": "spring", "level": -DEPTH, "stiffness": BED},
        "contact": {},
        "line_types": {"chain": CHAIN},
        "lines": {
            "left": chain | {"start": {"position": [-span, 0.0, 0.0]}, "end": "free"},
            "right": chain | {"start": "free", "end": {"position": [span, 0.0, 0.0]}},
        },
        "bodies": {"clump": {"position": [0.0, 0.0, 0.5 - DEPTH], **CLUMP, **touch}},
        "joints": {
            "left_end": {"kind": "pinned", "between": [{"line": "left", "at": "end"}, {"body": "clump"}]},
            "right_end": {"kind": "pinned", "between": [{"line": "right", "at": "start"}, {"body": "clump"}]},
        },
        "stages": [{"name": "rest", "kind": "static"}, *stages],
    }


def let_go(
    bodies: Mapping[str, Mapping[str, Any]], duration: float, time_step: float, **more: Any
) -> dict[str, Any]:
    """Bodies without lines, from their places at rest on, in air; a short rope hangs high above. more: of the scene."""
    rope = {"EA": 1.0e6, "EI": 10.0, "GJ": 10.0, "mass": 1.0, "outer_diameter": 0.02}
    segments = [{"line_type": "rope", "length": 2.0, "elements": 2}]
    line = {"segments": segments, "start": {"position": [0.0, 0.0, 50.0]}, "end": {"position": [1.9, 0.0, 50.0]}}
    fall = {"name": "fall", "kind": "dynamic", "duration": duration, "time_step": time_step}
    scene = {
        "title": "Bodies on a seabed",
        "line_types": {"rope": rope},
        "lines": {"rope": line},
        "bodies": {name: dict(body) for name, body in bodies.items()},
        "seabed": {"kind": "rigid", "level": 0.0},
        "contact": {},
        "stages": [fall],
    }
    return scene | more
