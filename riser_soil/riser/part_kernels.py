"""What parts of a line say in compiled code, see `by_type`: forces, tangent, energy, work, history.

A part has its `kernel_data`: a NamedTuple of arrays, and kernels for that type. The line solver (`solve.line_solver`)
calls them, and so does `CompiledPart`, by which a part has a system's methods.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.by_type import bound_by_type
from riser_soil.core.compiled import njit
from riser_soil.core.part import Weights
from riser_soil.riser.configuration import Configuration, Maps
from riser_soil.riser.hermite import add_geometric, collect_nodal, scatter, write_pulled_back


class LineForces(NamedTuple):
    """Residuals by group, see `core.part`: conjugate to q (ne, 4, d), to the dofs of the elements (ne, 2 ndof), and to
    those of the nodes (nn, ndof): what acts on nodes, until the others are collected there.
    """

    inertia_q: Array
    force_q: Array
    end_q: Array
    inertia_e: Array
    force_e: Array
    inertia: Array
    force: Array
    end: Array


class Border(NamedTuple):
    """Unknowns beside a line's dofs (n,), which all couple with each other: increments u (nb,), residual (nb,); of
    the tangent the corner (nb, nb), and what couples it with the line (n, nb): to the right, in the border's columns,
    and below, in its rows, turned over; the line's nodes (nn,) that are coupled.
    """

    u: Array
    residual: Array
    corner: Array
    right: Array
    below: Array
    coupled: BoolArray


def forces_at(at: Configuration) -> LineForces:
    """Workspace for the residuals in a configuration."""
    (_, ndof), ne = at.v.shape, len(at.q)
    conjugate = (np.zeros(at.q.shape) for _ in range(3))
    of_elements = (np.zeros((ne, 2 * ndof)) for _ in range(2))
    return LineForces(*conjugate, *of_elements, *(np.zeros(at.v.shape) for _ in range(3)))


@bound_by_type
def add_forces(part: tuple, at: Configuration, out: LineForces) -> None:
    """Add a part's residual in a configuration to the `LineForces`."""


@bound_by_type
def find_water(part: tuple, at: Configuration) -> None:
    """Find the water at a part's stations, as its forces do, for tangent and energy; of parts in water that moves."""


@bound_by_type
def add_tangent(part: tuple, at: Configuration, maps: Maps, weights: Weights, K: Array) -> None:
    """Add to K (ne, n, n) the derivative of a part's residual by the dofs, without that of P in `LineForces`."""


@bound_by_type
def add_energy(part: tuple, at: Configuration, energy: Array) -> None:
    """Add a part's energy to (3,): kinetic, strain, potential [J]."""


@bound_by_type
def add_work(part: tuple, first: Configuration, last: Configuration, work: Array) -> None:
    """Add what a part turns over in a step between two configurations to work (4,): dissipated, external, inertial, by
    the scheme, as in `core.part.Work` [J].
    """


@bound_by_type
def keep(part: tuple, at: Configuration) -> None:
    """Store a part's history at the end of a step, where its forces were evaluated last; for parts with a history."""


@njit
def clear(forces: LineForces) -> None:
    """Write zero."""
    for conjugate in (forces.inertia_q, forces.force_q, forces.end_q):
        conjugate[:] = 0.0
    for elementwise in (forces.inertia_e, forces.force_e):
        elementwise[:] = 0.0
    for nodal in (forces.inertia, forces.force, forces.end):
        nodal[:] = 0.0


@njit
def collect(at: Configuration, forces: LineForces) -> None:
    """Add what is conjugate to q and to the elements' dofs to what is conjugate to the nodes'."""
    collect_nodal(forces.inertia_q, at.P, forces.inertia, at.D, at.R)
    collect_nodal(forces.force_q, at.P, forces.force, at.D, at.R)
    collect_nodal(forces.end_q, at.P, forces.end, at.D, at.R)
    scatter(forces.inertia_e, forces.inertia)
    scatter(forces.force_e, forces.force)


@njit
def write_residual(at: Configuration, forces: LineForces, out: Array) -> None:
    """Write the sum (ne, 2 ndof) of all groups within the elements."""
    q = forces.inertia_q + forces.force_q + forces.end_q
    write_pulled_back(q, at.P, out, at.D, at.R)
    for e in range(out.shape[0]):
        for i in range(out.shape[1]):
            out[e, i] += forces.inertia_e[e, i] + forces.force_e[e, i]


@njit
def weigh(forces: LineForces, weights: Weights, conjugate: Array) -> None:
    """Write what is conjugate to the tangents of the elements' ends (ne, 2, d), groups weighted."""
    for e in range(conjugate.shape[0]):
        for side in range(2):
            k = 2 * side + 1
            for i in range(conjugate.shape[2]):
                bulk = weights.inertia * forces.inertia_q[e, k, i] + weights.force * forces.force_q[e, k, i]
                conjugate[e, side, i] = bulk + forces.end_q[e, k, i]


@njit
def turn(at: Configuration, turning: Array, K: Array) -> None:
    """Add what the turning (ne, 2, r, r) of the tangents gives to the element matrices."""
    add_geometric(K, 1.0, turning, len(at.D))
