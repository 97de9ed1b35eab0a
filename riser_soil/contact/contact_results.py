"""What results tell of the riser's contact with one ground at an accepted state, as one vector."""

from __future__ import annotations

import math
from typing import NamedTuple

from riser_soil.core.arrays import Array, views
from riser_soil.core.by_type import bound_by_type
from riser_soil.riser.configuration import Configuration


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
        """As views of the numbers (..., n); see `size_of`."""
        return cls(*views(vector, _shapes(nodes, points)))


def _shapes(nodes: int, points: int) -> list[tuple[int, ...]]:
    return [(nodes,), (nodes,), (nodes,), (points,), (points,), (1,), (3,)]


def size_of(nodes: int, points: int) -> int:
    """How many numbers they are."""
    return sum(math.prod(shape) for shape in _shapes(nodes, points))


@bound_by_type
def put_results(part: tuple, at: Configuration, out: ContactResults) -> None:
    """Write the results of a contact in numbers, see `part_kernels`, in the configuration of the forces found last."""
