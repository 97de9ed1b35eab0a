"""Study of a scene: the error of its key results against processor time, setting by setting."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from riser_soil.accuracy.cheapest_setting import next_setting
from riser_soil.accuracy.findings import TARGETS, Echo, Study
from riser_soil.accuracy.refinements import RATIOS, Refinements
from riser_soil.accuracy.study_files import write_files
from riser_soil.accuracy.study_points import POINTS
from riser_soil.errors import ResultsError, SceneError, SolveError, WriteError
from riser_soil.interruption import interrupted
from riser_soil.scene.scene import Scene
from riser_soil.variants.runs_folder import claimed
from riser_soil.variants.settings import HELPING, Setting, resolved, settings_of

TRIES = 3  # largest number of settings run for a target, each predicted to reach it
FINER = 2  # largest number of levels by which a scene that fails is refined
LEAST_LEVELS, MOST_LEVELS = 3, 9


def study(
    scene: Scene, folder: Path, *, settings: Sequence[str] = (), levels: int = 5, jobs: int = 1, force: bool = False,
    echo: Echo = print,
) -> Study:  # fmt: skip
    """Run a study and leave its files in a folder. A study that was interrupted is resumed.

    settings: names of those to vary, all of the scene's by default. levels: number in each refinement series. jobs:
    processes at a time for the finest points; the others, which are timed, run one at a time. force: discard earlier
    runs. Where the scene fails, the study is around one with more elements and shorter steps. Raises SceneError,
    ResultsError, and SolveError where those fail, too.
    """
    refinements = Refinements(resolved(scene), _chosen(scene, settings), levels)
    kept = f"call again to go on, {folder} keeps what was computed"
    with claimed(folder, POINTS, "a study") as runs:
        if force:
            shutil.rmtree(runs, ignore_errors=True)
        try:
            with interrupted(f"in a study; {kept}"):
                made = _around_what_runs(Study(refinements, folder, echo))
                _compute_refinements(made, jobs)
                _try_settings(made)
        except WriteError as err:
            raise WriteError(f"{err}; {kept}") from err
        write_files(made)
    return made


def _around_what_runs(made: Study) -> Study:
    """The study with its scene computed; where that fails, a study around a finer scene."""
    made.compute([made.refinements.base], 1)
    for _ in range(FINER):
        if made.scene.done or not any(setting.name in HELPING for setting in made.refinements.settings):
            break
        made = _finer(made)
    if made.scene.status == SceneError.exit_status:
        raise SceneError(made.scene.reason)
    if not made.scene.done:
        raise SolveError(f"the scene itself fails, and a study varies one that runs: {made.scene.reason}")
    return made


def _finer(made: Study) -> Study:
    """The study around a scene one level finer in elements and steps, with the same points in its terms."""
    step = tuple(RATIOS[setting.name] if setting.name in HELPING else 1.0 for setting in made.refinements.settings)
    refinements = Refinements(made.refinements.scene_at(step), made.refinements.settings, made.refinements.levels)
    finer = Study(refinements, made.folder, made.echo, failure=made.failure or made.scene.reason)
    for before in made.outcomes.values():
        factors = tuple(factor / ratio for factor, ratio in zip(before.factors, step, strict=True))
        finer.outcomes[factors] = replace(before, factors=factors)
    finer.compute([refinements.base], 1)
    return finer


def _chosen(scene: Scene, names: Sequence[str]) -> tuple[Setting, ...]:
    there = settings_of(scene)
    known = [setting.name for setting in there]
    for name in names:
        if name not in known:
            raise ResultsError(f"--setting {name}: the scene has no such setting; choose among {', '.join(known)}")
    return tuple(setting for setting in there if not names or setting.name in names)


def _compute_refinements(made: Study, jobs: int) -> None:
    """Compute the finest point of each series and the corner, which take longest, then the others one at a time."""
    refinements = made.refinements
    along = [refinements.along(number) for number in range(len(refinements.settings))]
    finest = [points[-1] for points in along]
    made.compute([*finest, *([refinements.corner] if refinements.corner is not None else [])], jobs)
    made.compute([point for points in along for point in points], 1)


def _try_settings(made: Study) -> None:
    """Run settings that are predicted to reach the targets at less cost than the runs so far."""
    for target in TARGETS:
        for _ in range(TRIES):
            point = next_setting(made.predicted(target))
            if point is None:
                break
            made.echo(f"expected to reach {target:.1%}:")
            made.compute([point], 1)
