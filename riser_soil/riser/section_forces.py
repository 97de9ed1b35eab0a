"""Section forces, moments and reactions of the line, from the residuals of its elements.

An element's residual, summed over the parts that act within it, is what its neighbours exert on its ends. So
moments contain the fixed-end part of distributed loads and inertia; without it they are useless on coarse
meshes.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.core.part import State
from riser_soil.riser import bending_peaks
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart
from riser_soil.riser.sections import Elements
from riser_soil.riser.spatial_directors import SpatialOrientation
from riser_soil.riser.trial import Trial

NOTHING, NO_FRAMES = np.empty((0, 0)), np.empty((0, 3, 3))


class SectionForces(NamedTuple):
    """Section forces and moments at nodes, exerted by the line after a node on the line before it, in global axes: (nn,
    3) or (nn,).

    force N, moment N m; effective_tension N, positive in tension; bending_moment N m and curvature 1/m, magnitudes.
    Of the elements themselves, at their ends (ne, 2): curvature_beside, which differs where stiffnesses meet, and the
    slopes of moment [N] and curvature [1/m2], which differ where a force or contact acts on a node.
    """

    force: Array
    moment: Array
    effective_tension: Array
    bending_moment: Array
    curvature: Array
    curvature_beside: Array
    moment_slope: Array
    curvature_slope: Array


@dataclass(frozen=True, eq=False)
class Reaction:
    """Force (3,) N and moment (3,) N m exerted by the support on the riser, global axes."""

    force: Array
    moment: Array

    def __add__(self, other: Reaction) -> Reaction:
        return Reaction(self.force + other.force, self.moment + other.moment)


def element_residual(line: Line, parts: Iterable[LinePart], state: State) -> Array:
    """Sum over parts and groups (ne, 2 ndof)."""
    groups = (group for part in parts for group in part.element_forces(state))
    return _total(groups, (line.length.size, 2 * line.ndof))


def viscous_residual(line: Line, parts: Iterable[LinePart], state: State) -> Array:
    """The share of `element_residual` (ne, 2 ndof) that follows from strain rates."""
    return _total((part.viscous_forces(state) for part in parts), (line.length.size, 2 * line.ndof))


def nodal_residual(line: Line, parts: Iterable[LinePart], state: State) -> Array | None:
    """Sum (nn, ndof) of what acts on nodes but isn't a support, if anything: contact with soil, point loads and masses.
    """
    told = [forces for part in parts if (forces := part.nodal_forces(state)) is not None]
    return _total(told, (line.nodes, line.ndof)) if told else None


def _total(told: Iterable[Array | None], shape: tuple[int, int]) -> Array:
    total = np.zeros(shape)
    for values in told:
        if values is not None:
            total += values
    return total


def section_forces(
    line: Line, elements: Elements, state: State, residual: Array, viscous: Array | None = None
) -> SectionForces:
    """Section forces at the nodes, averaged over the two adjoining elements.

    residual: from `element_residual`; viscous: from `viscous_residual`, for the curvature follows from the rest of
    the bending moment.
    """
    trial, nn, ne = line.trial(state), line.nodes, line.length.size
    at_nodes, at_ends = ((nn, 3), (nn, 3), nn, nn, nn), ((ne, 2),) * 3
    out = tuple(np.empty(shape) for shape in (*at_nodes, *at_ends))
    acting = residual, NOTHING if viscous is None else viscous
    turned = line.basis, _moment_maps(line, trial), trial.turn.tangent, *section_frames(trial)
    _put_section_forces(*acting, *turned, elements.bends_beside, *elements.flexibility, out)
    return SectionForces(*out)


@njit
def _put_section_forces(
    residual: Array,
    viscous: Array,
    basis: Array,
    maps: Array,
    tangent: Array,
    first: Array,
    second: Array,
    bends: Array,
    y: Array,
    z: Array,
    out: tuple[Array, ...],
) -> None:
    """All together. viscous: `NOTHING` where nothing is; tangent (ne, 2, d): in the line's axes. Takes a plain tuple:
    numba reads named ones a microsecond slower.
    """
    ne, found = len(residual), SectionForces(*out)
    shape, free = (ne, 2, 3), np.empty((ne + 1, 3))
    on_ends, moments, damping, along = np.empty(shape), np.empty(shape), np.zeros(shape), np.zeros(shape)
    _put_end_forces(residual, basis, maps, on_ends, moments)
    if len(viscous) > 0:
        _put_end_forces(viscous, basis, maps, np.empty(shape), damping)
    for e in range(ne):
        for end in range(2):
            for i in range(3):
                for j in range(basis.shape[1]):
                    along[e, end, i] += basis[i, j] * tangent[e, end, j]
    _put_at_nodes(on_ends, moments, damping, along, bends, free, found)
    _put_curvatures(free, first, second, y, z, found)


def section_frames(trial: Trial) -> tuple[Array, Array]:
    """Section frames (ne, 3, 3) at the elements' ends; none in a plane, where there is one stiffness."""
    if isinstance(trial.turn, SpatialOrientation):
        return trial.turn.frame1, trial.turn.frame2
    return NO_FRAMES, NO_FRAMES


@njit
def _put_at_nodes(
    on_ends: Array, moments: Array, damping: Array, tangent: Array, bends: Array, free: Array, out: SectionForces
) -> None:
    """Forces, moments and the moment's slope; free (nn, 3): the bending moment less the damping's.

    on_ends, moments, damping (ne, 2, 3): on the elements' ends; tangent: there; bends (nn,): 1, or 0 between chains.
    """
    nn = len(free)
    bending, behind = np.empty((nn, 3)), np.empty(on_ends.shape)
    for n in range(nn):
        viscous, t = np.zeros(3), np.zeros(3)
        force, moment = out.force[n], out.moment[n]
        share = 1.0 if n == 0 or n == nn - 1 else 0.5
        for i in range(3):
            force[i] = moment[i] = 0.0
            for e, end, sign in ((n - 1, 1, share), (n, 0, -share)):
                if 0 <= e < nn - 1:
                    behind[e, end, i] = sign / share * on_ends[e, end, i]
                    force[i] += sign * on_ends[e, end, i]
                    moment[i] += sign * moments[e, end, i]
                    viscous[i] += sign * damping[e, end, i]
                    t[i] += tangent[e, end, i]
        size = math.sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2])
        tension, twist, twist_rate, square = 0.0, 0.0, 0.0, 0.0
        for i in range(3):
            t[i] /= size
            tension += force[i] * t[i]
            twist += moment[i] * t[i]
            twist_rate += viscous[i] * t[i]
        for i in range(3):
            bending[n, i] = (moment[i] - twist * t[i]) * bends[n]
            free[n, i] = bending[n, i] - (viscous[i] - twist_rate * t[i])
            square += bending[n, i] ** 2
        out.effective_tension[n], out.bending_moment[n] = tension, math.sqrt(square)
    bending_peaks.slopes(bending, behind, tangent, out.moment_slope)


@njit
def _put_curvatures(free: Array, first: Array, second: Array, y: Array, z: Array, out: SectionForces) -> None:
    """Curvatures: bending moment over stiffness, about the section axes where there are two stiffnesses.

    free (nn, 3): the moment that bends; first, second: see `_frames`; y, z (ne,): 1/EI.
    """
    beside = out.curvature_beside
    out.curvature[:] = 0.0
    for e in range(len(beside)):
        for end in range(2):
            M = free[e + end]
            if len(first) == 0:
                k = math.sqrt(M[0] * M[0] + M[1] * M[1] + M[2] * M[2]) * y[e]
            else:
                F = first[e] if end == 0 else second[e]
                about_y = F[0, 1] * M[0] + F[1, 1] * M[1] + F[2, 1] * M[2]
                about_z = F[0, 2] * M[0] + F[1, 2] * M[1] + F[2, 2] * M[2]
                k = math.hypot(about_y * y[e], about_z * z[e])
            n, size = e + end, out.bending_moment[e + end]
            beside[e, end] = k
            out.curvature[n] += k if n == 0 or n == len(beside) else 0.5 * k
            out.curvature_slope[e, end] = out.moment_slope[e, end] * k / size if size > 0.0 else 0.0


def end_reactions(
    line: Line, state: State, residual: Array, nodal: Array | None = None
) -> tuple[Reaction, Reaction]:
    """Reactions at start and end.

    residual: from `element_residual`; nodal: from `nodal_residual`. A spring is a support, so its moment belongs to the
    reaction.
    """
    trial = line.trial(state)
    force, moment = end_forces(line, trial, residual)
    start, end = Reaction(force[0, 0], moment[0, 0]), Reaction(force[-1, 1], moment[-1, 1])
    if nodal is None:
        return start, end
    maps, d = _moment_maps(line, trial), line.dimension
    first, last = (Reaction(line.basis @ nodal[n, :d], maps[n] @ nodal[n, d:]) for n in (0, -1))
    return start + first, end + last


def end_forces(line: Line, trial: Trial, residual: Array) -> tuple[Array, Array]:
    """Force and moment on the elements' ends, each (ne, 2, 3), global axes."""
    shape = line.length.size, 2, 3
    force, moment = np.empty(shape), np.empty(shape)
    _put_end_forces(np.ascontiguousarray(residual), line.basis, _moment_maps(line, trial), force, moment)
    return force, moment


def _moment_maps(line: Line, trial: Trial) -> Array:
    """Maps (nn, 3, r) of what is conjugate to the rotation dofs of nodes to moments in global axes."""
    maps: Array = trial.once("moment maps", lambda trial: trial.turn.moment_maps(line.turning_axes))
    return maps


@njit
def _put_end_forces(residual: Array, basis: Array, maps: Array, force: Array, moment: Array) -> None:
    """basis (3, d): the line's axes; maps: of `_moment_maps`."""
    d, r = basis.shape[1], maps.shape[2]
    for e in range(len(force)):
        for end in range(2):
            k = end * (d + r)
            for i in range(3):
                push, turn = 0.0, 0.0
                for j in range(d):
                    push += basis[i, j] * residual[e, k + j]
                for j in range(r):
                    turn += maps[e + end, i, j] * residual[e, k + d + j]
                force[e, end, i], moment[e, end, i] = push, turn


def at_most(beside: Array) -> Array:
    """The larger (nn,) of what the elements beside a node have there (ne, 2)."""
    return np.maximum(np.append(beside[:, 0], -np.inf), np.append(-np.inf, beside[:, 1]))
