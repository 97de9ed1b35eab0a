"""Functional load effects of code checks from the end of another run: `code_check.N.functional_run`.

A current acts in all stages of a scene, and an offset of the vessel from the beginning. What is functional then
follows from a run of the same line without them.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from riser_soil.assembly import Assembly, LineAssembly
from riser_soil.core.arrays import Array
from riser_soil.errors import ResultsError, SceneError
from riser_soil.results.checkpoint import mine_of
from riser_soil.results.folder import is_finished
from riser_soil.results.read import Run

if TYPE_CHECKING:
    from riser_soil.code_checks.line_checks import LineChecks
    from riser_soil.code_checks.load_effects import SectionEffects

SAME_ARC = 1e-9  # of the line's length


def line_checks(line: LineAssembly, name: str) -> LineChecks | None:
    """Code checks of a line, by its name, with the load effects that other runs give; None where there are none.

    SceneError where such a run does not fit.
    """
    checks = line.code_checks()
    if checks is not None:
        for number, folder in checks.functional_runs.items():
            key = f"code_check.{number}.functional_run: {folder}"
            checks.begin_from(number, _at_end(folder, name, line.line.arc, key))
    return checks


def refuse_unfit_runs(assembly: Assembly) -> None:
    """SceneError where a run named by a code check does not fit a line; collective, to be asked early."""

    def read() -> None:
        for name, line in assembly.lines.items():
            line_checks(line, name)

    mine_of(assembly.comm, read)


def _at_end(folder: Path, line: str, arc: Array, key: str) -> SectionEffects:
    """Load effects (nn,) at a run's end."""
    from riser_soil.code_checks.load_effects import SectionEffects

    if not is_finished(folder):
        raise SceneError(f"{key}: holds no finished run; run it to its end first")
    try:
        run = Run(folder, line or None)
        if run.arc.shape != arc.shape or np.abs(run.arc - arc).max() > SAME_ARC * arc[-1]:
            raise SceneError(f"{key}: its line has other nodes than this one; give both scenes the same segments")
        tension, moment_y = run["effective_tension"][-1], run["bending_moment_y"][-1]
        moment_z = run["bending_moment_z"][-1] if run.has("bending_moment_z") else np.zeros_like(arc)
    except ResultsError as err:
        remedy = "give the line types of that scene a wall: {}, and output.fields their tension and moments"
        raise SceneError(f"{key}: {err}; {remedy}") from err
    return SectionEffects(tension, moment_y, moment_z)
