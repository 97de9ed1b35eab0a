"""The catenary against closed forms, piecewise catenaries found by shooting, and balance."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq, fsolve

from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.riser.catenary import Catenary, bend_of_curvature, catenary, curvature
from riser_soil.riser.shapes import X

ARC = np.linspace(0.0, 350.0, 3501)
W, STIFF = 346.1, 1.0e15
ORIGIN = np.zeros(3)
COUNTS = (250, 500, 1000)


def vertical(cable: Catenary) -> Array:
    """Vertical force at the nodes (nn,) N."""
    return np.asarray(cable.tension * np.append(cable.curve.tangent[:, 0, 2], cable.curve.tangent[-1, 1, 2]))


def balance(cable: Catenary, weight: float) -> float:
    """Largest error of dT/ds = w z: the change of the vertical force between nodes, over the weight between
    them.
    """
    return float(np.abs(np.diff(vertical(cable)) - weight * np.diff(ARC)).max() / (weight * ARC[1]))


def require_second_order(error: Callable[[int], float], finest: float) -> None:
    """error: of the number of bars. finest: what the error may be with the last of COUNTS."""
    errors = np.array([error(count) for count in COUNTS])
    orders = np.log2(errors[:-1] / errors[1:])
    assert np.all(orders > 1.8), f"errors {errors}, orders {orders}"
    assert errors[-1] < finest


# Closed forms


def test_hanging_line_tends_to_the_closed_form() -> None:
    a = brentq(lambda a: 2.0 * a * np.sinh(75.0 / a) - np.sqrt(350.0**2 - 150.0**2), 10.0, 100.0, xtol=1e-13)
    nodes, end = np.linspace(0.0, 350.0, 26), np.array([150.0, 0.0, 150.0])
    require_second_order(lambda n: abs(catenary(nodes, ORIGIN, end, W, STIFF, bars=n).H / (W * a) - 1.0), 3e-7)
    assert abs(catenary(nodes, ORIGIN, end, W, STIFF).H / (W * a) - 1.0) < 1e-7


def test_curvature_and_how_it_bends_are_derivatives_of_the_angle() -> None:
    """A cable rises by atan(w s/H) at s from its lowest point."""
    H, s, h = 4.0e4, np.array([-300.0, -20.0, 0.0, 50.0, 66.0, 400.0]), 0.05
    T = np.hypot(H, W * s)
    angle = [np.arctan(W * (s + n * h) / H) for n in (-2, -1, 0, 1, 2)]
    assert curvature(np.array(W), H, T) == pytest.approx((angle[3] - angle[1]) / (2.0 * h), rel=1e-6)
    third = np.abs(angle[4] - 2.0 * angle[3] + 2.0 * angle[1] - angle[0]) / (2.0 * h**3)
    assert bend_of_curvature(np.array(W), H, T) == pytest.approx(third, abs=1e-4 * third.max())


def test_hanging_line_is_balanced() -> None:
    cable = catenary(ARC, ORIGIN, np.array([150.0, 0.0, 150.0]), W, STIFF)
    assert cable.curve.position[-1] == pytest.approx([150.0, 0.0, 150.0], abs=1e-9)
    assert balance(cable, W) < 1e-9
    assert cable.slack == 0.0


def test_ends_at_one_level_are_symmetric() -> None:
    cable = catenary(ARC, ORIGIN, np.array([0.0, 200.0, 0.0]), W, STIFF)
    assert cable.curve.position[1750, 1] == pytest.approx(100.0)
    assert cable.tension[0] == pytest.approx(cable.tension[-1])
    assert cable.tension[0] == pytest.approx(np.hypot(cable.H, 0.5 * W * 350.0))


def test_elastic_line_is_longer_by_its_tension() -> None:
    EA = 1.0e7
    cable = catenary(ARC, ORIGIN, np.array([150.0, 0.0, 150.0]), W, EA)
    length = np.linalg.norm(cable.curve.chord, axis=1)
    strain = 0.5 * (cable.tension[1:] + cable.tension[:-1]) / EA
    assert length / np.diff(ARC) - 1.0 == pytest.approx(strain, rel=1e-3, abs=1e-7)
    assert balance(cable, W) < 1e-9


def test_resting_line_tends_to_the_closed_form() -> None:
    """Length 40 m, its end 28 m away and 15 m up: a arccosh(1 + 15/a) + 40 - sqrt(15^2 + 30 a) = 28."""
    a = brentq(lambda a: a * np.arccosh(1.0 + 15.0 / a) + 12.0 - np.sqrt(225.0 + 30.0 * a), 1.0, 30.0, xtol=1e-13)
    arc, end, counts = np.linspace(0.0, 40.0, 41), np.array([28.0, 0.0, 15.0]), np.array([200, 400, 800, 1600, 3200])
    errors = [abs(catenary(arc, ORIGIN, end, 147.1, STIFF, 0.0, bars=n).H / (147.1 * a) - 1.0) for n in counts]
    assert np.all(errors < (40.0 / counts / a) ** 2), f"second order, with the touchdown anywhere in its bar: {errors}"


def test_resting_line_lies_on_the_seabed() -> None:
    arc, end = np.linspace(0.0, 40.0, 401), np.array([30.0, 2.0, 15.15])
    cable = catenary(arc, np.array([1.0, 2.0, 0.15]), end, 147.1, 1.0e5, level=0.15)
    assert cable.curve.position[-1] == pytest.approx(end, abs=1e-9)
    resting = (arc > 0.0) & (arc < 10.0)
    assert cable.curve.position[resting, 2] == pytest.approx(0.15, abs=1e-5)
    assert cable.tension[resting] == pytest.approx(cable.H, rel=1e-6)
    assert np.linalg.norm(cable.curve.chord[0]) / 0.1 - 1.0 == pytest.approx(cable.H / 1.0e5, rel=1e-6)


@pytest.mark.parametrize("moved", [0.1, 5.0, 120.0])
def test_it_is_found_from_one_nearby_and_from_one_far_away(moved: float) -> None:
    """Both ends in other places, the lower one lifted off the seabed by as much."""
    start, end = np.array([0.0, 0.0, moved]), np.array([230.0 - moved, 0.0, 150.0 + moved])
    near = catenary(ARC, ORIGIN, np.array([230.0, 0.0, 150.0]), W, 1e8, 0.0)
    cable, alone = (catenary(ARC, start, end, W, 1e8, 0.0, near=known) for known in (near, None))
    assert abs(near.H / alone.H - 1.0) > 1e-4
    assert abs(cable.H / alone.H - 1.0) < 1e-5
    assert np.abs(cable.curve.position - alone.curve.position).max() < 1e-3


def test_a_line_that_clears_the_seabed_hangs() -> None:
    free, above = (
        catenary(ARC, ORIGIN, np.array([150.0, 0.0, 150.0]), W, STIFF, level=level) for level in (-np.inf, -200.0)
    )
    assert above.curve.position == pytest.approx(free.curve.position, abs=1e-4)


def test_stretched_vertical_line() -> None:
    """Pulled up by 1 %: z(s) = s + (T0 s + w s^2/2)/EA."""
    EA, arc = 1.0e7, np.linspace(0.0, 100.0, 21)
    cable = catenary(arc, ORIGIN, np.array([0.0, 0.0, 101.0]), W, EA)
    T0 = 1.0 / 100.0 * EA - 0.5 * W * 100.0
    assert cable.curve.position[:, 2] == pytest.approx(arc + (T0 * arc + 0.5 * W * arc**2) / EA, abs=1e-5)
    assert cable.tension[[0, -1]] == pytest.approx([T0, T0 + 100.0 * W], rel=1e-5)


@pytest.mark.parametrize("end", [[99.999, 0.0, 0.0], [100.0, 0.0, 0.0], [100.5, 0.0, 0.0], [60.0, 0.0, 80.4]])
def test_nearly_straight_and_stretched_lines(end: list[float]) -> None:
    EA, arc = 1.0e9, np.linspace(0.0, 100.0, 51)
    cable = catenary(arc, ORIGIN, np.array(end), W, EA)
    assert cable.curve.position[-1] == pytest.approx(end, abs=1e-9)
    assert np.linalg.norm(cable.curve.chord, axis=1).sum() / 100.0 - 1.0 == pytest.approx(
        cable.tension.mean() / EA, abs=2e-7
    )


# Lines of several kinds, against catenaries joined by shooting


def joined(lengths: Array, weights: Array, EA: Array, loads: Array, end: Array, guess: Array) -> Array:
    """H and the vertical force at the start of inextensible or elastic pieces, each an exact catenary; loads (n,) N
    hang at the pieces' ends.
    """

    def misfit(log_H_and_V: Array) -> Array:
        H, V, place = np.exp(log_H_and_V[0]), log_H_and_V[1], np.zeros(2)
        for L, w, stiff, load in zip(lengths, weights, EA, loads, strict=True):
            end_V = V + w * L
            a, T = H / w, (np.hypot(H, V), np.hypot(H, end_V))
            place += [a * (np.arcsinh(end_V / H) - np.arcsinh(V / H)) + H * L / stiff, 0.0]
            place += [0.0, (T[1] - T[0]) / w + 0.5 * (V + end_V) * L / stiff]
            V = end_V + load
        return np.asarray(place - end)

    solution, _, status, message = fsolve(misfit, [np.log(guess[0]), guess[1]], xtol=1e-13, full_output=True)
    assert status == 1, message
    return np.array([np.exp(solution[0]), solution[1]])


SEVERAL = {
    "two segments": ([60.0, 90.0], [200.0, 900.0], [1e7, 4e7], [0.0, 0.0]),
    "point weight": ([50.0, 100.0], [300.0, 300.0], [1e8, 1e8], [2e4, 0.0]),
    "buoy": ([60.0, 90.0], [300.0, 300.0], [1e9, 1e9], [-1.8e4, 0.0]),
    "lazy wave": ([50.0, 40.0, 60.0], [300.0, -400.0, 300.0], [1e8, 1e8, 1e8], [0.0, 0.0, 0.0]),
}


@pytest.mark.parametrize("kind", SEVERAL)
def test_joined_pieces(kind: str) -> None:
    lengths, weights, EA, loads = (np.array(values) for values in SEVERAL[kind])
    end, arc, count = np.array([100.0, 0.0, 50.0]), np.linspace(0.0, 150.0, 31), np.rint(lengths / 5.0).astype(int)
    points = np.stack([np.cumsum(lengths), loads], axis=1)[:-1]

    def positions(bars: int) -> Array:
        line = catenary(arc, ORIGIN, end, np.repeat(weights, count), np.repeat(EA, count), points=points, bars=bars)
        return np.array([line.H, vertical(line)[0]])

    exact = joined(lengths, weights, EA, loads, end[[0, 2]], positions(2000))
    require_second_order(lambda n: float(np.abs(positions(n) - exact).max()) / np.abs(exact).max(), 2e-5)


def test_buoyant_stretch_lifts_off_the_seabed_between_two_that_touch() -> None:
    """What the seabed bears and what the ends carry make up the weight."""
    arc, w = np.linspace(0.0, 400.0, 101), np.full(100, 300.0)
    w[40:50] = -400.0
    cable = catenary(arc, ORIGIN, np.array([300.0, 0.0, 90.0]), w, 1e9, level=0.0)
    z = cable.curve.position[:, 2]
    touching = z < 1e-3
    starts = np.flatnonzero(np.diff(touching.astype(int)) == 1)
    assert touching[0]
    assert starts.size == 1, "two stretches touch"
    assert z[40:50].max() > 5.0
    assert z.min() > -1e-3
    last = np.flatnonzero(touching)[-1]
    assert vertical(cable)[-1] - vertical(cable)[last + 1] == pytest.approx((400.0 - arc[last + 1]) * 300.0, rel=1e-3)


# Any line


@given(st.floats(0.1, 340.0), st.floats(-200.0, 200.0), st.floats(0.0, 6.0), st.floats(3.0, 9.0))
def test_any_hanging_line_ends_where_it_should(h: float, v: float, heading: float, log_EA: float) -> None:
    if np.hypot(h, v) > 345.0:
        return
    end = np.array([h * np.cos(heading), h * np.sin(heading), v])
    cable = catenary(ARC[::50], ORIGIN, end, W, W * 350.0 * 10.0**log_EA)
    normal = np.array([np.cos(heading), np.sin(heading), 0.0])
    assert cable.curve.position[-1] == pytest.approx(end + cable.slack * normal, abs=1e-8)
    assert cable.slack == 0.0 or h < 5.0


@given(
    st.sampled_from([1.02, 0.9999, 0.9, 0.5, 0.0]),
    st.sampled_from([0.0, 0.5, 1.5, 0.5 * np.pi]),
    st.lists(st.sampled_from([-300.0, 0.0, 100.0, 1000.0]), min_size=1, max_size=5),
    st.sampled_from([-np.inf, -20.0, 0.0]),
    st.floats(4.0, 10.0),
)
def test_any_line_finds_its_balance(
    distance: float, slope: float, weights: list[float], level: float, log_EA: float
) -> None:
    if not any(weights):
        return
    w, end = np.repeat(weights, 60 // len(weights)), 100.0 * distance * np.array([np.cos(slope), 0.0, np.sin(slope)])
    arc = np.linspace(0.0, 100.0, w.size + 1)
    cable = catenary(arc, ORIGIN, end, w, 10.0**log_EA, level, bars=500)
    assert cable.curve.position[-1] == pytest.approx(end + cable.slack * X, abs=1e-7), "to 1e-9 of its length"
    assert cable.curve.position[:, 2].min() > level - 1e-3
    assert np.linalg.norm(cable.curve.tangent, axis=2) == pytest.approx(1.0)
    scale = np.abs(w).mean() * 100.0 + cable.tension.max()
    borne = np.dot(w, np.diff(arc)) - np.diff(vertical(cable)[[0, -1]])[0]
    assert borne > -1e-6 * scale, "the seabed pushes, it never pulls"
    assert level > -np.inf or borne < 1e-6 * scale


@pytest.mark.parametrize("end", [[0.0, 0.0, 0.0], [0.0, 0.0, 100.0], [3.0, 4.0, 20.0]])
@pytest.mark.parametrize("level", [-np.inf, 0.0])
def test_slack_line_is_laid_with_the_least_tension(end: list[float], level: float) -> None:
    cable = catenary(ARC[::50], ORIGIN, np.array(end), W, 1e9, level, least_H=10.0 * W)
    assert pytest.approx(10.0 * W) == cable.H
    normal = np.array([0.6, 0.8, 0.0]) if end[0] else np.array([1.0, 0.0, 0.0])
    assert cable.slack > 1.0
    assert cable.curve.position[-1] == pytest.approx(end + cable.slack * normal, abs=1e-8)
    assert np.linalg.norm(cable.curve.chord, axis=1).sum() == pytest.approx(350.0, rel=2e-2)


@pytest.mark.parametrize(
    ("end", "weight", "level", "message"),
    [
        ([100.0, 0.0, -3.0], W, -1.0, r"z = -3 m lies below the level -1 m"),
        ([100.0, 0.0, 50.0], 0.0, -np.inf, r"needs a submerged weight"),
    ],
)
def test_impossible_catenaries_are_refused(
    end: list[float], weight: float, level: float, message: str
) -> None:
    with pytest.raises(SceneError, match=message):
        catenary(ARC, ORIGIN, np.array(end), weight, STIFF, level)
