"""The cushion on which a riser is laid: how it bears, fades and is absent beside the soil; its tangent."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.contact.seabed_contact import Cushion
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.riser import shapes
from riser_soil.riser.line import Line
from riser_soil.riser.line_ends import End
from tests.support.covered_ground import beyond
from tests.support.dense_chain import STATIC, residual, tangent
from tests.support.differences import difference_tangent, error

RADIUS, LEVEL, WEIGHT, DEPTH = 0.15, -2.0, 700.0, 0.003


def lying(dimension: int = 2, above: float = 0.0, covered: float = np.inf) -> tuple[Line, Cushion]:
    """A straight pipe whose underside is so far above the soil; nothing but the cushion up to x = covered."""
    arc = np.linspace(0.0, 10.0, 6)
    flat = shapes.straight(arc, (0.0, 0.0, LEVEL + RADIUS + above))
    line = Line(dimension, shapes.layout(arc, np.full(5, 0.3), flat, flat), End(False), End(False))
    return line, Cushion(line, np.full(5, RADIUS), LEVEL, WEIGHT, DEPTH, beyond(-1.0, covered))


def at(line: Line, t: float, u: Array | None = None) -> State:
    u = np.zeros(line.size) if u is None else u
    return State(t, u, np.zeros(line.size), np.zeros(line.size))


def borne(line: Line, cushion: Cushion, t: float) -> float:
    forces = residual([cushion], at(line, t))
    return -float(forces[line.translation_dofs[:, -1]].sum())


@pytest.mark.parametrize(("t", "share"), [(0.0, 1.0), (0.25, 0.5625), (0.5, 0.25), (1.0, 0.0)])
def test_a_pipe_that_touches_the_soil_is_borne_and_the_less_the_farther(t: float, share: float) -> None:
    line, cushion = lying()
    assert borne(line, cushion, t) == pytest.approx(share * WEIGHT * 10.0, rel=1e-9)


def test_beside_the_soil_there_is_none() -> None:
    line, cushion = lying(covered=4.0)
    assert borne(line, cushion, 0.0) == pytest.approx(4.0 * WEIGHT, rel=1e-9)
    line, cushion = lying(above=2.0 * DEPTH)
    assert borne(line, cushion, 0.0) == 0.0


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_tangent_is_the_slope_of_the_residual(dimension: int) -> None:
    line, cushion = lying(dimension, above=0.3 * DEPTH)
    random = np.random.default_rng(3)
    state = at(line, 0.3, 2e-4 * random.normal(size=line.size))
    wanted = difference_tangent(cushion, state, STATIC, h=1e-6)
    assert error(tangent([cushion], state), wanted) < 1e-6
