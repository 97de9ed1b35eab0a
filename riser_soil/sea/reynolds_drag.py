"""Drag across the pipe whose coefficient follows Reynolds's number.

With the velocity v_n across the pipe, through the water, and Re = |v_n| D/nu the pipe feels per length

    -(1/2) rho D Cd(Re) |v_n| v_n,

Cd linear in log Re between the points of a table and constant beyond. The derivatives are exact; at a point of the
table they are those of the range above it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.riser.hermite import Size
from riser_soil.sea import through_kernels
from riser_soil.sea.morison import Morison
from riser_soil.sea.morison_law import write_drag_derivatives
from riser_soil.sea.moving_water_kernels import FlowWorkspace, MovingWaterData, moving_water
from riser_soil.sea.stream_kernels import FlowAtStations
from riser_soil.sea.through_kernels import write_derivatives, write_resistance

Rows = Sequence[tuple[float, float]]


class ReynoldsTables(NamedTuple):
    """By element: natural logarithms of Re/|v_n| [s/m] (ne,); those of Re and Cd times rho D/2 [kg/m2], (ne, n),
    shorter tables filled up with their last point.
    """

    scale: Array
    numbers: Array
    drag: Array


def tables_of(rho: float, nu: float, diameter: Array, rows: Sequence[Rows]) -> ReynoldsTables:
    """Drag tables of elements from rows (Re, Cd) of each, Re increasing. rho [kg/m3], nu [m2/s], diameter (ne,) [m]."""
    longest = max(map(len, rows))
    filled = np.array([[*given, *[given[-1]] * (longest - len(given))] for given in rows])
    drag = 0.5 * rho * diameter[:, None] * filled[..., 1]
    return ReynoldsTables(np.log(diameter / nu), np.log(filled[..., 0]), drag)


class ReynoldsData(NamedTuple):
    """Drag by Reynolds's number along a pipe, as kernels read it."""

    flow: MovingWaterData
    law: ReynoldsTables


through_kernels.with_kernels(ReynoldsData)


@njit
def coefficient(tables: ReynoldsTables, m: int, speed: float) -> tuple[float, float]:
    """Factor of |v_n| v_n at a speed, and its derivative by log Re, both [kg/m2]."""
    x, y = tables.numbers[m], tables.drag[m]
    at = math.log(speed) + tables.scale[m] if speed > 0.0 else -math.inf
    if at < x[0]:
        return y[0], 0.0
    for k in range(1, x.size):
        if at < x[k]:
            slope = (y[k] - y[k - 1]) / (x[k] - x[k - 1])
            return y[k - 1] + slope * (at - x[k - 1]), slope
    return y[x.size - 1], 0.0


@njit
def _across(v: Array, tau: Array, n: Array, D: Size) -> tuple[float, float]:
    """Write the velocity n across the pipe; speed across, and along it."""
    along, square = 0.0, 0.0
    for i in range(len(D)):
        along += v[i] * tau[i]
    for i in range(len(D)):
        n[i] = v[i] - along * tau[i]
        square += n[i] * n[i]
    return math.sqrt(square), along


@write_resistance.of(ReynoldsTables)
def _write_resistance(law: ReynoldsTables, side: int, m: int, g: int, at: FlowWorkspace, D: Size) -> None:
    speed, _ = _across(at.through, at.tau, at.force, D)
    c, _ = coefficient(law, m, speed)
    for i in range(len(D)):
        at.force[i] *= c * speed


@write_derivatives.of(ReynoldsTables)
def _write_derivatives(
    law: ReynoldsTables, m: int, g: int, v: Array, tau: Array, stretch: float, weight: float,
    by_v: Array, by_slope: Array, D: Size,
) -> None:
    """Write derivatives of the resistance: those of a constant coefficient, and by the coefficient's change."""
    n, pair = np.empty(len(D)), np.zeros(2)
    speed, along = _across(v, tau, n, D)
    pair[0], change = coefficient(law, m, speed)
    write_drag_derivatives(v, tau, stretch, pair, weight, by_v, by_slope, D)
    if change == 0.0:
        return
    for i in range(len(D)):
        for j in range(len(D)):
            dyad = weight * change / speed * n[i] * n[j]
            by_v[i, j] += dyad
            by_slope[i, j] -= along / stretch * dyad


def reynolds_drag(
    water: FlowAtStations, tables: ReynoldsTables, span: Array | None = None, dissipative: bool = False
) -> Morison:
    """The part of this drag; span and dissipative as in `moving_water`."""

    def data() -> ReynoldsData:
        return ReynoldsData(moving_water(water, span=span, dissipative=dissipative), tables)

    return Morison(water.pipe.line, data, water)
