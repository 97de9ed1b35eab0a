"""A law of one's own, from outside the package: `kind: imported` with the class that `from` names.

The class has one of three methods, see `own_formula`: `update`, `evaluate` or `psi`. `law_trial` looks for its faults
as it is first evaluated at some depths.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, Self

from pydantic import ConfigDict, Field, PrivateAttr, model_validator

from riser_soil.core.lazy import LazyModule
from riser_soil.core.quantities import FROZEN
from riser_soil.errors import SceneError
from riser_soil.soil.law import PORE_PRESSURE, Formula, SoilLaw
from riser_soil.soil.law_source import LawError, Source, accepted_by, arguments

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np

    from riser_soil.core.arrays import Array
    from riser_soil.soil import imported_formula, law_trial
    from riser_soil.soil.own_formula import OwnFormula
else:
    np, imported_formula = LazyModule("numpy"), LazyModule("riser_soil.soil.imported_formula")
    law_trial = LazyModule("riser_soil.soil.law_trial")

BEYOND = 1.01  # times the greatest depth of the last trial: deeper points are tried anew


class ImportedLaw(SoilLaw):
    """A law of one's own: a class from a Python file or module, with its parameters beside."""

    model_config = ConfigDict(**{**FROZEN, "extra": "allow"})
    kind: Literal["imported"] = Field(description="the law's name")
    from_: Source = Field(
        alias="from",
        description='the law\'s class: "my_clay.py:CamClay", a file beside the scene, or "package.module:Class"; all '
        "other keys are parameters of its constructor",
    )
    _key: str = PrivateAttr("soil.law")
    _above: tuple[float, float] = PrivateAttr((0.0, 1.0))  # unit weight [N/m3], K0
    _tried: tuple[float, float] | None = PrivateAttr(None)  # depths [m]

    @model_validator(mode="after")
    def _has_its_parameters(self) -> Self:
        arguments(self.from_.loaded, self._given)
        return self

    @property
    def _given(self) -> dict[str, Any]:
        return dict(self.__pydantic_extra__ or {})

    def lies(self, key: str, unit_weight: float, K0: float) -> None:
        self._key, self._above = key, (unit_weight, K0)

    def knows_effective_stress(self, columns: Sequence[str]) -> bool:
        return PORE_PRESSURE in columns

    def surface_modulus(self, width: float) -> float:
        """Modulus at half the width below the surface, of soil at rest under its weight."""
        depth = np.array([0.5 * width])
        vertical = self._above[0] * depth
        horizontal, none = self._above[1] * vertical, np.zeros((1, 3))
        formula = self.at_points(depth, np.column_stack((-horizontal, -horizontal, -vertical, none)))
        K, G = float(formula.bulk[0]), float(formula.shear[0])
        return 9.0 * K * G / (3.0 * K + G)

    def at_points(self, depth: Array, initial: Array) -> Formula:
        try:
            self._try(depth, initial)
            return self._made(depth, initial)
        except LawError as err:
            raise SceneError(f"{self._key}: {self.from_.label}: {err}; correct the law") from err

    def _made(self, depth: Array, initial: Array) -> OwnFormula:
        law = self.from_.loaded
        given = arguments(law, self._given) | accepted_by(law, {"depth": depth, "initial": initial})
        return imported_formula.formula_of(lambda: law(**given), depth, initial, f"{self._key}: {self.from_.label}")

    def _try(self, depth: Array, initial: Array) -> None:
        """Try the law, unless that has been done."""
        if not depth.size:
            return
        low, high = float(depth.min()), float(depth.max())
        if self._tried is not None:
            first, last = self._tried
            if low >= first and high <= BEYOND * last:
                return
            low, high = min(low, first), max(high, last)
        law_trial.try_out(self._made, depth, initial)
        self._tried = low, high
