"""The wet share of the pipe, and the buoyancy that the dry share loses, against Archimedes."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import pytest
from scipy.integrate import quad

from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.riser import shapes
from riser_soil.riser.line import End, Line
from riser_soil.sea.buoyancy import Buoyancy, dry_pipe
from riser_soil.sea.flows import Sea, WaterMotion, add_flow
from riser_soil.sea.pipe import Pipe
from riser_soil.sea.stream_kernels import FlowAtStations
from riser_soil.sea.waterline import dry_height, wet_share, wet_slope
from tests.support.dense_chain import residual

pytestmark = pytest.mark.usefixtures("uncompiled")

D, L, LEVEL, WEIGHT = 0.6, 6.0, 2.0, 2000.0


@pytest.mark.parametrize("draught", [0.02, 0.2, 0.3, 0.47, 0.6])
def test_share_of_a_lying_circle_by_quadrature(draught: float) -> None:
    wet = quad(lambda z: 2.0 * np.sqrt(z * (D - z)), 0.0, draught)[0]
    assert wet_share(draught - 0.5 * D, D) == pytest.approx(wet / (0.25 * np.pi * D**2), rel=1e-10)


def test_beyond_the_pipe_all_is_wet_or_dry() -> None:
    assert [wet_share(h, D) for h in (-np.inf, -0.31, 0.31, np.inf)] == [0.0, 0.0, 1.0, 1.0]
    assert not any(wet_slope(h, D) for h in (-np.inf, -0.31, 0.31, np.inf))
    assert [dry_height(h, D) for h in (-0.31, 0.31, np.inf)] == pytest.approx([0.31, 0.0, 0.0])


@pytest.mark.parametrize("h", np.linspace(-0.29, 0.29, 7))
def test_slope_and_integral_belong_to_the_share(h: float) -> None:
    step = 1e-6
    rise, fall = (f(h + step, D) - f(h - step, D) for f in (wet_share, dry_height))
    assert rise / (2.0 * step) == pytest.approx(wet_slope(h, D), rel=1e-6)
    assert -fall / (2.0 * step) == pytest.approx(1.0 - wet_share(h, D), rel=1e-6, abs=1e-9)


def pipe(start: Array, tangent: Array, elements: int, dimension: int) -> Pipe:
    arc = np.linspace(0.0, L, elements + 1)
    curve = shapes.straight(arc, start, tangent)
    layout = shapes.layout(arc, np.full(elements, D), curve, curve)
    return Pipe(Line(dimension, layout, End(False), End(False)))


def lost(at: Pipe) -> tuple[float, float]:
    """Weight [N] and potential [J] of what is dry."""
    part = Buoyancy(FlowAtStations(at, Sea(LEVEL)), dry_pipe(np.full(at.line.length.size, WEIGHT)), flat=True)
    state = State.at_rest(0.0, at.line.size)
    return float(at.line.nodal(residual([part], state))[:, at.line.dimension - 1].sum()), part.energy(state).potential


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("height", [-0.2, 0.0, 0.25])
def test_a_lying_pipe_floats_by_archimedes(height: float, dimension: int) -> None:
    at = pipe(np.array([0.0, 0.0, LEVEL + height]), np.array([1.0, 0.0, 0.0]), 5, dimension)
    dry = quad(lambda z: 2.0 * np.sqrt(0.25 * D**2 - z * z), -height, 0.5 * D)[0] / (0.25 * np.pi * D**2)
    assert lost(at)[0] == pytest.approx(WEIGHT * L * dry, rel=1e-9)


@pytest.mark.parametrize("dimension", [2, 3])
def test_an_upright_pipe_floats_by_archimedes(dimension: int) -> None:
    """On the mean over its heights exactly; anywhere, to 0.03 % of an element; its waterplane to 5 %."""
    up, elements = np.array([0.0, 0.0, 1.0]), 4
    out = np.linspace(2.0, 3.5, 60, endpoint=False)  # an element's length of drier and drier pipe
    pipes = [pipe(np.array([0.0, 0.0, LEVEL - L + o]), up, elements, dimension) for o in out]
    dry = np.array([lost(at)[0] for at in pipes]) / WEIGHT
    assert dry.mean() == pytest.approx(out.mean(), rel=1e-12)
    assert np.abs(dry - out).max() < 3e-4 * L / elements
    assert np.diff(dry) == pytest.approx(np.diff(out), rel=0.05)


class Ripple(NamedTuple):
    """A flow: a rippled surface, by its wave number [1/m]."""

    k: float


@add_flow.of(Ripple)
def _ripple(flow: Ripple, motion: WaterMotion, t: Array, x: Array) -> None:
    for p in range(x.shape[0]):
        motion.immersion[p] += 0.2 * math.cos(flow.k * x[p, 0])
        motion.immersion_gradient[p, 0] -= 0.2 * flow.k * math.sin(flow.k * x[p, 0])


def test_a_wavy_surface_is_followed_between_the_stations() -> None:
    """Waves of 12 m, of which an element holds a tenth."""
    k = 2.0 * np.pi / 12.0
    at = pipe(np.array([0.0, 0.0, LEVEL + 0.1]), np.array([1.0, 0.0, 0.0]), 5, 2)
    part = Buoyancy(FlowAtStations(at, Sea(LEVEL, [Ripple(k)])), dry_pipe(np.ones(5)), flat=False)
    buoyancy = at.line.nodal(residual([part], State.at_rest(0.0, at.line.size)))[:, 1].sum()
    expected = quad(lambda x: 1.0 - wet_share(0.2 * np.cos(k * x) - 0.1, D), 0.0, L, epsabs=1e-10, limit=200)[0]
    assert buoyancy == pytest.approx(expected, rel=1e-4)


def test_lifting_a_pipe_out_of_the_water_takes_its_lost_weight() -> None:
    heights = np.linspace(-0.5, 0.9, 400)
    works = [lost(pipe(np.array([0.0, 0.0, LEVEL + h]), np.array([1.0, 0.0, 0.0]), 3, 3)) for h in heights]
    force, potential = np.array(works).T
    assert potential[0] == 0.0
    work = np.concatenate([[0.0], np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(heights))])
    assert work == pytest.approx(potential, abs=1e-5 * potential[-1])
