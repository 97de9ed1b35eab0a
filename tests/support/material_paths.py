"""One material point along paths of strain, for tests: its stress, and what it dissipates."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.soil import mandel
from riser_soil.soil.law import Formula, StressUpdate


def initial_stress(n: int, K0: float, shallow: float = 2000.0, deep: float = 6000.0) -> Array:
    """Geostatic stress (n, 6) [Pa] under vertical pressures from shallow to deep."""
    pressure = np.linspace(shallow, deep, n)
    return np.column_stack([-K0 * pressure, -K0 * pressure, -pressure, *np.zeros((3, n))])


def dissipated(initial: Array, increment: Array, before: StressUpdate, after: StressUpdate) -> Array:
    """Work of the stress at the increment's end less the change of what is stored (n,) [J/m3]."""
    by_initial = mandel.product(initial, after.elastic - before.elastic)
    return np.asarray(mandel.product(after.stress, increment) - (after.stored - before.stored) - by_initial)


def at_start(law: Formula, n: int) -> StressUpdate:
    return law.update(np.zeros((n, 6)), law.start())


def random_paths(
    law: Formula, initial: Array, steps: int, seed: int, largest: float = -0.5, seconds: Sequence[float] = (math.inf,)
) -> float:
    """Random increments of 1e-7 to 10^largest at n points, within these seconds in turn; asserts finite numbers and no
    work given back; the worst stress over its limit.
    """
    rng, n, worst = np.random.default_rng(seed), len(initial), 0.0
    before = at_start(law, n)
    for step in range(steps):
        increment = 10.0 ** rng.uniform(-7.0, largest, (n, 1)) * rng.standard_normal((n, 6))
        update = law.update(increment, before.history, seconds[step % len(seconds)])
        assert all(np.isfinite(values).all() for values in update), step
        lost = dissipated(initial, increment, before, update)
        scale = np.abs(update.stored) + mandel.product(np.abs(update.stress), np.abs(increment)) + 1e-9
        assert np.min(lost / scale) > -1e-10, step
        worst = max(worst, float(law.overstress(update.stress).max()))
        before = update
    return worst
