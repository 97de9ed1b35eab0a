"""Paths of a pipe into a seabed and out again, and the work that they take."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.seabed.aubeny_biscontin import AubenyBiscontin
from riser_soil.seabed.aubeny_biscontin_formula import AubenyBiscontinFormula
from riser_soil.seabed.law import NormalLaw
from riser_soil.seabed.randolph_quiggin import RandolphQuiggin
from riser_soil.seabed.randolph_quiggin_formula import RandolphQuigginFormula


def randolph_quiggin(D: float, su: float, su_gradient: float = 0.0, **constants: float) -> RandolphQuigginFormula:
    """Clay under a pipe of diameter D [m]."""
    return RandolphQuiggin(kind="randolph-quiggin", su=su, su_gradient=su_gradient, **constants).of_pipe(D)


def aubeny_biscontin(D: float, su: float, su_gradient: float = 0.0, **constants: float) -> AubenyBiscontinFormula:
    """A seafloor under a pipe of diameter D [m]."""
    return AubenyBiscontin(kind="aubeny-biscontin", su=su, su_gradient=su_gradient, **constants).of_pipe(D)


def through(*turns: float, steps: int = 80) -> Array:
    """Even steps from turn to turn, without the first point."""
    return np.concatenate([np.linspace(a, b, steps + 1)[1:] for a, b in pairwise(turns)])


def after(law: NormalLaw, path: Array) -> Array:
    """History (1, nh) of one point at the end of a path."""
    history = law.initial_history((1,))
    for z in path:
        history = law.update(np.array([z]), history).history
    return history


def forces(law: NormalLaw, path: Array, history: Array | None = None) -> Array:
    """Force at each point of a path that is taken step by step."""
    history = law.initial_history((1,)) if history is None else history
    values = np.empty(path.size)
    for i, z in enumerate(path):
        answer = law.update(np.array([z]), history)
        values[i], history = answer.force[0], answer.history
    return values


def work(path: Array, force: Array, begin: float = 0.0) -> Array:
    """Work taken up to each point, with the force at the end of each step, as an implicit step takes it."""
    return np.cumsum(force * np.diff(path, prepend=begin))


def at(law: NormalLaw, z: Array, history: Array) -> tuple[Array, Array]:
    """Force and slope of one step from a history to each of some penetrations."""
    answer = law.update(z, np.repeat(history, z.size, axis=0))
    return answer.force, answer.slope
