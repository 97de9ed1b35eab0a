"""Scenes of several lines and bodies: moorings of a buoy, a riser on clay hung on a buoy, a lazy S, bodies alone."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from riser_soil.core.arrays import Array
from tests.support.catenaries import pulls
from tests.support.scenes import LAY, block, cells, dynamic, line, static, touchdown

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


def lines_scene(*stages: Mapping[str, Any], lines: Mapping[str, Any], **more: Any) -> dict[str, Any]:
    """Lines at rest and in the stages; more: sections of the scene, line types, bodies and joints among them."""
    return {"title": "Several lines", "lines": dict(lines), "stages": [static("rest"), *stages], **more}


def pin(name: str, at: str, body: str, **more: Any) -> dict[str, Any]:
    """A joint between an end of a line and a body; more: of its place on the body."""
    return {"kind": "pinned", "between": [{"line": name, "at": at}, {"body": body, **more}]}


def mooring(
    *stages: Mapping[str, Any], body: Mapping[str, Any] = POINT, elements: int = 20, **more: Any
) -> dict[str, Any]:
    """Three lines from anchors on a circle to a buoy amid them, on a rigid one at arms of 1 m; more: of the scene."""
    arm = 1.0 if body["kind"] == "rigid" else 0.0
    types = {"chain": CHAIN | (IN_WATER if len(stages) > 1 else {})}
    bodies = {"buoy": {"position": [0.0, 0.0, -20.0], **body}}
    water = {"density": RHO, "surface_level": 0.0}
    lines, joints = {}, {}
    for n, name in enumerate(NAMES):
        c, s = math.cos(2.0 * math.pi * n / 3.0), math.sin(2.0 * math.pi * n / 3.0)
        lines[name] = line("chain", LENGTH, elements, {"position": [RADIUS * c, RADIUS * s, -DEPTH]}, "free")
        joints[f"{name}_top"] = pin(name, "end", "buoy", offset=[arm * c, arm * s, -arm])
    return lines_scene(*stages, line_types=types, lines=lines, bodies=bodies, joints=joints, water=water) | more


def with_line_named(name: str) -> dict[str, Any]:
    """The mooring whose line `east` has another name."""
    scene: dict[str, Any] = json.loads(json.dumps(mooring()).replace('"east"', json.dumps(name)))
    return scene


def shaken(duration: float = 1.0, time_step: float = 0.05) -> dict[str, Any]:
    """A dynamic stage in which an anchor moves."""
    heave = {"amplitude": [1.0, 0.3, 0.5], "period": 3.0, "ramp": 1.0}
    return dynamic(duration, time_step, "shaken", lines={"east": {"motion": {"start": {"harmonic": heave}}}})


def as_line(scene: Mapping[str, Any]) -> dict[str, Any]:
    """A riser's scene with this as the only one of its lines, `only`."""
    line = {key: value for key, value in scene.items() if key not in ("riser", "dimension")}
    stages = [dict(stage) for stage in scene["stages"]]
    for stage in stages:
        of_line = {key: stage.pop(key) for key in ("move", "motion", "loads") if key in stage}
        stage |= {"lines": {"only": of_line}} if of_line else {}
    soil = {"soil": scene["soil"] | {"line": "only"}} if scene.get("soil") else {}
    return line | {"lines": {"only": scene["riser"]}, "stages": stages} | soil


def hung_over_clay(*stages: Mapping[str, Any], model: str = "block") -> dict[str, Any]:
    """The riser of `touchdown`, whose upper end hangs on a buoy, which a second line holds on to a support above."""
    scene = as_line(touchdown(LAY, *map(dict, stages), su=3.0e3))
    riser, types = scene["lines"]["only"], scene["line_types"]
    upper, place = line("flexible", 10.0, 10, "free", {"position": [31.0, 0.0, 17.0]}), riser["end"]["position"]
    scene["lines"] = {"lower": riser | {"end": "free"}, "upper": upper}
    types["flexible"] |= IN_WATER
    # On cells that do not resolve what touches, a pipe without friction lies as on a seesaw, and slides to either side.
    mesh = cells({"along": 0.75, "across": 0.015, "strip": 0.12}, 0.3)
    scene["soil"] |= block(scene["soil"]["law"], (5.0, 9.5), 0.6, 0.6, mesh, line="lower", model=model)
    buoy = {"kind": "point", "position": place, "mass": 300.0, "volume": 1.8, "drag_area": 1.0, "added_mass": 0.5}
    joints = {"lower_hung": pin("lower", "end", "buoy"), "upper_hung": pin("upper", "start", "buoy")}
    return scene | {"bodies": {"buoy": buoy}, "joints": joints}


# A riser in two parts over a buoyant arch that a tether holds, all in the plane y = 0, above the seabed.
ARCH: dict[str, Any] = {
    "kind": "rigid", "position": [-60.0, 0.0, -70.0], "mass": 12.0e3, "inertia": [4.0e4, 4.0e4, 4.0e4], "volume": 24.0,
    "centre_of_gravity": [0.0, 0.0, -0.5], "centre_of_buoyancy": [0.0, 0.0, 0.6], "drag_area": [20.0, 30.0, 20.0],
    "added_mass": [0.6, 0.8, 0.6],
}  # fmt: skip
PIPE: dict[str, Any] = {"EA": 3.0e8, "EI": 2.0e3, "GJ": 2.0e3, "mass": 60.0, "outer_diameter": 0.2}
ROPE: dict[str, Any] = {"EA": 4.0e7, "EI": 10.0, "GJ": 10.0, "mass": 12.0, "outer_diameter": 0.1}
PIPE["submerged_weight"], ROPE["submerged_weight"] = 350.0, 30.0
# Of each line: type, length, elements, place of the other end, arm on the arch, whether the arch is its upper end.
LAZY_S = {
    "upper": (PIPE, 115.0, 46, (0.0, 0.0, -5.0), (2.5, 0.0, 0.0), False),
    "lower": (PIPE, 105.0, 42, (-115.0, 0.0, -140.0), (-2.5, 0.0, 0.0), True),
    "tether": (ROPE, 76.0, 20, (-60.0, 0.0, -150.0), (0.0, 0.0, -2.0), True),
}


def lazy_s(*stages: Mapping[str, Any], **more: Any) -> dict[str, Any]:
    """The riser over its arch."""
    lines, joints = {}, {}
    for name, (kind, length, elements, place, arm, ends_up) in LAZY_S.items():
        point = {"position": list(place)}
        start, end = (point, "free") if ends_up else ("free", point)
        lines[name] = line("pipe" if kind is PIPE else "rope", length, elements, start, end)
        joints[f"{name}_hung"] = pin(name, "end" if ends_up else "start", "arch", offset=list(arm))
    types, water = {"pipe": PIPE, "rope": ROPE}, {"density": RHO}
    return (
        lines_scene(*stages, line_types=types, lines=lines, bodies={"arch": ARCH}, joints=joints, water=water) | more
    )


def lazy_s_by_catenaries() -> tuple[Array, dict[str, tuple[float, float]]]:
    """x, z [m] and angle [rad] of the arch, and tensions [N] of each line at its start and end, by a root finder."""

    def hung(at: Array) -> dict[str, tuple[Array, Array, Array]]:
        """Each line's arm in the plane, force on the arch and at the other end."""
        c, s = math.cos(at[2]), math.sin(at[2])
        turn, lines = np.array([[c, -s], [s, c]]), {}
        for name, (kind, length, _, place, arm, ends_up) in LAZY_S.items():
            lever, other = turn @ np.array(arm)[[0, 2]], np.array(place)[[0, 2]]
            ends = (other, at[:2] + lever) if ends_up else (at[:2] + lever, other)
            forces = pulls(ends[0], ends[1], kind["submerged_weight"], kind["EA"], length)
            lines[name] = lever, forces[int(ends_up)], forces[int(not ends_up)]
        for key, force in (("centre_of_gravity", -ARCH["mass"] * G), ("centre_of_buoyancy", RHO * G * ARCH["volume"])):
            lines[key] = turn @ np.array(ARCH[key])[[0, 2]], np.array([0.0, force]), np.zeros(2)
        return lines

    def unbalanced(at: Array) -> Array:
        levers, forces = (np.array([each[n] for each in hung(at).values()]) for n in (0, 1))
        moment = levers[:, 0] * forces[:, 1] - levers[:, 1] * forces[:, 0]
        return np.append(forces.sum(axis=0), moment.sum())

    tight = {"xtol": 1e-15, "ftol": 1e-15, "gtol": 1e-15, "diff_step": 1e-6}
    at = least_squares(unbalanced, np.array([-60.0, -72.0, 0.1]), x_scale=np.array([1.0, 1.0, 0.1]), **tight).x
    assert np.abs(unbalanced(at)).max() < 1e-3, "of 90 kN"
    ends = {name: [float(np.linalg.norm(force)) for force in hung(at)[name][1:]] for name in LAZY_S}
    return at, {name: (two[1], two[0]) if LAZY_S[name][5] else (two[0], two[1]) for name, two in ends.items()}
