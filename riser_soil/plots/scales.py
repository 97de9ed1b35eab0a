"""Round numbers for colour bars and magnification, lengths in words, units as engineers read them."""

from __future__ import annotations

import math

from riser_soil.core.arrays import Array

# Upper ends of colour scales within a decade, each with the number of labels that makes round steps.
_TOPS = ((1, 6), (1.2, 5), (1.6, 5), (2, 5), (3, 4), (4, 5), (5, 6), (6, 4), (8, 5), (10, 6))
_FACTORS = (5.0, 2.0, 1.0)
# A magnified displacement that is this share of the body's depth is well visible, and not absurd.
_VISIBLE_SHARE = 0.1
SHOWN: dict[str, tuple[str, float]] = {  # unit of SI as UDUNITS writes it -> unit shown, how many of it are one of SI
    "N": ("kN", 1e-3),
    "N m": ("kN m", 1e-3),
    "N m-1": ("kN/m", 1e-3),
    "m-1": ("1/m", 1.0),
    "Pa": ("MPa", 1e-6),
    "1": ("-", 1.0),
    "degree": ("°", 1.0),
}


def colour_scale(values: Array) -> tuple[float, int]:
    """Upper end of a colour scale from 0 that holds all values, and how many labels make it read well."""
    largest = float(values.max(initial=0.0))
    if not largest > 0.0:
        return 1.0, 2
    decade = 10.0 ** math.floor(math.log10(largest))
    return next((top * decade, labels) for top, labels in _TOPS if top * decade >= largest * (1.0 - 1e-9))


def magnification(largest: float, depth: float) -> float:
    """Factor 1, 2, 5, 10, ... that draws the largest displacement [m] visibly on a body of this depth [m]."""
    wanted = max(1.0, _VISIBLE_SHARE * depth / largest) if largest > 0.0 else 1.0
    decade = 10.0 ** math.floor(math.log10(wanted))
    return next(factor * decade for factor in _FACTORS if factor * decade <= wanted * (1.0 + 1e-9))


def metres(length: float) -> str:
    """A length in words: whole metres from 100 m on, else three figures."""
    return f"{length:.0f} m" if abs(length) >= 99.95 else f"{length:.3g} m"


def shown(units: str) -> tuple[str, float]:
    """The unit shown for one of SI, and how many of it are one of SI."""
    return SHOWN.get(units, (units, 1.0))


def axis_words(text: str, units: str) -> tuple[str, float]:
    """An axis' label of a quantity, and the factor to its unit."""
    unit, factor = shown(units)
    return f"{text} [{unit}]", factor
