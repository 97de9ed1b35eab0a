"""Files that grow by whole updates, at a cost of what they change."""

from __future__ import annotations

import errno
import os
import shutil
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest

from riser_soil.results import growing_file
from riser_soil.results.growing_file import GrowingFile, appending, reading
from tests.support.recorded_run import CATENARY_ARC, a_recorder, step
from tests.support.small_disk import files_of_at_most


def numbers(path: Path) -> list[int]:
    with reading(path) as store:
        return [int(store[name][0]) for name in sorted(store)]


def append(file: GrowingFile, number: int, count: int = 1000) -> None:
    with appending(file) as store:
        store[f"{number:03d}"] = np.full(count, number)


@pytest.fixture
def file(tmp_path: Path) -> GrowingFile:
    path = tmp_path / "numbers.h5"
    with h5py.File(path, "w"):
        pass
    return GrowingFile(path, path.read_bytes())


def test_updates_add_up(file: GrowingFile) -> None:
    for number in range(20):
        append(file, number)
        assert numbers(file.path) == list(range(number + 1))


def test_who_opened_the_file_before_an_update_sees_it_as_it_was(file: GrowingFile) -> None:
    append(file, 0)
    with h5py.File(file.path, "r") as store:
        for number in range(1, 5):
            append(file, number)
            assert list(store) == ["000"]
            assert store["000"][-1] == 0
    assert numbers(file.path) == list(range(5))


@pytest.mark.parametrize("moment", ["copyfile", "_write", "_exchange"])
def test_an_update_that_fails_leaves_the_file_whole(
    moment: str, file: GrowingFile, monkeypatch: pytest.MonkeyPatch
) -> None:
    append(file, 0)

    def fail(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as patch:
        if moment == "copyfile":
            file.close()
        patch.setattr(shutil if moment == "copyfile" else growing_file, moment, fail)
        with pytest.raises(OSError, match=r"No space left .*numbers\.h5"):
            append(file, 1)
    assert numbers(file.path) == [0]
    append(file, 1)
    append(file, 2)
    assert numbers(file.path) == [0, 1, 2]


def test_a_file_that_may_not_grow_stays_whole(file: GrowingFile) -> None:
    append(file, 0)
    append(file, 1)
    with files_of_at_most(file.size + 100), pytest.raises(OSError, match="File too large"):
        append(file, 2)
    assert numbers(file.path) == [0, 1]


def test_a_file_system_without_hard_links(file: GrowingFile, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise PermissionError(errno.EPERM, "Operation not permitted")

    monkeypatch.setattr(os, "link", refuse)
    for number in range(4):
        append(file, number)
    assert numbers(file.path) == list(range(4))


def test_what_is_left_is_the_file_alone(file: GrowingFile) -> None:
    append(file, 0)
    append(file, 1)
    file.close()
    assert [p for p in file.path.parent.rglob("*") if p.is_file()] == [file.path]


@pytest.fixture
def written(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Bytes of each update, of all files."""
    sizes: list[int] = []
    usual: Callable[..., None] = growing_file._write

    def write(path: Path, changes: dict[int, bytes], size: int) -> None:
        sizes.append(sum(map(len, changes.values())))
        usual(path, changes, size)

    monkeypatch.setattr(growing_file, "_write", write)
    return sizes


def test_a_frame_costs_the_same_however_many_there_are(tmp_path: Path, written: list[int]) -> None:
    """Bytes written for frames 41 to 60 and for frames 241 to 260."""
    with a_recorder(tmp_path) as recorder:
        costs = []
        for first in (0, 200):
            for number in range(first, first + 200):
                step(recorder, 0.1 * (number + 1))
                if number - first in (40, 60):
                    recorder.flush()
                    costs.append(sum(written))
                    written.clear()
            recorder.flush()
            recorder.flush()
            written.clear()
    early, late = costs[1], costs[3]
    assert early > 20 * CATENARY_ARC.size * 8
    assert late < 1.3 * early


def test_waiting_frames_do_not_pile_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Though no time passes, in which they would have their turn."""
    monkeypatch.setattr("riser_soil.results.record.time.monotonic", lambda: 0.0)
    monkeypatch.setattr("riser_soil.results.record._MOST_WAITING", 500_000)
    with a_recorder(tmp_path) as recorder:
        for number in range(100):
            step(recorder, 0.1 * (number + 1))
        with reading(tmp_path / "results.nc") as series:
            assert len(series["time"]) >= 50
