"""A riser in current, in waves and at the surface, through the time loop: closed forms, orders, energy, ranks."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from riser_soil.core.arrays import Array
from tests.support.differences import orders
from tests.support.scenes import AVERAGE, Mapping, dynamic, in_waves, prescribed, riser_scene, static
from tests.support.stage_histories import StageHistory, distance, stage_histories

RHO, D, CD, CA, MASS = 1025.0, 0.3, 1.1, 1.0, 120.0
PIPE: Mapping = {"EA": 1.0e6, "EI": 2.0e3, "GJ": 2.0e3, "outer_diameter": D, "mass": MASS}
PIPE |= {"drag": {"normal": CD, "tangential": 0.05}, "added_mass": {"normal": CA, "tangential": 0.2}}
ROUGH = 0.5 * RHO * D * CD
DISPLACED = RHO * 0.25 * np.pi * D**2


# Current

SPEED = 1.3


@pytest.mark.parametrize("stage", ["first", "later"])
def test_current_on_a_fixed_pipe_is_borne_by_its_ends(stage: str) -> None:
    """An upright pipe across the current: half of rho D Cd U^2 L/2 at each end; bowing adds 0.05 N lengthwise."""
    scene = riser_scene(
        *([] if stage == "first" else [static("before")]),
        static("current"),
        pipe=PIPE | {"EI": 1.0e9, "EA": 1.0e9},
        length=20.0,
        elements=4,
        start=prescribed(0.0, 0.0, 0.0, rotation="fixed"),
        end=prescribed(0.0, 0.0, 20.0, rotation="fixed"),
        water={"density": RHO, "current": {"profile": [[0.0, SPEED, 0.0]]}},
    )
    end = stage_histories(scene)[-1].end
    for force in (end.start_force, end.end_force):
        assert force == pytest.approx([-0.5 * ROUGH * SPEED**2 * 20.0, 0.0, 0.0], rel=1e-6, abs=0.1)


def sheared(elements: int) -> Mapping:
    """A riser across a current that grows with height, out of its plane too."""
    return riser_scene(
        static("current"),
        pipe=PIPE | {"EI": 4.0e4, "EA": 5.0e6},
        length=52.0,
        elements=elements,
        start=prescribed(0.0, 0.0, 0.0),
        end=prescribed(20.0, 0.0, 47.0),
        water={"density": RHO, "current": {"profile": [[0.0, 0.2, 0.1], [47.0, 1.2, 0.7]]}},
        gravity=9.81,
        solver={"tolerance": 1e-10},
    )


def test_deflection_under_a_current_profile_converges_with_fourth_order() -> None:
    points = [stage_histories(sheared(n))[-1].position[-1][:: n // 8] for n in (8, 16, 32, 128)]
    errors = [distance(p, points[-1]) for p in points[:-1]]
    assert np.all(orders(errors) > 4.0)


def test_a_pipe_let_go_in_a_current_comes_to_drift_with_it() -> None:
    """m w' = -c w^2 for the velocity w through the water: it has moved by U t - (m/c) log(1 + c U t/m)."""
    scene = riser_scene(
        dynamic(6.0, 0.02),
        pipe=PIPE,
        length=6.0,
        elements=3,
        start="free",
        end="free",
        riser={"unstressed": {"points": [[0.0, 0.0, 0.0], [0.0, 0.0, 6.0]]}},
        water={"density": RHO, "current": {"profile": [[0.0, SPEED, 0.0]]}},
    )
    history = stage_histories(scene)[0]
    mass, t = MASS + CA * DISPLACED, np.array(history.t)
    exact = SPEED * t - mass / ROUGH * np.log1p(ROUGH * SPEED * t / mass)
    moved = np.array([x[:, 0].mean() for x in history.position])
    assert moved == pytest.approx(exact, abs=2e-5 * exact[-1])


# The surface


def heaving(lift: float, time_step: float, drag: bool) -> StageHistory:
    """A lying pipe let go above its draught.

    By the average acceleration: generalised-alpha weighs inertia at another time than forces, which costs it an order,
    with the factor (1 - rho_inf)/(1 + rho_inf), where the mass changes with the position.
    """
    pipe = PIPE if drag else {key: value for key, value in PIPE.items() if key != "drag"}
    scene = riser_scene(
        dynamic(4.0, time_step, scheme=AVERAGE),
        pipe=pipe | {"mass": 0.6 * DISPLACED},
        length=1.2,
        elements=2,
        start="free",
        end="free",
        riser={"unstressed": {"points": [[0.0, 0.0, lift], [1.2, 0.0, lift]]}},
        water={"density": RHO, "surface_level": 0.0},
        gravity=9.81,
        solver={"tolerance": 1e-10},
    )
    return stage_histories(scene)[0]


def share(z: float) -> float:
    """Wet share of the section with its centre at z, by the segment's angle."""
    half = np.arccos(np.clip(2.0 * z / D, -1.0, 1.0))
    return float((half - np.sin(half) * np.cos(half)) / np.pi)


def heave(lift: float, t: Array, drag: bool) -> Array:
    """Heave by the equation of a rigid section."""
    c = ROUGH if drag else 0.0

    def rates(_: float, y: Array) -> list[float]:
        wet, mass = share(y[0]), 0.6 * DISPLACED
        force = 9.81 * (wet * DISPLACED - mass) - wet * c * abs(y[1]) * y[1]
        return [y[1], force / (mass + wet * CA * DISPLACED)]

    return np.asarray(solve_ivp(rates, (0.0, t[-1]), [lift, 0.0], t_eval=t, rtol=1e-9, atol=1e-12).y[0])


@pytest.mark.parametrize(
    ("lift", "drag"), [pytest.param(0.12, True, marks=pytest.mark.verify), (0.05, False), (0.4, True)]
)
def test_a_lying_pipe_heaves_like_a_rigid_section(lift: float, drag: bool) -> None:
    """Also where it falls from the air; its added mass changes as it gets wet. Steps halved once, and extrapolated."""
    coarse, fine = (heaving(lift, dt, drag) for dt in (0.01, 0.005))
    heights = [np.array([x[:, 2].mean() for x in history.position]) for history in (coarse, fine)]
    both = heights[0], heights[1][1::2]
    exact = heave(lift, np.array(coarse.t), drag)
    extrapolated = (4.0 * both[1] - both[0]) / 3.0
    errors = [np.abs(h - exact).max() for h in both]
    assert errors[0] / errors[1] > 3.9
    assert extrapolated == pytest.approx(exact, abs=2e-5 * lift)


def test_an_upright_pipe_heaves_about_its_draught() -> None:
    """A pipe of 60 % of the water's density floats 60 % immersed; its period is 2 pi sqrt(0.6 L/g)."""
    length, lift = 6.0, 0.4
    scene = riser_scene(
        dynamic(8.0, 0.02, scheme=AVERAGE),
        pipe={"EA": 1.0e9, "EI": 1.0e6, "outer_diameter": D, "mass": 0.6 * DISPLACED},
        length=length,
        elements=4,
        start="free",
        end="free",
        riser={"unstressed": {"points": [[0.0, 0.0, lift - 0.6 * length], [0.0, 0.0, lift + 0.4 * length]]}},
        water={"density": RHO, "surface_level": 0.0},
        gravity=9.81,
        solver={"tolerance": 1e-10},
    )
    history = stage_histories(scene)[0]
    middle = np.array([x[:, 2].mean() for x in history.position]) + 0.1 * length
    exact = lift * np.cos(np.sqrt(9.81 / (0.6 * length)) * np.array(history.t))
    assert middle == pytest.approx(exact, abs=2e-3 * lift)


def balance(history: StageHistory) -> float:
    """Largest error of the energy balance since the first step [J]."""
    energy, work = np.array(history.energy), np.cumsum(history.work)
    return float(np.abs(energy - energy[0] - (work - work[0])).max())


def test_heave_keeps_its_energy_to_second_order() -> None:
    errors = [balance(heaving(0.12, dt, drag=False)) for dt in (0.02, 0.01, 0.005)]
    assert np.all(orders(errors) > 1.95)
    assert errors[-1] < 1e-3 * np.ptp(heaving(0.12, 0.02, drag=False).energy)


# Waves


@cache
def moved_by_waves(time_step: float, top: float, rho_inf: float = 0.8) -> StageHistory:
    return stage_histories(in_waves(time_step, top, rho_inf))[-1]


@pytest.mark.parametrize(
    ("top", "rho_inf"),
    [(21.0, 0.8), *(pytest.param(18.0, rho_inf, marks=pytest.mark.verify) for rho_inf in (0.8, 0.2))],
)
def test_motion_in_waves_is_of_second_order_in_time(top: float, rho_inf: float) -> None:
    """The water's acceleration enters as an external force; taken as inertia, generalised-alpha would lose an order."""
    ends = [moved_by_waves(dt, top, rho_inf).position[-1] for dt in (0.1, 0.05, 0.025, 0.00625)]
    errors = [distance(end, ends[-1]) for end in ends[:-1]]
    assert np.all(orders(errors) > 1.8)


@pytest.mark.parametrize(("top", "order"), [(18.0, 1.95), (21.0, 1.5)])
def test_energy_in_waves_balances(top: float, order: float) -> None:
    """To second order; at the surface the added mass changes with the position (see `heaving`)."""
    histories = [moved_by_waves(dt, top) for dt in (0.1, 0.05, 0.025)]
    errors = [balance(one) for one in histories]
    assert np.all(orders(errors) > order)
    assert errors[-1] < 1e-4 * np.ptp(histories[-1].energy)
