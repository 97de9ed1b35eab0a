"""State of a study: its points so far, and the errors, fronts and cheapest settings that follow from them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path

from riser_soil.accuracy.assessment import AssessedQuantity, Outcomes, assess, with_known_reference, worst
from riser_soil.accuracy.cheapest_setting import CostAndError, Quantities, cheapest
from riser_soil.accuracy.refinements import Refinements
from riser_soil.accuracy.study_points import POINTS, Factors, PointOutcome, compute

TARGETS = (0.01, 0.001)

Echo = Callable[[str], None]


def pareto(outcomes: Outcomes, quantities: Quantities) -> list[PointOutcome]:
    """Pareto front: points than which none is both cheaper and more accurate, from cheap to expensive."""
    front, least = [], math.inf
    for outcome in sorted((each for each in outcomes.values() if each.done), key=lambda each: each.cpu):
        error, _ = worst(quantities, outcome)
        if error < least:
            front.append(outcome)
            least = error
    return front


@dataclass(eq=False)
class Study:
    """A study and its points so far. Settings of the scene are numbers where the user's are auto.

    failure: why the user's own scene fails, where it does; the study's is a finer one then.
    """

    refinements: Refinements
    folder: Path
    echo: Echo
    outcomes: dict[Factors, PointOutcome] = field(default_factory=dict)
    failure: str = ""

    def compute(self, points: Iterable[Factors], jobs: int) -> None:
        """Compute points that have no outcome yet, `jobs` at a time."""
        scenes = {point: self.refinements.scene_at(point) for point in points if point not in self.outcomes}
        for outcome in compute(scenes, self.folder / POINTS, jobs, self._print):
            self.outcomes[outcome.factors] = outcome

    def _print(self, outcome: PointOutcome, before: bool) -> None:
        how = f"{outcome.cpu:.3g} s" if outcome.done else f"failed: {outcome.reason}"
        self.echo(f"{self.refinements.in_words(outcome.factors)}: {how}{', computed before' if before else ''}")

    @property
    def scene(self) -> PointOutcome:
        """Outcome of the scene as it is."""
        return self.outcomes[self.refinements.base]

    def quantities(self) -> dict[str, AssessedQuantity]:
        """All key results of the scene, assessed."""
        return assess(self.refinements, self.outcomes)

    def judged(self) -> dict[str, AssessedQuantity]:
        """Quantities whose errors can be judged."""
        return with_known_reference(self.quantities())

    def predicted(self, target: float) -> CostAndError:
        """Predicted cost and error of settings, for a target."""
        return CostAndError(self.refinements, self.outcomes, self.judged(), target)

    def front(self) -> list[PointOutcome]:
        """Pareto front of cost and error."""
        return pareto(self.outcomes, self.judged())

    def reaching(self, target: float) -> PointOutcome | None:
        """The cheapest point that reaches a relative error in all quantities judged; None where none does."""
        return cheapest(self.predicted(target))

    def error(self, outcome: PointOutcome) -> tuple[float, str]:
        """Largest relative error of a point, and the quantity that has it."""
        return worst(self.judged(), outcome)
