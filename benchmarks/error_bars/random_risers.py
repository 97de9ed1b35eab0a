"""Random risers on grounds of all kinds: pipes, shapes, meshes, motions, waves and currents are drawn from a seed.

A riser hangs between two ends, or comes down from its upper end at a slope and lies on the ground up to its lower one.
Half of them move, by their upper end or in waves. Elements are even or graded, few or many: short ones resolve how the
riser bends, long ones do not. The same seed, ground and number give the same riser everywhere.
"""

from __future__ import annotations

import math
import random
from typing import Any

from benchmarks.error_bars.scenes import HANG, SCENES, Mapping, freely, line, moved

Draw = random.Random

GROUNDS = ("hanging", "rigid", "spring", "randolph-quiggin", "aubeny-biscontin")
SEA, STEEL = 1025.0, 7850.0  # densities of water and steel [kg/m3]
YOUNG = 2.07e11  # of steel [Pa]
G = 9.80665
EACH = 8  # risers on each ground, in the calibration and out of it


def random_riser(seed: int, ground: str, number: int) -> Mapping:
    """A scene on a ground of `GROUNDS`; of odd number it moves."""
    draw = Draw(f"{seed} {ground} {number}")
    pipe = some_pipe(draw)
    depth = _depth(draw, pipe)
    if ground == "hanging":
        hung, more = _hung(draw, depth), dict[str, Any]()
    else:
        hung, more = _laid(draw, depth, pipe), _on_ground(draw, ground)
    ends, length = hung
    stages, sea = _motion(draw, depth) if number % 2 else ([HANG], _still(draw, depth))
    return line(pipe, *ends, _cut(draw, length, ground), stages, water=sea, **more)


def _depth(draw: Draw, pipe: Mapping) -> float:
    """So much that weight bends the pipe: times the length (EI/w)^(1/3) over which it resists that."""
    stiff = (pipe["EI"] / submerged_weight(pipe)) ** (1.0 / 3.0)
    return figures(min(max(stiff * spread(draw, 6.0, 80.0), 12.0), 2000.0))


def submerged_weight(pipe: Mapping) -> float:
    """In sea water [N/m]."""
    return float(G * (pipe["mass"] - 0.25 * math.pi * SEA * pipe["outer_diameter"] ** 2))


def spread(draw: Draw, low: float, high: float) -> float:
    """A random value of three figures, evenly in the logarithm."""
    return float(f"{low * (high / low) ** draw.random():.3g}")


def some_pipe(draw: Draw) -> Mapping:
    made = draw.choice([_steel, _flexible])(draw)
    drag = {"normal": spread(draw, 0.7, 1.3), "tangential": draw.choice([0.0, 0.05])}
    return made | {"drag": drag, "added_mass": {"normal": 1.0}}


def _steel(draw: Draw) -> Mapping:
    """Full of water, oil or gas; it sinks."""
    outer = spread(draw, 0.15, 0.6)
    inner = outer * (1.0 - 2.0 / spread(draw, 12.0, 22.0))
    steel, within = (0.25 * math.pi * (a**2 - b**2) for a, b in ((outer, inner), (inner, 0.0)))
    mass = STEEL * steel + draw.choice([SEA, 800.0, 150.0]) * within
    EI = YOUNG * math.pi * (outer**4 - inner**4) / 64.0
    return _section(outer, mass, EA=YOUNG * steel, EI=EI, GJ=EI / 1.3)


def _flexible(draw: Draw) -> Mapping:
    """A pipe of many layers, an umbilical or a hose: limp, and not that stiff along its axis."""
    outer = spread(draw, 0.08, 0.4)
    mass = spread(draw, 1.3, 2.5) * SEA * 0.25 * math.pi * outer**2
    EI = spread(draw, 3.0e5, 1.0e7) * outer**3
    return _section(outer, mass, EA=spread(draw, 1.0e9, 1.0e10) * outer**2, EI=EI, GJ=spread(draw, 1.0, 10.0) * EI)


def _section(outer: float, mass: float, **stiffnesses: float) -> Mapping:
    return {"outer_diameter": outer, "mass": figures(mass)} | {n: figures(k) for n, k in stiffnesses.items()}


def figures(x: float) -> float:
    """The number of four figures: as an engineer would write it, and the same on all machines."""
    return float(f"{x:.4g}")


def _hung(draw: Draw, depth: float) -> tuple[tuple[Any, Any], float]:
    """Between two ends, slack or taut."""
    span = depth * spread(draw, 0.3, 2.0)
    length = math.hypot(span, depth) * (1.0 + spread(draw, 0.02, 0.8))
    return ([0.0, 0.0, 0.0], _upper(draw, [figures(span), 0.0, depth])), figures(length)


def _laid(draw: Draw, depth: float, pipe: Mapping) -> tuple[tuple[Any, Any], float]:
    """The catenary of a slope at its upper end, and pipe that lies."""
    slope = math.radians(draw.uniform(45.0, 82.0))
    a = depth / (1.0 / math.cos(slope) - 1.0)
    lying = spread(draw, 0.25, 1.0) * depth + 10.0 * pipe["outer_diameter"]
    end = [figures(lying + a * math.asinh(math.tan(slope))), 0.0, depth]
    return ([0.0, 0.0, 0.5 * pipe["outer_diameter"]], _upper(draw, end)), figures(lying + a * math.tan(slope))


def _upper(draw: Draw, place: list[float]) -> Any:
    """Free to turn, more often than not."""
    return {"position": place, "rotation": "fixed"} if draw.random() < 0.2 else place


def _cut(draw: Draw, length: float, ground: str) -> list[Mapping]:
    """Even elements, or on ground some that are graded away from where the riser touches down."""
    count = round(spread(draw, 25.0, 120.0))
    if ground == "hanging" or draw.random() < 0.6:
        return [{"length": length, "elements": count}]
    size = figures(0.5 * length / count)
    lower = figures(draw.uniform(0.3, 0.5) * length)
    graded = {"length": figures(length - lower), "element_length": [size, 4.0 * size]}
    return [{"length": lower, "element_length": size}, graded]


def _on_ground(draw: Draw, ground: str) -> Mapping:
    """Seabed, at times sloping, and contact, at times with friction."""
    seabed = _seabed(draw, ground)
    if draw.random() < 0.15:
        seabed |= {"slope_deg": draw.choice([-3.0, 2.0, 5.0])}
    rubs = draw.random() < 0.15
    return {"seabed": seabed} | ({"contact": {"friction": {"axial": spread(draw, 0.1, 0.6)}}} if rubs else {})


def _seabed(draw: Draw, ground: str) -> Mapping:
    if ground == "rigid":
        return {"kind": "rigid"}
    if ground == "spring":
        return {"kind": "spring", "stiffness": spread(draw, 1.0e4, 1.0e6)}
    law = {"kind": ground, "su": spread(draw, 1.0e3, 1.0e4), "su_gradient": spread(draw, 5.0e2, 3.0e3)}
    return {"kind": "hysteretic", "law": law}


def _motion(draw: Draw, depth: float) -> tuple[list[Mapping], Mapping]:
    """Stages and water: the upper end heaves or surges, moves across, or waves go by."""
    how = draw.choice(["heave", "heave", "surge", "both", "across", "waves"])
    period = spread(draw, 5.0, 15.0)
    steps = spread(draw, 30.0, 150.0)
    if how == "waves":
        airy = {"height": spread(draw, 1.0, 5.0), "period": max(period, 7.0)}
        sea = _still(draw, depth) | {"depth": depth, "surface_level": depth, "waves": {"airy": airy}}
        return [HANG, freely(2.5 * airy["period"], round(2.5 * steps))], sea
    size = spread(draw, 0.1, 1.6) * period / (2.0 * math.pi)  # by its largest velocity [m/s]
    along = {"heave": (0, 0, 1), "surge": (1, 0, 0), "both": (0.7, 0, 0.7), "across": (0, 1, 0)}[how]
    motion = moved([figures(size * part) for part in along], period, 2.5, steps)
    if draw.random() < 0.15:
        motion |= {"time_step": "auto"}
    return [HANG, motion], _still(draw, depth)


def _still(draw: Draw, depth: float) -> Mapping:
    """Water without waves, in half of all scenes with a current."""
    if draw.random() < 0.5:
        return {"density": SEA}
    fast, how = spread(draw, 0.1, 1.0), draw.choice([(1.0, 0.0), (-1.0, 0.0), (0.3, 0.9)])
    profile = [[0.0, 0.0, 0.0], [depth, *(figures(fast * part) for part in how)]]
    return {"density": SEA, "current": {"profile": profile}}


def _drawn(letter: str, seed: int) -> dict[str, Mapping]:
    return {f"{ground} {letter}{n}": random_riser(seed, ground, n) for ground in GROUNDS for n in range(EACH)}


CALIBRATION = SCENES | _drawn("A", 1) | _drawn("B", 2)
OUT_OF_SAMPLE = _drawn("C", 3)
