"""Peaks of a variant that is solved in this process, without a results folder."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from riser_soil.assembly import Assembly, build, sized
from riser_soil.core.snapshot import Record, Records, SoilSnapshot, stacked
from riser_soil.results.bodies_and_joints_figures import bodies_and_joints_reader, bodies_and_joints_values
from riser_soil.results.instants import InstantReader
from riser_soil.results.peaks import RunPeaks
from riser_soil.results.schedule import Schedule
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import Stage, StaticStage
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import StatelessObserver, solve_stages

OnRecord = Callable[[str, Record], None]
"""Called on the first rank with a line's name and state, after the last step of static stages, each step of others."""


def peaks_of(scene: Scene, comm: Any, on_record: OnRecord | None = None) -> RunPeaks:
    """Peaks of a scene, on the first rank; collective. Raises the errors of a run."""
    assembly = build(sized(scene), comm)
    observer = _PeakObserver(assembly, on_record)
    solve_stages(assembly, observer)
    return observer.peaks


class _PeakObserver(StatelessObserver):
    """Gathers peaks as the observer of a run does."""

    def __init__(self, assembly: Assembly, on_record: OnRecord | None) -> None:
        self._assembly, self._on_record = assembly, on_record
        self._readers = {line: InstantReader(own) for line, own in assembly.lines.items()}
        self._bodies_and_joints = bodies_and_joints_reader(assembly)
        output, soil = assembly.scene.output, assembly.soil
        self._schedule = Schedule(output.interval, output.xdmf_interval)
        self.peaks = RunPeaks(None if soil is None else soil.whole.output_mesh(), assembly.name_on_soil)

    def begin_stage(self, stage: Stage, stepper: TimeStepper) -> None:
        first = not self.peaks.stages
        self._schedule.begin_stage(stage.kind)
        self.peaks.begin_stage(stage.name, stage.kind, stage.end, self._readers)
        if first and not isinstance(stage, StaticStage) and self._assembly.comm.rank == 0:
            self._record(0.0, stepper)

    def record(self, stepper: TimeStepper, step: AcceptedStep, last: bool) -> None:
        """Record an accepted step; collective where there is soil."""
        known = self._assembly.soil if self._schedule.due(step.t, last).pictures else None
        soil = None if known is None else known.recovered().output_fields()
        if self._assembly.comm.rank == 0:
            records = self._record(step.t, stepper, soil)
            if self._on_record is not None and (last or not isinstance(self._assembly.stage, StaticStage)):
                for line, record in records.items():
                    self._on_record(line, record.at(0))

    def _record(self, t: float, stepper: TimeStepper, soil: SoilSnapshot | None = None) -> Records:
        records = {line: reader.record_of([reader.copy(stepper)]) for line, reader in self._readers.items()}
        bodies_and_joints = bodies_and_joints_values(self._bodies_and_joints, stepper.now)
        self.peaks.record([t], records, soil, stacked([bodies_and_joints]))
        return records
