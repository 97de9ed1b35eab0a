"""The wet share of the pipe, and the buoyancy that the dry share loses, against Archimedes."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

from riser_soil.arrays import Array
from riser_soil.part import State
from riser_soil.riser import shapes
from riser_soil.riser.line import End, Line
from riser_soil.sea.buoyancy import Buoyancy
from riser_soil.sea.pipe import Pipe
from riser_soil.sea.wetting import FlatSurface, Wetting, dry_height, wet_share, wet_slope
from tests.dense_chain import residual

D, L, LEVEL, WEIGHT = 0.6, 6.0, 2.0, 2000.0


@pytest.mark.parametrize("draught", [0.02, 0.2, 0.3, 0.47, 0.6])
def test_share_of_a_lying_circle_by_quadrature(draught: float) -> None:
    h = np.array([draught - 0.5 * D])
    chords = quad(lambda z: 2.0 * np.sqrt(z * (D - z)), 0.0, draught)[0]
    assert wet_share(h, np.array([D])) == pytest.approx(chords / (0.25 * np.pi * D**2), rel=1e-10)


def test_beyond_the_pipe_all_is_wet_or_dry() -> None:
    h, b = np.array([-np.inf, -0.31, 0.31, np.inf]), np.array([D])
    assert wet_share(h, b).tolist() == [0.0, 0.0, 1.0, 1.0]
    assert not np.any(wet_slope(h, b))
    assert dry_height(h[1:], b) == pytest.approx([0.31, 0.0, 0.0])


def test_slope_and_integral_belong_to_the_share() -> None:
    h, b, step = np.linspace(-0.29, 0.29, 40), np.array([D]), 1e-6
    assert (wet_share(h + step, b) - wet_share(h - step, b)) / (2 * step) == pytest.approx(wet_slope(h, b), rel=1e-6)
    falling = (dry_height(h - step, b) - dry_height(h + step, b)) / (2 * step)
    assert falling == pytest.approx(1.0 - wet_share(h, b), rel=1e-6, abs=1e-9)


def pipe(start: Array, tangent: Array, elements: int, dimension: int) -> Pipe:
    arc = np.linspace(0.0, L, elements + 1)
    curve = shapes.straight(arc, start, tangent)
    layout = shapes.layout(arc, np.full(elements, D), curve, curve)
    return Pipe(Line(dimension, layout, End(False), End(False)))


def lost(at: Pipe) -> tuple[float, float]:
    """Weight [N] and potential [J] of what is dry."""
    part = Buoyancy(at, Wetting(at, FlatSurface(at, LEVEL)), np.full(at.line.length.size, WEIGHT), flat=True)
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
    """On the mean over its heights exactly; anywhere, to 3 % of an element."""
    up, elements = np.array([0.0, 0.0, 1.0]), 4
    out = np.linspace(2.0, 3.5, 60, endpoint=False)  # an element's length of drier and drier pipe
    pipes = [pipe(np.array([0.0, 0.0, LEVEL - L + o]), up, elements, dimension) for o in out]
    dry = np.array([lost(at)[0] for at in pipes]) / WEIGHT
    assert dry.mean() == pytest.approx(out.mean(), rel=1e-12)
    assert np.abs(dry - out).max() < 0.03 * L / elements


def test_lifting_a_pipe_out_of_the_water_takes_its_lost_weight() -> None:
    heights = np.linspace(-0.5, 0.9, 400)
    found = [lost(pipe(np.array([0.0, 0.0, LEVEL + h]), np.array([1.0, 0.0, 0.0]), 3, 3)) for h in heights]
    force, potential = np.array(found).T
    assert potential[0] == 0.0
    work = np.concatenate([[0.0], np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(heights))])
    assert work == pytest.approx(potential, abs=1e-5 * potential[-1])
