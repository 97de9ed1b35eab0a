"""The artificial drag of dynamic relaxation: its tangent, and that it resists all that moves."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.core.part import Forces, State, Weights
from riser_soil.solve.dynamic_relaxation import Relaxation
from tests.support.sample_line import sample

DRAG = 700.0
STATIC = Weights(inertia=0.0, force=1.0, shift_v=0.0, shift_a=0.0)


@pytest.mark.parametrize("dimension", [2, 3])
def test_tangent_and_resistance(dimension: int) -> None:
    line = sample(dimension).line
    part = Relaxation(line, DRAG)
    u = np.random.default_rng(3).normal(size=line.size)
    forces = Forces.zeros(line.size)
    part.residual(State(1.0, u, np.zeros_like(u), np.zeros_like(u)), forces)
    block = line.element_block()
    values = {"riser": block.zeros()}
    part.tangent(State.at_rest(1.0, line.size), STATIC, values)
    product = np.zeros(line.size)
    np.add.at(product, block.rows, np.einsum("eij,ej->ei", values["riser"], u[block.cols]))
    assert product == pytest.approx(forces.force, rel=1e-12)
    assert np.all(forces.force * u > 0.0)
    shift = np.zeros((line.nodes, line.ndof))
    shift[:, 0] = 1.0
    uniform = Forces.zeros(line.size)
    part.residual(State(1.0, shift.ravel(), np.zeros_like(u), np.zeros_like(u)), uniform)
    assert uniform.force.sum() == pytest.approx(DRAG * line.arc[-1])
