"""Kernels of parts of a line, bound to a configuration and to where they write: which there are, and in which order.

A line's Newton loop is made of them (`solve.packed_line`), and so is what parts are asked at a state (`line_part`).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.bound import Bound, Packed, bound
from riser_soil.riser.configuration import Configuration, write_maps, write_turning
from riser_soil.riser.part_kernels import (
    add_energy,
    add_forces,
    add_tangent,
    add_work,
    clear,
    collect,
    find_water,
    forces_at,
    keep,
    turn,
    weigh,
    write_residual,
)

KernelData = tuple[Any, ...]


class BoundParts:
    """Kernels of parts of a line in a configuration. Its methods return kernels, to be called in this order.

    at: the configuration; data: the parts' kernel data; forces: their residuals there.
    """

    def __init__(self, at: Configuration, data: Sequence[KernelData]) -> None:
        self.at, self.data, self.forces = at, data, forces_at(at)
        self.packed_at, self.packed_forces = Packed(at), Packed(self.forces)

    def find_forces(self) -> list[Bound]:
        """Write the parts' residuals, as they act on elements and on nodes."""
        here, forces = self.packed_at, self.packed_forces
        return [Bound(clear, forces), *(bound(add_forces, data, here, forces) for data in self.data)]

    def collect(self) -> Bound:
        """Add what acts on elements to what acts on nodes; once after each evaluation of the residuals."""
        return Bound(collect, self.packed_at, self.packed_forces)

    def write_residual(self, out: Array) -> Bound:
        """Write the residual of the elements (ne, 2 ndof), all groups."""
        return Bound(write_residual, self.packed_at, self.packed_forces, Packed(out))

    def find_water(self) -> list[Bound]:
        """Evaluate the water's motion in the residuals' configuration, as another one may have been evaluated since."""
        return [bound(find_water, data, self.packed_at) for data in self.data if type(data) in find_water.kernels]

    def tangent(self, data: Sequence[KernelData], maps: Packed, weights: Packed, K: Packed) -> list[Bound]:
        """Add the tangent of some of the parts, but for `turning`, to K; maps must be written there."""
        return [bound(add_tangent, each, self.packed_at, maps, weights, K) for each in data]

    def write_maps(self, maps: Packed, weights: Packed) -> Bound:
        """Write the maps of the tangent, rates by the shifts of the weights."""
        return bound(write_maps, self.at, maps, weights)

    def turning(self, weights: Packed, K: Packed) -> list[Bound]:
        """Add to K the derivative of the evaluated residuals by the turning of the elements' ends."""
        conjugate, turned = self._turning
        return [
            Bound(weigh, self.packed_forces, weights, conjugate),
            bound(write_turning, self.at, conjugate, turned),
            Bound(turn, self.packed_at, turned, K),
        ]

    @cached_property
    def _turning(self) -> tuple[Packed, Packed]:
        """Workspace (ne, 2, d) for what is conjugate to the tangents of the elements' ends; for its turning."""
        (ne, _, d), ndof = self.at.q.shape, self.at.v.shape[1]
        return Packed(np.empty((ne, 2, d))), Packed(np.empty((ne, 2, ndof - d, ndof - d)))

    def energy(self, out: Packed) -> list[Bound]:
        """Add the parts' energy to (3,)."""
        return [bound(add_energy, data, self.packed_at, out) for data in self.data]

    def work(self, before: Configuration, rows: Array) -> list[Bound]:
        """Add what parts turn over in a step from another configuration to rows (m, 4), one each that has a kernel."""
        data, then = [each for each in self.data if has_work(each)], Packed(before)
        pairs = zip(data, rows, strict=True)
        return [bound(add_work, each, then, self.packed_at, Packed(row)) for each, row in pairs]

    def keep(self) -> list[Bound]:
        """Keep the history of the parts that have one."""
        return [bound(keep, data, self.packed_at) for data in self.data if has_history(data)]


def has_work(data: KernelData) -> bool:
    """Whether there is a kernel for what a part turns over."""
    return type(data) in add_work.kernels


def has_history(data: KernelData) -> bool:
    """Whether there is a kernel that keeps a part's history."""
    return type(data) in keep.kernels
