"""How a law remembers: mean stress after cycles of shear about a constant strain, strain that cycles of stress add.

A law whose loops close keeps both. Where it hardens by a backstress that fades (Armstrong & Frederick), a mean stress
relaxes by the same share in each cycle, and a mean load adds the same strain in each, without end (J. Lemaitre, J.-L.
Chaboche, Mechanics of Solid Materials, 1990, section 5.4).
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain, repeat
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.errors import SolveError
from riser_soil.material.path import shear_path
from riser_soil.material.point import MaterialPoint, drive

CYCLES, ROWS = 14, 40  # cycles of one amplitude; rows from turn to turn
TOP = 0.03  # shear strain at the top of the cycles of strain
AMPLITUDES = tuple(10.0 ** (0.5 * k) for k in range(-6, -3))
LOW, HIGH = 0.1, 0.7  # of the stress at that strain, between which cycles of stress go
ZERO_MEAN = 1e-3  # a mean stress below this share of the stress counts as zero


class StressRelaxation(NamedTuple):
    """Cycles of strain from TOP down by twice the amplitude and back: shear stress at TOP when they begin and at the
    end of each (CYCLES + 1,), and mean stress of each (CYCLES,) [Pa].
    """

    amplitude: float
    top: Array
    mean: Array

    @property
    def lost(self) -> float:
        """Share of the mean stress that a cycle takes; nan where there is no more to take."""
        first, last = self.mean[0], self.mean[-1]
        if abs(first) <= ZERO_MEAN * abs(self.top[0]):
            return np.nan
        return float(1.0 - (max(last / first, 0.0)) ** (1.0 / (CYCLES - 1)))


class Memory(NamedTuple):
    """How a soil remembers cycles: stress relaxation by strain amplitude, and ratcheting.

    ratchet (CYCLES + 1,): shear strain [-] at the top of each cycle of stress, the first way up too; nan where the soil
    can't follow it.
    """

    relaxation: tuple[StressRelaxation, ...]
    ratchet: Array


def memory(point: MaterialPoint) -> Memory:
    """How the law of a point remembers cycles, from its initial state on."""
    relaxation = tuple(_relaxation(point, amplitude) for amplitude in AMPLITUDES)
    return Memory(relaxation, _ratchet(point, float(relaxation[0].top[0])))


def _relaxation(point: MaterialPoint, amplitude: float) -> StressRelaxation:
    stress = drive(point, shear_path(_between(TOP - 2.0 * amplitude, TOP), ROWS)).stress[:, 4]
    turns = (stress - stress[0])[ROWS::ROWS]
    top, bottom = turns[::2], turns[1::2]
    return StressRelaxation(amplitude, top, 0.5 * (bottom + top[1:]))


def _ratchet(point: MaterialPoint, largest: float) -> Array:
    try:
        path = shear_path(_between(LOW * largest, HIGH * largest), ROWS, by_stress=True)
        return drive(point, path).strain[ROWS :: 2 * ROWS, 4]
    except SolveError:
        return np.full(CYCLES + 1, np.nan)


def _between(low: float, high: float) -> Iterator[float]:
    """Turns from 0 to `high`, and CYCLES times to `low` and back."""
    return chain((0.0, high), *repeat((low, high), CYCLES))


def in_words(memory: Memory) -> list[str]:
    """How a soil remembers cycles in words, a line each."""
    lines = [
        f"{CYCLES} cycles of shear strain up to {TOP:g}:",
        f"{'amplitude [-]':>15} {'first [kPa]':>12} {'last [kPa]':>12} {'of the mean lost a cycle [%]':>29}",
    ]
    for each in memory.relaxation:
        first, last = (f"{1e-3 * each.top[n]:12.4g}" for n in (0, -1))
        lost = "-" if np.isnan(each.lost) else f"{100.0 * each.lost:.2f}"
        lines.append(f"{each.amplitude:15.4g} {first} {last} {lost:>29}")
    first, last = memory.ratchet[0], memory.ratchet[-1]
    added = f"{first:.5f} at first, {last:.5f} at last, {abs(last - memory.ratchet[-2]):.5f} more by the last one"
    return [*lines, f"{CYCLES} cycles of shear stress, {LOW:g} to {HIGH:g} of the largest one there: strain {added}"]


def table_columns(memory: Memory) -> dict[str, Array]:
    """Columns of a table by their headings, a row a cycle; the first row is the first way up."""
    tops = {f"stress_at_{each.amplitude:.4g} [Pa]": each.top for each in memory.relaxation}
    return {"cycle [-]": np.arange(CYCLES + 1.0), **tops, "strain_of_stress_cycles [-]": memory.ratchet}
