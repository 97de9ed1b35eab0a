"""A small scene as plain data: a riser of 140 m on a rigid seabed, moved for a second."""

from __future__ import annotations

from typing import Any

BASE: dict[str, Any] = {
    "water": {"density": 1025.0},
    "line_types": {
        "pipe": {
            "outer_diameter": 0.3,
            "inner_diameter": 0.2,
            "mass": 120.0,
            "EA": 3e8,
            "EI": 5e4,
            "GJ": 4e4,
            "drag": {"normal": 1.1},
        }
    },
    "riser": {
        "segments": [{"line_type": "pipe", "length": 140.0, "elements": 70}],
        "start": {"position": [0.0, 0.0, 0.15]},
        "end": {"position": [80.0, 0.0, 100.0]},
    },
    "seabed": {"kind": "rigid"},
    "stages": [{"name": "move", "kind": "dynamic", "duration": 1.0, "time_step": 0.1}],
}


def joined(base: Any, piece: Any) -> Any:
    """A mapping with another laid over it, key by key."""
    if not isinstance(base, dict) or not isinstance(piece, dict):
        return piece
    return base | {key: joined(base.get(key), value) for key, value in piece.items()}
