"""Errors of a study's points, against a reference that its refinement series are extrapolated to.

Each setting's refinement series, the others as in the scene, leads to a limit; what the scene misses of it is the
setting's share of its error. The reference begins at the corner, the run with all settings one level finer, less what
each setting misses there by its own refinement series. If errors of settings add up, the corner is where the refinement
series say; by how much it is not, doubled, is added to the uncertainties of the limits: they make up the reference's.
Without a corner (it failed, or there is one setting) the reference begins at the scene; the second largest share then
bounds how two settings may act together.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

from riser_soil.accuracy.extrapolation import Limit, limit
from riser_soil.accuracy.refinements import Refinements
from riser_soil.accuracy.study_points import Factors, PointOutcome
from riser_soil.variants.key_results import KeyResult

TOGETHER = 2.0  # times what errors do not add up by, in the reference's uncertainty
TELLING = 0.1  # relative uncertainty of the reference beyond which an error of the quantity can't be told
Outcomes = Mapping[Factors, PointOutcome]


@dataclass(frozen=True, eq=False)
class AssessedQuantity:
    """A key result of the scene with its reference.

    reference: the quantity at the reference, whose scale errors are relative to. uncertainty: of it, in the unit.
    limits: of each setting's refinement series. by_level: of each setting, what it misses of its limit by level
    (signed, in the unit).
    """

    scene: KeyResult
    reference: KeyResult
    uncertainty: float
    limits: tuple[Limit, ...]
    by_level: tuple[Mapping[float, float], ...]

    @property
    def doubt(self) -> float:
        """Relative uncertainty of the reference."""
        return self.reference.relative(self.uncertainty)

    @property
    def error(self) -> float:
        """Relative error of the scene as it is."""
        return self.error_of(self.scene)

    def allowed(self, target: float) -> float:
        """Relative error that counts as the target: errors less than the reference's uncertainty can't be told."""
        return max(target, self.doubt)

    def error_of(self, found: KeyResult) -> float:
        """Relative error of the quantity in another run."""
        return self.reference.relative(found.value - self.reference.value)

    def share(self, number: int, factor: float = 1.0) -> float:
        """Relative error that one setting brings about on a level of its refinement series."""
        return self.reference.relative(self.by_level[number][factor])


def assess(refinements: Refinements, outcomes: Outcomes) -> dict[str, AssessedQuantity]:
    """Key results of the scene by their keys; the scene itself must have been computed."""
    base = outcomes[refinements.base]
    return {key: _assessed(each, refinements, outcomes) for key, each in base.key_results.items()}


def with_known_error(quantities: Mapping[str, AssessedQuantity]) -> dict[str, AssessedQuantity]:
    """The quantities whose reference is known well enough to tell errors."""
    return {key: each for key, each in quantities.items() if each.doubt <= TELLING}


def worst(quantities: Mapping[str, AssessedQuantity], outcome: PointOutcome) -> tuple[float, str]:
    """Largest relative error of a point among the quantities, and its key; inf where one is missing in it."""
    errors = [
        (each.error_of(outcome.key_results[key]) if key in outcome.key_results else math.inf, key)
        for key, each in quantities.items()
    ]
    return max(errors, default=(math.nan, ""))


def _assessed(scene: KeyResult, refinements: Refinements, outcomes: Outcomes) -> AssessedQuantity:
    found = [_refinement(scene.key, refinements, number, outcomes) for number in range(len(refinements.settings))]
    limits, by_level = tuple(each[0] for each in found), tuple(each[1] for each in found)
    value, together = _reference(scene, refinements, outcomes, by_level)
    uncertainty = math.fsum(each.uncertainty for each in limits) + together
    return AssessedQuantity(scene, replace(scene, value=value), uncertainty, limits, by_level)


def _refinement(
    key: str, refinements: Refinements, number: int, outcomes: Outcomes
) -> tuple[Limit, dict[float, float]]:
    """The limit of one setting's refinement series, and what its levels miss of it."""
    values = {}
    for factor in refinements.factors[number]:
        outcome = outcomes.get(refinements.turned(number, factor))
        if outcome is not None and key in outcome.key_results:
            values[factor] = outcome.key_results[key].value
    sizes = [1.0 / refinements.fineness(number, factor) for factor in values]
    found = limit(sizes, list(values.values()))
    return found, {factor: value - found.value for factor, value in values.items()}


def _reference(
    scene: KeyResult, refinements: Refinements, outcomes: Outcomes, by_level: tuple[Mapping[float, float], ...]
) -> tuple[float, float]:
    """Value of the reference, and how much of its uncertainty is from settings that act together."""
    missed = [levels[1.0] for levels in by_level]
    corner = outcomes.get(refinements.corner) if refinements.corner is not None else None
    finer = refinements.corner or refinements.base
    there = [levels.get(factor) for levels, factor in zip(by_level, finer, strict=True)]
    left = [each for each in there if each is not None]
    if corner is None or scene.key not in corner.key_results or len(left) < len(there):
        return scene.value - math.fsum(missed), sorted(map(abs, [0.0, *missed]))[-2]
    value = corner.key_results[scene.key].value
    foretold = scene.value - math.fsum(missed) + math.fsum(left)
    return value - math.fsum(left), TOGETHER * abs(value - foretold)
