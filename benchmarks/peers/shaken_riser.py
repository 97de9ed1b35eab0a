"""A riser under tension that is shaken by its vortices in a current that grows with height: the case, and its figures.

It stands upright, pinned at both ends; its own force and the tension keep it taut. All programs have Thorsen, Sævik and
Larsen's model across the flow, with the same coefficients.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from benchmarks.peers.case import GRAVITY, WATER

LENGTH, CHORD, DIAMETER = 60.0, 60.6, 0.1  # m
MASS, EA, EI = 15.0, 2.0e6, 1.0e3  # kg/m, N, N.m2
DRAG, ADDED_MASS = 1.2, 1.0
CURRENT = 0.2, 0.6  # m/s at the lower and at the upper end
FORCE, MIDDLE, WIDTH = 1.2, 0.18, 0.08  # coefficient of the vortices' force, frequencies of shedding times D/U
DURATION, RECORDS = 60.0, 0.02  # s; the second half counts


class Shaken(NamedTuple):
    """Times (nt,) [s], places (nt, nodes, 3) [m] along x with the flow, y across it and z upwards; processor time of
    the time loop [s].
    """

    t: np.ndarray
    x: np.ndarray
    seconds: float


class Swing(NamedTuple):
    """Across the flow, in the second half: frequency [Hz] where it swings most; amplitude over the diameter there and
    over all nodes, sqrt 2 times the standard deviation.
    """

    frequency: float
    largest: float
    mean: float


def sag(motion: Shaken) -> float:
    """Largest mean displacement along the flow in the second half [m]: what drag makes of it."""
    return float(motion.x[len(motion.t) // 2 :, :, 0].mean(axis=0).max())


def swing(motion: Shaken) -> Swing:
    later = slice(len(motion.t) // 2, None)
    t, y = motion.t[later], motion.x[later, :, 1] - motion.x[later, :, 1].mean(axis=0)
    node = int(y.std(axis=0).argmax())
    (up,) = np.nonzero((y[:-1, node] < 0.0) & (y[1:, node] >= 0.0))
    crossed = t[up] - y[up, node] * (t[up + 1] - t[up]) / (y[up + 1, node] - y[up, node])
    return Swing(
        frequency=(len(crossed) - 1) / (crossed[-1] - crossed[0]),
        largest=math.sqrt(2.0) * float(y[:, node].std()) / DIAMETER,
        mean=math.sqrt(2.0) * math.sqrt(float((y**2).mean())) / DIAMETER,
    )


def scene_of(elements: int, time_step: float, force: float) -> dict[str, Any]:
    """The case for riser_soil. force: coefficient of the vortices' force; 0 for none."""
    pipe: dict[str, Any] = {
        "outer_diameter": DIAMETER,
        "mass": MASS,
        "EA": EA,
        "EI": EI,
        "GJ": EI,
        "drag": {"normal": DRAG},
        "added_mass": {"normal": ADDED_MASS},
    }
    if force:
        pipe["vortex_force"] = {"coefficient": force, "frequency": MIDDLE, "width": WIDTH}
    dynamic = {"name": "shaken", "kind": "dynamic", "duration": DURATION, "time_step": time_step}
    ends = {name: {"position": [0.0, 0.0, z], "rotation": "free"} for name, z in (("start", 0.0), ("end", CHORD))}
    segment = {"line_type": "pipe", "length": LENGTH, "elements": elements}
    profile = [[z, u, 0.0] for z, u in zip((0.0, CHORD), CURRENT, strict=True)]
    return {
        "title": "A riser shaken by its vortices",
        "gravity": GRAVITY,
        "dimension": 3,
        "water": {"density": WATER, "current": {"profile": profile}},
        "line_types": {"pipe": pipe},
        "riser": {"segments": [segment], "initial": "straight", **ends},
        "stages": [{"name": "rest", "kind": "static"}, dynamic],
        "output": {"interval": RECORDS, "xdmf_interval": DURATION},
    }
