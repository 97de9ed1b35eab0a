"""Fatigue: S-N curves, rainflow cycles and damage against published numbers, closed forms and fatpack by hand."""

from __future__ import annotations

import math

import fatpack
import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.fatigue.assessment import CaseDamage, YearlyDamage
from riser_soil.fatigue.damage import (
    StressRanges,
    damage_rates,
    mean_period,
    rainflow_ranges,
    records_per_period,
    standard_error,
)
from riser_soil.fatigue.fatigue_file import Fatigue
from riser_soil.fatigue.sn_curve import (
    CLASSES,
    ENVIRONMENTS,
    CurveClass,
    Environment,
    SNCurve,
    curve_through,
    dnv_curve,
)
from riser_soil.fatigue.stress_history import StressHistory
from riser_soil.riser.wall_stress import Wall, wall_sections
from tests.support.said import line_with

# Fatigue limit at 1e7 cycles [MPa] as printed in the tables, in the order of the classes.
LIMITS = (106.97, 93.59, 73.10, 65.50, 58.48, 52.63, 46.78, 41.52, 36.84, 32.75, 29.24, 26.32, 23.39, 21.05)
STRAIGHT = SNCurve("straight", "by hand", (12.0,), (3.0,))


def irregular(n: int = 4000) -> Array:
    """A stress history [MPa] without any period."""
    t = np.linspace(0.0, 400.0, n)
    return 60.0 * np.sin(t) + 35.0 * np.sin(2.3 * t + 1.0) + 20.0 * np.sin(0.17 * t * t / 40.0)


@pytest.mark.parametrize("environment", ["air", "cathodic-protection"])
@pytest.mark.parametrize(("name", "limit"), [*zip(CLASSES, LIMITS, strict=True)])
def test_curves_have_their_printed_fatigue_limits(name: CurveClass, limit: float, environment: Environment) -> None:
    """At 1e7 cycles; limits are printed to four digits, and N falls with their fifth power."""
    assert dnv_curve(name, environment).endurance(np.array(0.999 * limit)) == pytest.approx(1e7, rel=0.008)


@pytest.mark.parametrize("name", CLASSES)
@pytest.mark.parametrize("environment", ENVIRONMENTS)
def test_branches_of_the_curves_meet(name: CurveClass, environment: Environment) -> None:
    """Branches meet to the three decimals that logarithms are printed with."""
    curve = dnv_curve(name, environment)
    for log_a, m, change in zip(curve.log_a, curve.m, curve.change, strict=False):
        S = 10.0 ** ((log_a - math.log10(change)) / m)
        after = curve.log_a[1] - curve.m[1] * math.log10(S)
        assert after == pytest.approx(math.log10(change), abs=0.002)


def test_the_sea_shortens_lives() -> None:
    """Cathodic protection by 2.5 and free corrosion by 3 where stress is large, of the classes of slope 3."""
    S = np.array(200.0)
    for name in CLASSES[2:]:
        air, cathodic, free = (dnv_curve(name, environment).endurance(S) for environment in ENVIRONMENTS)
        assert air / cathodic == pytest.approx(2.5, rel=0.01)
        assert air / free == pytest.approx(3.0, rel=0.01)


def test_numbers_of_a_curve_by_hand() -> None:
    """D in seawater with cathodic protection on both sides of 1e6 cycles; nothing for no stress."""
    endurance = dnv_curve("D", "cathodic-protection").endurance(np.array([100.0, 50.0, 0.0]))
    assert endurance[:2] == pytest.approx([10.0**11.764 / 100.0**3, 10.0**15.606 / 50.0**5], rel=1e-12)
    assert endurance[2] == np.inf


def test_thick_walls_are_weaker_and_thin_ones_not_stronger() -> None:
    curve = dnv_curve("F", "air")
    assert curve.thickness_factor(0.05) == pytest.approx(2.0**0.25, rel=1e-12)
    assert curve.thickness_factor(0.02) == 1.0


def test_a_table_is_straight_in_logarithms_and_goes_on_beyond() -> None:
    points = [(1e4, 300e6), (1e6, 80e6), (1e8, 30e6)]
    curve = curve_through(points)
    assert curve.endurance(np.array([300.0, 80.0, 30.0])) == pytest.approx([1e4, 1e6, 1e8], rel=1e-9)
    between = math.sqrt(300.0 * 80.0), math.sqrt(80.0 * 30.0), 300.0**2 / 80.0, 30.0**2 / 80.0
    assert curve.endurance(np.array(between)) == pytest.approx([1e5, 1e7, 1e2, 1e10], rel=1e-9)


def test_rainflow_of_astm_e1049() -> None:
    """The standard's example of a repeating history; 900 classes have all its turns in their middle."""
    history = np.array([-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0])
    assert sorted(rainflow_ranges(history, 900)) == pytest.approx([3.0, 4.0, 7.0, 9.0], rel=1e-12)


def test_damage_is_what_fatpack_finds_by_hand() -> None:
    y, k = irregular(), 4096
    reversals, _ = fatpack.find_reversals(y, k)
    closed, residue = fatpack.find_rainflow_cycles(reversals)
    rest, _ = fatpack.find_rainflow_cycles(fatpack.concatenate_reversals(residue, residue))
    cycles = np.concatenate([closed, rest])
    by_hand = fatpack.LinearEnduranceCurve(10.0 ** (12.0 / 3.0) / (2.0e6) ** (1.0 / 3.0))
    by_hand.m, by_hand.Nc = 3.0, 2.0e6
    expected = by_hand.find_miner_sum(np.abs(cycles[:, 1] - cycles[:, 0]))
    assert STRAIGHT.damage(rainflow_ranges(y, k)) == pytest.approx(expected, rel=1e-9)


def test_two_slopes_by_fatpack_s_own_curve() -> None:
    """One whose branches meet to the last digit, as fatpack's do."""
    change, S = 1e6, 10.0 ** ((11.764 - 6.0) / 3.0)
    curve = SNCurve("two", "by hand", (11.764, 6.0 + 5.0 * math.log10(S)), (3.0, 5.0), (change,))
    by_hand = fatpack.BiLinearEnduranceCurve(S)
    by_hand.m1, by_hand.m2, by_hand.Nc, by_hand.Nd = 3.0, 5.0, change, change
    ranges = rainflow_ranges(irregular(), 4096)
    assert ranges.min() < S < ranges.max()
    assert curve.damage(ranges) == pytest.approx(by_hand.find_miner_sum(ranges), rel=1e-9)


def test_a_sine_has_its_cycles() -> None:
    t = np.arange(0.0, 50.0 + 1e-9, 0.01)
    y = 40.0 * np.cos(2.0 * np.pi * t)
    assert STRAIGHT.damage(rainflow_ranges(y, 4096)) == pytest.approx(50.0 * 80.0**3 / 1e12, rel=1e-3)
    assert mean_period(t, y) == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize(
    ("history", "expected"),
    [
        ([5.0, 5.0, 5.0], []),
        ([0.0, 1.0, 4.0], [4.0]),
        ([0.0, 3.0, 1.0], [3.0]),
        ([3.0, 1.0, 2.0, 0.0], [1.0, 3.0]),
    ],
)
def test_histories_of_few_turns(history: list[float], expected: list[float]) -> None:
    """Gone on with as they began, they have no cycle or one of their whole range."""
    assert rainflow_ranges(np.array(history), 4096) == pytest.approx(np.array(expected), rel=1e-3)
    assert mean_period(np.arange(float(len(history))), np.array(history)) == np.inf


@pytest.mark.parametrize("m", [3.0, 5.0])
def test_narrow_band_stress_has_rayleigh_s_damage(m: float) -> None:
    """D = N/a (2 sqrt(2) sigma)^m Gamma(1 + m/2), within three standard errors of twelve seas of 4096 waves each."""
    curve, waves, n, random = SNCurve("m", "by hand", (12.0,), (m,)), 4096, 2**17, np.random.default_rng(7)
    ratio = []
    for _ in range(12):
        amplitude = np.zeros(n // 2 + 1, dtype=complex)
        band = np.arange(int(0.96 * waves), int(1.04 * waves) + 1)
        amplitude[band] = random.normal(size=band.size) + 1j * random.normal(size=band.size)
        y = np.fft.irfft(amplitude)
        y *= 30.0 / y.std()
        upward = math.sqrt(float((np.abs(amplitude[band]) ** 2 * band**2).sum() / (np.abs(amplitude) ** 2).sum()))
        rayleigh = upward / 1e12 * (2.0 * math.sqrt(2.0) * 30.0) ** m * math.gamma(1.0 + 0.5 * m)
        ratio.append(curve.damage(rainflow_ranges(y, 4096)) / rayleigh)
    error = np.std(ratio, ddof=1) / math.sqrt(len(ratio))
    assert error < 0.03
    assert abs(np.mean(ratio) - 1.0) < 3.0 * error


def of_one_pipe(time: Array, moment_y: Array, moment_z: Array) -> StressHistory:
    """Moments (nt,) on both nodes of an element [N m]."""
    wall = Wall(np.array([0.3]), np.array([0.2]))
    sections = wall_sections(wall, np.zeros(1), np.ones((1, 2)))
    still = np.zeros((time.size, 2))
    y, z = (np.stack([moment, moment], axis=1) for moment in (moment_y, moment_z))
    return StressHistory(time, np.array([0.0, 5.0]), sections, sections.loads(still, y, z, still, still, still))


def test_a_moment_that_turns_damages_all_around_alike() -> None:
    """Once around in every period: each point has its range twice M r/I, one after the other."""
    t = np.arange(0.0, 100.0 + 1e-9, 0.025)
    turning = of_one_pipe(t, 4.0e4 * np.sin(2.0 * np.pi * t), 4.0e4 * np.cos(2.0 * np.pi * t))
    rates = damage_rates(turning, StressRanges(STRAIGHT, points=8), [0, 1])
    S = 2e-6 * 4.0e4 * 0.15 / (np.pi / 64.0 * (0.3**4 - 0.2**4))
    assert rates == pytest.approx(np.full((2, 8), S**3 / 1e12), rel=0.005)
    back_and_forth = of_one_pipe(t, 4.0e4 * np.sin(2.0 * np.pi * t), 0.0 * t)
    rates = damage_rates(back_and_forth, StressRanges(STRAIGHT, points=8), [0])
    expected = (np.abs(np.sin(np.pi / 4.0 * np.arange(8))) * S) ** 3 / 1e12
    assert rates[0] == pytest.approx(expected, rel=0.005, abs=1e-12)


def test_records_too_far_apart_and_few_waves_are_reported() -> None:
    """6.25 records in each period of 5 s, and amplitudes that grow; 5 % of a sine's turn is what ten records miss."""
    t = np.arange(0.0, 80.0, 0.8)
    history = of_one_pipe(t, t * np.sin(2.0 * np.pi * t / 5.0), 0.0 * t)
    how = StressRanges(STRAIGHT, points=4)
    period, records = records_per_period(history, how, 0, 1)
    assert period == pytest.approx(5.0, rel=0.02)
    assert records == pytest.approx(6.25, rel=0.02)
    scatter = standard_error(history, how, 0, 1)
    growth = np.arange(4.0) + 0.5
    assert scatter == pytest.approx(np.std(growth**3, ddof=1) / (2.0 * np.mean(growth**3)), rel=0.1)
    given = Fatigue.model_validate(
        {"curve": {"log_a": [12.0], "m": [3.0]}, "cases": [{"run": "sea", "share": 1.0}], "points": 4}
    )
    case = CaseDamage(given.cases[0], np.ones((2, 4)), 80.0, period, records, scatter, (np.nan, np.nan))
    sparse, few = YearlyDamage(given, how, history.arc, history.sections.wall, [case]).warnings()
    assert sparse.startswith("sea: 6.2")
    line_with([sparse], "missed", "up to 13%", "output.interval", "0.5 s")
    line_with([few], f"uncertain by some {scatter:.0%}", "sea, 100% of the damage", "simulate that longer")


def test_sea_states_that_hardly_damage_may_scatter() -> None:
    """The root of the sum of squares: of 100 with 10 %, 1 with 80 % the year's error is below 10 %."""
    calm, storm = "calm", "storm"
    given = Fatigue.model_validate(
        {
            "curve": {"log_a": [12.0], "m": [3.0]},
            "cases": [{"run": calm, "share": 0.7}, {"run": storm, "share": 0.3}],
            "points": 4,
        }
    )
    history = of_one_pipe(np.arange(0.0, 8.0, 0.5), np.zeros(16), np.zeros(16))

    def year(scatter: float) -> YearlyDamage:
        parts = ((1.0, 0.8), (100.0, scatter))
        seas = [
            CaseDamage(case, np.full((2, 4), damage), 80.0, 5.0, 20.0, error, (np.nan, np.nan))
            for case, (damage, error) in zip(given.cases, parts, strict=True)
        ]
        return YearlyDamage(given, StressRanges(STRAIGHT, points=4), history.arc, history.sections.wall, seas)

    assert year(0.1).standard_error == pytest.approx(math.hypot(0.8, 10.0) / 101.0)
    assert [*year(0.1).warnings()] == []
    line_with([*year(0.3).warnings()], "uncertain by some 30%", "storm, 99% of the damage")
