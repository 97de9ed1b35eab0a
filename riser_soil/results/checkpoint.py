"""Checkpoints of a run: when they are due, their writing, and the last one of a folder."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from riser_soil import __version__
from riser_soil.assembly import Assembly, sized
from riser_soil.core.communicator import Communicator, raised_on_all_ranks
from riser_soil.core.saved_state import Saved
from riser_soil.errors import SceneError
from riser_soil.interruption import leave_between_steps, uninterrupted
from riser_soil.results.checkpoint_file import About, read_checkpoint
from riser_soil.results.folder import CHECKPOINT
from riser_soil.results.record import Recorder
from riser_soil.scene.identity import first_difference, identity_of
from riser_soil.scene.output import Checkpoint
from riser_soil.scene.scene import Scene

MAY_DIFFER = (("output", "checkpoint"), ("output", "directory"), ("error_bars",))
AT_END = 0.1  # of the time between checkpoints, after which there is one at a stage's end


class CheckpointSchedule:
    """Says after each step whether a checkpoint is due: by wall time, at the end of a stage, at an interruption.

    settings: None for no checkpoints at all.
    """

    def __init__(self, settings: Checkpoint | None, comm: Communicator) -> None:
        self._settings, self._comm = settings, comm
        self.restart()

    def due(self, last: bool, ends_run: bool, leaving: bool) -> bool:
        """Collective. last: of its stage; ends_run: of the run; leaving: before its time."""
        if self._settings is None:
            return False
        if leaving or (ends_run and self._settings.keep):
            return True
        wait = AT_END * self._settings.every if last else self._settings.every
        return bool(self._comm.bcast(not ends_run and time.monotonic() - self._last > wait))

    def restart(self) -> None:
        """Count the time from now, as a checkpoint has been written."""
        self._last = time.monotonic()


class RunCheckpoints:
    """Checkpoints that a run writes. recorder: None off rank 0.

    A checkpoint has the version, ranks and scene of the run's start, as files of the scene may change.
    """

    def __init__(self, assembly: Assembly, recorder: Recorder | None) -> None:
        settings, self._comm, self._recorder = assembly.scene.output.checkpoint, assembly.comm, recorder
        self.wanted, self._schedule = settings is not None, CheckpointSchedule(settings, assembly.comm)
        if self.wanted and recorder is not None:
            self._about = About(__version__, assembly.comm.size, identity_of(assembly.scene))

    def due(self, last: bool, ends_run: bool, leaving: bool) -> bool:
        """Whether one is due after a step, see `CheckpointSchedule`; may leave the run where it is interrupted.
        Collective.
        """
        if self.wanted:
            leave_between_steps()
        return self._schedule.due(last, ends_run, leaving)

    def write(self, gather: Callable[[], Saved], ended: str | None) -> None:
        """Write the state after a recorded step; collective. gather: this rank's state; ended: name of the stage that
        the step is the last one of, if any.
        """
        with uninterrupted():
            shares = self._comm.gather(gather())
            if self._recorder is not None:
                assert shares is not None
                self._recorder.checkpoint(replace(self._about, ended=ended), shares)
        self._schedule.restart()


def last_checkpoint(folder: Path, scene: Scene, with_peaks: bool, comm: Communicator) -> Saved | None:
    """This rank's state of the folder's run, from which it goes on; None where there is no checkpoint. Collective.

    with_peaks: whether the run follows peaks, for its error bars. Raises SceneError where the run was another one,
    ResultsError where the checkpoint can't be read.
    """
    saved = mine_of(comm, lambda: _shares(folder, scene, with_peaks, comm.size))
    if saved is None and comm.rank == 0:
        print(f"{folder}: has no checkpoint to go on from: the run begins")
    return saved


def mine_of(comm: Communicator, read: Callable[[], list[Saved] | None]) -> Saved | None:
    """This rank's share of what the first one reads, or the error that it meets; collective."""
    shares: list[Saved] | None = None
    with raised_on_all_ranks(comm):
        if comm.rank == 0:
            shares = read()
    if not comm.bcast(shares is not None):
        return None
    mine: Saved = comm.scatter(shares)
    return mine


def _shares(folder: Path, scene: Scene, with_peaks: bool, ranks: int) -> list[Saved] | None:
    path = folder / CHECKPOINT
    if not path.exists():
        return None
    checkpoint = read_checkpoint(path)
    _refuse_another(checkpoint.about, path, scene, ranks)
    if with_peaks and not any(name.startswith("observer/peaks/") for name in checkpoint.shares[0]):
        raise SceneError(
            f"{path}: the run was begun without error bars, which follow it from its beginning; go on without "
            "--error-bars"
        )
    return checkpoint.shares


def _refuse_another(about: About, path: Path, scene: Scene, ranks: int) -> None:
    """SceneError where a checkpoint is not of this version, number of ranks and scene."""
    anew = "or begin anew by --force in the place of --restart"
    if about.version != __version__:
        raise SceneError(
            f"{path}: was written by riser_soil {about.version}, and this is {__version__}; go on with that one, {anew}"
        )
    if about.ranks != ranks:
        raise SceneError(f"{path}: was written on {about.ranks} rank(s), and these are {ranks}; take as many, {anew}")
    if difference := first_difference(about.scene, identity_of(sized(scene)), MAY_DIFFER):
        raise SceneError(f"{path}: the scene is another one: {difference}; take that scene, {anew}")
