"""Study of a scene: the error of its headline quantities against processor time, knob by knob."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from riser_soil.accuracy.assessment import AssessedQuantity, assess, worst
from riser_soil.accuracy.cheapest import CostAndError, cheapest, next_setting, pareto
from riser_soil.accuracy.knobs import Knob, knobs_of, resolved
from riser_soil.accuracy.ladders import Ladders
from riser_soil.accuracy.study_points import POINTS, Factors, PointOutcome, StudyPoint
from riser_soil.accuracy.workers import compute
from riser_soil.errors import Interruption, ResultsError, SceneError, SolveError
from riser_soil.results.whole_file import refuse_file, unusable
from riser_soil.scene.scene import Scene

TARGETS = (0.01, 0.001)
TRIES = 3  # settings foretold to reach a target that are run
LEAST_RUNGS, MOST_RUNGS = 3, 9

Says = Callable[[str], None]


@dataclass(eq=False)
class Study:
    """A study and all that it has found so far. The scene has numbers where it says auto."""

    ladders: Ladders
    folder: Path
    says: Says
    outcomes: dict[Factors, PointOutcome] = field(default_factory=dict)

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

    def foretold(self) -> CostAndError:
        return CostAndError(self.ladders, self.outcomes, self.quantities())

    def front(self) -> list[PointOutcome]:
        return pareto(self.outcomes, self.quantities())

    def reaching(self, target: float) -> PointOutcome | None:
        """The cheapest setting run that reaches a relative error in all known quantities."""
        return cheapest(self.foretold(), target)

    def error(self, outcome: PointOutcome) -> tuple[float, str]:
        """Largest relative error of a point, and its quantity."""
        return worst(self.quantities(), outcome)


def study(
    scene: Scene, folder: Path, *, knobs: Sequence[str] = (), rungs: int = 5, jobs: int = 1, force: bool = False,
    says: Says = print,
) -> Study:  # fmt: skip
    """Run the study and leave its files in a folder; one that was interrupted goes on where it was.

    knobs: names of those to vary, all that the scene has by default. rungs: of each ladder. jobs: processes at a time
    for the finest points; the others, whose time counts, run one at a time. force: begin anew. Raises SceneError,
    ResultsError, and SolveError where the scene itself fails.
    """
    from riser_soil.accuracy.study_files import write_files

    refuse(folder, force)
    made = Study(Ladders(resolved(scene), _chosen(scene, knobs), rungs), folder, says)
    try:
        _compute_all(made, jobs)
        if made.scene.done:
            _try_settings(made)
    except Interruption as end:
        end.place = f"in a study; call again to go on, {folder} keeps {len(made.outcomes)} point(s) and more"
        raise
    if not made.scene.done:
        raise SolveError(f"the scene itself fails, and a study varies one that runs: {made.scene.reason}")
    write_files(made)
    return made


def refuse(folder: Path, force: bool) -> None:
    """Only an empty folder, or one with a study, takes a study; by force an earlier one's points are removed."""
    refuse_file(folder)
    there = [entry.name for entry in folder.iterdir()] if folder.is_dir() else []
    if there and POINTS not in there:
        raise SceneError(f"{folder}: holds something else than a study, {min(there)}; choose another with -o FOLDER")
    try:
        if force:
            shutil.rmtree(folder / POINTS, ignore_errors=True)
        (folder / POINTS).mkdir(parents=True, exist_ok=True)
    except OSError as err:
        raise unusable(folder, err) from err


def _chosen(scene: Scene, names: Sequence[str]) -> tuple[Knob, ...]:
    there = knobs_of(scene)
    known = [knob.name for knob in there]
    for name in names:
        if name not in known:
            raise ResultsError(f"--knob {name}: the scene has no such knob; choose among {', '.join(known)}")
    return tuple(knob for knob in there if not names or knob.name in names)


def _compute_all(made: Study, jobs: int) -> None:
    """The scene, then the finest of each ladder and the corner, which take longest, then the rest one at a time."""
    ladders = made.ladders
    made.compute([ladders.base], 1)
    if not made.scene.done:
        return
    along = [ladders.along(number) for number in range(len(ladders.knobs))]
    finest = [points[-1] for points in along]
    made.compute([*finest, *([ladders.corner] if ladders.corner is not None else [])], jobs)
    made.compute([point for points in along for point in points], 1)


def _try_settings(made: Study) -> None:
    """Run what should reach the targets at less cost than what has been run."""
    for target in TARGETS:
        for _ in range(TRIES):
            point = next_setting(made.foretold(), target)
            if point is None:
                break
            made.says(f"foretold to reach {target:.1%}:")
            made.compute([point], 1)
