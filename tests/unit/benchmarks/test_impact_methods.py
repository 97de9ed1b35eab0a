"""The energy-consistent contact law that the benchmark of impact compares with."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.impact_methods import DiscreteGradient
from riser_soil.contact.law import Penalty

PENALTY = Penalty(1e6, 1e-3)
DEPTHS = np.array([-5e-3, -8e-4, 2e-4, 1.5e-3, 4e-3])
LAW = DiscreteGradient(PENALTY)


@pytest.mark.parametrize("before", DEPTHS)
def test_work_of_a_step_is_the_change_of_the_potential(before: float) -> None:
    force = LAW.update(DEPTHS, np.full((DEPTHS.size, 1), before)).force
    change = PENALTY.potential(DEPTHS) - PENALTY.potential(np.array(before))
    np.testing.assert_allclose(force * (DEPTHS - before), change, atol=1e-14)


@pytest.mark.parametrize("before", DEPTHS + 1e-4)
def test_slope_is_exact(before: float) -> None:
    history, h = np.full((DEPTHS.size, 1), before), 1e-7
    plus, minus = (LAW.update(DEPTHS + s, history).force for s in (h, -h))
    slope = LAW.update(DEPTHS, history).slope
    np.testing.assert_allclose(slope, (plus - minus) / (2.0 * h), rtol=1e-4, atol=1e-4 * PENALTY.stiffness)


@pytest.mark.parametrize("depth", DEPTHS)
def test_short_way_is_the_penalty(depth: float) -> None:
    """Without a jump where the difference quotient would be round-off."""
    history = np.full((2, 1), depth)
    force, slope, _, _ = LAW.update(depth + np.array([9e-9, 2e-8]), history)
    np.testing.assert_allclose(force, PENALTY.force(np.array(depth)), rtol=1e-4, atol=0.02)
    np.testing.assert_allclose(slope, 0.5 * PENALTY.slope(np.array(depth)), rtol=2e-2, atol=1e-3)


def test_touches_while_it_leaves() -> None:
    """Contact that ends within the step still gives back its potential."""
    assert LAW.answers(np.array([-1.0, -1.0]), np.array([[1e-3], [-0.5]])).acts.tolist() == [True, False]
