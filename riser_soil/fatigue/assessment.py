"""The story of `riser-soil fatigue`: from the runs of a fatigue file to the damage of a year, and what to doubt."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.errors import ResultsError
from riser_soil.fatigue.damage import YEAR, StressRanges, damage_rates, records_per_period, standard_error
from riser_soil.fatigue.fatigue_file import Fatigue, FatigueCase, run_folder
from riser_soil.fatigue.stress_history import StressHistory, same_sections, stress_history
from riser_soil.results import Run
from riser_soil.results.cycles import dynamic_stage
from riser_soil.riser.wall_stress import Wall

FEW_RECORDS = 10.0  # in a mean period: a sine's turns are missed by up to 1 - cos(pi/10) = 5 % of its amplitude
_WAVES = ("airy", "jonswap", "pierson_moskowitz", "regular")
LARGE_SCATTER = 0.2  # standard error of the year's damage, by those of the cases


@dataclass(frozen=True, eq=False)
class CaseDamage:
    """A case's part of the year's damage (ns, np).

    seconds: counted. period [s] and records: of the stress where all cases together damage most: its mean time between
    upward crossings of its mean, inf for fewer than two of them, and how many records that has; scatter: relative
    standard error of the damage there. touchdown: least and greatest arc length [m], nan where nothing touches.
    sea: height [m], period [s] and direction [deg] of the waves, of a scene with one train of them.
    """

    case: FatigueCase
    per_year: Array
    seconds: float
    period: float
    records: float
    scatter: float
    touchdown: tuple[float, float]
    sea: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class YearlyDamage:
    """Damage at sections of the wall (ns,) and points around them (np,)."""

    given: Fatigue
    how: StressRanges
    arc: Array  # (ns,) m
    wall: Wall  # (ns,)
    cases: Sequence[CaseDamage]

    @cached_property
    def per_year(self) -> Array:
        """(ns, np), of all cases together."""
        return np.asarray(np.sum([each.per_year for each in self.cases], axis=0))

    @property
    def worst(self) -> tuple[int, int]:
        """Section and point of the largest damage."""
        return _largest(self.per_year)

    @property
    def utilisation(self) -> float | None:
        """Damage in the design life times the design fatigue factor; None without a design life."""
        if self.given.design_life is None:
            return None
        return float(self.given.design_fatigue_factor * self.given.design_life * self.per_year.max())

    @property
    def standard_error(self) -> float:
        """Relative standard error of the largest damage: by those of the cases, each from its own waves."""
        errors, whole = self._errors, float(self.per_year.max())
        return float(np.linalg.norm(errors)) / whole if whole > 0.0 else 0.0

    @property
    def _errors(self) -> Array:
        """(nc,) Standard errors of the cases' parts of the largest damage."""
        return np.array([each.scatter * each.per_year[self.worst] for each in self.cases])

    def warnings(self) -> Iterator[str]:
        """Warnings with numbers and a remedy."""
        total = self.given.total_share
        if total < 1.0 - 1e-9:
            yield f"the cases cover {100.0 * total:.4g} % of the year; the rest counts as calm"
        for each in self.cases:
            yield from _doubts(each)
        yield from self._uncertain()
        used = self.utilisation
        if used is not None and used > 1.0:
            yield (
                f"the damage in {self.given.design_life:g} years times {self.given.design_fatigue_factor:g} is "
                f"{used:.4g}, more than 1"
            )

    def _uncertain(self) -> Iterator[str]:
        """A year's damage that longer simulations would change; sea states that hardly damage may scatter."""
        if self.standard_error <= LARGE_SCATTER:
            return
        most = self.cases[int(self._errors.argmax())]
        share = float(most.per_year[self.worst] / self.per_year.max())
        yield (
            f"the largest damage is uncertain by some {self.standard_error:.0%} (standard error, more than "
            f"{LARGE_SCATTER:.0%}), most of it by {most.case.run}, {share:.0%} of the damage with a standard error of "
            f"{most.scatter:.0%} by the quarters of its {most.seconds:.4g} s; simulate that longer, or with more seeds"
        )


def assess(file: Path, given: Fatigue) -> YearlyDamage:
    """Damage of a year by the cases of a fatigue file; ResultsError where a run does not fit."""
    how = StressRanges(
        given.curve.curve(),
        given.points,
        given.surface,
        given.load_classes,
        given.stress_concentration,
        given.thickness,
    )
    runs = [Run(run_folder(file, case)) for case in given.cases]
    chosen: IntArray = np.empty(0, dtype=int)
    first: StressHistory | None = None
    rates, histories = [], []
    for run, case in zip(runs, given.cases, strict=True):
        history = stress_history(run, case.stage, given.skip if case.skip is None else case.skip)
        if first is None:
            first, chosen = history, _chosen(file, history, given.arcs)
        if not same_sections(first, history):
            raise ResultsError(f"{run.place}: has other nodes or walls than {runs[0].place}; cases share one riser")
        rates.append(damage_rates(history, how, [int(i) for i in chosen]) * case.share * YEAR)
        histories.append(history)
    assert first is not None  # a fatigue file has a case at least
    section, point = _largest(np.sum(rates, axis=0))
    cases = [
        _case(run, case, history, how, rate, int(chosen[section]), point)
        for run, case, history, rate in zip(runs, given.cases, histories, rates, strict=True)
    ]
    return YearlyDamage(given, how, first.arc[chosen], Wall(*(d[chosen] for d in first.sections.wall)), cases)


def _largest(damage: Array) -> tuple[int, int]:
    section, point = np.unravel_index(int(damage.argmax()), damage.shape)
    return int(section), int(point)


def _chosen(file: Path, history: StressHistory, arcs: tuple[float, float] | None) -> IntArray:
    """Sections in the stretch that is asked for."""
    if arcs is None:
        return np.arange(history.arc.size)
    numbers = np.flatnonzero((history.arc >= arcs[0]) & (history.arc <= arcs[1]))
    if not numbers.size:
        reach = f"{history.arc.min():g} to {history.arc.max():g} m"
        wanted = f"{arcs[0]:g} to {arcs[1]:g} m"
        raise ResultsError(f"{file}: arcs: no node of a wall lies from {wanted}; walls lie from {reach}")
    return numbers


def _case(
    run: Run, case: FatigueCase, history: StressHistory, how: StressRanges, per_year: Array, section: int, point: int
) -> CaseDamage:
    period, records = records_per_period(history, how, section, point)
    touchdown = run["touchdown_arc"][run["stage"] == dynamic_stage(run, case.stage)]
    known = touchdown[np.isfinite(touchdown)]
    zone = (float(known.min()), float(known.max())) if known.size else (np.nan, np.nan)
    scatter = standard_error(history, how, section, point)
    return CaseDamage(case, per_year, history.duration, period, records, scatter, zone, _sea(run))


def _sea(run: Run) -> dict[str, float]:
    """Height, period and direction of the waves of a run's scene; nothing where it has several trains, or none."""
    waves = (run.scene.get("water") or {}).get("waves") or {}
    trains = [train for name, train in waves.items() if name in _WAVES and train]
    if len(trains) != 1:
        return {}
    keys = {"height": ("Hs", "height"), "period": ("Tp", "period"), "direction_deg": ("direction_deg",)}
    values = {key: next((trains[0][name] for name in names if name in trains[0]), None) for key, names in keys.items()}
    return {key: float(value) for key, value in values.items() if value is not None}


def _doubts(each: CaseDamage) -> Iterator[str]:
    name = each.case.run
    if np.isinf(each.period) and each.per_year.any():
        yield (
            f"{name}: the stress goes up through its mean less than twice in {each.seconds:.4g} s, too short for whole "
            "cycles; simulate longer or skip less"
        )
    if each.records < FEW_RECORDS:
        yield (
            f"{name}: {each.records:.3g} records in the mean period of the stress, {each.period:.4g} s: turns between "
            f"records are missed by up to {1.0 - np.cos(np.pi / max(each.records, 2.0)):.0%}; let output.interval be "
            f"{each.period / FEW_RECORDS:.2g} s or less"
        )
