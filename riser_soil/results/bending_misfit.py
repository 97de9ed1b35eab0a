"""A posteriori estimate of the bending error: how well the elements resolve the curvature.

The relative rotation of an element's ends is the integral of its curvature k, and the moments and shear forces at its
ends give k and k' there. Where both describe one smooth curve, the Euler-Maclaurin formula relates them:

    turn/L = (k1 + k2)/2 - L/12 (k2' - k1') + O(L^4 k'''')

A tension T bends a line into shapes that a cubic can't follow, and leaves an error in the moments of an element of
about T L^4 k''/384, the fourth-order error of its deflection times T; the difference of the two sides is that error.
Near a clamped end, where k decays within sqrt(EI/T), shear and moment have the same error. There the trapezoidal rule
alone is used: its error is the drop of k within the element. At a pinned end, where k sets in, it is no error of the
moment.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.core.part import State
from riser_soil.riser.line import Line
from riser_soil.riser.section_forces import end_forces
from riser_soil.riser.sections import Elements
from riser_soil.riser.spatial_directors import SpatialOrientation
from riser_soil.riser.vectors import (
    Vec,
    add,
    cross,
    dot,
    matmul,
    norm,
    padded,
    padded_matrix,
    scale,
    sub,
    transpose,
    write,
)


class BendingMisfit(NamedTuple):
    """The largest difference [N m] between an element's bending moment by its end rotations and by its end moments.

    smooth: by the formula with shear; steep: by the trapezoidal rule, without elements at ends where the moment sets
    in. Each with its element.
    """

    smooth: float
    smooth_at: int
    steep: float
    steep_at: int


def misfit(line: Line, elements: Elements, state: State, residual: Array) -> BendingMisfit:
    """residual (ne, 2 ndof): from `section_forces.element_residual`, less its viscous share."""
    trial = line.trial(state)
    tangent, out = trial.turn.tangent, (np.empty(line.length.size), np.empty(line.length.size))
    stiffness = *trial.turn.end_frames, *elements.flexibility, elements.larger_EI
    on_ends = end_forces(line, state, residual)
    _write_misfits(line.length, *on_ends, line.basis, tangent, _turns(line, state), *stiffness, *out)
    i, j = (int(values.argmax()) for values in out)
    return BendingMisfit(float(out[0][i]), i, float(out[1][j]), j)


@njit
def _write_misfits(
    length: Array,
    force: Array,
    moment: Array,
    basis: Array,
    tangent: Array,
    turn: Array,
    first: Array,
    second: Array,
    y: Array,
    z: Array,
    EI: Array,
    smooth: Array,
    steep: Array,
) -> None:
    """Write the misfits (ne,) of the elements by the formula with shear, and by the trapezoidal rule.

    force, moment (ne, 2, 3): on the elements' ends; basis (3, d): axes of the tangents (ne, 2, d) there; turn: of
    `_turns`; first, second: `end_frames`; y, z (ne,): 1/EI.
    """
    ne, size = len(length), np.empty(2)
    k, slope = np.empty((2, 3)), np.empty((2, 3))
    for e in range(ne):
        for end in range(2):
            sign, t, F = 2.0 * end - 1.0, _in_space(basis, tangent[e, end]), padded(force[e, end])
            M = scale(sign, padded(moment[e, end]))
            bending, shear = sub(M, scale(dot(M, t), t)), scale(sign, cross(F, t))
            size[end] = norm(bending)
            for vector, out in ((bending, k[end]), (shear, slope[end])):
                if len(first) == 0:
                    write(scale(y[e], vector), out)
                else:
                    _write_over_stiffness(first[e] if end == 0 else second[e], vector, y[e], z[e], out)
        L, trapezoidal, corrected = length[e], 0.0, 0.0
        for i in range(3):
            plain = turn[e, i] - 0.5 * L * (k[0, i] + k[1, i])
            trapezoidal += plain**2
            corrected += (plain + L * L / 12.0 * (slope[1, i] - slope[0, i])) ** 2
        smooth[e], steep[e] = EI[e] / L * math.sqrt(corrected), EI[e] / L * math.sqrt(trapezoidal)
        if (e == 0 and not size[0] > size[1]) or (e == ne - 1 and not size[1] > size[0]):
            steep[e] = 0.0


@njit
def _in_space(basis: Array, a: Array) -> Vec:
    """The vector, global axes, of components (d,) along those of a basis (3, d)."""
    x = y = z = 0.0
    for i in range(len(a)):
        x, y, z = x + basis[0, i] * a[i], y + basis[1, i] * a[i], z + basis[2, i] * a[i]
    return x, y, z


@njit
def _write_over_stiffness(frame: Array, moment: Vec, y: float, z: float, out: Array) -> None:
    """Write the curvature of a moment, global axes, about the section axes of two stiffnesses."""
    about_y = frame[0, 1] * moment[0] + frame[1, 1] * moment[1] + frame[2, 1] * moment[2]
    about_z = frame[0, 2] * moment[0] + frame[1, 2] * moment[1] + frame[2, 2] * moment[2]
    for i in range(3):
        out[i] = frame[i, 1] * y * about_y + frame[i, 2] * z * about_z


def _turns(line: Line, state: State) -> Array:
    """Rotation vectors (ne, 3) by which elements' ends turn against each other from the unstressed state on, less the
    twist.
    """
    turn = line.trial(state).turn
    if not isinstance(turn, SpatialOrientation):
        angle = turn.angle
        return np.asarray((angle[1:] - angle[:-1])[:, None] * line.normal)
    turns = np.empty((line.length.size, 3))
    _write_turns(turn.R, turn.tangent, turns)
    return turns


@njit
def _write_turns(R: Array, tangent: Array, out: Array) -> None:
    """R (nn, 3, 3): frames of the nodes; tangent (ne, 2, 3): at the elements' ends."""
    for e in range(len(out)):
        Q = matmul(padded_matrix(R[e + 1]), transpose(padded_matrix(R[e])))
        twice = Q[2][1] - Q[1][2], Q[0][2] - Q[2][0], Q[1][0] - Q[0][1]
        vector = scale(0.5, twice)
        sine, cosine = norm(vector), 0.5 * (Q[0][0] + Q[1][1] + Q[2][2] - 1.0)
        turn = scale(math.atan2(sine, cosine) / sine if sine > 0.0 else 1.0, vector)
        middle = add(padded(tangent[e, 0]), padded(tangent[e, 1]))
        middle = scale(1.0 / norm(middle), middle)
        write(sub(turn, scale(dot(turn, middle), middle)), out[e])
