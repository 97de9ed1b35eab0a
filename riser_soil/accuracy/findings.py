"""What a study has found: its points so far, and the errors, fronts and cheapest settings that follow from them.

Cheapest settings that reach an accuracy: foretold from a study's refinement series, then run.

Foretold errors are the sums of the settings' own, whatever their signs, so that no setting is chosen for errors that
happen to cancel; foretold costs are products of the refinement series' ratios. One level beyond each refinement series
is foretold by the observed order and by how the cost has grown.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import product
from pathlib import Path

from riser_soil.accuracy.assessment import AssessedQuantity, Outcomes, assess, with_known_error, worst
from riser_soil.accuracy.refinements import RATIOS, Refinements
from riser_soil.accuracy.study_points import POINTS, Factors, PointOutcome, StudyPoint, compute

TARGETS = (0.01, 0.001)

Says = Callable[[str], None]
LUCK = 2.0  # times the target: what the settings' errors of a setting that reaches it may add up to without their signs

Quantities = Mapping[str, AssessedQuantity]


@dataclass(frozen=True, eq=False)
class CostAndError:
    """What the refinement series foretell of settings that are to meet a target in the quantities."""

    refinements: Refinements
    outcomes: Outcomes
    quantities: Quantities
    target: float

    def settings(self) -> Iterator[Factors]:
        """All combinations of levels, with one beyond each refinement series."""
        levels = [(*self._levels(n), self._beyond(n)) for n in range(len(self.refinements.settings))]
        return product(*levels)

    def excess(self, point: Factors) -> float:
        """Largest over the quantities of the error to be expected over the allowed one; errors of the settings are
        added without their signs.
        """
        parts = (
            math.fsum(self._share(each, *at) for at in enumerate(point)) / each.allowed(self.target)
            for each in self.quantities.values()
        )
        return max(parts, default=math.inf)

    def reached_by(self, outcome: PointOutcome) -> bool:
        """Whether a setting that was run reaches the target, and not by errors that happen to cancel."""
        found = outcome.key_results
        missed = [
            key not in found or each.error_of(found[key]) > each.allowed(self.target)
            for key, each in self.quantities.items()
        ]
        return outcome.done and not any(missed) and self.excess(outcome.factors) <= LUCK

    def seconds(self, point: Factors) -> float:
        """Processor time [s]."""
        base = self.outcomes[self.refinements.base].cpu
        return base * math.prod(self._cost(number, factor) for number, factor in enumerate(point))

    def _levels(self, number: int) -> list[float]:
        """The levels of one setting's refinement series that were computed, from coarse to fine."""
        points = zip(self.refinements.factors[number], self.refinements.along(number), strict=True)
        return [factor for factor, point in points if point in self.outcomes and self.outcomes[point].done]

    def _beyond(self, number: int) -> float:
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
        costs = [self.outcomes[self.refinements.turned(number, each)].cpu for each in levels]
        base = self.outcomes[self.refinements.base].cpu
        if factor in levels:
            return costs[levels.index(factor)] / base
        growth = max(1.0, costs[-1] / costs[-2]) if len(costs) > 1 else factor / levels[-1]
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
    """The setting that reaches the target at the least cost, among those that have been run; None where none does."""
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


@dataclass(eq=False)
class Study:
    """A study and all that it has found so far. The scene has numbers where it says auto.

    failure: why the user's own scene fails, where it does: the study's is a finer one then.
    """

    refinements: Refinements
    folder: Path
    says: Says
    outcomes: dict[Factors, PointOutcome] = field(default_factory=dict)
    failure: str = ""

    def compute(self, points: Iterable[Factors], jobs: int) -> None:
        """Compute points that are not there yet, `jobs` at a time."""
        wanted, place = [point for point in points if point not in self.outcomes], self.folder / POINTS
        runs = [StudyPoint(point, self.refinements.scene_at(point), place) for point in wanted]
        for outcome in compute(runs, jobs, self._tell):
            self.outcomes[outcome.factors] = outcome

    def _tell(self, outcome: PointOutcome, before: bool) -> None:
        how = f"{outcome.cpu:.3g} s" if outcome.done else f"failed: {outcome.reason}"
        self.says(f"{self.refinements.in_words(outcome.factors)}: {how}{', computed before' if before else ''}")

    @property
    def scene(self) -> PointOutcome:
        """The scene as it is."""
        return self.outcomes[self.refinements.base]

    def quantities(self) -> dict[str, AssessedQuantity]:
        return assess(self.refinements, self.outcomes)

    def judged(self) -> dict[str, AssessedQuantity]:
        """Those whose errors can be told."""
        return with_known_error(self.quantities())

    def foretold(self, target: float) -> CostAndError:
        return CostAndError(self.refinements, self.outcomes, self.judged(), target)

    def front(self) -> list[PointOutcome]:
        return pareto(self.outcomes, self.judged())

    def reaching(self, target: float) -> PointOutcome | None:
        """The cheapest setting run that reaches a relative error in all quantities judged, as far as can be told."""
        return cheapest(self.foretold(target))

    def error(self, outcome: PointOutcome) -> tuple[float, str]:
        """Largest relative error of a point, and its quantity."""
        return worst(self.judged(), outcome)
