"""The artificial drag of dynamic relaxation: its tangent, and that it resists all that moves."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.bodies.body import MovingBody
from riser_soil.core.part import Forces, State, Weights
from riser_soil.solve.dynamic_relaxation import Relaxation
from tests.support.sample_line import sample

DRAG = 700.0
STATIC = Weights(inertia=0.0, force=1.0, shift_v=0.0, shift_a=0.0)


@pytest.mark.parametrize("dimension", [2, 3])
def test_tangent_and_resistance(dimension: int) -> None:
    line = sample(dimension).line
    part = Relaxation([line], DRAG)
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


@pytest.mark.parametrize("turns", [False, True], ids=["point", "rigid"])
def test_a_body_meets_the_drag_of_a_length_of_line(turns: bool) -> None:
    """Forces by its tangent; a turn meets them at its lever."""
    line, body = sample(3).line, MovingBody("buoy", np.zeros(3), turns, lever=2.0)
    body.offset = line.size
    part, size = Relaxation([line], DRAG, {body: 5.0}), line.size + body.size
    u = np.random.default_rng(4).normal(size=size)
    forces = Forces.zeros(size)
    part.residual(State(1.0, u, np.zeros(size), np.zeros(size)), forces)
    values = {name: block.zeros() for name, block in part.blocks().items()}
    part.tangent(State.at_rest(1.0, size), STATIC, values)
    met = forces.force[body.part]
    assert met == pytest.approx(values["buoy"][0] @ u[body.part], rel=1e-12)
    assert met[:3] == pytest.approx(5.0 * DRAG * u[body.part][:3])
    assert met[3:] == pytest.approx(20.0 * DRAG * u[body.part][3:])
