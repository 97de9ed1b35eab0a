"""Kernels of contact and friction with condensed soil in the line solver, chosen by their kernel data.

They add to a line's forces and tangent, and to a border: the soil's reached dofs, see `solve.soil_border`.
"""

from __future__ import annotations

from typing import NamedTuple

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.by_type import bound_by_type
from riser_soil.core.compiled import njit
from riser_soil.riser.configuration import Configuration
from riser_soil.riser.part_kernels import Border, LineForces

SUPPORTED, UNREACHED = -1, -2  # in place of a border's row, of dofs that have none
# Entries of `Touched.counts`: the number of points that touch; 1 where something unwatched may touch, else 0; 1 where
# more points are near than there is room for, else 0.
POINTS, UNWATCHED, FULL = range(3)


class TopMotion(NamedTuple):
    """How the watched nodes (k,) of the top move by the increments of the border's first unknowns, the reached dofs
    (na,): by (3 k, na). accepted (np, 3): where all are before [m]. rows (np, 3): of the border, or why there is none.
    """

    nodes: IntArray
    by: Array
    accepted: Array
    rows: IntArray


class Touched(NamedTuple):
    """Outcome of the contact's last evaluation. counts (3,): see POINTS; newly_loaded (np,): nodes of the top that are
    not reached, and bear a force; energy (1,): stored [J].
    """

    counts: IntArray
    newly_loaded: BoolArray
    energy: Array


@bound_by_type
def add_contact(part: tuple, top: TopMotion, at: Configuration, out: LineForces, border: Border) -> None:
    """Add the residual of contact or friction to that of the line, and to the border's; friction after contact."""


@bound_by_type
def add_contact_tangent(part: tuple, top: TopMotion, at: Configuration, K: Array, border: Border) -> None:
    """Add the derivative of the residual that `add_contact` added last, to K (ne, n, n) and to the border's tangent."""


@njit
def add_block(
    block: Array, e: int, first: int, count: int, nodes: IntArray, rows: IntArray, K: Array, border: Border
) -> None:
    """Add a block (nr, nr) of a pair to K (ne, n, n) and to the border: of so many dofs of the line, from the dof
    `first` of an element on, then of the nodes (nv,) of a facet. rows (np, 3): see `TopMotion`.
    """
    ndof = K.shape[1] // 2
    at = e * ndof + first
    for i in range(count):
        border.coupled[(at + i) // ndof] = True
        for j in range(count):
            K[e, first + i, first + j] += block[i, j]
    for a in range(3 * nodes.size):
        row = rows[nodes[a // 3], a % 3]
        if row < 0:
            continue
        for i in range(count):
            border.right[at + i, row] += block[i, count + a]
            border.below[at + i, row] += block[count + a, i]
        for b in range(3 * nodes.size):
            column = rows[nodes[b // 3], b % 3]
            if column >= 0:
                border.corner[row, column] += block[count + a, count + b]
