"""Units as engineers read them, for the table of outputs' units of SI."""

from __future__ import annotations

SHOWN: dict[str, tuple[str, float]] = {  # unit of SI as UDUNITS writes it -> unit shown, how many of it are one of SI
    "N": ("kN", 1e-3),
    "N m": ("kN m", 1e-3),
    "N m-1": ("kN/m", 1e-3),
    "m-1": ("1/m", 1.0),
    "Pa": ("MPa", 1e-6),
    "1": ("-", 1.0),
    "degree": ("°", 1.0),
}


def shown(units: str) -> tuple[str, float]:
    """The unit shown for one of SI, and how many of it are one of SI."""
    return SHOWN.get(units, (units, 1.0))


def axis_words(text: str, units: str) -> tuple[str, float]:
    """What an axis says of a quantity, and the factor that makes it so."""
    unit, factor = shown(units)
    return f"{text} [{unit}]", factor
