"""Paths of a pipe into a seabed and out again, and the work that they take."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from riser_soil.contact.law import NormalLaw
from riser_soil.core.arrays import Array


def through(*turns: float, steps: int = 80) -> Array:
    """Even steps from turn to turn, without the first point."""
    return np.concatenate([np.linspace(a, b, steps + 1)[1:] for a, b in pairwise(turns)])


def after(law: NormalLaw, path: Array) -> Array:
    """History (1, nh) of one point at the end of a path."""
    history = law.initial_history((1,))
    for z in path:
        history = law.update(np.array([z]), history)
    return history


def forces(law: NormalLaw, path: Array, history: Array | None = None) -> Array:
    """Force at each point of a path that is taken step by step."""
    history = law.initial_history((1,)) if history is None else history
    found = np.empty(path.size)
    for i, z in enumerate(path):
        found[i] = law.force_and_stiffness(np.array([z]), history)[0][0]
        history = law.update(np.array([z]), history)
    return found


def work(path: Array, force: Array, begin: float = 0.0) -> Array:
    """Work taken up to each point, with the force at the end of each step, as an implicit step takes it."""
    return np.cumsum(force * np.diff(path, prepend=begin))


def at(law: NormalLaw, z: Array, history: Array) -> tuple[Array, Array]:
    """Force and slope of one step from a history to each of some penetrations."""
    return law.force_and_stiffness(z, np.repeat(history, z.size, axis=0))
