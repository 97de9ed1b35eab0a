"""What the compiled loop over a riser does besides where other unknowns stand beside it, which all couple: its border.

    [B  U ] [x]   [f]
    [U' D ] [y] = [g]

B is the riser's band, U the coupling, whose rows are zero but at few nodes, and D dense, as in `bordered_band`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from riser_soil.contact.surface_loop import LEFT, Border, TouchRoom
from riser_soil.core import banded, dense
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit
from riser_soil.riser.part_kernels import LineForces
from riser_soil.solve.riser_loop import (
    GOING_ON,
    OUTGROWN,
    SINGULAR,
    Dofs,
    MatrixRoom,
    NewtonProgress,
    StepNumbers,
    StopLimits,
    decide,
    line_norms,
)


class SoilNumbers(NamedTuple):
    """Of condensed soil: stiffness (nb, nb) [N/m] of its reached dofs, and the forces (nb,) that hold them as they were
    accepted [N].
    """

    stiffness: Array
    holding: Array


class Factors(NamedTuple):
    """Room for the factors of the border: the Schur complement (nb, nb) and its pivots; rows (n,) of the line that are
    coupled, as many as `filled` (1,) says.
    """

    schur: Array
    pivots: IntArray
    rows: IntArray
    filled: IntArray


@njit
def begin_border(soil: SoilNumbers, border: Border) -> None:
    """Write what the soil's own forces leave out of balance."""
    found = np.dot(soil.stiffness, border.u)
    for i in range(found.size):
        border.residual[i] = soil.holding[i] + found[i]


@njit
def judge_with_border(
    forces: LineForces, dofs: Dofs, limits: StopLimits, progress: NewtonProgress, border: Border, room: TouchRoom
) -> None:
    """As `riser_loop.judge`, of all unknowns; OUTGROWN where something touches what is not watched or not reached."""
    if progress.ending[0] != GOING_ON:
        return
    norm, apart = line_norms(forces, dofs)
    square = norm**2
    for residual in border.residual:
        square += residual * residual
    decide(math.sqrt(square), apart, forces, dofs, limits, progress)
    if room.found[LEFT] or room.met.any():
        progress.ending[0] = OUTGROWN


@njit
def clear_border(soil: SoilNumbers, border: Border) -> None:
    """Write the soil's own tangent."""
    border.corner[...] = soil.stiffness
    ndof = border.right.shape[0] // border.coupled.size
    for n in range(border.coupled.size):
        if border.coupled[n]:
            border.right[n * ndof : (n + 1) * ndof] = 0.0
            border.coupled[n] = False


@njit
def factorise_with_border(
    room: MatrixRoom, dofs: Dofs, border: Border, factors: Factors, progress: NewtonProgress
) -> None:
    """Factorise band and border."""
    fixed, count, ndof = dofs.fixed, 0, dofs.fixed.shape[1]
    for n in range(fixed.shape[0]):
        for i in range(ndof):
            if border.coupled[n] and not fixed[n, i]:
                factors.rows[count] = n * ndof + i
                count += 1
    factors.filled[0] = count
    rows, schur = factors.rows[:count], factors.schur
    schur[...] = border.corner
    if not banded.factorise(room.ab, room.pivots, room.band):
        progress.ending[0] = SINGULAR
        return
    if count > 0:
        right, inner = border.right[rows], banded.inverse_at(room.ab, room.pivots, rows, room.band)
        schur -= np.dot(np.ascontiguousarray(right.T), np.dot(inner, right))
    if not dense.factorise(schur, factors.pivots):
        progress.ending[0] = SINGULAR


@njit
def improve_with_border(room: MatrixRoom, step: StepNumbers, dofs: Dofs, border: Border, factors: Factors) -> None:
    """Take what the factorised tangent answers to the residual off the increments."""
    residual, fixed = dofs.residual.reshape(dofs.residual.size), dofs.fixed.reshape(dofs.fixed.size)
    for k in range(fixed.size):
        if fixed[k]:
            residual[k] = 0.0
    rows, answer = factors.rows[: factors.filled[0]], border.residual
    inner = residual.copy()
    banded.solve(room.ab, room.pivots, inner, room.band)
    for k in rows:
        for j in range(answer.size):
            answer[j] -= border.right[k, j] * inner[k]
    dense.solve(factors.schur, factors.pivots, answer)
    for k in rows:
        residual[k] -= dense.product(border.right, k, 0, answer.size, answer)
    banded.solve(room.ab, room.pivots, residual, room.band)
    u = step.u.reshape(step.u.size)
    for k in range(fixed.size):
        if not fixed[k]:
            u[k] -= residual[k]
    for j in range(answer.size):
        border.u[j] -= answer[j]
