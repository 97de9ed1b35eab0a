"""What a study has found: its points so far, and the errors, fronts and cheapest settings that follow from them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path

from riser_soil.accuracy.assessment import AssessedQuantity, Outcomes, assess, with_known_error, worst
from riser_soil.accuracy.cheapest_setting import CostAndError, Quantities, cheapest
from riser_soil.accuracy.refinements import Refinements
from riser_soil.accuracy.study_points import POINTS, Factors, PointOutcome, StudyPoint, compute

TARGETS = (0.01, 0.001)

Says = Callable[[str], None]


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
        wanted = [point for point in points if point not in self.outcomes]
        runs = [StudyPoint(point, self.refinements.scene_at(point)) for point in wanted]
        for outcome in compute(runs, self.folder / POINTS, jobs, self._tell):
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

    def predicted(self, target: float) -> CostAndError:
        """Cost and error to be expected of settings, for a target."""
        return CostAndError(self.refinements, self.outcomes, self.judged(), target)

    def front(self) -> list[PointOutcome]:
        return pareto(self.outcomes, self.judged())

    def reaching(self, target: float) -> PointOutcome | None:
        """The cheapest setting run that reaches a relative error in all quantities judged, as far as can be told."""
        return cheapest(self.predicted(target))

    def error(self, outcome: PointOutcome) -> tuple[float, str]:
        """Largest relative error of a point, and its quantity."""
        return worst(self.judged(), outcome)
