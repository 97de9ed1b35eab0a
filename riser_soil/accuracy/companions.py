"""Companion of a run: the same scene, coarser or finer, taken in the same process without files, for its peaks."""

from __future__ import annotations

from typing import Any

from riser_soil.accuracy.element_sizes import CurveEnvelope
from riser_soil.assembly import Assembly, build, sized
from riser_soil.core.snapshot import Instant, instants_at
from riser_soil.core.system import Timer
from riser_soil.interruption import agreeing
from riser_soil.results.instants import InstantReader
from riser_soil.results.peaks import RunPeaks
from riser_soil.results.schedule import Schedule
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import Stage, StaticStage
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import StatelessObserver, lay, run_stage


def peaks_of(scene: Scene, comm: Any, envelope: CurveEnvelope | None = None) -> RunPeaks:
    """Peaks of a scene, computed without a results folder; collective, told on rank 0. Raises what a run would.

    envelope: follows moments and tensions along the riser, where that is wanted; on rank 0.
    """
    assembly, clock = build(sized(scene), comm), Timer.new()
    observer = PeakObserver(assembly, envelope)
    with agreeing(comm):
        before, _ = lay(assembly, clock)
        for stage in assembly.scene.stages:
            before = run_stage(assembly, stage, before, observer, clock)
    return observer.peaks


class PeakObserver(StatelessObserver):
    """Follows a companion: `peaks` has what the summary of a run would have of it; on rank 0."""

    def __init__(self, assembly: Assembly, envelope: CurveEnvelope | None = None) -> None:
        self._assembly, self._instants = assembly, InstantReader(assembly)
        output, soil = assembly.scene.output, assembly.soil
        self._schedule = Schedule(output.interval, output.xdmf_interval)
        self.peaks = RunPeaks(None if soil is None else soil.output_mesh())
        self._envelope = envelope

    def begin_stage(self, stage: Stage, stepper: TimeStepper) -> None:
        first = not self.peaks.stages
        self._schedule.begin_stage(stage.kind)
        self.peaks.begin_stage(stage.name, stage.kind, stage.end)
        if first and not isinstance(stage, StaticStage) and self._assembly.comm.rank == 0:
            self.peaks.stages[-1].update([0.0], self._seen(stepper))  # not followed: no shape that a step has found

    def record(self, stepper: TimeStepper, step: AcceptedStep, last: bool) -> None:
        """Of a committed step; collective where there is soil."""
        whole = self._assembly.recovered_soil() if self._schedule.due(step.t, last).pictures else None
        soil = None if whole is None else whole.output_fields()
        if self._assembly.comm.rank == 0:
            seen = self._seen(stepper)
            self.peaks.record([step.t], seen, soil)
            if self._envelope is not None and (last or self.peaks.stages[-1].kind != "static"):
                self._envelope.follow(instants_at(seen, 0))

    def relaxed(self, relaxed: object) -> None:
        pass

    def _seen(self, stepper: TimeStepper) -> Instant:
        return self._instants.told([self._instants.look(stepper)])
