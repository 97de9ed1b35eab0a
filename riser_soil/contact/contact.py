"""Base class of the riser's contacts with any ground, and their results."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import NamedTuple

from riser_soil.contact.touchdown import PointsAlong
from riser_soil.core.arrays import Array, views
from riser_soil.core.by_type import bound_by_type
from riser_soil.core.part import Forces, State, Traits, Weights
from riser_soil.riser.configuration import Configuration
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart
from riser_soil.seabed.law import NormalLaw


class RiserContact(LinePart, ABC):
    """Normal contact of the riser, nn nodes, with a ground, by a law of the force per length; friction is a part of its
    own.

    On a rank that is not active the riser touches nothing: all results are zeros.
    """

    line: Line

    name: str
    traits: Traits

    def __init__(self, line: Line, law: NormalLaw) -> None:
        super().__init__(line)
        self.law = law

    @abstractmethod
    def residual(self, state: State, forces: Forces) -> None: ...

    @abstractmethod
    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None: ...

    @property
    @abstractmethod
    def along(self) -> PointsAlong:
        """Points along the line at which results have contact forces and gaps."""

    @abstractmethod
    def contact_along_line(self, state: State) -> tuple[Array, Array]:
        """Gaps (n,) there, less that at which the force begins [m], and forces (n,) per length [N/m]; called only on
        the rank that evaluates contact.
        """

    @abstractmethod
    def results(self, state: State) -> Array:
        """All results in one vector, see `ContactResults.within`; on the rank that evaluates contact."""

    @abstractmethod
    def force_per_length(self, state: State) -> Array:
        """Contact force per length at the nodes (nn,) [N/m], > 0 where it pushes the riser away, < 0 where it sucks."""

    @abstractmethod
    def penetration(self, state: State) -> Array:
        """Penetration (nn,) [m] of the nodes' undersides into the ground as it is now, 0 above it."""

    @abstractmethod
    def depth(self, state: State) -> Array:
        """Depth (nn,) [m] of the nodes' undersides below the ground before the riser came, 0 above it."""

    @abstractmethod
    def max_penetration(self, state: State) -> float:
        """Deepest penetration [m] of what the contact looks at, nodes or stations between them; >= 0."""

    @abstractmethod
    def force_on_riser(self, state: State) -> Array:
        """Sum of the contact forces on the riser (3,) [N], global axes."""

    @abstractmethod
    def predict(self, guess: State) -> Array:
        """Increments (all local dofs) of a first guess of a step in which the riser lands, see `along_step`."""


class ContactResults(NamedTuple):
    """Contact at nn nodes and n points along the line, see `RiserContact`. Those of many instants have one axis more in
    front.

    force_per_length (nn,): [N/m], > 0 where it pushes the riser away. penetration, depth (nn,): of the nodes'
    undersides into the ground as it is now, and below it as it lay at first [m]. clearance (n,): gap less that at which
    the force begins [m]; force (n,): per length [N/m]. deepest (1,): penetration of what the contact looks at [m].
    on_riser (3,): sum of the forces [N], global axes.
    """

    force_per_length: Array
    penetration: Array
    depth: Array
    clearance: Array
    force: Array
    deepest: Array
    on_riser: Array

    @classmethod
    def within(cls, vector: Array, nodes: int, points: int) -> ContactResults:
        """The results as views of one vector of packed numbers (..., n), n from `size_of`."""
        return cls(*views(vector, _shapes(nodes, points)))


def _shapes(nodes: int, points: int) -> list[tuple[int, ...]]:
    return [(nodes,), (nodes,), (nodes,), (points,), (points,), (1,), (3,)]


def size_of(nodes: int, points: int) -> int:
    """How many numbers the results at some nodes and points have."""
    return sum(math.prod(shape) for shape in _shapes(nodes, points))


@bound_by_type
def write_results(part: tuple, at: Configuration, out: ContactResults) -> None:
    """Write the results of a contact by its kernel data, see `part_kernels`, in the configuration of the forces
    evaluated last.
    """
