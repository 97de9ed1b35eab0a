"""Run as a scene asks: hang-offs and the vessel's offset first, then as it is, with error bars, or to an accuracy.

Modules are imported where they are needed, as a plain run needs few of them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from riser_soil.errors import Interruption, MemoryShortageError, SceneError, SolveError
from riser_soil.scene.lines import risers
from riser_soil.scene.scene import Scene
from riser_soil.scene.variants import at_offset, displacement


def run_as_asked(
    scene: Scene, folder: Path, force: bool = False, error_bars: bool = False, restart: bool = False
) -> None:
    """Run a scene and leave its results in a folder; collective.

    error_bars: estimate them, whether the scene asks for them or not. restart: resume from the last checkpoint.
    """
    if restart and force:
        raise SceneError("--restart and --force: one goes on with a run, the other overwrites it; leave one out")
    scene, more = in_numbers(scene)
    more = (_solved_before(folder) if restart else {}) | more
    with _adding(more, folder, scene):
        _run(scene, folder, force, error_bars, restart)


def _run(scene: Scene, folder: Path, force: bool, error_bars: bool, restart: bool) -> None:
    if scene.accuracy is not None:
        from riser_soil.accuracy.target_run import run_to_accuracy

        _refuse_restart(restart, folder)
        run_to_accuracy(scene, folder, force)
    elif error_bars or scene.error_bars:
        from riser_soil.accuracy.barred_run import run_with_error_bars

        run_with_error_bars(scene, folder, force, restart)
    else:
        from riser_soil.whole_run import run

        run(scene, folder, force, restart=restart)


def _solved_before(folder: Path) -> dict[str, Any]:
    """Blocks on hang-offs and the vessel's offset in the summary of a run that is resumed."""
    from riser_soil.results.folder import SUMMARY
    from riser_soil.results.read import Run

    known = Run(folder).summary if Run.is_there(folder) and (folder / SUMMARY).is_file() else {}
    return {key: known[key] for key in ("hang_off", "vessel") if key in known}


@contextmanager
def _adding(more: Mapping[str, Any], folder: Path, scene: Scene) -> Iterator[None]:
    """Add blocks to the summary of the run in the `with` statement, also of one that ends before its time."""
    try:
        yield
    except (SolveError, MemoryShortageError, Interruption):
        _add(more, folder, scene)
        raise
    _add(more, folder, scene)


def _add(more: Mapping[str, Any], folder: Path, scene: Scene) -> None:
    if not more:
        return
    from riser_soil.assembly.packages import communicator_of
    from riser_soil.results.folder import SUMMARY
    from riser_soil.results.summary import add_to_summary

    if communicator_of(scene).rank == 0 and (folder / SUMMARY).is_file():
        add_to_summary(folder, more)


def _refuse_restart(restart: bool, folder: Path) -> None:
    """SceneError for a restart with an accuracy: of its several runs the folder has the last one only."""
    if restart:
        raise SceneError(
            f"--restart: an accuracy is sought anew; take --force in its place, or run {folder}/scene.yaml, the "
            "setting that was computed last"
        )


def in_numbers(scene: Scene) -> tuple[Scene, dict[str, Any]]:
    """The scene with its hang-offs solved and its vessel at its offset; blocks of the summary on both; collective."""
    scene, more = _with_hang_offs_solved(scene)
    if scene.vessel is None:
        return scene, more
    from riser_soil.assembly.packages import communicator_of

    displaced = displacement(scene)
    if communicator_of(scene).rank == 0:
        print(displaced.in_words)
    return at_offset(scene), more | {"vessel": displaced.summary}


def _with_hang_offs_solved(scene: Scene) -> tuple[Scene, dict[str, Any]]:
    if not any(line.hangs_off for line in risers(scene).values()):
        return scene, {}
    from riser_soil.assembly.packages import communicator_of
    from riser_soil.hang_off import with_hang_offs_solved
    from riser_soil.interruption import handling_signals

    with handling_signals():
        solved = with_hang_offs_solved(scene)
    assert solved is not None
    if communicator_of(scene).rank == 0:
        print(solved.in_words)
    return solved.scene, {"hang_off": solved.summary}
