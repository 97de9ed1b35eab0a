"""A material point of the soil: its law at a depth, its answer along a path, and how it remembers.

How a law remembers: mean stress that cycles of shear about a held strain leave, strain that cycles of stress add.

A law whose loops close keeps both. Where it hardens by a backstress that fades (Armstrong & Frederick), a mean stress
relaxes by the same share in each cycle, and a mean load adds the same strain in each, without end (J. Lemaitre, J.-L.
Chaboche, Mechanics of Solid Materials, 1990, section 5.4).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain, repeat
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.errors import SceneError, SolveError
from riser_soil.material.path import STRAIN_FACTOR, STRESS_FACTOR, STRESSES, MaterialPath, shear_path
from riser_soil.scene.soil import SoilScene
from riser_soil.scene.soil_law import initial_stress, volumes
from riser_soil.scene.soil_layers import boundaries
from riser_soil.soil import mandel
from riser_soil.soil.law import PLASTIC_STRAIN, Formula, SoilLaw, StressUpdate
from riser_soil.soil.layered import layer_at

MOST_ITERATIONS, CONVERGED = 40, 1e-10  # where stress is given: Newton's; what may be missing over the largest stress
CYCLES, ROWS = 14, 40  # of one amplitude; rows from turn to turn
HELD = 0.03  # shear strain at the top of the cycles of strain
AMPLITUDES = tuple(10.0 ** (0.5 * k) for k in range(-6, -3))
LOW, HIGH = 0.1, 0.7  # of the stress at that strain, between which cycles of stress go
KEPT = 1e-3  # of the stress: less is no mean stress


@dataclass(frozen=True, eq=False)
class MaterialPoint:
    """A law at one point and the initial stress there (1, 6) [Pa], in the components of mandel.py."""

    law: Formula
    initial: Array


@dataclass(frozen=True, eq=False)
class MaterialCurve:
    """What a point did, the start first: strain since then (n, 6) and stress (n, 6) [Pa] in the engineer's components,
    equivalent plastic strain (n,), and what was dissipated since the start (n,) [J/m3].
    """

    strain: Array
    stress: Array
    plastic_strain: Array
    dissipated: Array


def point_at(soil: SoilScene, depth: float) -> MaterialPoint:
    """The soil's law at a depth below the seabed [m]; SceneError where it can't be, or starts beyond its limit."""
    given, within = law_at(soil, depth)
    found = given.wrong_within(within)
    if found:
        raise SceneError(f"soil.law: at a depth of {depth:g} m {found[0]}; {found[1]}, or a smaller --depth")
    initial = initial_stress(soil, np.array([depth]))
    law = given.at_points(np.array([within]), initial)
    over = float(law.overstress(initial)[0])
    if over > 1.0 + 1e-12:
        raise SceneError(
            f"soil.K0 = {soil.K0}: at depth {depth:.3g} m the geostatic stress is {over:.3g} times "
            "what the soil bears; bring K0 nearer to 1 or raise the strength"
        )
    return MaterialPoint(law, initial)


def law_at(soil: SoilScene, depth: float) -> tuple[SoilLaw, float]:
    """The law at a depth below the seabed, and the depth as it counts [m]; SceneError of layers by volume."""
    if soil.layers is None:
        return soil.top_law, depth
    if volumes(soil):
        raise SceneError("soil.layers: volumes of a mesh file have no depth: drive a scene with that one law")
    edges = boundaries(soil.layers)
    layer = int(layer_at(edges, np.array([depth]))[0])
    return soil.layers[layer].law, depth - (0.0, *edges)[layer]


def drive(point: MaterialPoint, path: MaterialPath) -> MaterialCurve:
    """Take a point along a path; SolveError where it can't bear a stress that the path asks for."""
    law = point.law
    before = law.update(np.zeros((1, 6)), law.start())
    wanted = path.values * np.where(path.stress, STRESS_FACTOR, STRAIN_FACTOR)
    strain: Array = np.zeros(6)
    lost = 0.0
    rows = [(strain, before, lost)]
    for row, values in enumerate(wanted):
        increment = np.where(path.stress, 0.0, values - strain)
        increment, found = _answer(point, increment, values, path, before.history, row)
        lost += _dissipated(point, increment, before, found)
        strain, before = strain + increment, found
        rows.append((strain, found, lost))
    return _curve(law, rows)


def _answer(
    point: MaterialPoint, increment: Array, wanted: Array, path: MaterialPath, history: Array, row: int
) -> tuple[Array, StressUpdate]:
    """The increment (6,) that brings the given components of stress to their change, by Newton's method, and its
    answer.
    """
    free: BoolArray = path.stress
    found = point.law.update(increment[None], history, path.seconds[row])
    for _ in range(MOST_ITERATIONS):
        missing = (wanted - found.stress[0] + point.initial[0])[free]
        if not np.abs(missing).max(initial=0.0) > CONVERGED * np.abs(found.stress).max():
            return increment, found
        moduli = found.tangent[0][np.ix_(free, free)]
        increment = increment.copy()
        increment[free] += np.linalg.lstsq(moduli, missing, rcond=1e-12)[0]
        found = point.law.update(increment[None], history, path.seconds[row])
    names = ", ".join(np.array(STRESSES)[free])
    raise SolveError(
        f"{path.source}, row {row + 1}: no strain brings {names} to what is asked: the soil has no such strength, or "
        "the row is too far from the one before; lower the stress, or put rows in between"
    )


def _dissipated(point: MaterialPoint, increment: Array, before: StressUpdate, after: StressUpdate) -> float:
    """Work of the mean stress of a step less the change of what is stored [J/m3]."""
    work = 0.5 * (before.stress + after.stress) @ increment
    by_initial = mandel.product(point.initial, after.elastic - before.elastic)
    return float((work - by_initial - after.stored + before.stored)[0])


def _curve(law: Formula, rows: list[tuple[Array, StressUpdate, float]]) -> MaterialCurve:
    plastic = law.columns.index(PLASTIC_STRAIN) if PLASTIC_STRAIN in law.columns else None
    return MaterialCurve(
        np.array([strain for strain, _, _ in rows]) / STRAIN_FACTOR,
        np.array([found.stress[0] for _, found, _ in rows]) / STRESS_FACTOR,
        np.array([0.0 if plastic is None else found.history[0, plastic] for _, found, _ in rows]),
        np.array([lost for _, _, lost in rows]),
    )


class StressRelaxation(NamedTuple):
    """Cycles of strain from HELD down by twice the amplitude and back: shear stress at HELD when they begin and at the
    end of each (CYCLES + 1,), and mean stress of each (CYCLES,) [Pa].
    """

    amplitude: float
    top: Array
    mean: Array

    @property
    def lost(self) -> float:
        """Share of the mean stress that a cycle takes; nan where there is no more to take."""
        first, last = self.mean[0], self.mean[-1]
        if abs(first) <= KEPT * abs(self.top[0]):
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
    stress = drive(point, shear_path(_between(HELD - 2.0 * amplitude, HELD), ROWS)).stress[:, 4]
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


def in_words(found: Memory) -> list[str]:
    """How a soil remembers cycles in words, a line each."""
    lines = [
        f"{CYCLES} cycles of shear strain up to {HELD:g}:",
        f"{'amplitude [-]':>15} {'first [kPa]':>12} {'last [kPa]':>12} {'of the mean lost a cycle [%]':>29}",
    ]
    for each in found.relaxation:
        first, last = (f"{1e-3 * each.top[n]:12.4g}" for n in (0, -1))
        lost = "-" if np.isnan(each.lost) else f"{100.0 * each.lost:.2f}"
        lines.append(f"{each.amplitude:15.4g} {first} {last} {lost:>29}")
    first, last = found.ratchet[0], found.ratchet[-1]
    added = f"{first:.5f} at first, {last:.5f} at last, {abs(last - found.ratchet[-2]):.5f} more by the last one"
    return [*lines, f"{CYCLES} cycles of shear stress, {LOW:g} to {HIGH:g} of the largest one there: strain {added}"]


def columns(found: Memory) -> dict[str, Array]:
    """Columns of a table by their headings, a row a cycle; the first row is the first way up."""
    tops = {f"stress_at_{each.amplitude:.4g} [Pa]": each.top for each in found.relaxation}
    return {"cycle [-]": np.arange(CYCLES + 1.0), **tops, "strain_of_stress_cycles [-]": found.ratchet}
