"""Plausible size of a quantity, and the doubt about a number that is beyond it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from riser_soil.scene.problem import Path

LARGEST = 1e100  # largest number that is checked
UNKNOWN = "in another unit"
LINES = (("riser",), ("lines", "*"))  # where a scene has its lines


class Doubt(NamedTuple):
    """A number of a scene that is not plausible: its path, and what is doubtful, with the likely unit."""

    path: Path
    text: str

    @property
    def names_a_unit(self) -> bool:
        return UNKNOWN not in self.text


@dataclass(frozen=True)
class Size:
    """What a quantity is at least and at most, whatever its sign, in its unit; factors of other units."""

    least: float
    most: float
    unit: str
    others: Mapping[str, float] = field(default_factory=dict)

    def holds(self, value: float) -> bool:
        """Whether a value is plausible; nothing of a quantity is."""
        return value == 0.0 or self.least <= abs(value) <= self.most

    def doubt(self, value: float) -> str:
        """Doubt about a value, in words; "" for a plausible one."""
        if self.holds(value):
            return ""
        fits = {unit: value * factor for unit, factor in self.others.items() if self.holds(value * factor)}
        return f"{value:g} {self.unit} is not plausible, {self.usual} is usual: is it {meant(fits, self.unit)}?"

    @property
    def usual(self) -> str:
        """The plausible range in words."""
        if self.most == math.inf:
            return f"at least {self.least:g} {self.unit}"
        least = f"{self.least:g} to" if self.least else "at most"
        return f"{least} {self.most:g} {self.unit}".rstrip()


def meant(fits: Mapping[str, float], unit: str) -> str:
    """Units that a number may be in, with what it would be, in words."""
    return " or ".join(f"in {name}, {value:.4g} {unit}" for name, value in fits.items()) or UNKNOWN


def number_of(value: Any) -> float:
    """A number of plain data; 0 for what is none."""
    plain = isinstance(value, int | float) and not isinstance(value, bool)
    return float(value) if plain and -LARGEST < value < LARGEST else 0.0


def amount_of(value: Any) -> float:
    """A number of a quantity that is never negative; 0 for a negative one."""
    return max(number_of(value), 0.0)
