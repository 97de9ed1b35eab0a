"""Resistance curves of the pipe segment: the path of the demo, published formulas, seabed laws on the same path."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from riser_soil.calibration.path import PenetrationPath, path_through
from riser_soil.calibration.segment import TABLE, PipeSegment, write_table
from riser_soil.core.arrays import Array
from riser_soil.seabed.aubeny_biscontin import AubenyBiscontin
from riser_soil.seabed.law import NormalLaw
from riser_soil.seabed.randolph_quiggin import RandolphQuiggin
from riser_soil.variants.variant import BaseScene

HERE = Path(__file__).parent
SCENE = HERE / "scene.yaml"
D, SU = 0.30, 5.0e3  # m, Pa; as in the scene
STEP, PAUSE, DEEPEST = 0.005, 0.1, 0.2  # of the path, where it cycles, its end, over D
AMPLITUDES = (0.0025, 0.005, 0.01, 0.02)  # of uplift, over D
CYCLES, UPLIFT = 14, 0.01  # of one amplitude, over D
LAWS: dict[str, NormalLaw] = {
    "randolph-quiggin": RandolphQuiggin(kind="randolph-quiggin", su=SU).of_pipe(D),
    "aubeny-biscontin": AubenyBiscontin(kind="aubeny-biscontin", su=SU).of_pipe(D),
}


def demo_path() -> PenetrationPath:
    """Down to D/10, up and down again ever farther, then on to D/5."""
    return _through(PAUSE, *(w for a in AMPLITUDES for w in (PAUSE - a, PAUSE)), DEEPEST)


def cyclic_path() -> PenetrationPath:
    """Down to D/10, and there many times up and down by as much."""
    return _through(PAUSE, *(PAUSE - UPLIFT, PAUSE) * CYCLES)


def _through(*corners: float) -> PenetrationPath:
    """Path from the surface, corner by corner, over D; short steps after each."""
    pieces = (path_through(D * np.array([b]), D * a, D * STEP).w[1:] for a, b in pairwise((0.0, *corners)))
    return PenetrationPath(np.concatenate([np.zeros(1), *pieces]), np.zeros(0))


def monotonic(deepest: float = DEEPEST) -> PenetrationPath:
    """Straight down to so many diameters."""
    return path_through(np.array([D * deepest]), 0.0, D * STEP)


def resistance(path: PenetrationPath, *overrides: str) -> Array:
    """V/(su D) (m,) of the scene with overrides along a path."""
    with TemporaryDirectory() as place:
        table = Path(place) / TABLE
        write_table(path, 0.0, table)
        return PipeSegment(BaseScene.read(SCENE, overrides)).resistance({}, path, table) / (SU * D)


def of_law(law: NormalLaw, w: Array) -> Array:
    """V/(su D) (m,) of a seabed law along penetrations w (m,) [m]."""
    history, out = law.initial_history((1,)), np.zeros(len(w))
    for n, depth in enumerate(w):
        answer = law.update(np.array([depth]), history)
        history, out[n] = answer.history, answer.force[0]
    return out / (SU * D)


def strip(ratio: Array) -> Array:
    """V/(su D) by Prandtl's (2 + pi) on the chord of a pipe that is w/D deep in level clay, without heave."""
    return (2.0 + math.pi) * 2.0 * np.sqrt(ratio * (1.0 - ratio))


FORMULAS = {
    "strip as wide as the chord": strip,
    "Merifield et al., smooth": lambda ratio: 5.3 * ratio**0.25,
    "Aubeny et al., smooth": lambda ratio: 4.97 * ratio**0.23,
    "Aubeny et al., rough": lambda ratio: 6.73 * ratio**0.29,
}


def at_the_pause(w: Array, V: Array) -> Array:
    """V each time that the path is where it cycles."""
    return V[np.isclose(w, PAUSE * D, rtol=1e-9)]


def secant_stiffnesses(w: Array, V: Array) -> list[float]:
    """Fall of V by the uplift of each amplitude over this uplift, over V before it: (dV/V)/(dw/D)."""
    out, at = [], np.flatnonzero(np.isclose(w, PAUSE * D, rtol=1e-9))
    for amplitude, (first, last) in zip(AMPLITUDES, pairwise(at), strict=True):
        up = first + int(np.argmin(w[first:last]))
        out.append(float((V[first] - V[up]) / V[first] / amplitude))
    return out
