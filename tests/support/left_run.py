"""Runs that a signal ends after so many steps, in this process, and that go on from their checkpoint."""

from __future__ import annotations

import signal
from pathlib import Path
from typing import Any

import pytest

from riser_soil.errors import Interruption
from riser_soil.results.observer import Observer
from riser_soil.results.peaks import RunPeaks
from riser_soil.scene.scene import Scene
from riser_soil.whole_run import run


def leave_after(
    steps: int, scene: Scene, folder: Path, peaks: RunPeaks | None = None, restart: bool = False
) -> Interruption:
    """Run the scene; SIGTERM comes while so many steps have been recorded."""
    usual, count = Observer.record, 0

    def record(self: Observer, *arguments: Any, **more: Any) -> None:
        nonlocal count
        usual(self, *arguments, **more)
        count += 1
        if count == steps:
            signal.raise_signal(signal.SIGTERM)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Observer, "record", record)
        with pytest.raises(Interruption) as end:
            run(scene, folder, peaks=peaks, restart=restart)
    return end.value
