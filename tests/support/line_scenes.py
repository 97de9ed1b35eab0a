"""Scenes of several lines: a mooring of three lines on a buoy, and elastic catenaries by themselves."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.optimize import fsolve

from riser_soil.core.arrays import Array

RADIUS, DEPTH, LENGTH = 100.0, 100.0, 130.0
RHO, G = 1025.0, 9.81
CHAIN: dict[str, Any] = {"EA": 1.0e8, "EI": 1.0e3, "GJ": 1.0e3, "mass": 8.0, "outer_diameter": 0.05}
WET = (CHAIN["mass"] - RHO * math.pi / 4.0 * CHAIN["outer_diameter"] ** 2) * G  # N/m
POINT: dict[str, Any] = {"kind": "point", "mass": 2000.0, "volume": 6.0, "drag_area": 3.0, "added_mass": 0.5}
RIGID: dict[str, Any] = {
    "kind": "rigid", "mass": 2000.0, "inertia": [800.0, 900.0, 700.0], "centre_of_gravity": [0.0, 0.0, -0.3],
    "volume": 6.0, "centre_of_buoyancy": [0.0, 0.0, 0.3], "drag_area": [3.0, 3.0, 2.0],
    "rotational_drag": [1.0, 1.0, 1.0], "added_mass": [0.5, 0.5, 0.8], "added_inertia": [300.0, 300.0, 100.0],
}  # fmt: skip
IN_WATER = {"drag": {"normal": 1.2, "tangential": 0.05}, "added_mass": {"normal": 1.0}}
NAMES = ("east", "north", "south")


def mooring(
    *stages: Mapping[str, Any], body: Mapping[str, Any] = POINT, elements: int = 20, **more: Any
) -> dict[str, Any]:
    """Three lines from anchors on a circle to a buoy amid them, on a rigid one at arms of 1 m; more: of the scene."""
    arm = 1.0 if body["kind"] == "rigid" else 0.0
    scene: dict[str, Any] = {
        "title": "A buoy on three lines",
        "water": {"density": RHO, "surface_level": 0.0},
        "line_types": {"chain": CHAIN | (IN_WATER if len(stages) > 1 else {})},
        "bodies": {"buoy": {"position": [0.0, 0.0, -20.0], **body}},
        "lines": {},
        "joints": {},
        "stages": [{"name": "rest", "kind": "static"}, *stages],
    }
    for n, name in enumerate(NAMES):
        c, s = math.cos(2.0 * math.pi * n / 3.0), math.sin(2.0 * math.pi * n / 3.0)
        scene["lines"][name] = {
            "segments": [{"line_type": "chain", "length": LENGTH, "elements": elements}],
            "start": {"position": [RADIUS * c, RADIUS * s, -DEPTH]},
            "end": "free",
        }
        at_body = {"body": "buoy", "offset": [arm * c, arm * s, -arm]}
        scene["joints"][f"{name}_top"] = {"kind": "pinned", "between": [{"line": name, "at": "end"}, at_body]}
    return scene | more


def shaken(duration: float = 1.0, time_step: float = 0.05) -> dict[str, Any]:
    """A dynamic stage in which an anchor moves."""
    heave = {"amplitude": [1.0, 0.3, 0.5], "period": 3.0, "ramp": 1.0}
    lines = {"east": {"motion": {"start": {"harmonic": heave}}}}
    return {"name": "shaken", "kind": "dynamic", "duration": duration, "time_step": time_step, "lines": lines}


def spans(H: float, V: float, w: float, EA: float, L: float) -> tuple[float, float]:
    """Horizontal and vertical distance [m] from the lower to the upper end of an elastic catenary that hangs on H, V.

    Irvine, Cable Structures, 1981, equations 2.24 and 2.25.
    """
    low = V - w * L
    x = H * L / EA + H / w * (math.asinh(V / H) - math.asinh(low / H))
    z = w * L / EA * (V / w - 0.5 * L) + H / w * (math.hypot(1.0, V / H) - math.hypot(1.0, low / H))
    return x, z


def upper_force(a: Array, b: Array, w: float, EA: float, L: float) -> Array:
    """Force (2,) [N] of an elastic catenary from a up to b, each (2,) [m] along x and z, on its end b."""
    dx, dz = b - a
    start = w * L * np.array([0.5, 0.7])

    def off(force: Array) -> Array:
        x, z = spans(abs(float(force[0])) + 1e-9, float(force[1]), w, EA, L)
        return np.array([x - abs(dx), z - dz])

    H, V = fsolve(off, start, xtol=1e-12)
    return np.array([-np.sign(dx) * abs(H), -V])
