"""How a scene is run: its hang-off solved first, as it is, with error bars, or to the accuracy asked.

What isn't needed isn't imported.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from riser_soil.scene.scene import Scene


def run_as_asked(scene: Scene, folder: Path, force: bool = False, error_bars: bool = False) -> None:
    """Leaves the results in a folder; collective. error_bars: wanted, whether the scene asks for them or not."""
    scene, more = in_numbers(scene)
    if scene.accuracy is not None:
        from riser_soil.accuracy.target_run import run_to_accuracy as compute
    elif error_bars or scene.error_bars:
        from riser_soil.accuracy.barred_run import run_with_error_bars as compute
    else:
        from riser_soil.whole_run import run as compute

    compute(scene, folder, force)
    if more:
        from mpi4py import MPI

        from riser_soil.results.summary import add_to_summary

        if MPI.COMM_WORLD.rank == 0:
            add_to_summary(folder, more)


def in_numbers(scene: Scene) -> tuple[Scene, dict[str, Any]]:
    """The scene with its hang-off solved, where it asks for one, and what its summary tells of that; collective."""
    if not scene.riser.hangs_off:
        return scene, {}
    from mpi4py import MPI

    from riser_soil.hang_off import hung
    from riser_soil.interruption import handling_signals

    with handling_signals():
        found = hung(scene)
    assert found is not None
    if MPI.COMM_WORLD.rank == 0:
        print(found.told)
    return found.scene, {"hang_off": found.summary}
