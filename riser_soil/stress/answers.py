"""Answers that a stressed run is judged by: exact ones with what may be missed, and bounds."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Answer:
    """A quantity with its unit, what a run found for it, and what it may be. exact: None where there are bounds
    only.
    """

    what: str
    found: float
    low: float
    high: float
    exact: float | None = None

    @property
    def holds(self) -> bool:
        return self.low <= self.found <= self.high

    @property
    def error(self) -> float:
        """Relative to the exact answer, or how far beyond the bounds relative to them; inf for what is no number."""
        if not math.isfinite(self.found):
            return math.inf
        if self.exact is not None:
            return abs(self.found - self.exact) / (abs(self.exact) or max(self.high - self.low, math.ulp(0.0)))
        beyond = max(self.low - self.found, self.found - self.high, 0.0)
        return beyond / max(*(abs(x) for x in (self.low, self.high) if math.isfinite(x)), math.ulp(1.0))

    @property
    def severity(self) -> tuple[bool, bool, float]:
        """By which the worst of several answers is found: one that does not hold, else an exact one, else a bound."""
        if not math.isfinite(self.found):
            return True, True, math.inf
        if self.exact is not None:
            room = self.high - self.low
            return not self.holds, True, abs(self.found - self.exact) / max(room, math.ulp(0.0))
        bound = self.high if 0.0 < self.high < math.inf else math.inf
        return not self.holds, False, self.error if self.error else self.found / bound

    def __str__(self) -> str:
        if self.exact is not None:
            return f"{self.what}: {self.found:.6g}, exactly {self.exact:.6g}"
        return f"{self.what}: {self.found:.6g}, within {self.low:.6g} and {self.high:.6g}"


def near(what: str, found: float, exact: float, *, rel: float = 0.0, within: float = 0.0) -> Answer:
    """An exact answer, missed by at most a share `rel` of it and `within`, in its unit."""
    missed = rel * abs(exact) + within
    return Answer(what, float(found), float(exact - missed), float(exact + missed), float(exact))


def between(what: str, found: float, low: float = -math.inf, high: float = math.inf) -> Answer:
    """An answer known by its bounds."""
    return Answer(what, float(found), float(low), float(high))
