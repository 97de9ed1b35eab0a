"""Cheapest settings that reach an accuracy: foretold from a study's ladders, then run.

Foretold errors are the sums of the knobs' own, whatever their signs, so that no setting is chosen for errors that
happen to cancel; foretold costs are products of the ladders' ratios. One rung beyond each ladder is foretold by the
observed order and by how the cost has grown.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import product

from riser_soil.accuracy.assessment import AssessedQuantity, Outcomes, worst
from riser_soil.accuracy.ladders import RATIOS, Ladders
from riser_soil.accuracy.study_points import Factors, PointOutcome

LUCK = 2.0  # times the target: what the knobs' errors of a setting that reaches it may add up to without their signs

Quantities = Mapping[str, AssessedQuantity]


@dataclass(frozen=True, eq=False)
class CostAndError:
    """What the ladders foretell of settings that are to meet a target in the quantities."""

    ladders: Ladders
    outcomes: Outcomes
    quantities: Quantities
    target: float

    def settings(self) -> Iterator[Factors]:
        """All combinations of rungs, with one beyond each ladder."""
        rungs = [(*self._rungs(n), self._beyond(n)) for n in range(len(self.ladders.knobs))]
        return product(*rungs)

    def excess(self, point: Factors) -> float:
        """Largest of the errors over what is allowed, those of the knobs added without their signs."""
        parts = (
            math.fsum(self._share(each, *at) for at in enumerate(point)) / each.allowed(self.target)
            for each in self.quantities.values()
        )
        return max(parts, default=math.inf)

    def reached_by(self, outcome: PointOutcome) -> bool:
        """Whether a setting that was run reaches the target, and not by errors that happen to cancel."""
        found = outcome.headlines
        missed = [
            key not in found or each.error_of(found[key]) > each.allowed(self.target)
            for key, each in self.quantities.items()
        ]
        return outcome.done and not any(missed) and self.excess(outcome.factors) <= LUCK

    def seconds(self, point: Factors) -> float:
        """Processor time [s]."""
        base = self.outcomes[self.ladders.base].cpu
        return base * math.prod(self._cost(number, factor) for number, factor in enumerate(point))

    def _rungs(self, number: int) -> list[float]:
        """Of one knob's ladder those that were computed."""
        points = zip(self.ladders.factors[number], self.ladders.along(number), strict=True)
        return [factor for factor, point in points if point in self.outcomes and self.outcomes[point].done]

    def _beyond(self, number: int) -> float:
        return self._rungs(number)[-1] * RATIOS[self.ladders.knobs[number].name]

    def _share(self, each: AssessedQuantity, number: int, factor: float) -> float:
        rungs, order = each.by_rung[number], each.limits[number].order
        if factor in rungs:
            return each.share(number, factor)
        if factor < max(rungs):
            return math.inf
        finest = max(rungs)
        return each.share(number, finest) * (finest / factor) ** (order or 0.0)

    def _cost(self, number: int, factor: float) -> float:
        """Over that of the scene."""
        rungs = self._rungs(number)
        costs = [self.outcomes[self.ladders.turned(number, each)].cpu for each in rungs]
        base = self.outcomes[self.ladders.base].cpu
        if factor in rungs:
            return costs[rungs.index(factor)] / base
        growth = max(1.0, costs[-1] / costs[-2]) if len(costs) > 1 else factor / rungs[-1]
        return growth * costs[-1] / base


def next_setting(foretold: CostAndError) -> Factors | None:
    """The cheapest setting not yet run that should reach the target at less than the cheapest that does."""
    reached = cheapest(foretold)
    most = reached.cpu if reached is not None else math.inf
    able = [
        (foretold.seconds(point), point)
        for point in foretold.settings()
        if point not in foretold.outcomes and foretold.excess(point) <= 1.0
    ]
    seconds, point = min(able, default=(math.inf, None))
    return point if seconds < most else None


def cheapest(foretold: CostAndError) -> PointOutcome | None:
    """Of the settings that have been run, the one that reaches the target at the least cost."""
    able = [outcome for outcome in foretold.outcomes.values() if foretold.reached_by(outcome)]
    return min(able, key=lambda outcome: outcome.cpu, default=None)


def pareto(outcomes: Outcomes, quantities: Quantities) -> list[PointOutcome]:
    """Points with an answer that none is both cheaper and better than, from cheap to dear."""
    front, least = [], math.inf
    for outcome in sorted((each for each in outcomes.values() if each.done), key=lambda each: each.cpu):
        error, _ = worst(quantities, outcome)
        if error < least:
            front.append(outcome)
            least = error
    return front
