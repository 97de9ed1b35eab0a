"""Runs that are killed, told to end, or meet a full disk, at any moment: what they leave can be read and is honest."""

from __future__ import annotations

import random
import signal
import time
from collections.abc import Sequence
from pathlib import Path

import pytest

from tests.broken_runs import ON_A_SMALL_DISK, look, start

AT_ONCE = 4


def end_by(number: signal.Signals, folder: Path, delays: Sequence[float]) -> list[tuple[Path, int, list[str]]]:
    """Folder, status and lines on standard error of runs that get a signal after so many seconds."""
    found = []
    for first in range(0, len(delays), AT_ONCE):
        begun = time.monotonic()
        some = list(enumerate(delays))[first : first + AT_ONCE]
        running = [(delay, folder / f"{number.name}{i}", start(folder / f"{number.name}{i}")) for i, delay in some]
        for delay, out, process in sorted(running, key=lambda run: run[0]):
            time.sleep(max(0.0, begun + delay - time.monotonic()))
            process.send_signal(number)
            _, told = process.communicate(timeout=120)
            found.append((out, process.returncode, told.splitlines()))
    return found


@pytest.mark.verify
def test_a_hundred_kills(tmp_path: Path) -> None:
    chance = random.Random(1)
    runs = end_by(signal.SIGKILL, tmp_path, [chance.uniform(2.0, 14.0) for _ in range(100)])
    left = look([folder for folder, _, _ in runs])
    print(f"nothing yet: {sum(x.rows is None for x in left)}; most rows: {max(x.rows or 0 for x in left)}")
    assert {status for _, status, _ in runs} == {-signal.SIGKILL}
    assert sum((x.rows or 0) > 1 for x in left) > 20, "too few have come to motion: wait longer"


@pytest.mark.verify
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_ten_signals(number: signal.Signals, tmp_path: Path) -> None:
    chance = random.Random(int(number))
    runs = end_by(number, tmp_path, [chance.uniform(3.0, 14.0) for _ in range(10)])
    left = look([folder for folder, _, _ in runs])
    for (_, status, lines), found in zip(runs, left, strict=True):
        assert status == 128 + number
        assert lines[-1].startswith(f"ended by {number.name} ")
        assert len(lines) == 1
        assert found.rows == found.frames
    assert sum((x.rows or 0) > 1 for x in left) > 3, "too few have come to motion: wait longer"


@pytest.mark.verify
def test_twenty_full_disks(tmp_path: Path) -> None:
    folders = []
    for size in [1000 * 2**k // 4 for k in range(20)][:14] + [3_000_000 + 300_000 * k for k in range(6)]:
        folders.append(tmp_path / f"{size}")
        process = start(folders[-1], "-c", ON_A_SMALL_DISK, str(size))
        _, told = process.communicate(timeout=120)
        assert process.returncode == 4, told
        (line,) = told.splitlines()
        assert "cannot be written: File too large" in line
    left = look(folders)
    print(f"rows: {[x.rows for x in left]}")
    assert all((x.rows or 0) > 1 for x in left[-6:])
