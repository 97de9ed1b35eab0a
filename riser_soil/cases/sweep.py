"""Load cases from their file to their table."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from riser_soil.cases.case_files import FILES, write_files
from riser_soil.cases.case_table import CaseTable, case_table
from riser_soil.cases.characteristic import CharacteristicExtreme, characteristic_extremes
from riser_soil.cases.expansion import Case, read_cases
from riser_soil.cases.progress import CaseProgress
from riser_soil.errors import Interruption, SceneError, WriteError
from riser_soil.results.whole_file import unusable
from riser_soil.variants import pool
from riser_soil.variants.one_run import Task, task
from riser_soil.variants.pool import Workers
from riser_soil.variants.runs_folder import OUTCOME, Outcome, claimed, running

CASES = "cases"  # folder of the cases' runs


def run_cases(
    file: Path, folder: Path, workers: Workers, overrides: Sequence[str] = (), limit: float | None = None,
    echo: Callable[[str], None] = print,
) -> tuple[CaseTable, list[CharacteristicExtreme]]:  # fmt: skip
    """Run the cases of a file that are not done yet, and leave their tables in the folder.

    overrides: of the base scene, beside those of the file. limit: s that one case may take, None for any time. Cases
    that fail are rows with their reasons. Raises SceneError before the first case is run; Interruption, and WriteError
    where the disk is full, leave the cases that have ended, and a further call goes on.
    """
    case_file, cases = read_cases(file, overrides)
    folder = folder.absolute()
    _refuse_foreign(folder / CASES, cases)
    with claimed(folder, CASES, "load cases") as runs:
        alone = workers.jobs == 1 and workers.scheduler is None
        tasks = [task(case.name, case.variant, runs, limit=limit, alone=alone) for case in cases]
        outcomes, todo = pool.divided(tasks)
        echo(f"{len(cases)} cases, {len(outcomes)} of them done already" if outcomes else f"{len(cases)} cases")
        outcomes |= _computed(cases, todo, workers, folder)
        table = case_table(f"Load cases of {file.name}", runs, cases, outcomes, case_file.statistics.since)
        extremes = characteristic_extremes(table, case_file.extremes)
        write_files(table, extremes, folder)
    return table, extremes


def _refuse_foreign(runs: Path, cases: Sequence[Case]) -> None:
    """SceneError where a case's folder was not written as one, and would be replaced."""
    for case in cases:
        at = runs / case.name
        if at.exists() and not (at / OUTCOME).is_file():
            raise SceneError(f"{at}: is no case's folder, and would be replaced; move it away, or choose another (-o)")


def _computed(cases: Sequence[Case], todo: Sequence[Task], workers: Workers, folder: Path) -> dict[str, Outcome]:
    outcomes = dict[str, Outcome]()

    def begin() -> None:
        """Remove the tables of an earlier call before the first case changes."""
        try:
            for name in FILES:
                (folder / name).unlink(missing_ok=True)
        except OSError as err:
            raise unusable(folder, err) from err

    if not todo:
        return outcomes
    groups = {case.name: case.group_labels for case in cases}
    with CaseProgress(groups, {each["name"] for each in todo}, lambda: running(folder / CASES)) as progress:

        def on_end(outcome: Outcome) -> None:
            outcomes[outcome.name] = outcome
            progress.add(outcome)

        try:
            pool.compute(todo, workers, on_end, begin)
        except Interruption as end:
            end.place = f"when {_kept(progress, folder)}"
            raise
        except WriteError as err:
            raise WriteError(f"{err}; {_kept(progress, folder)}") from err
    return outcomes


def _kept(progress: CaseProgress, folder: Path) -> str:
    return f"{progress.ended} of {progress.count} cases had ended; {folder} keeps them, call again to go on"
