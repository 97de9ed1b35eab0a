"""A material point of the soil: its law at a depth, and its response along a path."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.errors import SceneError, SolveError
from riser_soil.material.path import STRAIN_FACTOR, STRESS_FACTOR, STRESSES, MaterialPath
from riser_soil.scene.soil import SoilScene
from riser_soil.scene.soil_law import initial_stress, volumes
from riser_soil.scene.soil_layers import boundaries
from riser_soil.soil import mandel
from riser_soil.soil.law import PLASTIC_STRAIN, Formula, SoilLaw, StressUpdate
from riser_soil.soil.layered import layer_at

MOST_ITERATIONS, CONVERGED = 40, 1e-10  # where stress is given: Newton's; what may be missing over the largest stress


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
    wrong = given.wrong_within(within)
    if wrong:
        raise SceneError(f"soil.law: at a depth of {depth:g} m {wrong[0]}; {wrong[1]}, or a smaller --depth")
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
        increment, response = _response(point, increment, values, path, before.history, row)
        lost += _dissipated(point, increment, before, response)
        strain, before = strain + increment, response
        rows.append((strain, response, lost))
    return _curve(law, rows)


def _response(
    point: MaterialPoint, increment: Array, wanted: Array, path: MaterialPath, history: Array, row: int
) -> tuple[Array, StressUpdate]:
    """The increment (6,) that brings the given components of stress to their change, by Newton's method, and the
    law's response.
    """
    free: BoolArray = path.stress
    response = point.law.update(increment[None], history, path.seconds[row])
    for _ in range(MOST_ITERATIONS):
        missing = (wanted - response.stress[0] + point.initial[0])[free]
        if not np.abs(missing).max(initial=0.0) > CONVERGED * np.abs(response.stress).max():
            return increment, response
        moduli = response.tangent[0][np.ix_(free, free)]
        increment = increment.copy()
        increment[free] += np.linalg.lstsq(moduli, missing, rcond=1e-12)[0]
        response = point.law.update(increment[None], history, path.seconds[row])
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
        np.array([response.stress[0] for _, response, _ in rows]) / STRESS_FACTOR,
        np.array([0.0 if plastic is None else response.history[0, plastic] for _, response, _ in rows]),
        np.array([lost for _, _, lost in rows]),
    )
