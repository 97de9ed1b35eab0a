"""What the compiled loop over a riser alone asks of its parts, see `by_type`: forces, tangent, energy, work, history.

A part that takes part in the loop has its `numbers`: a NamedTuple of arrays, and kernels for that type. They are the
functions that its methods call, too, so that each formula is in one place.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.bound import Bound
from riser_soil.core.by_type import bound_by_type
from riser_soil.core.packed import Packed
from riser_soil.riser.configuration import Configuration, Maps
from riser_soil.riser.line import Line


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


class LineWeights(NamedTuple):
    """Weights of the groups I and F in the tangent."""

    inertia: float
    force: float


def forces_of(line: Line) -> LineForces:
    """Room for the residuals of a line."""
    ne = line.length.size
    conjugate = (np.zeros((ne, 4, line.dimension)) for _ in range(3))
    of_elements = (np.zeros((ne, 2 * line.ndof)) for _ in range(2))
    return LineForces(*conjugate, *of_elements, *(np.zeros((line.nodes, line.ndof)) for _ in range(3)))


def bound(stub: Any, numbers: tuple[Any, ...], *arguments: Packed) -> Bound:
    """The kernel for these numbers, bound to them and to its other arguments."""
    return Bound(stub.kernels[type(numbers)], Packed(numbers), *arguments)


@bound_by_type
def add_forces(part: tuple, at: Configuration, out: LineForces) -> None:
    """Add a part's residual in a configuration to the `LineForces`."""


@bound_by_type
def find_water(part: tuple, at: Configuration) -> None:
    """Find the water at a part's stations, as its forces do, for tangent and energy; of parts in water that moves."""


@bound_by_type
def add_tangent(part: tuple, at: Configuration, maps: Maps, weights: LineWeights, K: Array) -> None:
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
    """Keep a part's history at the end of a step, in the configuration of the forces found last; of parts with one."""
