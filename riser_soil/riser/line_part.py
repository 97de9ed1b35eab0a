"""Base class of the parts that act on a line: sparsity pattern, and defaults without energy or history."""

from __future__ import annotations

from riser_soil.core.part import Energy, MatrixBlock, State, Work
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

    def energy(self, state: State) -> Energy:
        return Energy()

    def work(self, before: State, after: State) -> Work:
        return Work()

    def commit(self, state: State) -> None:
        """Nothing is kept."""
