"""The catenary guess against its closed forms and against balance."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from riser_soil.errors import SceneError
from riser_soil.riser.catenary import Catenary, catenary

ARC = np.linspace(0.0, 350.0, 3501)
W, STIFF = 346.1, 1.0e15
ORIGIN = np.zeros(3)


def balance(found: Catenary, weight: float) -> float:
    """Largest error of dT/ds = w z: the change of the vertical force between nodes, over the weight between
    them.
    """
    vertical = found.tension * np.append(found.curve.tangent[:, 0, 2], found.curve.tangent[-1, 1, 2])
    return float(np.abs(np.diff(vertical) - weight * np.diff(ARC)).max() / (weight * ARC[1]))


def test_hanging_line_fulfils_the_closed_form() -> None:
    found = catenary(ARC, ORIGIN, np.array([150.0, 0.0, 150.0]), W, STIFF)
    a = found.H / W
    assert np.sqrt(350.0**2 - 150.0**2) == pytest.approx(2.0 * a * np.sinh(150.0 / (2.0 * a)), rel=1e-9)
    assert found.curve.position[-1] == pytest.approx([150.0, 0.0, 150.0], abs=1e-9)
    assert balance(found, W) < 1e-9


def test_ends_at_one_level_are_symmetric() -> None:
    found = catenary(ARC, ORIGIN, np.array([0.0, 200.0, 0.0]), W, STIFF)
    assert found.curve.position[1750, 1] == pytest.approx(100.0)
    assert found.tension[0] == pytest.approx(found.tension[-1])
    assert found.tension[0] == pytest.approx(np.hypot(found.H, 0.5 * W * 350.0))


@given(
    st.floats(1.0, 340.0),
    st.floats(-200.0, 200.0),
    st.floats(0.0, 6.0),
    st.floats(3.0, 9.0),
)
def test_any_hanging_line_ends_where_it_should(h: float, v: float, heading: float, log_EA: float) -> None:
    if np.hypot(h, v) > 345.0:
        return
    end = np.array([h * np.cos(heading), h * np.sin(heading), v])
    found = catenary(ARC, ORIGIN, end, W, W * 350.0 * 10.0**log_EA)
    assert found.curve.position[-1] == pytest.approx(end, abs=1e-8)


def test_elastic_line_is_longer_by_its_tension() -> None:
    EA = 1.0e7
    found = catenary(ARC, ORIGIN, np.array([150.0, 0.0, 150.0]), W, EA)
    length = np.linalg.norm(found.curve.chord, axis=1)
    strain = 0.5 * (found.tension[1:] + found.tension[:-1]) / EA
    assert length / np.diff(ARC) - 1.0 == pytest.approx(strain, rel=1e-3, abs=1e-7)
    assert balance(found, W) < 1e-9


def test_resting_line_fulfils_the_closed_form() -> None:
    arc = np.linspace(0.0, 40.0, 401)
    found = catenary(arc, ORIGIN, np.array([28.0, 0.0, 15.0]), 147.1, STIFF, level=0.0)
    a = found.H / 147.1
    suspended = np.sqrt(15.0**2 + 2.0 * a * 15.0)
    assert a * np.arccosh(1.0 + 15.0 / a) + 40.0 - suspended == pytest.approx(28.0, rel=1e-10)
    assert found.curve.position[-1] == pytest.approx([28.0, 0.0, 15.0], abs=1e-9)
    resting = arc < 40.0 - suspended
    assert np.all(found.curve.position[resting, 2] == 0.0)
    assert found.tension[resting] == pytest.approx(found.H)
    assert found.tension[-1] == pytest.approx(147.1 * (15.0 + a))


def test_resting_elastic_line_ends_where_it_should() -> None:
    arc = np.linspace(0.0, 40.0, 401)
    end = np.array([30.0, 2.0, 15.15])
    found = catenary(arc, np.array([1.0, 2.0, 0.15]), end, 147.1, 1.0e5, level=0.15)
    assert found.curve.position[-1] == pytest.approx(end, abs=1e-9)
    assert found.curve.position[:, 2].min() == pytest.approx(0.15, abs=1e-12)
    ground = np.linalg.norm(found.curve.chord[0]) / 0.1 - 1.0
    assert ground == pytest.approx(found.H / 1.0e5, rel=1e-9)


def test_both_ends_may_hang_above_the_ground() -> None:
    arc = np.linspace(0.0, 148.0, 149)
    start, end = np.array([0.0, 0.0, 20.0]), np.array([60.0, 0.0, 80.0])
    found = catenary(arc, start, end, 600.0, 3.0e8, level=2.0)
    assert found.curve.position[0] == pytest.approx(start)
    assert found.curve.position[-1] == pytest.approx(end, abs=1e-8)
    assert found.curve.position[:, 2].min() == pytest.approx(2.0)
    assert np.sum(found.curve.position[:, 2] < 2.0 + 1e-9) > 3


def test_a_line_that_clears_the_seabed_hangs() -> None:
    free = catenary(ARC, ORIGIN, np.array([150.0, 0.0, 150.0]), W, STIFF)
    above = catenary(ARC, ORIGIN, np.array([150.0, 0.0, 150.0]), W, STIFF, level=-200.0)
    assert np.array_equal(free.curve.position, above.curve.position)


@pytest.mark.parametrize(
    ("end", "weight", "level", "message"),
    [
        ([300.0, 0.0, 200.0], W, -np.inf, r"too short for a catenary: its length of 350 m .* 360\.555 m"),
        ([0.0, 0.0, 100.0], W, -np.inf, "give initial points"),
        ([100.0, 0.0, 100.0], -5.0, -np.inf, r"positive submerged weight, not -5 N/m"),
        ([100.0, 0.0, -3.0], W, -1.0, r"z = -3 m lies below the level -1 m"),
        ([100.0, 0.0, 50.0], W, 0.0, r"too long: with 300 m left to rest .* 100 m away"),
    ],
)
def test_impossible_catenaries_are_refused(
    end: list[float], weight: float, level: float, message: str
) -> None:
    with pytest.raises(SceneError, match=message):
        catenary(ARC, ORIGIN, np.array(end), weight, STIFF, level)
