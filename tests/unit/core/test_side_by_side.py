"""Jobs that forks of a process do side by side."""

from __future__ import annotations

import gc
import os
from contextlib import suppress
from pathlib import Path

import pytest

from riser_soil.core.side_by_side import AT_MOST, at_most, side_by_side


class Line:
    """A job that adds a line with the number of its process to a file; it fails in forks where it is said so."""

    def __init__(self, path: Path, only_in: int = 0) -> None:
        self._path, self._only_in = path, only_in

    @property
    def free(self) -> bool:
        return not self._path.exists()

    def do(self) -> None:
        if self._only_in not in (0, os.getpid()):
            raise OSError("not here")
        with suppress(FileExistsError), self._path.open("x", encoding="utf-8") as file:  # one process may be quicker
            file.write(f"{os.getpid()}\n")

    @property
    def process(self) -> int:
        return int(self._path.read_text(encoding="utf-8"))


class Awaited(Line):
    """One that waits until another one is done, which must be in another process then."""

    def __init__(self, path: Path, other: Path) -> None:
        super().__init__(path)
        self._other = other

    def do(self) -> None:
        super().do()
        while not self._other.exists() or not self._other.read_text(encoding="utf-8"):
            pass


def lines(folder: Path, n: int = 6, only_in: int = 0) -> list[Line]:
    return [Line(folder / f"{k}", only_in) for k in range(n)]


def test_each_job_is_done_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for count in (1, 2, 3, 9):
        monkeypatch.setenv(AT_MOST, f"{count}")
        folder = tmp_path / f"{count}"
        folder.mkdir()
        jobs = lines(folder)
        side_by_side(jobs)
        assert all(job.process for job in jobs)
        assert count > 1 or {job.process for job in jobs} == {os.getpid()}


def test_what_is_done_already_is_not_done_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(AT_MOST, "1")
    (tmp_path / "1").write_text("7", encoding="utf-8")
    side_by_side([Line(tmp_path / "0"), Line(tmp_path / "1", only_in=1)])
    assert (tmp_path / "0").exists()


def test_two_jobs_are_done_at_the_same_time(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(AT_MOST, "2")
    here, there = tmp_path / "here", tmp_path / "there"
    first, second = Awaited(here, there), Awaited(there, here)
    side_by_side([first, second])
    assert first.process == os.getpid() != second.process


class Collecting(Awaited):
    """One that says whether garbage is looked for where it is done."""

    def do(self) -> None:
        self._path.with_suffix(".collects").write_text(str(gc.isenabled()), encoding="utf-8")
        super().do()


def test_a_fork_looks_for_no_garbage(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(AT_MOST, "2")
    here, there = tmp_path / "here", tmp_path / "there"
    side_by_side([Collecting(here, there), Collecting(there, here)])
    assert here.with_suffix(".collects").read_text(encoding="utf-8") == str(gc.isenabled()) == "True"
    assert there.with_suffix(".collects").read_text(encoding="utf-8") == "False"


def test_what_forks_fail_to_do_is_done_here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(AT_MOST, "3")
    jobs = lines(tmp_path, only_in=os.getpid())
    side_by_side(jobs)
    assert {job.process for job in jobs} == {os.getpid()}


class Failing(Awaited):
    """One that fails when another has begun."""

    def do(self) -> None:
        super().do()
        raise OSError("not here")


def test_forks_are_gone_when_this_process_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(AT_MOST, "2")
    here, there = tmp_path / "here", tmp_path / "there"
    endless = Awaited(there, tmp_path / "never")
    with pytest.raises(OSError, match="not here"):
        side_by_side([Failing(here, there), endless])
    with pytest.raises(ProcessLookupError):
        os.kill(endless.process, 0)


def test_ranks_begin_at_different_jobs_and_share_the_cores(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(AT_MOST, "2")
    monkeypatch.setenv("OMPI_COMM_WORLD_SIZE", "2")
    monkeypatch.setenv("OMPI_COMM_WORLD_RANK", "1")
    done = list[str]()

    class Noted(Line):
        def do(self) -> None:
            super().do()
            done.append(self._path.name)

    side_by_side([Noted(tmp_path / f"{k}") for k in range(4)])
    assert done == ["2", "3", "0", "1"]


def test_as_many_as_cores_unless_the_environment_says_it(monkeypatch: pytest.MonkeyPatch) -> None:
    for word in ("0", "many", ""):
        monkeypatch.setenv(AT_MOST, word)
        assert at_most() == len(os.sched_getaffinity(0))
    monkeypatch.setenv(AT_MOST, "3")
    assert at_most() == 3
