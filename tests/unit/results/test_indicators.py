"""Indicators of numerical error: figures that turn sharply between steps, energy lost in impact, their warnings."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import pytest

from riser_soil.core.snapshot import Ledger, StepRecord, StepStatistics
from riser_soil.results.doubtful_extremes import AT, JUDGED
from riser_soil.results.figures import places_of
from riser_soil.results.indicators import FigureIndicators, ImpactLoss, StepIndicators
from riser_soil.results.time_resolution import TimeResolution
from tests.support.said import line_with

SHARE = 0.3  # of the second difference around an extreme: how far it may be off, as calibrated
SIZE = int(AT.max()) + 1
TENSION = places_of("end.effective_tension").start
LEAST = places_of("min_effective_tension").start
MOMENT = places_of("max_bending_moment").start


def resolved(dt: float, start: float = 0.0) -> TimeResolution:
    """A sine of amplitude 2 and its third harmonic, one period of 2 pi; steps of dt."""
    resolution = TimeResolution(2)
    for t in np.arange(start, 2.0 * np.pi + start, dt):
        resolution.update(float(t), np.array([2.0 * np.sin(t), np.sin(3.0 * t)]))
    return resolution


def test_estimate_is_the_second_difference_at_the_extreme() -> None:
    """dt^2 q'': 2 dt^2 at the crest of the sine, 9 dt^2 at those of its harmonic."""
    resolution = resolved(0.01)
    for estimate in (resolution.of_most, resolution.of_least):
        np.testing.assert_allclose(estimate, SHARE * 1e-4 * np.array([2.0, 9.0]), rtol=1e-2)


def test_estimate_is_of_second_order() -> None:
    np.testing.assert_allclose(resolved(0.02).of_most / resolved(0.01).of_most, 4.0, rtol=2e-2)


def test_steps_of_changing_size_count_as_the_longer_ones() -> None:
    resolution, t = TimeResolution(1), 0.0
    for n in range(400):
        resolution.update(t, np.array([t**2]))
        t += 0.01 if n % 2 else 0.02
    np.testing.assert_allclose(resolution.of_most, SHARE * 2.0 * 0.02**2, rtol=1e-9)


def test_a_corner_after_the_extreme_belongs_to_it() -> None:
    """A figure that falls off at once: its largest value is the last before the fall."""
    resolution = TimeResolution(1)
    for n, q in enumerate((0.0, 1.0, 2.0, -5.0, -5.0, -5.0, 30.0)):
        resolution.update(0.1 * n, np.array([q]))
    first = TimeResolution(1)
    for n, q in enumerate((0.0, 1.0, 2.0, -5.0, -5.0)):
        first.update(0.1 * n, np.array([q]))
    assert first.of_most[0] == pytest.approx(SHARE * 8.0)
    assert resolution.of_most[0] == pytest.approx(SHARE * 35.0)


def turning(*values: float, dt: float = 0.1) -> TimeResolution:
    resolution = TimeResolution(1)
    for n, q in enumerate(values):
        resolution.update(dt * n, np.array([q]))
    return resolution


HILL = (0.0, 4.0, 7.0, 9.0, 10.0, 10.0, 9.0, 7.0, 4.0, 0.0)  # second differences of 1


@pytest.mark.parametrize("first", [HILL, ()])
@pytest.mark.parametrize(("top", "rivals"), [(9.8, True), (9.0, False), (2.0, False)])
def test_a_sharp_peak_nearly_as_large_as_the_extreme_is_a_rival(
    first: tuple[float, ...], top: float, rivals: bool
) -> None:
    """Before or after the smooth one: 0.3 times 2 top of error, less by 10 - top than the extreme's 10."""
    resolution = turning(*first, 0.0, top, 0.0, 0.0, *(() if first else HILL))
    assert resolution.of_most[0] == pytest.approx(SHARE * 2.0 * top - (10.0 - top) if rivals else SHARE)
    mirrored = turning(*(-q for q in (*first, 0.0, top, 0.0, 0.0, *(() if first else HILL))))
    assert mirrored.of_least[0] == pytest.approx(resolution.of_most[0])


def test_steps_that_are_reported_are_those_around_the_rival() -> None:
    resolution, t = TimeResolution(1), 0.0
    for dt, q in ((1.0, 0.0), (1.0, 9.0), (1.0, 9.9), (1.0, 9.9), (1.0, 9.0), (0.5, 0.0), (0.2, 9.8), (0.5, 0.0)):
        t += dt
        resolution.update(t, np.array([q]))
    assert resolution.of_most[0] > SHARE * 9.9
    assert resolution.steps[1, 0] == pytest.approx(0.5)


def test_what_is_not_known_is_not_judged() -> None:
    resolution = TimeResolution(1)
    for n, q in enumerate((math.nan, 1.0, 2.0, math.nan, 5.0)):
        resolution.update(0.1 * n, np.array([q]))
    assert resolution.of_most[0] == 0.0


class Indicators(NamedTuple):
    """Those of a riser's figures, and of its steps."""

    figures: FigureIndicators
    steps: StepIndicators

    def warnings(self) -> list[str]:
        return [*self.figures.warnings(), *self.steps.warnings()]


def followed(tensions: list[float], dt: float = 0.1, lost: float = 0.0, local_error: float = 0.0) -> Indicators:
    """Indicators of steps with these tensions at the end and a loss by impact in each [J], 100 J of motion."""
    indicators, rows = Indicators(FigureIndicators(0.3, 1e3), StepIndicators(0.3, 0.5)), np.zeros((len(tensions), SIZE))
    rows[:, TENSION] = tensions
    ledgers = [
        Ledger(kinetic=100.0, dissipated_by={"seabed": 7.0, "seabed_time_scheme": lost * n}) for n in range(len(rows))
    ]
    steps = [StepRecord(0.0, StepStatistics(3, dt, 0.0, 0, local_error), ledger) for ledger in ledgers]
    times, half = dt * np.arange(len(rows)), len(rows) // 2  # as many at once as may be
    for some in (slice(half), slice(half, None)):
        indicators.figures.follow(times[some], rows[some])
        indicators.steps.follow(times[some], steps[some])
    return indicators


def test_a_tension_that_turns_sharply_is_a_warning() -> None:
    """Up and down by 200 N at 1000 N: 0.3 times 400 N of 1000 N; steps of 0.1 s sqrt(0.01/0.12)."""
    indicators = followed([600.0, 800.0, 1000.0, 800.0, 600.0])
    (warning,) = indicators.warnings()
    line_with([warning], "largest tension", "at the end", "120 N", "0.12 of 1000 N", "limit 0.03", "steps of 0.1 s")
    line_with([warning], "time_step of 0.029 s", "auto")
    assert list(followed([980.0, 995.0, 1000.0, 995.0, 980.0]).warnings()) == []


def judged(least: list[float], moments: list[float] | None = None, automatic: bool = False) -> list[str]:
    """Warnings of steps of 0.1 s with these least tensions and largest moments, while the end bears 1000 N."""
    indicators, vector = FigureIndicators(0.3, 1e3, automatic), np.zeros(SIZE)
    for n, tension in enumerate(least):
        vector[[TENSION, LEAST, MOMENT]] = 1000.0, tension, moments[n] if moments else 0.0
        indicators.follow(np.array([n * 0.1]), vector[None])
    return list(indicators.warnings())


def test_a_least_tension_that_turns_sharply_is_a_warning() -> None:
    """Down by 40 N and up again: 0.3 times 80 N of the largest 1000 N, beside a tenth of 150 N, and to a third of that
    as the square of the step; the largest value of the least tension is not asked.
    """
    (warning,) = judged([230.0, 190.0, 150.0, 190.0, 230.0])
    line_with([warning], "least effective tension", "24 N", "0.024 of 1000 N", "limit 0.015", "steps of 0.1 s")
    line_with([warning], "time_step of 0.046 s", "auto")
    assert judged([150.0, 190.0, 230.0, 190.0, 150.0]) == []


@pytest.mark.parametrize(
    ("least", "allowed"),
    [(0.0, 10.0), (50.0, 10.0), (200.0, 20.0), (900.0, 30.0), (-150.0, 10.0), (-300.0, 15.0), (-800.0, 30.0)],
)
def test_least_tension_is_reported_from_a_tenth_of_its_size(least: float, allowed: float) -> None:
    """Compression counts from a twentieth; within 1 and 3 % of the largest tension. V-shaped, by a little more or less
    than what is allowed.
    """
    for factor, warned in ((0.99, False), (1.01, True)):
        off = factor * allowed / (2.0 * SHARE)
        warnings = judged([least + 2.0 * off, least + off, least, least + off, least + 2.0 * off])
        assert bool(warnings) == warned
        assert not warnings or ("riser is compressed" in warnings[0]) == (least < 0.0)


def test_tension_and_moment_are_reported_of_each() -> None:
    warnings = judged([230.0, 190.0, 150.0, 190.0, 230.0], [0.0, 100.0, 200.0, 100.0, 0.0])
    assert [text.split(" may ")[0] for text in warnings] == [
        "the least effective tension",
        "the largest bending moment",
    ]


def test_automatic_steps_are_to_take_a_smaller_tolerance() -> None:
    """Steps that are 0.456 as long have 0.456³ of the local error."""
    (warning,) = judged([230.0, 190.0, 150.0, 190.0, 230.0], automatic=True)
    line_with([warning], "steps of 0.1 s", "tolerance of 0.095")


def test_steps_that_are_reported_are_those_around_the_extreme() -> None:
    resolution, t = TimeResolution(1), 0.0
    for dt, q in ((1.0, 0.0), (1.0, 1.0), (0.1, 2.0), (0.2, 3.0), (0.1, 2.0), (0.1, 1.0), (4.0, 0.5), (9.0, 0.4)):
        t += dt
        resolution.update(t, np.array([q]))
    np.testing.assert_allclose(resolution.steps, [[1.0], [0.2]])


def test_tension_beside_the_weight_is_too_small_to_judge() -> None:
    assert list(followed([0.0, 1e-6, -1e-6, 1e-6]).warnings()) == []


def test_impact_that_loses_the_motion_is_a_warning() -> None:
    warnings = list(followed([1000.0] * 3, lost=20.0).warnings())
    assert len(warnings) == 1
    line_with(warnings, "impact lost 38.1 J", "time step", "38% of the 100 J")
    line_with(warnings, "period of 0.5 s", "5 steps", "time_step of 0.005 s")
    assert list(followed([1000.0] * 3, lost=2.0).warnings()) == []


def test_losses_fade_within_two_periods_of_the_contact() -> None:
    """Landings long after each other are no one impact; the sum of all stays."""
    loss = ImpactLoss()
    for n in range(100):
        loss.follow(10.0 * n, 10.0, 0.5, Ledger(kinetic=100.0, dissipated_by={"contact_time_scheme": 6.0 * n}))
    assert loss.lost == 594.0
    assert loss.share == pytest.approx(0.06 / (1.0 - math.exp(-0.25)), rel=1e-6)


def test_what_the_scheme_puts_in_as_well_is_no_loss() -> None:
    """A pipe pressed in slowly: forces ahead of their mean are paid by the scheme; half of them by the motion."""
    loss, half = ImpactLoss(), ImpactLoss()
    for n in range(1, 9):
        booked = {"contact_time_scheme": 6.0 * n}
        loss.follow(n, 1.0, 0.5, Ledger(ahead=9.0 * n, numerical=-9.0 * n, dissipated_by=booked))
        half.follow(n, 1.0, 0.5, Ledger(ahead=9.0 * n, numerical=-4.5 * n, dissipated_by=booked))
    assert loss.lost == loss.share == 0.0
    assert half.lost == pytest.approx(24.0)


def test_steps_that_misplace_the_riser_are_a_warning() -> None:
    warnings = list(followed([1000.0] * 3, local_error=0.9).warnings())
    assert len(warnings) == 1
    line_with(warnings, "0.9 m", "3 diameters")
    assert list(followed([1000.0] * 3, local_error=0.5).warnings()) == []


def test_indicators_come_back_as_they_were() -> None:
    first = followed([600.0, 800.0, 1000.0, 700.0], lost=50.0, local_error=0.9)
    again = Indicators(FigureIndicators(0.3, 1e3), StepIndicators(0.3, 0.5))
    first.figures.bending = {"moment_error": 3.0}
    again.figures.restore(first.figures.state())
    again.steps.restore(first.steps.state())
    assert again.figures.as_dict(True) == first.figures.as_dict(True)
    assert again.steps.as_dict() == first.steps.as_dict()
    assert again.warnings() == first.warnings()
    assert len(first.warnings()) == 3


def test_statics_tell_of_bending_alone() -> None:
    indicators = FigureIndicators()
    assert indicators.as_dict(False) == {}
    indicators.bending = {"moment_error": 3.0}
    assert indicators.as_dict(False).keys() == {"bending"}
    assert set(indicators.as_dict(True)["time_step"]) == set(JUDGED)
    assert set(StepIndicators().as_dict()["time_step"]) == {"local_error"}
