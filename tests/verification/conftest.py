"""Runs that several tests look at."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.coupled_scenes import DEMO

if TYPE_CHECKING:
    from tests.watched_run import WatchedRun


@pytest.fixture(scope="session")
def demo(tmp_path_factory: pytest.TempPathFactory) -> WatchedRun:
    """The demo, some 20 s of computing. Its tests carry xdist_group("demo"), so that one process runs it."""
    # Imported here: what pytest imports to collect tests would start MPI in the process whose children run them.
    from riser_soil.scene.reader import read_scene
    from tests.watched_run import watched_run

    return watched_run(read_scene(DEMO), tmp_path_factory.mktemp("demo") / "results")
