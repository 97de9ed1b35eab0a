"""Short runs of scenes, which leave their kernels compiled: those of several scenes at a time, in processes."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Mapping
from contextlib import closing
from dataclasses import replace
from pathlib import Path

from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import Stage, StaticStage
from riser_soil.variants.one_run import task
from riser_soil.variants.pool import Workers, outcomes
from riser_soil.variants.runs_folder import Outcome, prepare_attempts
from riser_soil.variants.variant import variant_of

STEPS, AUTO_STEP = 2, 0.1  # steps of each time stage; step [s] where steps choose their size


def compile_kernels(scenes: Mapping[str, Scene], jobs: int) -> Iterator[Outcome]:
    """Run scenes, by names, for a few steps, so many at a time, in a folder that is removed; outcomes, by names too."""
    names = {f"{n}": name for n, name in enumerate(scenes)}
    with tempfile.TemporaryDirectory(prefix="riser_soil-") as folder:
        runs = Path(folder) / "runs"
        alone = min(jobs, len(names)) == 1
        tasks = [task(n, variant_of(shortened(scenes[name])), runs, alone=alone) for n, name in names.items()]
        with closing(outcomes(tasks, Workers(jobs), lambda: prepare_attempts(runs))) as results:
            for outcome in results:
                yield replace(outcome, name=names[outcome.name])


def shortened(scene: Scene) -> Scene:
    """The scene with time stages of a few steps, without a search for an accuracy."""
    return scene.model_copy(update={"stages": tuple(map(_short, scene.stages)), "accuracy": None})


def _short(stage: Stage) -> Stage:
    if isinstance(stage, StaticStage):
        return stage
    step = AUTO_STEP if stage.time_step == "auto" else stage.time_step
    return stage.model_copy(update={"duration": min(stage.duration, STEPS * step)})
