"""Parts of a line with their numbers for the compiled loop, see `riser.part_kernels`, at a time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from riser_soil.core.part import State, Work
from riser_soil.riser.compiled_part import CompiledPart
from riser_soil.riser.line_part import LinePart, overrides
from riser_soil.riser.part_kernels import add_work, keep

Numbers = tuple[Any, ...]


class NumberedParts:
    """Parts with their numbers; t: the time [s] that what depends on it was written for last; committed: parts whose
    history no kernel keeps.
    """

    def __init__(self, numbered: Sequence[tuple[Any, Numbers]]) -> None:
        self.numbered, self.t = numbered, math.nan
        self.parts: list[LinePart] = [part for part, _ in numbered]
        self.numbers = [held for _, held in numbered]
        self._renewed = [part for part in self.parts if overrides(part, "renew_numbers")]
        kernels = [(part, type(held) in add_work.kernels) for part, held in numbered]
        self.committed = [part for part, held in numbered if type(held) not in keep.kernels]
        self._turning = [(part, kernel) for part, kernel in kernels if kernel or _by_method(part)]

    def bring(self, start: float, end: float) -> None:
        """Write what depends on the time into the numbers, for a step between two times."""
        for part in self._renewed:
            part.renew_numbers(start, end)
        self.t = end

    def bring_to(self, t: float) -> None:
        if self.t != t:
            self.bring(t, t)

    def in_groups(self, groups: str) -> list[Numbers]:
        """Numbers of the parts with forces in some of the groups."""
        return [held for part, held in self.numbered if set(part.traits.groups) & set(groups)]

    def add_work(self, before: State, after: State, rows: list[list[float]], work: dict[str, Work]) -> None:
        """Add what the parts turn over in a step, by name; rows: of those that have kernels for it."""
        compiled = iter(rows)
        for part, kernel in self._turning:
            work[part.name] += Work(*next(compiled)) if kernel else part.work(before, after)


def _by_method(part: LinePart) -> bool:
    """Whether a part without a kernel for it says what it turns over."""
    return overrides(part, "work") and type(part).work is not CompiledPart.work
