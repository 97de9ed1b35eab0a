"""The recorder: writes every accepted step to the run's folder. Lives on one rank only."""

from __future__ import annotations

import shlex
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Self

from riser_soil.core import outputs
from riser_soil.core.arrays import Array
from riser_soil.core.saved_state import Saved, Stateful, gathered, restore_all
from riser_soil.core.snapshot import Records, RunFacts, SoilMesh, SoilSnapshot, StepRecord
from riser_soil.errors import SceneError, WriteError
from riser_soil.results import folder as run_folder
from riser_soil.results.checkpoint_file import About, write_checkpoint
from riser_soil.results.folder import FolderLock
from riser_soil.results.netcdf import SeriesFile, ledger_variables, series_rows, step_rows
from riser_soil.results.netcdf_layout import Variable
from riser_soil.results.ownership import prepare, sealed
from riser_soil.results.run_frames import RunFrames
from riser_soil.results.schedule import DueOutputs
from riser_soil.results.stage_tally import StageTally
from riser_soil.results.summary import Summary
from riser_soil.results.tallies import Tallies

# A killed run loses this much wall time of results [s]; more where flushing would take more than this share.
_FLUSH_EVERY, _FLUSH_SHARE = 1.0, 0.02
_LASTING_SHARE = 0.01  # of what waits for the disk itself, and is computed again after a checkpoint
# What waits in memory for its turn on disk [bytes]: at most so much, whatever the share; about so much for each step.
_MOST_WAITING, _STEP = 1 << 24, 2000


@dataclass(frozen=True)
class Keeping:
    """goes_on: from the folder's checkpoint. end: whether a finished run keeps the state at its end as a checkpoint."""

    goes_on: bool = False
    end: bool = False


@dataclass
class LastState:
    """The last recorded state, one instant as if of many, and the files that it has been written to."""

    records: Records
    bodies_and_joints: Mapping[str, Array]
    soil: SoilSnapshot | None
    written: DueOutputs
    stamp: float = 0.0  # s, of its record in the series


class Recorder:
    """Owner of everything in the run's folder. Use `open`, in a `with` statement, and `finish` at the end.

    A run that leaves the `with` statement without `finish`, or is killed, keeps its results as unfinished; in the first
    case up to the last accepted step. Raises WriteError where the disk takes no more.
    """

    def __init__(
        self,
        lock: FolderLock,
        folder: Path,
        facts: RunFacts,
        arcs: Mapping[str, Array],
        soil_mesh: SoilMesh | None,
        fields: Mapping[str, tuple[str, ...]],
        keeping: Keeping,
        bodies_and_joints: Mapping[str, Variable],
    ) -> None:
        self._tallies, self._keeping = Tallies(facts, [*arcs], soil_mesh), keeping
        self._lock, self._folder = lock, folder
        self._fields = fields
        unrecorded = {line: outputs.unrecorded(wanted) for line, wanted in fields.items()}
        self._ledger = ledger_variables(facts.dissipating, facts.working)
        self._series = SeriesFile(
            folder / run_folder.SERIES,
            arcs,
            facts.title,
            facts.version,
            unrecorded=unrecorded,
            ledger=self._ledger,
            sections=facts.sections,
            offsets=facts.offsets,
            goes_on=keeping.goes_on,
            more=bodies_and_joints,
        )
        nodes = {name: arc.size for name, arc in arcs.items()}
        self._frames = RunFrames(folder, nodes, soil_mesh, fields, keeping.goes_on)
        self._lasting, self._resumable, self._untouched = False, keeping.goes_on, keeping.goes_on
        self._last: LastState | None = None
        self._next_flush = 0.0
        self._waiting = 0
        self._closed = False

    @classmethod
    def open(
        cls,
        folder: Path,
        facts: RunFacts,
        arcs: Mapping[str, Array],
        soil_mesh: SoilMesh | None,
        scene_text: str,
        fields: Mapping[str, tuple[str, ...]] | None = None,
        force: bool = False,
        keeping: Keeping | None = None,
        bodies_and_joints: Mapping[str, Variable] | None = None,
    ) -> Self:
        """Takes the folder over, until it is closed, and lays the files out.

        arcs: (nn,) m, by the name of the line, "" of the only one. scene_text: the resolved scene, kept as scene.yaml.
        fields: of `outputs.choices()`, by line; None for all. bodies_and_joints: what is recorded of them, by path.
        Raises SceneError for an unknown field and for a folder that the run may not have (see `ownership`). A run that
        goes on is to be restored next.
        """
        wanted = _check_fields(dict.fromkeys(arcs, outputs.choices()) if fields is None else fields)
        keeping = keeping or Keeping()
        lock = prepare(folder, force, keeping.goes_on)
        try:
            with _reported_when_full(folder):
                run_folder.write_atomically(folder / run_folder.SCENE, sealed(scene_text))
                recorder = cls(lock, folder, facts, arcs, soil_mesh, wanted, keeping, bodies_and_joints or {})
                if not keeping.goes_on:
                    recorder.flush()
        except BaseException:
            lock.release()
            raise
        return recorder

    @property
    def summary(self) -> Summary:
        """Summary of the stages so far."""
        return self._tallies.summary

    @property
    def closed(self) -> bool:
        """Whether nothing more is written."""
        return self._closed

    @property
    def reached(self) -> str:
        """Progress of the run, for the message of a run that ends early."""
        if self.summary.finished:
            return f"after the last stage; {self._folder} has the whole run"
        if self._untouched:
            return f"before it went on; {self._folder} is as it was{self._way_on}"
        stages = [stage for stage in self.summary.stages if stage.steps]
        if not stages:
            return f"before the first step; {self._folder} holds no results yet"
        return f"{_place(stages[-1])}; {self._folder} has the results up to there, marked unfinished{self._way_on}"

    @property
    def place(self) -> str:
        """Stage and time of the last accepted step."""
        return _place(self.summary.stages[-1])

    @property
    def _way_on(self) -> str:
        """End of a message: the command that goes on from the last checkpoint."""
        if not self._resumable:
            return ""
        folder, scene = shlex.quote(str(self._folder)), shlex.quote(str(self._folder / run_folder.SCENE))
        return f"; go on with: riser-soil run {scene} -o {folder} --restart"

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def begin_stage(self, name: str, kind: str, automatic: bool = False) -> None:
        """kind: `static`, `quasi-static` or `dynamic`. automatic: whether the time steps are.

        Extremes of a stage along t include the state that it begins with.
        """
        if self.summary.stages:
            self.flush()
        self._tallies.begin_stage(name, kind, automatic)
        self._series.begin_stage(name)

    def begin_at(
        self, records: Records, soil: SoilSnapshot | None = None, bodies_and_joints: Mapping[str, Array] | None = None
    ) -> None:
        """The state that the run begins with, where its first stage is not static: recorded at time zero.

        records, bodies_and_joints: of one instant, as if of many.
        """
        stamp = self._tallies.begin_at(records)
        due = [DueOutputs(series=True, pictures=True)]
        self._record(records, bodies_and_joints or {}, due, [stamp], soil)

    def accept(
        self,
        steps: Sequence[StepRecord],
        due: Sequence[DueOutputs],
        records: Records,
        soil: SoilSnapshot | None = None,
        bodies_and_joints: Mapping[str, Array] | None = None,
    ) -> None:
        """Record accepted steps of the present stage, in turn.

        records: at the steps' ends. soil: at the last of them; needed where there is a soil mesh and pictures are due,
        for no other step then. bodies_and_joints: their values at the instants, by path.
        """
        bodies_and_joints = bodies_and_joints or {}
        times, stamps = self._tallies.accept(steps, due, records, bodies_and_joints)
        self._series.steps({"step_time": times} | step_rows(steps, self._ledger))
        self._waiting += _STEP * len(steps)
        self._record(records, bodies_and_joints, due, stamps, soil)
        if self.flush_is_due or self._waiting > _MOST_WAITING:
            self.flush()

    @property
    def flush_is_due(self) -> bool:
        """Whether accepted steps are to be written to disk now."""
        return time.monotonic() > self._next_flush

    def time_at(self, t: float) -> float:
        """Time of the run [s] at a time of the present stage; in a static stage its load factor."""
        return self._tallies.time_at(t)

    def record_last(self, soil: SoilSnapshot | None = None) -> None:
        """Writes the last accepted step to all that it has not been written to: the run ends before its time.

        soil: at that step; where it is missing, and there is a soil mesh, there is no picture.
        """
        last = self._last
        if last is None or self._closed:
            return
        soil = last.soil or soil
        drawable = self._frames.drawable(soil)
        if not last.written.series:
            due = [DueOutputs(series=True, pictures=drawable)]
            self._record(last.records, last.bodies_and_joints, due, [self._tallies.stamp()], soil)
        elif drawable and not last.written.pictures:
            self._picture(last.stamp, series_rows([last.stamp], last.records, self._fields), 0, soil)
            last.written = DueOutputs(series=True, pictures=True)

    def add_seconds(self, seconds: Mapping[str, float]) -> None:
        """Adds wall time [s] to the named parts of the run."""
        self.summary.seconds.update(seconds)

    def flush(self) -> None:
        """Writes all records so far to disk: the frames, the series that gives their number, the summary.

        Nothing before a run that goes on has been restored: its files have more than is known here.
        """
        if self._untouched:
            return
        start = time.monotonic()
        with self._reported_when_full():
            self._frames.flush()
            self._series.flush(self.summary.finished)
            self.summary.write(self._folder / run_folder.SUMMARY, self._lasting)
        self._waiting = 0
        now, share = time.monotonic(), _LASTING_SHARE if self._lasting else _FLUSH_SHARE
        self._next_flush = now + max(_FLUSH_EVERY, (now - start) / share)

    def checkpoint(self, about: About, shares: Sequence[Saved]) -> None:
        """Keeps the run's state after the last accepted step. From the first one on, files outlast a power loss.

        shares: of each rank. The files have all that belongs to that state before it is kept.
        """
        self._outlast_power()
        self.flush()
        with self._reported_when_full():
            write_checkpoint(self._folder / run_folder.CHECKPOINT, about, shares)
        self._resumable = True

    def _outlast_power(self) -> None:
        if not self._lasting:
            self._lasting = True
            with self._reported_when_full():
                self._frames.outlast_power()
                self._series.outlast_power()
                run_folder.synchronise(self._folder / run_folder.SCENE)

    def _reported_when_full(self) -> AbstractContextManager[None]:
        return _reported_when_full(self._folder, self._let_go, self._way_on)

    def finish(self) -> None:
        """Marks the run finished; nothing may be added afterwards."""
        self.summary.finished = True
        self.close()

    def close(self) -> None:
        """Brings the rest to disk and gives the folder free. Does nothing the second time."""
        if self._closed:
            return
        try:
            if not self.summary.finished:
                self.record_last()
            self.flush()
            if self.summary.finished and not self._keeping.end:
                (self._folder / run_folder.CHECKPOINT).unlink(missing_ok=True)
        finally:
            self._let_go()

    def _let_go(self) -> None:
        """Close all files without writing: what can't be written once is not tried again."""
        if self._closed:
            return
        self._closed = True
        self._frames.close()
        self._series.close()
        self._lock.release()

    def _record(
        self,
        records: Records,
        bodies_and_joints: Mapping[str, Array],
        due: Sequence[DueOutputs],
        stamps: Sequence[float],
        soil: SoilSnapshot | None,
    ) -> None:
        """stamps: of those whose series is due."""
        last = {line: record.at(slice(-1, None)) for line, record in records.items()}
        last_values = {path: values[-1:] for path, values in bodies_and_joints.items()}
        self._last = LastState(last, last_values, soil, due[-1], stamps[-1] if due[-1].series else 0.0)
        recorded = [n for n, wanted in enumerate(due) if wanted.series]
        if not recorded:
            return
        if len(recorded) < len(due):
            records = {line: record.at(recorded) for line, record in records.items()}
            bodies_and_joints = {path: values[recorded] for path, values in bodies_and_joints.items()}
        rows = series_rows(stamps, records, self._fields) | dict(bodies_and_joints)
        self._waiting += self._series.row_size * len(recorded)
        self._series.record(rows)
        for row, n in enumerate(recorded):
            if due[n].pictures:
                self._picture(stamps[row], rows, row, soil)

    def _picture(self, stamp: float, rows: Mapping[str, Array], row: int, soil: SoilSnapshot | None) -> None:
        self._waiting += self._frames.add(stamp, rows, row, soil)
        self._tallies.picture(soil)

    def state(self) -> Saved:
        """State to resume from: tallies, and how much has been written; files stay in the folder."""
        return gathered(self._owners)

    def restore(self, saved: Saved) -> None:
        with self._reported_when_full():
            restore_all(self._owners, saved)
        self._untouched = False
        if self._keeping.goes_on:
            self._outlast_power()

    @property
    def _owners(self) -> dict[str, Stateful]:
        owners: dict[str, Stateful] = {"tallies": self._tallies, "series": self._series}
        return owners | self._frames.owners


@contextmanager
def _reported_when_full(folder: Path, then: Callable[[], None] | None = None, way_on: str = "") -> Iterator[None]:
    """Raises WriteError for what the disk did not take, when `then` is done. way_on: the end of the message."""
    try:
        yield
    except OSError as err:
        if then is not None:
            then()
        raise WriteError(
            f"{err.filename or folder}: cannot be written: {err.strerror or err}; the run ends here, and its files are "
            f"whole up to what went in before: make room, or choose another folder (-o){way_on}"
        ) from err


def _check_fields(fields: Mapping[str, tuple[str, ...]]) -> Mapping[str, tuple[str, ...]]:
    allowed = outputs.choices()
    unknown = [name for wanted in fields.values() for name in wanted if name not in (*allowed, "position")]
    if unknown:
        raise SceneError(f'output.fields: "{unknown[0]}" is not a field; allowed: {", ".join(allowed)}')
    return fields


def _place(stage: StageTally) -> str:
    time = f" after {stage.steps} load step(s)" if stage.kind == "static" else f" at t = {stage.time:.6g} s"
    return f"in stage {stage.name}{time}"
