"""Section forces, moments and reactions of the line, from the residuals of its elements.

An element's residual, summed over the parts that act within it, is what its neighbours exert on its ends. So
moments contain the fixed-end part of distributed loads and inertia; without it they are useless on coarse
meshes.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.part import State
from riser_soil.riser import bending_peaks
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart
from riser_soil.riser.sections import Elements, larger_beside
from riser_soil.riser.spatial_directors import SpatialOrientation
from riser_soil.riser.trial import Trial

_BEHIND = np.array([[-1.0], [1.0]])  # of what acts on an element's ends: what the line after exerts on the line before


@dataclass(frozen=True, eq=False)
class SectionForces:
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


def element_residual(line: Line, parts: Iterable[LinePart], state: State) -> Array:
    """Sum over parts and groups (ne, 2 ndof)."""
    groups = (group for part in parts for group in part.element_forces(state))
    return _total(groups, (line.length.size, 2 * line.ndof))


def viscous_residual(line: Line, parts: Iterable[LinePart], state: State) -> Array:
    """The share of `element_residual` (ne, 2 ndof) that follows from strain rates."""
    return _total((part.viscous_forces(state) for part in parts), (line.length.size, 2 * line.ndof))


def nodal_residual(line: Line, parts: Iterable[LinePart], state: State) -> Array:
    """Sum (nn, ndof) of what acts on nodes but isn't a support: contact with soil, point loads and masses."""
    return _total((part.nodal_forces(state) for part in parts), (line.nodes, line.ndof))


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
    trial = line.trial(state)
    on_ends, moments_on_ends = end_forces(line, trial, residual)
    force, moment = _section(on_ends), _section(moments_on_ends)
    tangent = _nodal(trial.turn.tangent[:, 0], trial.turn.tangent[:, 1]) @ line.basis.T
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    bending = _across(moment, tangent) * larger_beside(elements.bends.astype(float))[:, None]
    damping = 0.0 if viscous is None else _across(_section(end_forces(line, trial, viscous)[1]), tangent)
    beside = np.stack(_curvatures(trial, elements, bending - damping), axis=1)
    magnitude = np.linalg.norm(bending, axis=1)
    slope = _slopes(line, trial, on_ends, bending)
    return SectionForces(
        force=force,
        moment=moment,
        effective_tension=np.sum(force * tangent, axis=1),
        bending_moment=magnitude,
        curvature=_nodal(beside[:, 0], beside[:, 1]),
        curvature_beside=beside,
        moment_slope=slope,
        curvature_slope=_of_curvature(slope, magnitude, beside),
    )


def _slopes(line: Line, trial: Trial, on_ends: Array, bending: Array) -> Array:
    """Of the moment's magnitude at the elements' ends (ne, 2); on_ends (ne, 2, 3): forces on these."""
    slope = np.empty(on_ends.shape[:2])
    bending_peaks.slopes(bending, on_ends * _BEHIND, trial.turn.tangent @ line.basis.T, slope)
    return slope


def _of_curvature(slope: Array, moment: Array, curvature: Array) -> Array:
    """Slopes of the curvature (ne, 2), which changes with the moment (nn,)."""
    beside = np.stack([moment[:-1], moment[1:]], axis=1)
    return np.divide(slope * curvature, beside, out=np.zeros_like(slope), where=beside > 0.0)


def _section(on_ends: Array) -> Array:
    """What the line after a node exerts on the line before it (nn, 3), from what acts on the elements' ends."""
    return _nodal(-on_ends[:, 0], on_ends[:, 1])


def _across(moment: Array, tangent: Array) -> Array:
    return np.asarray(moment - np.sum(moment * tangent, axis=1, keepdims=True) * tangent)


def end_reactions(
    line: Line, state: State, residual: Array, nodal: Array | None = None
) -> tuple[Reaction, Reaction]:
    """Reactions at start and end.

    residual: from `element_residual`; nodal: from `nodal_residual`. A spring is a support, so its moment belongs to the
    reaction.
    """
    force, moment = end_forces(line, line.trial(state), residual)
    at_nodes = np.zeros((line.nodes, line.ndof)) if nodal is None else nodal
    extra_force, extra_moment = _global(line, line.trial(state), at_nodes[[0, -1]], np.array([0, -1]))
    return (
        Reaction(force[0, 0] + extra_force[0], moment[0, 0] + extra_moment[0]),
        Reaction(force[-1, 1] + extra_force[1], moment[-1, 1] + extra_moment[1]),
    )


def end_forces(line: Line, trial: Trial, residual: Array) -> tuple[Array, Array]:
    """Force and moment on the elements' ends, each (ne, 2, 3), global axes."""
    first, second = residual[:, : line.ndof], residual[:, line.ndof :]
    nodes = np.arange(line.nodes, dtype=np.int64)
    ends = [_global(line, trial, first, nodes[:-1]), _global(line, trial, second, nodes[1:])]
    return np.stack([f for f, _ in ends], axis=1), np.stack([m for _, m in ends], axis=1)


def _global(line: Line, trial: Trial, dofs: Array, nodes: IntArray) -> tuple[Array, Array]:
    """Forces and moments (n, 3) in global axes from those conjugate to the dofs of the nodes (n, ndof)."""
    force, rest = dofs[:, : line.dimension] @ line.basis.T, dofs[:, line.dimension :]
    if isinstance(trial.turn, SpatialOrientation):
        return force, trial.turn.in_space(rest, nodes)
    return force, rest * line.normal


def _nodal(first: Array, second: Array) -> Array:
    """Mean (nn, ...) of what the elements have at their first and second ends; the only value at the line's
    ends.
    """
    total = np.concatenate([first, second[-1:]])
    total[1:-1] = 0.5 * (first[1:] + second[:-1])
    return total


def at_most(beside: Array) -> Array:
    """The larger (nn,) of what the elements beside a node have there (ne, 2)."""
    return np.maximum(np.append(beside[:, 0], -np.inf), np.append(-np.inf, beside[:, 1]))


def _curvatures(trial: Trial, elements: Elements, bending: Array) -> tuple[Array, Array]:
    """Bending moment over stiffness at both ends of the elements (ne,), about the section axes where there are two
    stiffnesses.
    """
    if isinstance(trial.turn, SpatialOrientation):
        return (
            _section_curvature(trial.turn.frame1, bending[:-1], elements),
            _section_curvature(trial.turn.frame2, bending[1:], elements),
        )
    magnitude, flexibility = np.linalg.norm(bending, axis=1), elements.flexibility()[0]
    return magnitude[:-1] * flexibility, magnitude[1:] * flexibility


def _section_curvature(frame: Array, moment: Array, elements: Elements) -> Array:
    about = np.einsum("eij,ei->ej", frame, moment)
    y, z = elements.flexibility()
    return np.hypot(about[:, 1] * y, about[:, 2] * z)
