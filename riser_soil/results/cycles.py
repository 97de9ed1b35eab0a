"""Cycles of a run's periodic stage, and the secant stiffness of the ground in each."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, TextIO

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.errors import ResultsError
from riser_soil.results.read import Run

SLACK = 1e-6  # of the period: time is a sum of steps
COLUMNS = ("arc_m", "cycle", "end_s", "force_range_N_per_m", "height_range_m", "k_Pa", "k_over_su")


@dataclass(frozen=True, eq=False)
class Cycle:
    """A whole cycle: its end [s of the run] and the records (n,) of results.nc from its beginning to its end."""

    end: float
    records: IntArray


def stage_of_kind(run: Run, name: str | None, *kinds: str) -> int:
    """Number of a stage of one of these kinds by its name; the last one by default."""
    numbers = {stage["name"]: n for n, stage in enumerate(run.summary["stages"]) if stage["kind"] in kinds}
    chosen = name if name is not None else next(reversed(numbers), "")
    if chosen not in numbers:
        words = " or ".join(kinds)
        choice = f"its {words} stages: {', '.join(numbers)}" if numbers else f"it has no {words} stage"
        raise ResultsError(f'{run.place}: "{chosen}" is no {words} stage of the run; {choice}')
    return numbers[chosen]


def dynamic_stage(run: Run, name: str | None) -> int:
    """Number of a dynamic stage by its name; the last one by default."""
    return stage_of_kind(run, name, "dynamic")


def timed_stage(run: Run, name: str | None) -> int:
    """Number of a stage along t by its name; the last one by default."""
    return stage_of_kind(run, name, "quasi-static", "dynamic")


def beginning(run: Run, stage: int) -> float:
    """Total simulated time [s] at which a stage begins."""
    return float(sum(before["time"] for before in run.summary["stages"][:stage]))


def period_of(run: Run, stage: int) -> float:
    """Period [s] of a stage's motion, or of regular waves where the ends stay."""
    stages = run.scene.get("stages") or []
    periods = {*_periods(stages[stage : stage + 1])} or {*_periods((run.scene.get("water") or {}).get("waves"))}
    if len(periods) != 1:
        each = ", ".join(f"{T:g}" for T in sorted(periods))
        problem = f"has the periods {each} s" if periods else "has no one period"
        raise ResultsError(
            f'{run.place}: stage "{run.stage_names[stage]}" {problem}; give the length of a cycle, period'
        )
    return periods.pop()


def _periods(piece: Any) -> Iterator[float]:
    """All values of keys named period in a piece of a scene."""
    if isinstance(piece, list):
        for item in piece:
            yield from _periods(item)
    if isinstance(piece, dict):
        for key, value in piece.items():
            if key == "period" and isinstance(value, int | float):
                yield float(value)
            else:
                yield from _periods(value)


def cycles(run: Run, stage: int, period: float) -> list[Cycle]:
    """The whole cycles of a stage, from its beginning on; ResultsError where there is none."""
    since, of_stage = beginning(run, stage), run["stage"] == stage
    at_first = np.flatnonzero(run["stage"] < stage)[-1:]
    records = np.concatenate([at_first, np.flatnonzero(of_stage)])
    passed = (run.time[records] - since) / period
    whole = int(np.floor(passed.max(initial=0.0) + SLACK))
    if whole < 1:
        raise ResultsError(f'{run.place}: stage "{run.stage_names[stage]}" has no whole cycle of {period:g} s')
    return [
        Cycle(since + (n + 1) * period, records[(passed > n - SLACK) & (passed < n + 1 + SLACK)]) for n in range(whole)
    ]


@dataclass(frozen=True, eq=False)
class SecantStiffness:
    """Secant stiffness in nc cycles at na arc lengths. su: strength at the ground's surface [Pa], nan where its law has
    none.
    """

    arc: Array  # (na,) m
    end: Array  # (nc,) s, of the run
    force: Array  # (nc, na) N/m, largest less smallest contact force per length
    height: Array  # (nc, na) m, largest less smallest height of the riser's axis
    su: float

    @property
    def k(self) -> Array:
        """Force range over height range (nc, na) [Pa]; nan where the riser stays, or never touches."""
        moved = (self.height > 0.0) & (self.force > 0.0)
        return np.where(moved, self.force / np.where(moved, self.height, 1.0), np.nan)

    @property
    def over_su(self) -> Array:
        """k/su (nc, na) [-]."""
        return self.k / self.su


def secant_stiffness(
    run: Run, arcs: Sequence[float], stage: str | None = None, period: float | None = None
) -> SecantStiffness:
    """Between the records of a stage along t, by default the last, and linear between the nodes.

    arcs: m. period: s; by default that of the stage's motion. Where the riser lifts off, the range of its height has
    the way through the water too: the stiffness is that of the whole cycle. Raises ResultsError.
    """
    _check_arcs(run, arcs)
    number = timed_stage(run, stage)
    whole_cycles = cycles(run, number, period_of(run, number) if period is None else period)
    force, height = (_at(run, values, arcs) for values in (run["contact_force"], run["position"][..., 2]))
    forces, heights = ([np.ptp(values[cycle.records], axis=0) for cycle in whole_cycles] for values in (force, height))
    ends = np.array([cycle.end for cycle in whole_cycles])
    return SecantStiffness(np.array(arcs), ends, np.array(forces), np.array(heights), _su(run))


def write_csv(stiffness: SecantStiffness, file: TextIO) -> None:
    """Write a table with one line for each arc length and cycle, cycles counted from 1."""
    rows = csv.writer(file, lineterminator="\n")
    rows.writerow(COLUMNS)
    for a, arc in enumerate(stiffness.arc):
        for c, end in enumerate(stiffness.end):
            values = (stiffness.force[c, a], stiffness.height[c, a], stiffness.k[c, a], stiffness.over_su[c, a])
            rows.writerow([f"{arc:.6g}", c + 1, f"{end:.6g}", *(f"{value:.6g}" for value in values)])


def _check_arcs(run: Run, arcs: Sequence[float]) -> None:
    beyond = [arc for arc in arcs if not run.arc[0] <= arc <= run.arc[-1]]
    if beyond:
        raise ResultsError(f"arc length {beyond[0]:g} m is not on the riser, which is {run.arc[-1]:g} m long")


def _at(run: Run, values: Array, arcs: Sequence[float]) -> Array:
    """Values (nt, nn) of the nodes at arc lengths (nt, na)."""
    return np.array([np.interp(arcs, run.arc, row) for row in values])


def _su(run: Run) -> float:
    """Undrained shear strength at the ground's surface [Pa]; nan where it has none, or the scene can't be read."""
    su = None if run.checked_scene is None else run.checked_scene.surface_strength
    return np.nan if su is None else su
