"""Step size control: the nominal step, halved where a step fails, doubled again where it goes well.

All times lie on a binary refinement of the nominal steps, so that nominal times are always hit. The last nominal step
ends where the stage does; it may be shorter than the others. A path with corners has nominal steps of its own from each
of them to the next.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Protocol

import numpy as np

from riser_soil.core.saved_state import Saved

LEVELS = 20


class Control(Protocol):
    """Step size control: gives the end of the next step. Times in s; in a static stage load factors.

    judges_error: whether it needs the local error of each step.
    """

    judges_error: bool

    @property
    def finished(self) -> bool: ...

    @property
    def target(self) -> float:
        """Time at the end of the step to be tried."""
        ...

    @property
    def dt(self) -> float: ...

    def rejection(self, error: float) -> str:
        """Why a step of this local error [m] is not accepted; empty for a good one."""
        ...

    def accept(self, easy: bool) -> None:
        """Count a step as done, which took few iterations or many."""
        ...

    def cut(self) -> bool:
        """Shorten the step that failed; False when it can't be shortened any more."""
        ...


class StepControl:
    """Steps from 0 to `end` of nominal size `step`; never below `smallest`."""

    judges_error = False

    def __init__(self, end: float, step: float, smallest: float) -> None:
        self.end, self.step = end, step
        self._levels = min(LEVELS, max(0, math.floor(math.log2(step / smallest) + 1e-9)))
        self._last = math.ceil(end / step - 1e-9) * 2**self._levels
        self._at = 0
        self._level = 0

    @property
    def finished(self) -> bool:
        return self._at >= self._last

    @property
    def target(self) -> float:
        """Time at the end of the step to be tried."""
        return self._time(self._at + self._stride)

    @property
    def dt(self) -> float:
        """Size of the step to be tried [s], the nominal one: the round-off of a difference of two times would make
        each step unlike the last.
        """
        return self._nominal(self._at) * self._stride / 2**self._levels

    def rejection(self, error: float) -> str:
        return ""

    def accept(self, easy: bool) -> None:
        """Move on; after an easy step on the coarser grid, try twice the step."""
        self._at += self._stride
        if easy and self._level > 0 and self._at % (2 * self._stride) == 0:
            self._level -= 1

    def cut(self) -> bool:
        """Halve the step; False when it can't be halved any more."""
        if self._level == self._levels:
            return False
        self._level += 1
        return True

    def state(self) -> Saved:
        return {"at": np.array(self._at), "level": np.array(self._level)}

    def restore(self, saved: Saved) -> None:
        self._at, self._level = int(saved["at"]), int(saved["level"])

    @property
    def _stride(self) -> int:
        return int(2 ** (self._levels - self._level))

    def _nominal(self, ticks: int) -> float:
        """Size of the nominal step in which a tick lies."""
        last = ticks >= self._last - 2**self._levels
        return self.end - ticks // 2**self._levels * self.step if last else self.step

    def _time(self, ticks: int) -> float:
        if ticks >= self._last:
            return self.end
        whole, rest = divmod(ticks, 2**self._levels)
        return whole * self.step + rest / 2**self._levels * self._nominal(ticks)


class PathSteps:
    """Steps of equal nominal size from each corner of a path to the next, so that corners are always hit.

    corners (n + 1,): increasing, from 0 on. counts (n,): nominal steps between them. share: of a nominal step, below
    which it is not cut.
    """

    judges_error = False

    def __init__(self, corners: Sequence[float], counts: Sequence[int], share: float) -> None:
        self._begins = corners[:-1]
        sizes = [(b - a) / count for (a, b), count in zip(pairwise(corners), counts, strict=True)]
        stretches = zip(pairwise(corners), sizes, strict=True)
        self._stretches = [StepControl(b - a, size, share * size) for (a, b), size in stretches]
        self._number = 0

    @property
    def finished(self) -> bool:
        return self._number == len(self._stretches)

    @property
    def target(self) -> float:
        return self._begins[self._number] + self._stretch.target

    @property
    def dt(self) -> float:
        return self._stretch.dt

    def rejection(self, error: float) -> str:
        return ""

    def accept(self, easy: bool) -> None:
        self._stretch.accept(easy)
        self._number += self._stretch.finished

    def cut(self) -> bool:
        return self._stretch.cut()

    def state(self) -> Saved:
        within = {} if self.finished else self._stretch.state()
        return within | {"number": np.array(self._number)}

    def restore(self, saved: Saved) -> None:
        self._number = int(saved["number"])
        if not self.finished:
            self._stretch.restore(saved)

    @property
    def _stretch(self) -> StepControl:
        return self._stretches[self._number]
