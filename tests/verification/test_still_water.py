"""A riser that moves through still water, in the time loop, against closed forms and independent equations."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from riser_soil.core.arrays import Array
from tests.support.scenes import AVERAGE, Mapping, dynamic, prescribed, riser_scene, static
from tests.support.stage_histories import StageHistory, stage_histories

RHO, D, CD, CA, MASS, WEIGHT = 1025.0, 0.3, 1.1, 1.0, 150.0, 800.0
PIPE: Mapping = {"EA": 1.0e7, "EI": 1.0e4, "outer_diameter": D, "mass": MASS, "submerged_weight": WEIGHT}
PIPE |= {"drag": {"normal": CD}, "added_mass": {"normal": CA}}
WATER = {"density": RHO}


def fallen(time_step: float, dimension: int) -> StageHistory:
    scene = riser_scene(
        dynamic(3.0, time_step),
        pipe=PIPE | {"GJ": 1.0e4},
        length=6.0,
        elements=3,
        start="free",
        end="free",
        water=WATER,
        gravity=9.81,
        dimension=dimension,
    )
    return stage_histories(scene)[0]


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_lying_pipe_falls_by_the_hyperbolic_tangent(dimension: int) -> None:
    """m v' = w - c v^2: v = V tanh(t/T) with V^2 = w/c, T = m V/w; it falls V T log cosh(t/T). Steps halved once."""
    mass = MASS + CA * RHO * 0.25 * np.pi * D**2
    final = np.sqrt(WEIGHT / (0.5 * RHO * D * CD))
    time = mass * final / WEIGHT
    coarse, fine = (fallen(dt, dimension) for dt in (0.04, 0.02))
    heights = [np.array([x[:, 2].mean() for x in history.position]) for history in (coarse, fine)]
    exact = -final * time * np.log(np.cosh(np.array(coarse.t) / time))
    errors = [np.abs(h - exact).max() / np.abs(exact).max() for h in (heights[0], heights[1][1::2])]
    assert errors[1] < 5e-5
    assert errors[0] / errors[1] > 3.5
    extrapolated = (4.0 * heights[1][1::2] - heights[0]) / 3.0
    assert extrapolated == pytest.approx(exact, abs=2e-6 * np.abs(exact).max())
    assert np.ptp(fine.position[-1][:, 2]) < 1e-12


# A taut string whose vibration dies away by quadratic drag.

LENGTH, TENSION, EA, PUSH = 10.0, 1.0e4, 1.0e6, 0.8
STRING_MASS, STRING_DRAG, CYCLES = 20.0, 20.0, 4
STRETCH = 1.0 + TENSION / EA
OMEGA = np.pi / LENGTH * np.sqrt(TENSION / STRETCH / STRING_MASS)
FIRST = 4.0 * PUSH * LENGTH**2 * STRETCH / (TENSION * np.pi**3)  # the first mode of the parabola [m]


def string(steps_per_cycle: int) -> Array:
    """Amplitude of the first mode after each step, let go from the parabola of a uniform push."""
    pipe = {"EA": EA, "EI": 0.02, "outer_diameter": D, "mass": STRING_MASS, "drag": {"normal": STRING_DRAG}}
    period = 2.0 * np.pi / OMEGA
    scene = riser_scene(
        static("stretch", move={"end": [LENGTH * STRETCH, 0.0, 0.0]}),
        static("push", loads=[{"distributed": [0.0, 0.0, PUSH]}]),
        dynamic(CYCLES * period, period / steps_per_cycle, scheme=AVERAGE),
        pipe=pipe,
        length=LENGTH,
        elements=16,
        start=prescribed(0.0, 0.0, 0.0),
        end=prescribed(LENGTH, 0.0, 0.0),
        water=WATER,
        solver={"tolerance": 1e-9},
    )
    shape = np.sin(np.linspace(0.0, np.pi, 17)) / 8.0
    return np.array(stage_histories(scene)[-1].position)[:, :, 2] @ shape


def first_mode(t: Array, count: int = 10) -> Array:
    """The first mode by Galerkin's method with odd modes of the linear string, drag integrated by midpoints."""
    n = np.arange(1, 2 * count, 2)
    s = (np.arange(200) + 0.5) / 200
    shape = np.sin(np.pi * np.outer(n, s))
    c = 0.5 * RHO * D * STRING_DRAG / STRING_MASS

    def rates(_: float, y: Array) -> Array:
        q, v = np.split(y, 2)
        speed = v @ shape
        drag = 2.0 * shape @ (c * np.abs(speed) * speed) / s.size
        return np.concatenate([v, -((n * OMEGA) ** 2) * q - drag])

    start = FIRST / n**3
    solution = solve_ivp(rates, (0.0, t[-1]), np.concatenate([start, 0.0 * start]), t_eval=t, rtol=1e-8, atol=1e-12)
    return np.asarray(solution.y[0])


def test_a_string_dies_away_by_quadratic_drag() -> None:
    """Against other equations; the average acceleration's period error is extrapolated away. And against the law of a
    mode that keeps its shape: the energy m L (w A)^2/4 loses c (w A)^3 times the means (4/3 pi)^2 of |sin|^3 over time
    and length, so that 1/A grows by 32 rho D Cd/(9 pi m) in a cycle. Drag also drives the other modes, to first order
    in rho D Cd A/m = 0.3, so the law is met the better the smaller A has become.
    """
    coarse, fine = string(160), string(320)[1::2]
    exact = first_mode(np.arange(1, coarse.size + 1) * 2.0 * np.pi / OMEGA / 160)
    extrapolated = (4.0 * fine - coarse) / 3.0
    assert extrapolated == pytest.approx(exact, abs=1e-4 * FIRST)
    law = 32.0 * RHO * D * STRING_DRAG / (9.0 * np.pi * STRING_MASS)
    beyond = np.diff(1.0 / np.array([FIRST, *extrapolated[159::160]])) / law - 1.0
    assert np.all(np.diff(beyond) < 0.0)
    assert 0.0 < beyond[-1] < 0.01
