"""The formula of an object of a user's class, by the one of three methods that it has."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from riser_soil.core.arrays import Array
from riser_soil.soil.law_source import LawError
from riser_soil.soil.own_formula import ConstitutiveFormula, OwnFormula, UpdateFormula, call_user_code

METHODS = ("update", "evaluate", "psi")


def formula_of(make: Callable[[], Any], depth: Array, initial: Array, label: str) -> OwnFormula:
    """The formula of the object that `make` makes, at depths (n,) [m] under a stress (n, 6) [Pa]; LawError."""
    law = call_user_code(make)
    methods = [name for name in METHODS if callable(getattr(law, name, None))]
    if len(methods) != 1:
        has = f"has {' and '.join(methods)}" if methods else "has none"
        raise LawError(f"the class must have one of the methods {', '.join(METHODS)}, and {has}")
    if methods[0] == "psi":
        from riser_soil.soil.energy_formula import EnergyFormula

        return EnergyFormula(law, depth, initial, label)
    kinds: dict[str, type[OwnFormula]] = {"update": UpdateFormula, "evaluate": ConstitutiveFormula}
    return kinds[methods[0]](law, depth, initial, label)
