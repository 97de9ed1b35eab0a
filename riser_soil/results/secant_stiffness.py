"""Secant stiffness of the ground, cycle by cycle: range of the contact force over that of the riser's height."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TextIO

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.errors import ResultsError
from riser_soil.results.cycles import cycles, period_of, timed_stage
from riser_soil.results.read import Run

COLUMNS = ("arc_m", "cycle", "end_s", "force_range_N_per_m", "height_range_m", "k_Pa", "k_over_su")


@dataclass(frozen=True, eq=False)
class SecantStiffness:
    """Of nc cycles at na arc lengths; su: strength at the ground's surface [Pa], nan where its law has none."""

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
    found = cycles(run, number, period_of(run, number) if period is None else period)
    force, height = (_at(run, values, arcs) for values in (run["contact_force"], run["position"][..., 2]))
    forces, heights = ([np.ptp(values[cycle.records], axis=0) for cycle in found] for values in (force, height))
    ends = np.array([cycle.end for cycle in found])
    return SecantStiffness(np.array(arcs), ends, np.array(forces), np.array(heights), _su(run))


def write_csv(found: SecantStiffness, file: TextIO) -> None:
    """One line for each arc length and cycle, cycles counted from 1."""
    rows = csv.writer(file, lineterminator="\n")
    rows.writerow(COLUMNS)
    for a, arc in enumerate(found.arc):
        for c, end in enumerate(found.end):
            values = (found.force[c, a], found.height[c, a], found.k[c, a], found.over_su[c, a])
            rows.writerow([f"{arc:.6g}", c + 1, f"{end:.6g}", *(f"{value:.6g}" for value in values)])


def _check_arcs(run: Run, arcs: Sequence[float]) -> None:
    beyond = [arc for arc in arcs if not run.arc[0] <= arc <= run.arc[-1]]
    if beyond:
        raise ResultsError(f"arc length {beyond[0]:g} m is not on the riser, which is {run.arc[-1]:g} m long")


def _at(run: Run, values: Array, arcs: Sequence[float]) -> Array:
    """Values (nt, nn) of the nodes at arc lengths (nt, na)."""
    return np.array([np.interp(arcs, run.arc, row) for row in values])


def _su(run: Run) -> float:
    ground = run.scene.get("soil") or run.scene.get("seabed") or {}
    return float((ground.get("law") or {}).get("su", np.nan))
