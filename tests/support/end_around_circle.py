"""Scene of a riser whose end is led once around its start on a circle of 60 m, either way."""

from __future__ import annotations

import numpy as np

from tests.support.coupled_scenes import Mapping
from tests.support.riser_scenes import dynamic, prescribed, riser_scene, static

R, LENGTH, DURATION = 30.0, 60.0, 40.0
PIPE: Mapping = {"EA": 3e8, "EI": 5e4, "GJ": 4e4, "mass": 120.0, "outer_diameter": 0.3}
PIPE |= {"drag": {"normal": 1.1}, "added_mass": {"normal": 1.0}}
LARGEST = {1: 34375.0, -1: 47563.0}
"""Tension at the start [N], up first (+1) or down first (-1), in 2,000 steps."""


def way_around(way: int, side: int) -> str:
    """A motion table: once around, up (+1) or down (-1) first, from a side, +x or -x, with a smooth start and end."""
    t = np.linspace(0.0, DURATION, 161)
    s = t / DURATION
    angle = 2.0 * np.pi * way * (10.0 * s**3 - 15.0 * s**4 + 6.0 * s**5)
    x, z = side * R * (np.cos(angle) - 1.0), R * np.sin(angle)
    rows = (f"{a:.9g},{b:.15g},0,{c:.15g}" for a, b, c in zip(t, x, z, strict=True))
    return "\n".join(("t [s],x [m],y [m],z [m]", *rows)) + "\n"


def end_led_around(table: str, side: int, time_step: float, elements: int = 60, dimension: int = 2) -> Mapping:
    """table: the name of a file that holds `way_around`."""
    return riser_scene(
        static(),
        dynamic(DURATION, time_step, motion={"end": {"table": table}}),
        pipe=PIPE,
        length=LENGTH,
        elements=elements,
        start=prescribed(0.0, 0.0, 0.0),
        end=prescribed(side * R, 0.0, 0.0),
        gravity=9.81,
        water={"density": 1025.0},
        dimension=dimension,
    )
