"""Compiled loops over the stations of a line in contact with a seabed, and what they do at one station.

Vectors are in the line's axes, the third component 0 in the plane. Arrays (ne, ng, d) hold those of all stations, and
(m, ng, d) those of the elements that touch.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from riser_soil.contact.along_step import lift
from riser_soil.contact.contact import ContactResults
from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.compiled import njit
from riser_soil.riser import stations
from riser_soil.riser.line import Line
from riser_soil.riser.trial import Trial
from riser_soil.riser.vectors import (
    Mat,
    Vec,
    add,
    dot,
    isotropic,
    matadd,
    matmul,
    matrix,
    matscale,
    matvec,
    outer,
    padded,
    padded_matrix,
    put,
    put_matrix,
    scale,
    sub,
    transpose,
    vecmat,
    vector,
)
from riser_soil.seabed.compiled_law import answer, may_act
from riser_soil.seabed.grounds import distance_at


class LineFrame(NamedTuple):
    """Origin [m] and axes of a line, global; the rows of `axes` are unit vectors, the third 0 in the plane."""

    origin: Vec
    axes: Mat


def frame_of(line: Line) -> LineFrame:
    """The frame of a line's coordinates."""
    axes = np.zeros((3, 3))
    axes[: line.dimension] = line.basis.T
    return LineFrame(vector(line.origin), matrix(axes))


@njit
def distance_in(frame: LineFrame, ground: Any, x: Vec) -> tuple[float, Vec, Mat]:
    """Distance of a point from the ground [m], its gradient and hessian [1/m], in the line's axes as x is."""
    value, gradient, hessian = distance_at(ground, global_place(frame, x))
    return value, matvec(frame.axes, gradient), matmul(matmul(frame.axes, hessian), transpose(frame.axes))


@njit
def global_place(frame: LineFrame, x: Vec) -> Vec:
    """A place in global axes [m]."""
    return add(frame.origin, vecmat(x, frame.axes))


@njit
def by_position(force: float, slope: float, normal: Vec, bend: Mat) -> Mat:
    """Derivative by the position of minus the force per length on the riser; bend: derivative of the normal."""
    return matadd(matscale(slope, outer(normal, normal)), matscale(-force, bend))


@njit
def over_ground(
    frame: LineFrame, ground: Any, radius: Array, x: Array, penetration: Array, normal: Array, bend: Array
) -> None:
    """Write penetration (ne, ng), its normal and the normal's derivative (ne, ng, d, d) at stations x (ne, ng, d).

    The last only where it has room, as on a flat ground it has not. radius (ne,).
    """
    for e in range(x.shape[0]):
        for g in range(x.shape[1]):
            value, gradient, hessian = distance_in(frame, ground, padded(x[e, g]))
            penetration[e, g] = radius[e] - value
            put(gradient, normal[e, g])
            if bend.size > 0:
                put_matrix(hessian, bend[e, g])


@njit
def land(frame: LineFrame, ground: Any, radius: Array, start: float, x: Array, moved: Array) -> None:
    """Raise the increments (nn, ndof) of nodes at x (nn, d) that would sink, see `along_step`; radius (nn,)."""
    d = x.shape[1]
    for n in range(x.shape[0]):
        at = padded(x[n])
        present, _, _ = distance_in(frame, ground, at)
        guessed, _, _ = distance_in(frame, ground, add(at, padded(moved[n, :d])))
        moved[n, d - 1] += lift(present - radius[n] - start, guessed - radius[n] - start, start)


@njit
def touched(law: Any, penetration: Array, memory: Array) -> IntArray:
    """Elements (m,) that have a station where the law may act; memory (ne, ng, nh)."""
    found, m = np.empty(len(penetration), dtype=np.int64), 0
    for e in range(penetration.shape[0]):
        acts = False
        for g in range(penetration.shape[1]):
            acts |= may_act(law, penetration[e, g], memory[e, g])
        if acts:
            found[m] = e
            m += 1
    return found[:m]


@njit
def answers(law: Any, elements: IntArray, penetration: Array, memory: Array, normal: Array) -> tuple[Array, ...]:
    """Force, slope and energy stored (m, ng), normal and resistance (m, ng, d) of some elements."""
    m, ng, d = elements.size, normal.shape[1], normal.shape[2]
    force, slope, stored = np.empty((m, ng)), np.empty((m, ng)), np.empty((m, ng))
    normals, resistance, after = np.empty((m, ng, d)), np.empty((m, ng, d)), np.empty(memory.shape[2])
    for i in range(m):
        e = elements[i]
        for g in range(ng):
            force[i, g], slope[i, g], stored[i, g] = answer(law, penetration[e, g], memory[e, g], after)
            for j in range(d):
                normals[i, g, j], resistance[i, g, j] = normal[e, g, j], -force[i, g] * normal[e, g, j]
    return force, slope, stored, normals, resistance


class OverNodes(NamedTuple):
    """What stations (ne, ng) share with the nodes: radius and length of the line that belongs to a node (nn,) [m];
    linear (2, ng): shares of a station at the first and the second node of its element.
    """

    radius: Array
    length: Array
    linear: Array


@njit
def put_contact(
    frame: LineFrame,
    ground: Any,
    nodes: OverNodes,
    start: float,
    share: Array,
    x: Array,
    found: tuple[BoolArray, Array, Array, Array],
    out: ContactResults,
) -> None:
    """Write the results of contact.

    start: gap at which it begins [m]; share (ne, ng) [m]; x (nn, d); found: which elements touch (ne,), penetration and
    force (ne, ng), the force where they touch, and normal (ne, ng, d).
    """
    touches, penetration, force, normal = found
    total, ng = (0.0, 0.0, 0.0), share.shape[1]
    out.force_per_length[:], out.deepest[0] = 0.0, 0.0
    for e in range(touches.size):
        for g in range(ng):
            pressing, k = force[e, g] if touches[e] else 0.0, e * ng + g
            out.clearance[k], out.force[k] = -penetration[e, g] - start, pressing
            out.deepest[0] = max(out.deepest[0], penetration[e, g])
            for side in range(2):
                out.force_per_length[e + side] += nodes.linear[side, g] * (share[e, g] * pressing)
            total = add(total, scale(share[e, g] * pressing, padded(normal[e, g])))
    put(vecmat(total, frame.axes), out.on_riser)
    for n in range(x.shape[0]):
        value, _, _ = distance_in(frame, ground, padded(x[n]))
        out.force_per_length[n] /= nodes.length[n]
        out.penetration[n] = out.depth[n] = max(0.0, nodes.radius[n] - value)


@njit
def shared(values: Array, linear: Array) -> Array:
    """Values at stations (ne, ng) shared by the nodes beside them (nn,); linear (2, ng): the shares."""
    out = np.zeros(values.shape[0] + 1)
    for e in range(values.shape[0]):
        for g in range(values.shape[1]):
            out[e] += linear[0, g] * values[e, g]
            out[e + 1] += linear[1, g] * values[e, g]
    return out


@njit
def by_positions(force: Array, slope: Array, normal: Array, bend: Array | None) -> Array:
    """`by_position` (m, ng, d, d) of elements; bend: None where it is zero."""
    out = np.empty((*normal.shape, normal.shape[2]))
    for m in range(force.shape[0]):
        for g in range(force.shape[1]):
            n, turning = padded(normal[m, g]), isotropic(0.0)
            if bend is not None:
                turning = padded_matrix(bend[m, g])
            put_matrix(by_position(force[m, g], slope[m, g], n, turning), out[m, g])
    return out


@njit
def integral(share: Array, elements: IntArray, values: Array) -> float:
    """Of values (m, ng) over some elements; share (ne, ng) [m]."""
    total = 0.0
    for m in range(elements.size):
        for g in range(share.shape[1]):
            total += share[elements[m], g] * values[m, g]
    return total


@njit
def work_of(share: Array, elements: IntArray, force: Array, before: Array, after: Array) -> float:
    """Work of a force per length (m, ng, d) on the stations of some elements from one place to another (ne, ng, d)."""
    total = 0.0
    for m in range(elements.size):
        for g in range(share.shape[1]):
            e = elements[m]
            way = sub(padded(after[e, g]), padded(before[e, g]))
            total += share[e, g] * dot(padded(force[m, g]), way)
    return total


class StationForces:
    """Forces of a part with a resistance (m, ng, d) [N/m] at the stations `at` of some elements (m,); kept by trial."""

    def __init__(self, line: Line, at: stations.Stations) -> None:
        self._line, self._at = line, at

    def in_elements(self, trial: Trial, elements: IntArray, resistance: Array) -> Array:
        """Element residuals (ne, 2 ndof)."""
        found: Array = trial.once(
            (self, "element forces"), lambda trial: trial.pull_back(self._F(trial, elements, resistance))
        )
        return found

    def add_tangent(self, K: Array, trial: Trial, elements: IntArray, resistance: Array, by_position: Array) -> None:
        """Add to K (ne, n, n), unweighted, what a resistance with the derivative (m, ng, d, d) by the position has."""
        if elements.size == 0:
            return
        stations.add_stiffness(K, self._at, elements, by_position, trial.turn.P)
        trial.add_turning(K, 1.0, self._F(trial, elements, resistance))

    def _F(self, trial: Trial, elements: IntArray, resistance: Array) -> Array:
        """Residual conjugate to q (ne, 4, d)."""
        found: Array = trial.once((self, "F"), lambda _: self._integrated(elements, resistance))
        return found

    def _integrated(self, elements: IntArray, resistance: Array) -> Array:
        F = np.zeros((self._line.length.size, 4, self._line.dimension))
        F[elements] = stations.integrate(self._at.of(elements), resistance)
        return F
