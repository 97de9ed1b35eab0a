"""Observer of a run: reads the parts' states on all ranks after each step, and passes them to the recorder.

Steps are buffered, as the values of riser and contact are computed for many steps together (`step_buffer`).
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, nullcontext
from pathlib import Path

import numpy as np

from riser_soil.assembly import Assembly
from riser_soil.checks.inventory import inventory
from riser_soil.core.communicator import raised_on_all_ranks
from riser_soil.core.part import Energy
from riser_soil.core.saved_state import Saved, Stateful, gathered, restore_all
from riser_soil.core.snapshot import SoilSnapshot, StepRecord, StepStatistics, stacked
from riser_soil.errors import Interruption, MemoryShortageError, SolveError
from riser_soil.interruption import uninterrupted
from riser_soil.results.bodies_and_joints_figures import bodies_and_joints_reader, bodies_and_joints_values
from riser_soil.results.checkpoint import RunCheckpoints
from riser_soil.results.energy_ledger import EnergyLedger
from riser_soil.results.functional_run import line_checks
from riser_soil.results.instants import InstantReader
from riser_soil.results.peaks import RunPeaks
from riser_soil.results.plausibility_checks import PlausibilityChecks
from riser_soil.results.record import Keeping, Recorder
from riser_soil.results.run_clock import RunClock
from riser_soil.results.run_facts import facts_of, known_fields
from riser_soil.results.schedule import Schedule
from riser_soil.results.screen import Progress, print_summary
from riser_soil.results.step_buffer import BufferedStep, StepBuffer
from riser_soil.scene.dump import dump_scene
from riser_soil.scene.stages import DynamicStage, Stage, StaticStage
from riser_soil.solve.dynamic_relaxation import RelaxationResult
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper


class Observer:
    """Observer of a run: progress bar, energy ledger, files, and peaks where wanted. recorder: None off rank 0."""

    def __init__(
        self,
        assembly: Assembly,
        clock: RunClock,
        recorder: Recorder | None,
        progress: Progress,
        peaks: RunPeaks | None = None,
    ) -> None:
        self._assembly, self._clock, self._recorder, self._progress = assembly, clock, recorder, progress
        self._peaks = peaks if recorder is not None else None
        output = assembly.scene.output
        self._schedule = Schedule(output.interval, output.xdmf_interval)
        lines, fields = assembly.lines, known_fields(assembly)
        checks = {name: line_checks(line, name) for name, line in lines.items()} if recorder is not None else {}
        self._instants = {name: InstantReader(line, fields[name], checks.get(name)) for name, line in lines.items()}
        self._bodies_and_joints = bodies_and_joints_reader(assembly)
        self._buffer = StepBuffer()
        self._plausibility = PlausibilityChecks(assembly, self._bodies_and_joints)
        self._inventory = inventory(assembly)
        self._checkpoints = RunCheckpoints(assembly, recorder)

    @classmethod
    @contextmanager
    def open(
        cls,
        assembly: Assembly,
        clock: RunClock,
        folder: Path,
        force: bool,
        peaks: RunPeaks | None = None,
        goes_on: bool = False,
        warnings: Sequence[str] = (),
    ) -> Iterator[Observer]:
        """Open the run's folder for its results; collective. What was written stays when the block is left early.

        goes_on: whether to append to the files that are there, after what is restored. warnings: those printed before
        the first step, for the summary.
        """
        mesh = assembly.soil.whole.output_mesh() if assembly.soil is not None else None
        facts = facts_of(assembly, warnings)
        with Progress(enabled=assembly.comm.rank == 0) as progress:
            recorder = None
            with raised_on_all_ranks(assembly.comm), uninterrupted():
                if assembly.comm.rank == 0:
                    text, fields = dump_scene(assembly.scene), known_fields(assembly)
                    settings = assembly.scene.output.checkpoint
                    keeping = Keeping(goes_on, end=settings is not None and settings.keep)
                    arcs = {name: line.line.arc for name, line in assembly.lines.items()}
                    reader = bodies_and_joints_reader(assembly)
                    more = {} if reader is None else reader.variables
                    recorder = Recorder.open(folder, facts, arcs, mesh, text, fields, force, keeping, more)
            with recorder or nullcontext():
                observer = cls(assembly, clock, recorder, progress, peaks)
                try:
                    yield observer
                finally:
                    with uninterrupted():
                        observer.flush()

    def begin_stage(self, stage: Stage, stepper: TimeStepper) -> None:
        """Begin a stage; collective. stepper: at its beginning."""
        self._enter(stage, stepper.energy)
        if self._recorder is not None:
            automatic = isinstance(stage, DynamicStage) and stage.time_step == "auto"
            self._recorder.begin_stage(stage.name, stage.kind, automatic)
        if self._peaks is not None:
            self._peaks.begin_stage(stage.name, stage.kind, stage.end, self._instants)
        if stage is self._assembly.scene.stages[0] and not isinstance(stage, StaticStage):
            self._record_start(stepper)
        self._show_progress(stage)

    def _enter(self, stage: Stage, start: Energy) -> None:
        """Prepare ledger, readers and checks for a stage. start: energy stored at its beginning."""
        static = not isinstance(stage, DynamicStage)
        self._stage = stage
        self._schedule.begin_stage(stage.kind)
        self._balance = EnergyLedger(start, static, self._inventory.dissipating, self._inventory.working)
        self._relaxed = 0
        for reader in self._instants.values():
            reader.begin_stage(stage.name)
        self._plausibility.begin_stage(stage)

    def _show_progress(self, stage: Stage) -> None:
        self._progress.begin_stage(stage.name, stage.kind, stage.end)

    def _record_start(self, stepper: TimeStepper) -> None:
        """Record the state before all stages, where no static stage comes first."""
        soil = self._soil()
        if self._recorder is not None:
            records = {name: reader.record_of([reader.copy(stepper)]) for name, reader in self._instants.items()}
            bodies_and_joints = bodies_and_joints_values(self._bodies_and_joints, stepper.now)
            self._recorder.begin_at(records, soil, stacked([bodies_and_joints]))
            if self._peaks is not None:
                self._peaks.record([0.0], records)

    def record(self, stepper: TimeStepper, step: AcceptedStep, last: bool) -> None:
        """Put an accepted step into the buffer, and write the buffer where it is full; collective."""
        since = time.perf_counter()
        due = self._schedule.due(step.t, last)
        # Relaxation, in statics, commits states that are no steps: the soil must be known before it.
        soil = self._soil() if due.pictures or not isinstance(self._stage, DynamicStage) else None
        change = self._balance.add(stepper.energy, step)
        self._progress.update(step.t, step.dt, step.solution.iterations)
        if last:
            self._plausibility.measure_soil_boundary()
        if self._recorder is not None:
            iterations = step.solution.iterations + self._relaxed
            health = StepStatistics(iterations, step.dt, change, step.cuts, stepper.local_error)
            record = StepRecord(step.t, health, self._balance.ledger)
            at_rest = due.series and isinstance(self._stage, StaticStage)
            lines = {name: reader.copy(stepper, at_rest) for name, reader in self._instants.items()}
            bodies_and_joints = bodies_and_joints_values(self._bodies_and_joints, stepper.now)
            pressed = self._plausibility.pressed_soil(stepper.now) if due.series else None
            self._buffer.add(BufferedStep(record, due, lines, bodies_and_joints, pressed, soil))
            static = isinstance(self._stage, StaticStage)
            if last or static or self._buffer.full or self._recorder.flush_is_due:
                self.flush()
        self._relaxed = 0
        self._clock.add("output", since)

    def flush(self) -> None:
        """Pass all buffered steps to the recorder, the peaks and the checks of plausibility."""
        steps, recorder = self._buffer.emptied(), self._recorder
        if not steps or recorder is None or recorder.closed:
            return
        made, pictured = [each.record for each in steps], any(each.due.pictures for each in steps)
        copies = {name: [each.lines[name] for each in steps] for name in self._instants}
        records = {name: reader.record_of(copies[name], misfits=pictured) for name, reader in self._instants.items()}
        bodies_and_joints = stacked([each.bodies_and_joints for each in steps])
        recorder.accept(made, [each.due for each in steps], records, steps[-1].soil, bodies_and_joints)
        if self._peaks is not None:
            self._peaks.record([step.t for step in made], records)
        times = np.array([recorder.time_at(step.t) for step in made])
        self._plausibility.check(steps, times, records, recorder.summary.stages[-1])

    def checkpoint(self, gather: Callable[[], Saved], last: bool, leaving: bool) -> None:
        """Write the state after a recorded step, where a checkpoint is due; collective.

        gather: this rank's state. last: of its stage; leaving: before its time.
        """
        ends_run = last and self._stage is self._assembly.scene.stages[-1]
        if self._checkpoints.due(last, ends_run, leaving):
            since = time.perf_counter()
            self._checkpoints.write(gather, self._stage.name if last else None)
            self._clock.add("checkpoints", since)

    def record_last(self, end: SolveError | MemoryShortageError | Interruption) -> None:
        """Write the last accepted step of a run that ends before its time; collective where the ranks end together."""
        together = self._assembly.comm.size == 1 or not isinstance(end, Interruption) or end.together
        with uninterrupted():
            self.flush()
            soil = self._soil() if together else None
            if self._recorder is not None:
                self._recorder.summary.processor_seconds = self._clock.processor_seconds
                self._recorder.record_last(soil)
                if isinstance(end, Interruption):
                    end.place = self._recorder.reached

    def _soil(self) -> SoilSnapshot | None:
        """Fields of the soil; collective where there is soil."""
        soil = self._assembly.soil
        return None if soil is None else soil.recovered().output_fields()

    def laid(self, slack: float, steps: int, relaxations: int) -> None:
        """Record that a slack or steep riser's end was moved to its place, from `slack` [m] beyond it."""
        if self._recorder is not None:
            self._recorder.summary.laying = {"slack": slack, "load_steps": steps, "relaxations": relaxations}
            helped = f" and {relaxations} dynamic relaxation(s)" if relaxations else ""
            if not slack:
                print(f"joints closed, and bodies came to rest, in {steps} step(s)")
                return
            print(f"the riser is slack: laid {slack:.4g} m too far, its end came back in {steps} step(s){helped}")

    def relaxed(self, relaxed: RelaxationResult) -> None:
        """Record that dynamic relaxation, or settling, was needed; its Newton iterations count with the next step."""
        self._relaxed += relaxed.iterations
        if self._recorder is None:
            return
        tally, iterations = self._recorder.summary.stages[-1], f"{relaxed.iterations} Newton iterations"
        if relaxed.sunk:
            tally.settlings += 1
            print(f"the clay as it was did not bear the riser, which settled by {relaxed.sunk:.3g} m in {iterations}")
            return
        tally.relaxations += 1
        tally.branch_switches += relaxed.branch_switches
        print(f"dynamic relaxation was needed; it took {iterations}, counted with the next step")
        if relaxed.branch_switches:
            print(f"it left {relaxed.branch_switches} unstable equilibrium(s) in the mode of buckling")

    def finish(self) -> None:
        if self._recorder is not None:
            self._recorder.add_seconds(self._clock.seconds)
            self._recorder.summary.processor_seconds = self._clock.processor_seconds
            self._recorder.finish()
            print_summary(self._recorder.summary.as_dict())

    def state(self) -> Saved:
        """State to resume from, after the buffer is written."""
        self.flush()
        stage = self._assembly.scene.stages.index(self._stage)
        return gathered(self._owners) | {"stage": np.array(stage), "relaxed": np.array(self._relaxed)}

    def restore(self, saved: Saved) -> None:
        """Resume the stage from where it was saved."""
        self._enter(self._assembly.scene.stages[int(saved["stage"])], Energy())
        restore_all(self._owners, saved)
        self._relaxed = int(saved["relaxed"])
        self._show_progress(self._stage)
        if self._recorder is not None:
            print(f"the run goes on {self._recorder.place}")

    @property
    def _owners(self) -> dict[str, Stateful]:
        owners: dict[str, Stateful] = {} if self._recorder is None else {"recorder": self._recorder}
        owners |= {} if self._peaks is None else {"peaks": self._peaks}
        owners |= {"schedule": self._schedule, "ledger": self._balance}
        owners |= {f"instants/{name}" if name else "instants": reader for name, reader in self._instants.items()}
        return owners | self._plausibility.owners
