"""How a scene is run: as it is, with error bars, or to the accuracy asked. What isn't needed isn't imported."""

from __future__ import annotations

from pathlib import Path

from riser_soil.scene.scene import Scene


def run_as_asked(scene: Scene, folder: Path, force: bool = False, error_bars: bool = False) -> None:
    """Leaves the results in a folder; collective. error_bars: wanted, whether the scene asks for them or not."""
    if scene.accuracy is not None:
        from riser_soil.accuracy.target_run import run_to_accuracy as compute
    elif error_bars or scene.error_bars:
        from riser_soil.accuracy.barred_run import run_with_error_bars as compute
    else:
        from riser_soil.whole_run import run as compute

    compute(scene, folder, force)
