"""Runs that are killed, or meet a full disk, at any moment go on from their last checkpoint to the end that they would
have had.
"""

from __future__ import annotations

import os
import random
import signal
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from riser_soil.errors import ResultsError, WriteError
from riser_soil.results import Run, folder
from riser_soil.results.ownership import refuse
from riser_soil.scene.reader import read_scene, scene_from_mapping
from riser_soil.scene.scene import Scene
from riser_soil.whole_run import run
from tests.support.equal_runs import unlike
from tests.support.scenes import LAY, heave, touchdown

ROOT = Path(__file__).parents[2]
OFTEN = {"every": 0.05}  # s
FULL = 10


def riser(every: float = 0.05) -> Scene:
    """Seabed with memory, friction, waves, automatic steps."""
    waves = "water.waves={airy: {height: 2.0, period: 6.0}, ramp: 0.5}"
    steps = ("stages.1.duration=3.0", "stages.1.time_step=auto", "output.interval=0.2")
    settings = ("water.surface_level=95.0", waves, *steps, f"output.checkpoint.every={every}")
    return read_scene(ROOT / "tests/scenes/hysteretic.yaml", settings)


def soil() -> Scene:
    """Clay that yields and remembers."""
    scene = touchdown(LAY, heave(0.8), su=1000.0)
    return scene_from_mapping(scene | {"output": {"checkpoint": OFTEN}})


def sections() -> Scene:
    """Cyclic clay at large strain, in sections."""
    scene = touchdown(LAY, heave(0.8), su=1500.0)
    scene["soil"] |= {"model": "sections", "law": scene["soil"]["law"] | {"kind": "iwan"}}
    return scene_from_mapping(scene | {"contact": {"method": "surface"}, "output": {"checkpoint": OFTEN}})


def killed(scene: Scene, out: Path, after: float, on_the_way: bool) -> None:
    """The run of a process of its own, so many seconds after its beginning, or after its first checkpoint."""
    child = os.fork()
    if child == 0:
        with open(os.devnull, "w") as nowhere:
            os.dup2(nowhere.fileno(), 1)
            os.dup2(nowhere.fileno(), 2)
        run(scene, out)
        os._exit(0)
    while on_the_way and not (out / "checkpoint.npz").exists():
        time.sleep(0.001)
    time.sleep(after)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)


def look(out: Path) -> int:
    """Rows of a folder's series, all of which can be read; the next run may have the folder."""
    if not (out / "results.nc").exists():
        return 0
    refuse(out, force=True)
    try:
        run = Run(out)
    except ResultsError:  # its summary was not there yet
        assert not (out / "summary.json").exists()
        return 0
    return len(run["position"])


@pytest.mark.verify
@pytest.mark.parametrize(
    ("make", "kills"), [(riser, 100), (soil, 20), (sections, 8)], ids=["riser", "soil", "sections"]
)
def test_every_killed_run_goes_on_to_the_same_end(make: Callable[[], Scene], kills: int, tmp_path: Path) -> None:
    scene, chance, gone_on = make(), random.Random(kills), 0
    run(scene, tmp_path / "alone")  # kernels are there from now on
    began = time.perf_counter()
    run(scene, tmp_path / "alone", force=True)
    lasts = time.perf_counter() - began
    for number in range(kills):
        out, on_the_way = tmp_path / f"{number}", number % 4 > 0
        killed(scene, out, chance.uniform(0.0, 0.4 if on_the_way else 1.0) * lasts, on_the_way)
        rows = look(out)
        if folder.is_finished(out):
            continue
        gone_on += (out / "checkpoint.npz").exists()
        run(scene, out, restart=True)
        assert unlike(tmp_path / "alone", out) == [], f"killed with {rows} rows"
    print(f"{gone_on} of {kills} went on from a checkpoint; a run lasts {lasts:.2f} s")
    assert gone_on >= kills // 2


@pytest.mark.verify
def test_every_run_that_met_a_full_disk_goes_on_to_the_same_end(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The disk takes so many files, results and checkpoints; there is a checkpoint after each step."""
    scene, usual, left, gone_on = riser(every=1e-6), folder.synchronise, 0, 0

    def synchronise(path: Path) -> None:
        nonlocal left
        left -= 1
        if left < 0:
            raise OSError(28, "No space left on device", str(path))
        usual(path)

    run(scene, tmp_path / "alone")
    chance = random.Random(FULL)
    for number in range(FULL):
        out, left = tmp_path / f"{number}", chance.randrange(2, 100)
        with monkeypatch.context() as patch:
            for module in ("folder", "growing_file", "checkpoint_file"):
                patch.setattr(f"riser_soil.results.{module}.synchronise", synchronise)
            with pytest.raises(WriteError):
                run(scene, out)
        look(out)
        gone_on += (out / "checkpoint.npz").exists()
        run(scene, out, restart=True)
        assert unlike(tmp_path / "alone", out) == []
    assert gone_on >= FULL // 2
