"""Errors of a study's points against a reference, to which the refinement series are extrapolated.

The refinement series of each setting, the others as in the scene, has a limit; the scene's difference from it is the
setting's share of the scene's error. The reference is the value at the corner, the run with all settings one level
finer, less the error of each setting there by its own refinement series. If errors of settings add up, the value at the
corner is that which the refinement series predict. Twice the difference from it is added to the uncertainties of the
limits; the sum is the uncertainty of the reference. Without a corner (it failed, or there is one setting) the reference
is the value of the scene less its errors; the second largest of these then bounds how two settings may interact.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

from riser_soil.accuracy.refinements import Refinements
from riser_soil.accuracy.study_points import Factors, PointOutcome
from riser_soil.variants.extrapolation import Limit, limit
from riser_soil.variants.key_results import KeyResult

INTERACTION = 2.0  # factor on the corner's difference from its prediction, in the reference's uncertainty
MOST_UNCERTAIN = 0.1  # relative uncertainty of a reference by which errors of a quantity can be judged
Outcomes = Mapping[Factors, PointOutcome]


@dataclass(frozen=True, eq=False)
class AssessedQuantity:
    """A key result of the scene with its reference.

    reference: the quantity at the reference, to whose scale errors are relative. uncertainty: of the reference, in the
    quantity's unit. limits: of each setting's refinement series. by_level: signed errors of each setting by its
    levels, in the unit.
    """

    scene: KeyResult
    reference: KeyResult
    uncertainty: float
    limits: tuple[Limit, ...]
    by_level: tuple[Mapping[float, float], ...]

    @property
    def relative_uncertainty(self) -> float:
        """Relative uncertainty of the reference."""
        return self.reference.relative(self.uncertainty)

    @property
    def error(self) -> float:
        """Relative error of the scene as it is."""
        return self.error_of(self.scene)

    def allowed(self, target: float) -> float:
        """Relative error that counts as the target, at least the uncertainty of the reference."""
        return max(target, self.relative_uncertainty)

    def error_of(self, other: KeyResult) -> float:
        """Relative error of the quantity in another run."""
        return self.reference.error(other)

    def share(self, number: int, factor: float = 1.0) -> float:
        """Relative error by one setting at a level of its refinement series."""
        return self.reference.relative(self.by_level[number][factor])


def assess(refinements: Refinements, outcomes: Outcomes) -> dict[str, AssessedQuantity]:
    """Assessed key results of the scene by their keys; the scene itself must have been computed."""
    base = outcomes[refinements.base]
    return {key: _assessed(each, refinements, outcomes) for key, each in base.key_results.items()}


def with_known_reference(quantities: Mapping[str, AssessedQuantity]) -> dict[str, AssessedQuantity]:
    """Quantities whose reference is known well enough to judge errors."""
    return {key: each for key, each in quantities.items() if each.relative_uncertainty <= MOST_UNCERTAIN}


def worst(quantities: Mapping[str, AssessedQuantity], outcome: PointOutcome) -> tuple[float, str]:
    """Largest relative error of a point among the quantities, and its key; inf where one is missing in it."""
    errors = [
        (each.error_of(outcome.key_results[key]) if key in outcome.key_results else math.inf, key)
        for key, each in quantities.items()
    ]
    return max(errors, default=(math.nan, ""))


def _assessed(scene: KeyResult, refinements: Refinements, outcomes: Outcomes) -> AssessedQuantity:
    series = [_refinement(scene.key, refinements, number, outcomes) for number in range(len(refinements.settings))]
    limits, by_level = tuple(each[0] for each in series), tuple(each[1] for each in series)
    value, interaction = _reference(scene, refinements, outcomes, by_level)
    uncertainty = math.fsum(each.uncertainty for each in limits) + interaction
    return AssessedQuantity(scene, replace(scene, value=value), uncertainty, limits, by_level)


def _refinement(
    key: str, refinements: Refinements, number: int, outcomes: Outcomes
) -> tuple[Limit, dict[float, float]]:
    """Limit of one setting's refinement series, and the errors of its levels."""
    values = {}
    for factor in refinements.factors[number]:
        outcome = outcomes.get(refinements.point(number, factor))
        if outcome is not None and key in outcome.key_results:
            values[factor] = outcome.key_results[key].value
    sizes = [1.0 / refinements.fineness(number, factor) for factor in values]
    reached = limit(sizes, list(values.values()))
    return reached, {factor: value - reached.value for factor, value in values.items()}


def _reference(
    scene: KeyResult, refinements: Refinements, outcomes: Outcomes, by_level: tuple[Mapping[float, float], ...]
) -> tuple[float, float]:
    """Value of the reference, and the part of its uncertainty by settings that interact."""
    errors = [levels[1.0] for levels in by_level]
    extrapolated = scene.value - math.fsum(errors)
    corner = outcomes.get(refinements.corner) if refinements.corner is not None else None
    finer = refinements.corner or refinements.base
    at_corner = [levels.get(factor) for levels, factor in zip(by_level, finer, strict=True)]
    known = [each for each in at_corner if each is not None]
    if corner is None or scene.key not in corner.key_results or len(known) < len(at_corner):
        return extrapolated, sorted(map(abs, [0.0, *errors]))[-2]
    value, error = corner.key_results[scene.key].value, math.fsum(known)
    return value - error, INTERACTION * abs(value - (extrapolated + error))
