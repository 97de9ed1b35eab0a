"""Structural damping of a pinned beam's modes, and where the energy goes."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from tests.support.scenes import AVERAGE, Mapping, dynamic, prescribed, riser_scene, static
from tests.support.stage_histories import stage_histories

LENGTH, EA, EI, MASS, TENSION, RATIO, ELEMENTS, DT = 30.0, 1.0e9, 5.0e5, 80.0, 4.0e4, 0.02, 20, 0.02
STRETCH = 1.0 + TENSION / EA


def closed_form(n: int, tension: float) -> float:
    """Angular frequency of the pinned beam [rad/s]."""
    k, stretch = n * np.pi / LENGTH, 1.0 + tension / EA
    k /= stretch
    return float(np.sqrt((k**4 * EI + k**2 * tension) * stretch / MASS))


def plucked(dimension: int, tension: float, frequency: float, dt: float = DT) -> Mapping:
    """A damped beam, under tension or not, pushed aside a little and let go."""
    pipe = {"EA": EA, "EI": EI, "GJ": EI, "mass": MASS, "damping": {"ratio": RATIO, "frequency": frequency}}
    return riser_scene(
        static("stretch", move={"end": [LENGTH * (1.0 + tension / EA), 0.0, 0.0]}),
        static("push", loads=[{"at": LENGTH / 5, "force": [0.0, 0.0, 0.05]}]),
        dynamic(round(10.0 / dt) * dt, dt, scheme=AVERAGE),
        pipe=pipe,
        length=LENGTH,
        elements=ELEMENTS,
        start=prescribed(0.0, 0.0, 0.0),
        end=prescribed(LENGTH, 0.0, 0.0),
        dimension=dimension,
        solver={"tolerance": 1e-9},
    )


def modes(scene: Mapping) -> list[Array]:
    """Amplitudes of the first three sine modes, step by step."""
    aside = np.array(stage_histories(scene)[-1].position)[:, :, 2]
    shapes = np.sin(np.outer(np.arange(1, 4), np.linspace(0.0, np.pi, ELEMENTS + 1)))
    return [aside @ shape for shape in shapes]


def damping_of(series: Array, dt: float) -> tuple[float, float]:
    """Angular frequency [rad/s] and damping ratio of q(n+1) = b q(n) - c q(n-1), freed of the average acceleration's
    own error: on a linear system it maps each eigenvalue s to (1 + s dt/2)/(1 - s dt/2).
    """
    b, c = np.linalg.lstsq(np.stack([series[1:-1], -series[:-2]], axis=1), series[2:], rcond=None)[0]
    z = np.roots([1.0, -b, c])[0]
    s = 2.0 / dt * (z - 1.0) / (z + 1.0)
    return abs(s), float(-s.real / abs(s))


@pytest.mark.parametrize("dimension", [2, 3])
def test_ratio_holds_at_its_frequency_and_grows_with_it(dimension: int) -> None:
    omega = [closed_form(n, 0.0) for n in (1, 2, 3)]
    ratios = [damping_of(q, DT) for q in modes(plucked(dimension, 0.0, omega[0] / (2.0 * np.pi)))]
    assert [w for w, _ in ratios] == pytest.approx(omega, rel=1e-4)
    assert [ratio for _, ratio in ratios] == pytest.approx([RATIO, 4.0 * RATIO, 9.0 * RATIO], rel=2e-4)


def test_logarithmic_decrement_as_the_step_shrinks() -> None:
    """2 pi ratio / sqrt(1 - ratio^2) between maxima, which the scheme meets to second order."""
    period = 2.0 * np.pi / closed_form(1, 0.0)
    exact, errors = 2.0 * np.pi * RATIO / np.sqrt(1.0 - RATIO**2), []
    for steps in (40, 80, 160):
        dt = period / steps
        first = modes(plucked(2, 0.0, 1.0 / period, dt))[0]
        b, c = np.linalg.lstsq(np.stack([first[1:-1], -first[:-2]], axis=1), first[2:], rcond=None)[0]
        decay, turn = 0.5 * np.log(c), np.arccos(0.5 * b / np.sqrt(c))
        errors.append(abs(-2.0 * np.pi * decay / turn / exact - 1.0))
    assert errors[-1] < 1e-3
    assert np.log2(np.array(errors[:-1]) / errors[1:]) == pytest.approx([2.0, 2.0], abs=0.1)


def test_tension_is_not_damped() -> None:
    """What is damped is bending alone, EI k^4 of the modal stiffness EI k^4 + T k^2."""
    frequency = closed_form(1, TENSION) / (2.0 * np.pi)
    for n, q in zip((1, 2, 3), modes(plucked(2, TENSION, frequency)), strict=True):
        k = n * np.pi / LENGTH
        omega, ratio = damping_of(q, DT)
        bending = EI * k**4 / (EI * k**4 + TENSION * k**2)
        assert omega == pytest.approx(closed_form(n, TENSION), rel=1e-4)
        assert ratio == pytest.approx(RATIO * omega / (2.0 * np.pi * frequency) * bending, rel=1e-3)


def swinging(dt: float, dimension: int, **damping: Any) -> Mapping:
    """A soft pipe let go from the horizontal; in space it is pushed out of the plane, too."""
    aside = [{"distributed": [0.0, 30.0, 0.0]}] if dimension == 3 else []
    return riser_scene(
        dynamic(2.0, dt, scheme=AVERAGE, loads=aside),
        pipe={"EA": 2.0e5, "EI": 4.0e3, "GJ": 3.0e3, "mass": 20.0, "submerged_weight": 196.2, **damping},
        length=6.0,
        elements=6,
        start=prescribed(0.0, 0.0, 0.0),
        end="free",
        dimension=dimension,
        gravity=9.81,
        riser={"initial": {"points": [[0.0, 0.0, 0.0], [6.0, 0.0, 0.0]]}},
        solver={"tolerance": 1e-10},
    )


@pytest.mark.parametrize("dimension", [2, 3])
def test_energy_balance_closes_with_damping(dimension: int) -> None:
    given, gaps = {"damping": {"ratio": 0.05, "frequency": 1.0}}, []
    for dt in (0.01, 0.005):
        history = stage_histories(swinging(dt, dimension, **given))[-1]
        stored, turned = np.array(history.energy), np.cumsum(history.work)
        gaps.append(np.abs(stored - turned - (stored[0] - turned[0])).max())
    lost = stage_histories(swinging(0.01, dimension))[-1].energy[-1] - history.energy[-1]
    assert lost > 25.0
    assert gaps[1] < 2e-2 * lost
    assert gaps[0] / gaps[1] > 3.5
