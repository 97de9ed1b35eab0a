"""Load cases from their file to their table."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from riser_soil import __version__
from riser_soil.cases.case_folder import ATTEMPTS, CASE, CASES, FILES, Outcome, clear_attempts, found, place, running
from riser_soil.cases.case_table import CaseTable, case_table
from riser_soil.cases.characteristic import CharacteristicExtreme, characteristic_extremes
from riser_soil.cases.expansion import Case, read_cases
from riser_soil.cases.progress import CaseProgress
from riser_soil.cases.work import Task
from riser_soil.errors import Interruption, SceneError, WriteError
from riser_soil.results.folder import FolderLock
from riser_soil.results.ownership import sealed
from riser_soil.results.whole_file import refuse_file, unusable


@dataclass(frozen=True)
class Workers:
    """Who computes: `jobs` worker processes on this machine, or those of a Dask scheduler at an address.

    limit: s that one case may take, from its start to its end; None: as long as it likes.
    """

    jobs: int = 1
    scheduler: str | None = None
    limit: float | None = None


def run_cases(
    file: Path, folder: Path, workers: Workers, overrides: Sequence[str] = (), says: Callable[[str], None] = print
) -> tuple[CaseTable, list[CharacteristicExtreme]]:
    """Run the cases of a file that are not done yet, and leave their tables in the folder.

    overrides: of the base scene, beside those of the file. Cases that fail are rows with their reasons. Raises
    SceneError before the first case is run; Interruption, and WriteError where the disk is full, leave what has ended,
    and a further call goes on.
    """
    case_file, cases = read_cases(file, overrides)
    folder = folder.absolute()
    with _held(folder, cases):
        outcomes = {case.name: known for case in cases if (known := found(folder, case.name, case.key))}
        todo = [_task(case, folder, workers.limit) for case in cases if case.name not in outcomes]
        says(f"{len(cases)} cases, {len(outcomes)} of them done already" if outcomes else f"{len(cases)} cases")
        outcomes |= _computed(cases, todo, workers, folder) if todo else {}
        table = case_table(f"Load cases of {file.name}", folder, cases, outcomes, case_file.statistics.since)
        extremes = characteristic_extremes(table, case_file.extremes)
        from riser_soil.cases.case_files import write_files

        write_files(table, extremes, folder)
    return table, extremes


def _computed(cases: Sequence[Case], todo: Sequence[Task], workers: Workers, folder: Path) -> dict[str, Outcome]:
    from riser_soil.cases.pool import outcomes

    found = {}

    def begin() -> None:
        """The tables of an earlier call go before the first case changes."""
        try:
            clear_attempts(folder)
            (folder / CASES / ATTEMPTS).mkdir(parents=True)
            for name in FILES:
                (folder / name).unlink(missing_ok=True)
        except OSError as err:
            raise unusable(folder, err) from err

    groups = {case.name: case.group_labels for case in cases}
    with CaseProgress(groups, {task["name"] for task in todo}, lambda: running(folder)) as progress:
        try:
            for outcome in outcomes(todo, min(workers.jobs, len(todo)), workers.scheduler, begin):
                if outcome.status == WriteError.exit_status:
                    raise WriteError(f"{outcome.name}: {outcome.reason}; {_kept(progress, folder)}")
                found[outcome.name] = outcome
                progress.take(outcome)
        except Interruption as end:
            end.place = f"when {_kept(progress, folder)}"
            raise
    return found


def _kept(progress: CaseProgress, folder: Path) -> str:
    return f"{progress.ended} of {progress.count} cases had ended; {folder} keeps them, call again to go on"


def _task(case: Case, folder: Path, limit: float | None) -> Task:
    task = {"name": case.name, "key": case.key, "scene": sealed(case.scene), "folder": str(folder)}
    return task | {"limit": limit, "version": __version__}


@contextmanager
def _held(folder: Path, cases: Sequence[Case]) -> Iterator[None]:
    """The folder for this call alone. Attempts do not outlast it; nor does a folder that it has made, if empty."""
    _refuse(folder, cases)
    there = folder.is_dir()
    try:
        lock = FolderLock(folder)
    except OSError as err:
        raise unusable(folder, err) from err
    try:
        with lock:
            try:
                yield
            finally:
                clear_attempts(folder)
    finally:
        if not there:
            with suppress(OSError):  # holds something
                folder.rmdir()


def _refuse(folder: Path, cases: Sequence[Case]) -> None:
    """Only an empty folder, or one with cases, takes cases; of these only what was written as one is replaced."""
    refuse_file(folder)
    there = [entry.name for entry in folder.iterdir()] if folder.is_dir() else []
    if there and CASES not in there:
        raise SceneError(f"{folder}: holds something else than load cases, {min(there)}; choose another with -o FOLDER")
    for case in cases:
        at = place(folder, case.name)
        if at.exists() and not (at / CASE).is_file():
            raise SceneError(f"{at}: is no case's folder, and would be replaced; move it away, or choose another (-o)")
