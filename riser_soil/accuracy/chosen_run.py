"""How a scene is run: as it is, with error bars, or to the accuracy asked. What isn't needed isn't imported."""

from __future__ import annotations

from pathlib import Path

from riser_soil.errors import SceneError
from riser_soil.scene.scene import Scene


def run_as_asked(
    scene: Scene, folder: Path, force: bool = False, error_bars: bool = False, restart: bool = False
) -> None:
    """Leaves the results in a folder; collective. error_bars: wanted, whether the scene asks for them or not. restart:
    go on from the folder's last checkpoint.
    """
    if restart and force:
        raise SceneError("--restart and --force: one goes on with a run, the other overwrites it; leave one out")
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


def _refuse_restart(restart: bool, folder: Path) -> None:
    """An accuracy is reached by several runs, of which the folder has the last one alone."""
    if restart:
        raise SceneError(
            f"--restart: an accuracy is sought anew; leave --restart out, or run {folder}/scene.yaml, the setting that "
            "was computed last"
        )
