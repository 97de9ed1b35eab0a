"""Scenes beyond a bifurcation: a column, a blade that buckles sideways, a right-angle frame."""

from __future__ import annotations

from typing import Any

import numpy as np

from tests.support.coupled_scenes import Mapping
from tests.support.riser_scenes import prescribed, riser_scene, static

EULER = 0.25 * np.pi**2  # of a cantilever of unit length and bending stiffness
ALONG, SLANTING = (1.0, 0.0, 0.0), (0.6, 0.0, 0.8)


def column(elements: int, ratio: float, EA: float = 1e7, dimension: int = 2, axis: Any = ALONG) -> Mapping:
    """A straight cantilever without weight or imperfection, pushed along its axis by `ratio` times Euler's load."""
    load = {"at": "end", "force": [-ratio * EULER * a for a in axis]}
    more: Mapping = {"riser": {"unstressed": {"points": [[0.0, 0.0, 0.0], list(axis)]}}, "dimension": dimension}
    ends: Mapping = {"start": prescribed(0.0, 0.0, 0.0, rotation="fixed"), "end": "free"}
    pipe = {"EA": EA, "EI": 1.0, "GJ": 1.0}
    return riser_scene(static(loads=[load]), pipe=pipe, length=1.0, elements=elements, **ends, **more)


def blade(elements: int, force: float) -> Mapping:
    """The cantilever blade of `test_space_beams`, loaded across its deep section at the tip."""
    load = {"at": "end", "force": [0.0, 0.0, -force]}
    more: Mapping = {"riser": {"unstressed": {"points": [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]}}, "dimension": 3}
    ends: Mapping = {"start": prescribed(0.0, 0.0, 0.0, rotation="fixed"), "end": "free"}
    pipe = {"EA": 1e5, "EI_y": 1e3, "EI_z": 1.0, "GJ": 0.5}
    return riser_scene(static(loads=[load]), pipe=pipe, length=1.0, elements=elements, **ends, **more)


def frame(elements: int, force: float, across: float = 0.0) -> Mapping:
    """The right-angle frame of `test_space_beams`, N and mm, its joint bent within the two elements beside it.

    force: in its plane, positive pulls the clamped leg; across: out of it.
    """
    soft, deep = 71240.0 * 30.0 * 0.6**3 / 12.0, 71240.0 * 0.6 * 30.0**3 / 12.0
    pipe = {"EA": 71240.0 * 18.0, "EI_y": deep, "EI_z": soft, "GJ": 71240.0 / 2.62 * 30.0 * 0.6**3 / 3.0}
    points = [[0.0, 0.0, 0.0], [240.0, 0.0, 0.0], [240.0, 0.0, -240.0]]
    load = {"at": "end", "force": [force, across, 0.0]}
    ends: Mapping = {"start": prescribed(0.0, 0.0, 0.0, rotation="fixed"), "end": "free"}
    more: Mapping = {"riser": {"unstressed": {"points": points}}, "dimension": 3}
    return riser_scene(static(loads=[load]), pipe=pipe, length=480.0, elements=elements, **ends, **more)
