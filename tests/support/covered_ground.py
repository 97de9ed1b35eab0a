"""Something that covers a seabed in places: all between two values of x."""

from __future__ import annotations

import math
from typing import NamedTuple

from riser_soil.contact.seabed_contact import Covering
from riser_soil.riser.vectors import Vec
from riser_soil.seabed.points import covered_by


class BeyondData(NamedTuple):
    """Kernel data of `beyond`."""

    x: float
    until: float


def beyond(x: float, until: float = math.inf) -> Covering:
    """Covers all beyond an x up to another one [m], never moves."""
    return Covering(lambda: BeyondData(x, until), lambda cover: None)


@covered_by.of(BeyondData)
def _beyond(cover: BeyondData, x: Vec, previous: int) -> int:
    return 0 if cover.x < x[0] <= cover.until else -1
