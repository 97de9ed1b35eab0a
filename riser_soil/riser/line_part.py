"""Base class of the parts that act on a line: sparsity pattern, and defaults without energy, history or forces."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from riser_soil.core.arrays import Array
from riser_soil.core.part import Energy, MatrixBlock, Part, State, Work
from riser_soil.riser.line import Line


class LinePart:
    """Base of the parts that act on a line; called only on the rank that evaluates it."""

    def __init__(self, line: Line) -> None:
        self.line = line

    @property
    def active(self) -> bool:
        return self.line.active

    def blocks(self) -> dict[str, MatrixBlock]:
        """All dofs of each element."""
        return {self.line.name: self.line.element_block()}

    def kernel_data(self) -> tuple[Any, ...] | None:
        """The part's kernel data, for the compiled loop over a riser alone, see `part_kernels`; None without.

        Asked for once a stage, so that what changes is an array that is written to, see `renew_kernel_data`.
        """
        return None

    def renew_kernel_data(self, start: float, end: float) -> None:
        """Write what depends on the time alone into the kernel data that was asked for last, for a step between two
        times [s].
        """

    def energy(self, state: State) -> Energy:
        return Energy()

    def work(self, before: State, after: State) -> Work:
        return Work()

    def commit(self, state: State) -> None:
        """Nothing is kept."""

    def element_forces(self, state: State) -> Array | None:
        """Element residual (ne, 2 ndof) of all groups, of what acts within the elements; None for nothing."""
        return None

    def viscous_forces(self, state: State) -> Array | None:
        """The share of `element_forces` (ne, 2 ndof) that follows from strain rates; None for nothing."""
        return None

    def nodal_forces(self, state: State) -> Array | None:
        """Residual (nn, ndof) of what acts on nodes without holding them; None for nothing."""
        return None


def acting_on(line: Line, parts: Iterable[Part]) -> list[LinePart]:
    """Those of the parts that act on this line and say where."""
    return [part for part in parts if isinstance(part, LinePart) and part.line is line]


def overrides(part: LinePart, method: str) -> bool:
    """Whether a part has a method of its own in the place of the base's, which does nothing."""
    return getattr(type(part), method) is not getattr(LinePart, method)
