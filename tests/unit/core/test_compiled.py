"""The cache of compiled kernels, and calls of kernels from compiled code and from Python."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from riser_soil.core import compiled, kernel_cache
from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit

DAY = 86400.0


def test_versions_of_numba_have_their_own_caches(monkeypatch: pytest.MonkeyPatch) -> None:
    before = compiled.version()
    monkeypatch.setattr(compiled.numba, "__version__", "0.1")
    assert compiled.version() != before


def test_cache_is_where_the_user_keeps_caches(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    assert compiled.choose_folder("0" * 16) == tmp_path / "cache" / "riser_soil" / ("0" * 16)
    monkeypatch.delenv("XDG_CACHE_HOME")
    monkeypatch.setenv("HOME", str(tmp_path))
    assert compiled.choose_folder("0" * 16) == tmp_path / ".cache" / "riser_soil" / ("0" * 16)


def test_what_cant_be_written_is_replaced_by_a_private_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("in the way")
    (tmp_path / "tmp").mkdir()
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "tmp"))
    folder = compiled.choose_folder("0" * 16)
    assert folder == tmp_path / "tmp" / f"riser_soil-{os.getuid()}" / ("0" * 16)
    (line,) = capfd.readouterr().err.splitlines()
    assert str(tmp_path / "file") in line
    assert line.endswith(f"{folder} is used")
    folder.parent.chmod(0o777)
    other = compiled.choose_folder("0" * 16)
    assert other.is_dir()
    assert folder.parent not in other.parents
    assert other.stat().st_mode & 0o077 == 0


def test_a_full_disk_is_no_place_for_a_cache_unless_the_kernels_are_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    full = SimpleNamespace(f_bavail=10, f_frsize=4096)
    monkeypatch.setattr(os, "statvfs", lambda path: full)
    with pytest.raises(OSError, match="No space left"):
        compiled.require_room(tmp_path, 100_000)
    (tmp_path / "kernels").mkdir()
    (tmp_path / "kernels" / "morison.nbc").write_bytes(bytes(60_000))
    compiled.require_room(tmp_path, 100_000)


def test_old_versions_go_and_nothing_else(tmp_path: Path) -> None:
    versions = [tmp_path / f"{k:016x}" for k in range(8)]
    bystanders = [tmp_path / "fenics", tmp_path / "0123"]
    for age, path in enumerate([*versions, *bystanders]):
        path.mkdir()
        os.utime(path, (path.stat().st_mtime - age * DAY,) * 2)
    kernel_cache.remove_old(tmp_path, keep=versions[7])
    remaining = set(tmp_path.iterdir())
    assert remaining == {*versions[:4], versions[7], *bystanders}


def test_versions_in_use_stay(tmp_path: Path) -> None:
    versions = [tmp_path / f"{k:016x}" for k in range(8)]
    for path in versions:
        path.mkdir()
    kernel_cache.remove_old(tmp_path, keep=versions[0])
    assert all(path.is_dir() for path in versions)


KERNEL = """
import numpy as np
from riser_soil.riser.vectors import vector
vector(np.ones(3))
"""


def test_compiling_is_announced_once_by_the_first_rank(tmp_path: Path) -> None:
    def output_of(rank: str) -> str:
        environment = os.environ | {"XDG_CACHE_HOME": str(tmp_path), "OMPI_COMM_WORLD_RANK": rank}
        environment.pop("NUMBA_CACHE_DIR", None)
        return subprocess.run([sys.executable, "-c", KERNEL], env=environment, capture_output=True, text=True).stderr

    assert output_of("1") == ""
    assert not list(tmp_path.rglob("announced"))
    for path in tmp_path.rglob("*.nbi"):
        path.unlink()
    assert output_of("0") == compiled.ANNOUNCEMENT + "\n"
    assert list(tmp_path.rglob("*.nbc"))
    assert output_of("0") == ""


def test_processes_may_start_at_once(tmp_path: Path) -> None:
    environment = os.environ | {"XDG_CACHE_HOME": str(tmp_path)}
    environment.pop("NUMBA_CACHE_DIR", None)
    running = [subprocess.Popen([sys.executable, "-c", KERNEL], env=environment) for _ in range(4)]
    assert [process.wait(120) for process in running] == [0] * 4
    assert len(list((tmp_path / "riser_soil").iterdir())) == 1


def test_arrays_may_lie_in_memory_as_they_will() -> None:
    """One after the other, in the same function: by rows, by columns, with gaps, and such as may not be written to."""
    values = np.arange(12.0).reshape(3, 4)
    fixed, wide = values.copy(), np.repeat(np.repeat(values, 2, axis=0), 2, axis=1)
    fixed.flags.writeable = False
    for each in (values, np.asfortranarray(values), wide[::2, ::2], fixed, np.asfortranarray(values), values):
        assert row_sum(each, 1) == 22.0


@compiled.njit
def row_sum(values: Array, row: int) -> float:
    total = 0.0
    for each in values[row]:
        total += each
    return total


def test_division_by_zero_is_no_crash() -> None:
    @compiled.njit
    def ratio(a: float, b: float) -> float:
        return a / b

    assert ratio(1.0, 0.0) == np.inf


@njit
def _twice(x: float) -> float:
    return 2.0 * x


@njit
def _four_times(x: float) -> float:
    doubled: float = _twice(_twice(x))
    return doubled


def test_what_kernels_call_may_be_called_from_python_too() -> None:
    assert _four_times(1.5) == 6.0
    assert [_twice(6.0), _twice(8), _twice(6.0)] == [12.0, 16.0, 12.0]
    np.testing.assert_array_equal(_twice(np.array([1.0, 2.0])), [2.0, 4.0])
