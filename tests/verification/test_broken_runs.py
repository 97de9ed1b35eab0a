"""Runs that are killed, told to end, or meet a full disk, at any moment: what they leave can be read and is honest."""

from __future__ import annotations

import random
import signal
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

import pytest

from tests.support.broken_runs import ON_A_SMALL_DISK, look, start, start_on_a_filled_disk
from tests.support.said import line_with

AT_ONCE = 4


class Ended(NamedTuple):
    """A run that a signal has ended, and its lines on standard error."""

    folder: Path
    status: int
    output: list[str]


def end_by(number: signal.Signals, folder: Path, runs: int) -> list[Ended]:
    """Half of the runs get the signal within seconds of their start, the others when they are in motion; all by chance.

    Before its own first line is read the program can't listen: Python then answers.
    """
    chance = random.Random(int(number))

    def end(run: int, seconds: float) -> Ended:
        out = folder / f"{run}"
        process = start(out)
        while number != signal.SIGKILL and process.poll() is None and not listens(process.pid):
            time.sleep(0.02)
        while run % 2 and process.poll() is None and not in_motion(out):
            time.sleep(0.02)
        time.sleep(seconds)
        process.send_signal(number)
        _, output = process.communicate(timeout=300)
        return Ended(out, process.returncode, output.splitlines())

    with ThreadPoolExecutor(AT_ONCE) as pool:
        return list(pool.map(end, range(runs), [chance.uniform(0.0, 5.0) for _ in range(runs)]))


def in_motion(folder: Path) -> bool:
    """Whether the files have more than the static stage's frame."""
    frames = folder / "riser.xdmf"
    return frames.exists() and frames.read_bytes().count(b"<Time") > 1


def listens(process: int) -> bool:
    """Whether SIGTERM has a handler."""
    status = Path(f"/proc/{process}/status").read_text(encoding="ascii")
    caught = next(line for line in status.splitlines() if line.startswith("SigCgt:"))
    return bool(int(caught.split()[1], 16) >> (signal.SIGTERM - 1) & 1)


@pytest.mark.verify
def test_a_hundred_kills(tmp_path: Path) -> None:
    runs = end_by(signal.SIGKILL, tmp_path, 100)
    remains = look([run.folder for run in runs])
    print(f"nothing yet: {sum(x.rows is None for x in remains)}; rows: {sorted(x.rows or 0 for x in remains)}")
    assert {run.status for run in runs} == {-signal.SIGKILL}
    assert sum((x.frames or 0) > 1 for x in remains) >= 50


@pytest.mark.verify
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_ten_signals(number: signal.Signals, tmp_path: Path) -> None:
    runs = end_by(number, tmp_path, 10)
    remains = look([run.folder for run in runs])
    print(f"rows: {[x.rows for x in remains]}")
    for run, outcome in zip(runs, remains, strict=True):
        assert run.status == 128 + number
        (line,) = run.output
        assert line.startswith(f"ended by {number.name} ")
        assert (outcome.rows or 0) == (outcome.frames or 0)
    assert sum((x.rows or 0) > 1 for x in remains) >= 5


@pytest.mark.verify
def test_twenty_disks_that_others_fill(tmp_path: Path) -> None:
    """Disks in memory; the scene would fit on them by its estimate."""

    def end(free: int) -> Ended:
        disk = tmp_path / f"disk-{free}"
        disk.mkdir()
        process = start_on_a_filled_disk(tmp_path / f"{free}", disk, free)
        _, output = process.communicate(timeout=300)
        return Ended(tmp_path / f"{free}", process.returncode, output.splitlines())

    with ThreadPoolExecutor(AT_ONCE) as pool:
        runs = list(pool.map(end, [400_000 * k for k in range(20)]))
    for run in runs:
        assert run.status == 4, run.output
        (line,) = run.output
        assert "No space left" in line
    remains = look([run.folder for run in runs])
    print(f"rows: {[x.rows for x in remains]}")
    assert all((x.rows or 0) > 1 for x in remains[-6:])


@pytest.mark.verify
def test_twenty_files_that_may_not_grow(tmp_path: Path) -> None:
    folders = []
    for size in [1000 * 2**k // 4 for k in range(20)][:14] + [3_000_000 + 300_000 * k for k in range(6)]:
        folders.append(tmp_path / f"{size}")
        process = start(folders[-1], "-c", ON_A_SMALL_DISK, str(size))
        _, output = process.communicate(timeout=120)
        assert process.returncode == 4, output
        (line,) = output.splitlines()
        line_with([line], "cannot be written:", "File too large")
    remains = look(folders)
    print(f"rows: {[x.rows for x in remains]}")
    assert all((x.rows or 0) > 1 for x in remains[-6:])
