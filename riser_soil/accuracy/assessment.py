"""Errors of a study's points, against a reference that its ladders are extrapolated to.

Each knob's ladder, the others as in the scene, leads to a limit; what the scene misses of it is the knob's share of its
error. The reference begins at the corner, the run with all knobs one rung finer, less what each knob misses there by
its own ladder. If errors of knobs add up, the corner is where the ladders say; by how much it is not, doubled, is added
to the uncertainties of the limits: they make up the reference's. Without a corner (it failed, or there is one knob) the
reference begins at the scene; the second largest share then bounds how two knobs may act together.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

from riser_soil.accuracy.extrapolation import Limit, limit
from riser_soil.accuracy.headlines import Headline
from riser_soil.accuracy.ladders import Ladders
from riser_soil.accuracy.study_points import Factors, PointOutcome

TOGETHER = 2.0  # times what errors do not add up by, in the reference's uncertainty
TELLING = 0.1  # relative uncertainty of the reference beyond which an error of the quantity can't be told

Outcomes = Mapping[Factors, PointOutcome]


@dataclass(frozen=True, eq=False)
class AssessedQuantity:
    """A headline quantity of the scene with its reference.

    reference: the quantity at the reference, whose scale errors are relative to. uncertainty: of it, in the unit.
    limits: of each knob's ladder. by_rung: of each knob, what it misses of its limit by rung (signed, in the unit).
    """

    scene: Headline
    reference: Headline
    uncertainty: float
    limits: tuple[Limit, ...]
    by_rung: tuple[Mapping[float, float], ...]

    @property
    def doubt(self) -> float:
        """Relative uncertainty of the reference."""
        return self.reference.relative(self.uncertainty)

    @property
    def error(self) -> float:
        """Of the scene as it is, relative."""
        return self.error_of(self.scene)

    def allowed(self, target: float) -> float:
        """Relative error that counts as the target: errors less than the reference's uncertainty can't be told."""
        return max(target, self.doubt)

    def error_of(self, found: Headline) -> float:
        """Relative error of the quantity in another run."""
        return self.reference.relative(found.value - self.reference.value)

    def share(self, number: int, factor: float = 1.0) -> float:
        """Relative error that one knob brings about on a rung of its ladder."""
        return self.reference.relative(self.by_rung[number][factor])


def assess(ladders: Ladders, outcomes: Outcomes) -> dict[str, AssessedQuantity]:
    """Headline quantities of the scene by their keys; the scene itself must have been computed."""
    base = outcomes[ladders.base]
    return {key: _assessed(each, ladders, outcomes) for key, each in base.headlines.items()}


def told(quantities: Mapping[str, AssessedQuantity]) -> dict[str, AssessedQuantity]:
    """The quantities whose reference is known well enough to tell errors."""
    return {key: each for key, each in quantities.items() if each.doubt <= TELLING}


def worst(quantities: Mapping[str, AssessedQuantity], outcome: PointOutcome) -> tuple[float, str]:
    """Largest relative error of a point among the quantities, and its key; inf where one is missing in it."""
    errors = [
        (each.error_of(outcome.headlines[key]) if key in outcome.headlines else math.inf, key)
        for key, each in quantities.items()
    ]
    return max(errors, default=(math.nan, ""))


def _assessed(scene: Headline, ladders: Ladders, outcomes: Outcomes) -> AssessedQuantity:
    found = [_ladder(scene.key, ladders, number, outcomes) for number in range(len(ladders.knobs))]
    limits, by_rung = tuple(each[0] for each in found), tuple(each[1] for each in found)
    value, together = _reference(scene, ladders, outcomes, by_rung)
    uncertainty = math.fsum(each.uncertainty for each in limits) + together
    return AssessedQuantity(scene, replace(scene, value=value), uncertainty, limits, by_rung)


def _ladder(key: str, ladders: Ladders, number: int, outcomes: Outcomes) -> tuple[Limit, dict[float, float]]:
    """The limit of one knob's ladder, and what its rungs miss of it."""
    values = {}
    for factor in ladders.factors[number]:
        outcome = outcomes.get(ladders.turned(number, factor))
        if outcome is not None and key in outcome.headlines:
            values[factor] = outcome.headlines[key].value
    sizes = [1.0 / ladders.fineness(number, factor) for factor in values]
    found = limit(sizes, list(values.values()))
    return found, {factor: value - found.value for factor, value in values.items()}


def _reference(
    scene: Headline, ladders: Ladders, outcomes: Outcomes, by_rung: tuple[Mapping[float, float], ...]
) -> tuple[float, float]:
    """Value of the reference, and how much of its uncertainty is from knobs that act together."""
    missed = [rungs[1.0] for rungs in by_rung]
    corner = outcomes.get(ladders.corner) if ladders.corner is not None else None
    finer = ladders.corner or ladders.base
    there = [rungs.get(factor) for rungs, factor in zip(by_rung, finer, strict=True)]
    left = [each for each in there if each is not None]
    if corner is None or scene.key not in corner.headlines or len(left) < len(there):
        return scene.value - math.fsum(missed), sorted(map(abs, [0.0, *missed]))[-2]
    value = corner.headlines[scene.key].value
    foretold = scene.value - math.fsum(missed) + math.fsum(left)
    return value - math.fsum(left), TOGETHER * abs(value - foretold)
