"""Run of a scene: assembly, stages in turn, recorder."""

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path

from riser_soil.assembly import Assembly, build, sized
from riser_soil.assembly.packages import communicator_of
from riser_soil.checks.check import resolution, wave_theory
from riser_soil.checks.limits import announce, size_that_fits, tight, too_long
from riser_soil.checks.plausibility import physical_warnings, refuse_impossible
from riser_soil.core.part import State
from riser_soil.core.saved_state import Saved
from riser_soil.errors import Interruption, MemoryShortageError, SolveError
from riser_soil.interruption import agreeing, check, handling_signals, uninterrupted, unmasked
from riser_soil.results.checkpoint import last_checkpoint
from riser_soil.results.end_of_run import refuse_unfit
from riser_soil.results.functional_run import refuse_unfit_runs
from riser_soil.results.observer import Observer
from riser_soil.results.ownership import refuse_together
from riser_soil.results.peaks import RunPeaks
from riser_soil.results.run_clock import RunClock
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import Stage
from riser_soil.stages import lay, resume_stage, run_stage


def run(
    scene: Scene, folder: Path | str, force: bool = False, peaks: RunPeaks | None = None, restart: bool = False
) -> None:
    """Run a scene and leave its results in a folder; collective over all ranks.

    force: overwrite a finished run, or one with a checkpoint. peaks: gathered on the way, where they are wanted.
    restart: go on from the folder's last checkpoint, or begin where there is none.
    Raises SceneError or MeshError before anything is computed. After SolveError, MemoryShortageError and Interruption
    (Ctrl-C, SIGTERM) the folder keeps everything up to the last accepted step, after WriteError what went in; it is
    marked unfinished.
    """
    folder = Path(folder)
    with handling_signals():
        comm, clock, since = communicator_of(scene), RunClock(), time.perf_counter()
        refuse_together(folder, force, comm, goes_on=restart)
        saved = last_checkpoint(folder, scene, peaks is not None, comm) if restart else None
        scene = sized(scene)
        size = size_that_fits(scene, folder, comm)
        announce(size, comm)
        of_size = [*tight(size, comm), *too_long(size)]
        refuse_impossible(scene)
        assembly = build(scene, comm)
        if saved is None:
            refuse_unfit(assembly)
        if scene.code_check:
            refuse_unfit_runs(assembly)
        clock.add("build", since)
        lying = assembly.line_on_soil
        if comm.rank == 0:
            for line in (*wave_theory(assembly), *(resolution(lying) if lying is not None else ())):
                print(line)
        warnings = [*physical_warnings(assembly), *of_size]
        for warning in warnings if comm.rank == 0 else ():
            print(f"warning: {warning}")
        opened = Observer.open(assembly, clock, folder, force, peaks, saved is not None, warnings)
        with agreeing(comm), opened as observer:
            _solve_stages(assembly, observer, clock, saved)


def _solve_stages(assembly: Assembly, observer: Observer, clock: RunClock, saved: Saved | None) -> None:
    stages: Sequence[Stage] = assembly.scene.stages
    try:
        with unmasked():
            if saved is None:
                before = _begin(assembly, observer, clock)
            else:
                stages, before = _go_on(assembly, observer, clock, saved)
            for stage in stages:
                before = run_stage(assembly, stage, before, observer, clock, observer.checkpoint)
        with uninterrupted():
            observer.finish()
        check(assembly.comm)
    except (SolveError, MemoryShortageError, Interruption) as end:
        observer.record_last(end)
        raise


def _begin(assembly: Assembly, observer: Observer, clock: RunClock) -> State:
    before, laid = lay(assembly, clock)
    if laid is not None:
        observer.laid(assembly.slackest.slack, laid.steps, laid.relaxations)
    return before


def _go_on(assembly: Assembly, observer: Observer, clock: RunClock, saved: Saved) -> tuple[Sequence[Stage], State]:
    """Take the stage that was saved to its end; those that are left, and the state that they begin with."""
    stage, before = resume_stage(assembly, saved, observer, clock, observer.checkpoint)
    stages = assembly.scene.stages
    return stages[stages.index(stage) + 1 :], before
