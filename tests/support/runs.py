"""A scene run into a folder, and its results."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from riser_soil.results import Run
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.whole_run import run


def run_of(scene: dict[str, Any], folder: Path) -> Run:
    """Results of a scene that is run into a folder."""
    run(scene_from_mapping(scene), folder)
    return Run(folder)
