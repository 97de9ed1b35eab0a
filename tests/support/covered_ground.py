"""Something that covers a seabed in places: all between two values of x."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from riser_soil.contact.seabed_kernels import covered_by
from riser_soil.riser.vectors import Vec


class BeyondData(NamedTuple):
    """As of `Beyond`."""

    x: float
    until: float


@dataclass(frozen=True)
class Beyond:
    """Covers all beyond an x up to another one [m], never moves."""

    x: float
    until: float = math.inf

    def cover(self) -> BeyondData:
        return BeyondData(self.x, self.until)

    def renew_cover(self, cover: BeyondData) -> None:
        """It stays."""


@covered_by.of(BeyondData)
def _beyond(cover: BeyondData, x: Vec, known: int) -> int:
    return 0 if cover.x < x[0] <= cover.until else -1
