"""Runs that several tests look at."""

from __future__ import annotations

import pickle
import time
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.support.on_ranks import HANGS
from tests.support.scenes import ON_BLOCK

if TYPE_CHECKING:
    from tests.support.watched_run import WatchedRun


#: Half a period, that moves more and presses the riser into coarser cells.
BRIEFLY = (
    "stages.1.duration=4.0",
    "stages.1.motion.end.harmonic.amplitude=[0.55, 0.0, 1.1]",
    *("soil.mesh.size_far=1.25", "soil.block.depth=1.75"),
)


@pytest.fixture(scope="session")
def on_block(tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest) -> WatchedRun:
    """A third of the touchdown demo on a block, some 8 s of computing, once."""
    return computed_once("on_block", BRIEFLY, tmp_path_factory, request)


@pytest.fixture(scope="session")
def whole_on_block(tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest) -> WatchedRun:
    """The touchdown demo on a block, some 20 s of computing, once."""
    return computed_once("whole_on_block", (), tmp_path_factory, request)


def computed_once(
    name: str, overrides: tuple[str, ...], factory: pytest.TempPathFactory, request: pytest.FixtureRequest
) -> WatchedRun:
    """xdist's other processes wait for the first."""
    own = factory.getbasetemp()
    place = (own.parent if hasattr(request.config, "workerinput") else own) / name
    try:
        place.mkdir()
    except FileExistsError:
        return wait_for(place)
    try:
        compute(place, overrides)
    finally:
        (place / "over").touch()
    return wait_for(place)


def compute(place: Path, overrides: tuple[str, ...]) -> None:
    # Imported here: what pytest imports to collect tests would start MPI in the process whose children run them.
    from riser_soil.scene.reader import read_scene
    from tests.support.watched_run import watched_run

    run = watched_run(read_scene(ON_BLOCK, overrides), place / "results")
    (place / "watched").write_bytes(pickle.dumps(run))


def wait_for(place: Path) -> WatchedRun:
    ends = time.monotonic() + HANGS
    while not (place / "over").exists() and time.monotonic() < ends:
        time.sleep(0.1)
    watched: WatchedRun = pickle.loads((place / "watched").read_bytes())
    return watched
