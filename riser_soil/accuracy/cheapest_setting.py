"""Cheapest settings that reach an accuracy: predicted from a study's refinement series, then run.

Predicted errors are the sums of the settings' own, whatever their signs, so that no setting is chosen for errors that
happen to cancel; predicted costs are products of the refinement series' ratios. The level after the finest of each
series is predicted by the observed order and by the growth of the cost.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import product

from riser_soil.accuracy.assessment import AssessedQuantity, Outcomes
from riser_soil.accuracy.refinements import RATIOS, Refinements
from riser_soil.accuracy.study_points import Factors, PointOutcome

MAX_CANCELLATION = 2.0  # largest sum of absolute error shares, over the target, of a setting that reaches it

Quantities = Mapping[str, AssessedQuantity]


@dataclass(frozen=True, eq=False)
class CostAndError:
    """Cost and error of settings, predicted by refinement series, for a target in the quantities."""

    refinements: Refinements
    outcomes: Outcomes
    quantities: Quantities
    target: float

    def settings(self) -> Iterator[Factors]:
        """All combinations of levels, with one more than were computed of each setting."""
        levels = [(*self._levels(n), self._next_level(n)) for n in range(len(self.refinements.settings))]
        return product(*levels)

    def error_ratio(self, point: Factors) -> float:
        """Largest ratio of the predicted error to the allowed one among the quantities.

        Errors of the settings are added without their signs.
        """
        ratios = (
            math.fsum(self._share(each, *at) for at in enumerate(point)) / each.allowed(self.target)
            for each in self.quantities.values()
        )
        return max(ratios, default=math.inf)

    def reached_by(self, outcome: PointOutcome) -> bool:
        """Whether a setting that was run reaches the target, and not by errors that happen to cancel."""
        results = outcome.key_results
        reached = all(
            key in results and each.error_of(results[key]) <= each.allowed(self.target)
            for key, each in self.quantities.items()
        )
        return outcome.done and reached and self.error_ratio(outcome.factors) <= MAX_CANCELLATION

    def seconds(self, point: Factors) -> float:
        """Predicted processor time of a point [s]."""
        base = self.outcomes[self.refinements.base].cpu
        return base * math.prod(self._cost(number, factor) for number, factor in enumerate(point))

    def _levels(self, number: int) -> list[float]:
        """Levels of one setting's refinement series that were computed, from coarse to fine."""
        points = zip(self.refinements.factors[number], self.refinements.along(number), strict=True)
        return [factor for factor, point in points if point in self.outcomes and self.outcomes[point].done]

    def _next_level(self, number: int) -> float:
        return self._levels(number)[-1] * RATIOS[self.refinements.settings[number].name]

    def _share(self, each: AssessedQuantity, number: int, factor: float) -> float:
        levels, order = each.by_level[number], each.limits[number].order
        if factor in levels:
            return each.share(number, factor)
        if factor < max(levels):
            return math.inf
        finest = max(levels)
        return each.share(number, finest) * (finest / factor) ** (order or 0.0)

    def _cost(self, number: int, factor: float) -> float:
        """Processor time at a level of one setting over that of the scene."""
        levels = self._levels(number)
        costs = [self.outcomes[self.refinements.point(number, each)].cpu for each in levels]
        base = self.outcomes[self.refinements.base].cpu
        if factor in levels:
            return costs[levels.index(factor)] / base
        growth = max(1.0, costs[-1] / costs[-2]) if len(costs) > 1 else factor / levels[-1]
        return growth * costs[-1] / base


def next_setting(predicted: CostAndError) -> Factors | None:
    """Cheapest setting that is predicted to reach the target at less cost than any run so far; None without one."""
    reached = cheapest(predicted)
    most = reached.cpu if reached is not None else math.inf
    candidates = [
        (predicted.seconds(point), point)
        for point in predicted.settings()
        if point not in predicted.outcomes and predicted.error_ratio(point) <= 1.0
    ]
    seconds, point = min(candidates, default=(math.inf, None))
    return point if seconds < most else None


def cheapest(predicted: CostAndError) -> PointOutcome | None:
    """The cheapest run that reaches the target; None where none does."""
    reaching = [outcome for outcome in predicted.outcomes.values() if predicted.reached_by(outcome)]
    return min(reaching, key=lambda outcome: outcome.cpu, default=None)
