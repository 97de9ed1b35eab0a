"""What a study has found: its points so far, and the errors, fronts and cheapest settings that follow from them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path

from riser_soil.accuracy.assessment import AssessedQuantity, assess, told, worst
from riser_soil.accuracy.cheapest import CostAndError, cheapest, pareto
from riser_soil.accuracy.ladders import Ladders
from riser_soil.accuracy.study_points import POINTS, Factors, PointOutcome, StudyPoint
from riser_soil.accuracy.workers import compute

TARGETS = (0.01, 0.001)

Says = Callable[[str], None]


@dataclass(eq=False)
class Study:
    """A study and all that it has found so far. The scene has numbers where it says auto.

    failure: why the user's own scene fails, where it does: the study's is a finer one then.
    """

    ladders: Ladders
    folder: Path
    says: Says
    outcomes: dict[Factors, PointOutcome] = field(default_factory=dict)
    failure: str = ""

    def compute(self, points: Iterable[Factors], jobs: int) -> None:
        """Compute points that are not there yet, `jobs` at a time."""
        wanted, place = [point for point in points if point not in self.outcomes], self.folder / POINTS
        runs = [StudyPoint(point, self.ladders.scene_at(point), place) for point in wanted]
        for outcome in compute(runs, jobs, self._tell):
            self.outcomes[outcome.factors] = outcome

    def _tell(self, outcome: PointOutcome, before: bool) -> None:
        how = f"{outcome.cpu:.3g} s" if outcome.done else f"failed: {outcome.reason}"
        self.says(f"{self.ladders.told(outcome.factors)}: {how}{', computed before' if before else ''}")

    @property
    def scene(self) -> PointOutcome:
        """The scene as it is."""
        return self.outcomes[self.ladders.base]

    def quantities(self) -> dict[str, AssessedQuantity]:
        return assess(self.ladders, self.outcomes)

    def judged(self) -> dict[str, AssessedQuantity]:
        """Those whose errors can be told."""
        return told(self.quantities())

    def foretold(self, target: float) -> CostAndError:
        return CostAndError(self.ladders, self.outcomes, self.judged(), target)

    def front(self) -> list[PointOutcome]:
        return pareto(self.outcomes, self.judged())

    def reaching(self, target: float) -> PointOutcome | None:
        """The cheapest setting run that reaches a relative error in all quantities judged, as far as can be told."""
        return cheapest(self.foretold(target))

    def error(self, outcome: PointOutcome) -> tuple[float, str]:
        """Largest relative error of a point, and its quantity."""
        return worst(self.judged(), outcome)
