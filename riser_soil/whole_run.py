"""Run of a scene: assembly, stages in turn, recorder."""

from __future__ import annotations

import time
from pathlib import Path

from riser_soil.assembly import Assembly, build, sized
from riser_soil.assembly.packages import communicator_of
from riser_soil.checks.check import resolution
from riser_soil.checks.limits import size_that_fits, tell, tight, too_long
from riser_soil.checks.plausibility import physical_warnings
from riser_soil.core.system import Timer
from riser_soil.errors import Interruption, MemoryShortageError, SolveError
from riser_soil.interruption import agreeing, handling_signals, uninterrupted, unmasked
from riser_soil.results.observer import Observer
from riser_soil.results.ownership import refuse_together
from riser_soil.results.peaks import RunPeaks
from riser_soil.scene.scene import Scene
from riser_soil.stages import lay, run_stage


def run(scene: Scene, folder: Path | str, force: bool = False, peaks: RunPeaks | None = None) -> None:
    """Run a scene and leave its results in a folder; collective over all ranks.

    force: overwrite a finished run. peaks: gathered on the way, where they are wanted. Raises SceneError or MeshError
    before anything is computed. After SolveError, MemoryShortageError and Interruption (Ctrl-C, SIGTERM) the folder
    keeps everything up to the last accepted step, after WriteError what went in; it is marked unfinished.
    """
    folder = Path(folder)
    with handling_signals():
        comm, clock, since = communicator_of(scene), Timer.new(), time.perf_counter()
        refuse_together(folder, force, comm)
        scene = sized(scene)
        size = size_that_fits(scene, folder, comm)
        tell(size, comm)
        of_size = [*tight(size, comm), *too_long(size)]
        assembly = build(scene, comm)
        clock.add("build", since)
        if comm.rank == 0:
            for told in resolution(assembly):
                print(told)
        for warning in (*physical_warnings(assembly), *of_size):
            if comm.rank == 0:
                print(f"warning: {warning}")
        with agreeing(comm), Observer.open(assembly, clock, folder, force, peaks) as observer:
            _take_all(assembly, observer, clock)


def _take_all(assembly: Assembly, observer: Observer, clock: Timer) -> None:
    try:
        with unmasked():
            before, laid = lay(assembly, clock)
            if laid is not None:
                observer.laid(assembly.slack, laid.steps, laid.relaxations)
            for stage in assembly.scene.stages:
                before = run_stage(assembly, stage, before, observer, clock)
        with uninterrupted():
            observer.finish()
    except (SolveError, MemoryShortageError, Interruption) as end:
        observer.record_last(end)
        raise
