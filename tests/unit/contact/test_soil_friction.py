"""Friction and suction between the pipe's cylinder and the soil's surface: derivatives, closed forms, dissipation."""

from __future__ import annotations

import gc
import weakref
from functools import partial

import numpy as np
import pytest

from riser_soil.contact.law import Penalty, SuctionLaw
from riser_soil.contact.soil_friction import SoilFriction, friction_tangents
from riser_soil.core.arrays import Array
from tests.support.differences import slope as differences
from tests.support.pipe_on_surface import RADIUS, STIFFNESS, PipeOnSurface, pipe_on_surface, sagging, shaken
from tests.support.soil_tops import top

AXIAL, LATERAL, ALONG_ITSELF = 0.3, 0.7, 1.0e6  # -, -, N/m3
DEPTH, LIFT, CAP, REACH = 0.02, 0.024, 3.0e3, 0.03  # m, m, Pa, m
KINDS = pytest.mark.parametrize("kind", ["quad4", "tri6"])
DIMENSIONS = pytest.mark.parametrize("dimension", [2, 3])


def with_friction(made: PipeOnSurface, limit: Array | None = None) -> SoilFriction:
    """held (nf,): adhesion of the facets [Pa]."""
    adhesion = None if limit is None else lambda facet, z: limit[facet]
    return SoilFriction(made.contact, AXIAL, LATERAL, ALONG_ITSELF, adhesion)


def clay(made: PipeOnSurface) -> Array:
    """Adhesion of facets, 2 to 5 kPa: less than friction where the pipe lies deep."""
    return 5.0e3 - 1.0e3 * (np.arange(len(made.surface.facets)) % 4)


def level(depth: float = DEPTH, beside: float = 0.013) -> Array:
    """A straight pipe along the middle of the surface, beyond both of its ends."""
    return np.stack([np.linspace(-0.5, 3.5, 6), np.full(6, beside), np.full(6, RADIUS - depth)], axis=1)


def moved(made: PipeOnSurface, move: tuple[float, float, float]) -> Array:
    """The riser moved as a whole."""
    u = np.zeros(made.size)
    u[made.line.translation_dofs] = np.array(move) @ made.line.basis
    return u


def along_line(made: PipeOnSurface, friction: SoilFriction, u: Array, direction: Array, s: float) -> Array:
    return made.residual(u + s * direction, friction)


@KINDS
@DIMENSIONS
@pytest.mark.parametrize("size", [1e-4, 4e-3])
@pytest.mark.parametrize("adhesive", [False, True], ids=["", "adhesion"])
def test_the_tangent_is_the_slope_of_the_residual(kind: str, dimension: int, size: float, adhesive: bool) -> None:
    """Sticking and slipping, in a second step, whose start has tractions and a bent pipe."""
    made = pipe_on_surface(sagging(), top(kind), dimension)
    friction = with_friction(made, clay(made) if adhesive else None)
    made.commit(shaken(made, 1, 2e-3), friction)
    u = shaken(made, 2, size)
    K, h = made.tangent(u, friction), 1e-8
    for seed in range(3):
        direction = shaken(made, 10 + seed, 1.0)
        slope = differences(partial(along_line, made, friction, u, direction), h)
        assert np.abs(K @ direction - slope).max() < 2e-5 * np.abs(slope).max()


@pytest.mark.parametrize(("move", "mu"), [((1.0, 0.0, 0.0), AXIAL), ((0.0, 1.0, 0.0), LATERAL)])
def test_dragged_far_it_resists_with_mu_times_the_pressure(move: tuple[float, float, float], mu: float) -> None:
    """Along the pipe and across it; mobilised over pressure over stiffness, and stuck before that."""
    made = pipe_on_surface(level(), top("quad4"))
    friction = with_friction(made)
    pressed = made.contact.evaluate(made.state()).pressed
    little = 1e-6
    u = moved(made, (little * move[0], little * move[1], 0.0))
    stuck = friction.force_on_riser(made.state(u))
    if mu == AXIAL:
        area = pressed.points.area[pressed.force > ALONG_ITSELF * little / mu].sum()
        assert -stuck[0] == pytest.approx(ALONG_ITSELF * little * area, rel=1e-2)
    for _ in range(10):
        made.commit(moved(made, (0.005 * move[0], 0.005 * move[1], 0.0)), friction)
    force, upright = friction.force_on_riser(made.state()), made.contact.force_on_riser(made.state())[2]
    pressing = made.contact.evaluate(made.state()).pressed.force.sum() if mu == AXIAL else upright
    assert -(force @ move) == pytest.approx(mu * pressing, rel=0.02)  # around the pipe, friction is level at its bottom
    if mu == AXIAL:
        assert friction.slip()[2:4] == pytest.approx(0.05, rel=0.2)


def dragged(made: PipeOnSurface, friction: SoilFriction, way: float) -> float:
    """Force on the riser along itself [N] once it has been pulled along itself by a way [m]."""
    made.commit(moved(made, (way, 0.0, 0.0)), friction)
    return float(friction.force_on_riser(made.state())[0])


def test_dragged_far_it_resists_with_the_adhesion_of_what_touches() -> None:
    """Each point resists with its adhesion, or with mu times its pressure where that is less; all of it comes into
    force at A/k.
    """
    made = pipe_on_surface(level(), top("quad4"))
    limit = clay(made)
    friction = with_friction(made, limit)
    pressed = made.contact.evaluate(made.state()).pressed
    most = np.minimum(AXIAL * pressed.force, limit[pressed.points.facet] * pressed.points.area)
    assert -dragged(made, friction, 0.05) == pytest.approx(most.sum(), rel=1e-2)
    assert most.sum() < 0.9 * AXIAL * pressed.force.sum()


def test_a_pipe_in_full_adhesion_bears_it_over_the_area_that_touches() -> None:
    """Where the pressure is a hundredth of what the coefficient needs for it, and slips at that traction."""
    made, A = pipe_on_surface(level(), top("quad4")), 50.0
    friction = with_friction(made, np.full(len(made.surface.facets), A))
    area = made.contact.evaluate(made.state()).pressed.points.area.sum()
    mobilised = A / ALONG_ITSELF
    assert -dragged(made, friction, 0.8 * mobilised) == pytest.approx(0.8 * A * area, rel=5e-3)
    assert friction.slip().max() < 0.1 * mobilised
    assert -dragged(made, friction, 0.4 * mobilised) == pytest.approx(A * area, rel=5e-3)
    assert -dragged(made, friction, 0.3) == pytest.approx(A * area, rel=5e-3)
    assert friction.energy(made.state()).potential == pytest.approx(0.5 * A * area * mobilised, rel=1e-2)


def test_the_tangent_needs_the_change_of_the_pressure(monkeypatch: pytest.MonkeyPatch) -> None:
    """Friction is below the adhesion."""
    made = pipe_on_surface(sagging(), top("quad4"))
    friction = with_friction(made, clay(made))
    made.commit(shaken(made, 1, 2e-3), friction)
    u = shaken(made, 2, 4e-3)
    expected = made.tangent(u, friction)

    monkeypatch.setattr(
        "riser_soil.contact.soil_friction.friction_tangents",
        lambda law, points, force, slope, *given: friction_tangents(law, points, force, 0.0 * slope, *given),
    )
    assert np.abs(made.tangent(u, friction) - expected).max() > 1e-2 * np.abs(expected).max()


@KINDS
@DIMENSIONS
def test_forces_on_riser_and_soil_sum_to_zero(kind: str, dimension: int) -> None:
    """In all, and of contact and friction together along the riser; in a plane what lies in it."""
    made = pipe_on_surface(sagging(angle=0.3 * (dimension == 3)), top(kind), dimension)
    friction = with_friction(made)
    made.commit(shaken(made, 1, 2e-3), friction)
    state = made.state(shaken(made, 3, 2e-3))
    residual = made.residual(state.u, friction)
    on_soil, on_riser = friction.force_on_soil(state), friction.force_on_riser(state)
    small = 1e-12 * np.abs(on_riser).max()
    assert np.abs(on_riser).max() > 1.0
    assert np.abs(on_soil + residual[made.surface.offset :].reshape(-1, 3).sum(axis=0)).max() < small
    in_plane = made.line.basis @ made.line.basis.T
    assert np.abs(in_plane @ on_soil + on_riser).max() < small
    parts = made.contact, friction
    total = sum(made.line.tributary_length @ part.force_on_soil_per_length(state) for part in parts)
    assert np.abs(in_plane @ total + sum(part.force_on_riser(state) for part in parts)).max() < 10.0 * small


def test_what_is_forgotten_goes_at_once() -> None:
    """A state of contact on soil is large, and Python looks for cycles late."""
    made = pipe_on_surface(level(), top("quad4"))
    friction = with_friction(made)
    gc.disable()
    try:
        trial = weakref.ref(friction.evaluate(made.state()).contact.trial)
        made.line.forget()
        assert trial() is None
    finally:
        gc.enable()


@pytest.mark.parametrize("adhesive", [False, True], ids=["", "adhesion"])
def test_a_closed_way_gives_no_work(adhesive: bool) -> None:
    """Dissipated in each step, and no more than is taken from the riser in all."""
    made = pipe_on_surface(level(), top("quad4"))
    friction = with_friction(made, clay(made) if adhesive else None)
    work, lost = 0.0, []
    angles = np.linspace(0.0, 2.0 * np.pi, 25)
    corners = 0.02 * np.stack([np.cos(angles), np.sin(angles), 0.2 * np.sin(3.0 * angles)], axis=1)
    for step in np.diff(corners, axis=0, prepend=corners[-1:]):
        state = made.state(moved(made, tuple(step)))
        lost.append(friction.work(made.state(), state).dissipated)
        work += float(made.residual(state.u, friction) @ state.u)
        made.commit(state.u, friction)
    assert min(lost) >= 0.0
    stored = friction.energy(made.state()).potential  # less what the next step loses as its directions are others
    assert 0.999 * work < sum(lost) + stored <= work


def test_a_rough_pipe_holds_the_soil_that_flows_aside() -> None:
    """Soil that moves out from under a resting pipe is held back on either side; the riser feels no sum."""
    made = pipe_on_surface(level(beside=0.0), top("quad4", ny=8), dimension=2, spacing=0.02)
    friction = with_friction(made)
    u = np.zeros(made.size)
    at, soil = made.surface.offset, made.surface.points
    u[at + 1 :: 3] = 0.01 * np.sign(np.round(soil[:, 1], 6)) * (np.abs(soil[:, 1]) < 0.6)
    force = -made.residual(u, friction)[at:].reshape(-1, 3)[:, 1]
    right, left = (float(force[side * soil[:, 1] > 0.1].sum()) for side in (1.0, -1.0))
    assert right < -10.0
    assert left == pytest.approx(-right)
    assert force.sum() == pytest.approx(0.0, abs=1e-9 * left)


SUCTION = SuctionLaw(Penalty(STIFFNESS), CAP, REACH)


def lifted(made: PipeOnSurface, heights: Array) -> list[float]:
    """Vertical force on the riser as it is lifted to heights above its first place [N]."""
    forces, before = [], 0.0
    for height in heights:
        u = moved(made, (0.0, 0.0, height - before))
        forces.append(float(made.contact.force_on_riser(made.state(u))[2]))
        made.commit(u)
        before = height
    return forces


@KINDS
def test_suction_pulls_up_to_the_cap_over_what_has_touched_and_breaks(kind: str) -> None:
    made = pipe_on_surface(level(), top(kind), spacing=0.01, pressure=SUCTION)
    pushed = lifted(made, np.zeros(1))[0]
    assert pushed > 0.0
    half = np.sqrt(RADIUS**2 - (RADIUS - DEPTH) ** 2)
    beside, height = np.linspace(-half, half, 4001), RADIUS - DEPTH + LIFT
    rho = np.hypot(beside, height)
    tension = SUCTION.update(RADIUS - rho, np.zeros((4001, 1))).force * height / rho
    force = lifted(made, np.linspace(0.0, LIFT, 4))[-1]
    assert force == pytest.approx(3.0 * 2.0 * half * tension.mean(), rel=0.02)
    assert made.contact.force_per_length(made.state())[2] < 0.0
    assert lifted(made, np.array([REACH + DEPTH]))[-1] == 0.0
    assert lifted(made, np.array([-REACH]))[-1] == 0.0  # back to just above: broken for good until it touches


def test_suction_never_gives_work() -> None:
    made = pipe_on_surface(level(), top("quad4"), pressure=SUCTION)
    heights, lost = [0.0, 0.021, 0.03, 0.022, 0.04, 0.01, 0.03, 0.06, 0.0], list[float]()
    for step in np.diff(heights):
        state = made.state(moved(made, (0.0, 0.0, float(step))))
        lost.append(made.contact.work(made.state(), state).dissipated)
        made.commit(state.u)
    assert min(lost) >= -1e-9
    assert sum(lost) > 1.0


@DIMENSIONS
def test_the_tangent_of_suction_is_the_slope_of_its_residual(dimension: int) -> None:
    law = SuctionLaw(Penalty(STIFFNESS, 2e-3), CAP, REACH)
    made = pipe_on_surface(sagging(), top("quad4"), dimension, pressure=law)
    made.commit(np.zeros(made.size))
    up = moved(made, (0.0, 0.0, 0.03))
    u = up + shaken(made, 4, 1e-4)
    K, h = made.tangent(u), 1e-8
    direction = shaken(made, 5, 1.0)
    slope = differences(lambda s: made.residual(u + s * direction), h)
    assert np.abs(K @ direction - slope).max() < 1e-4 * np.abs(slope).max()
    assert made.contact.evaluate(made.state(u)).pressed.force.min() < 0.0
