"""The cache of compiled kernels: a version of its own for every change, in a folder that can be written."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from riser_soil.core import compiled

DAY = 86400.0


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A package with a kernel that inlines a function of another module."""
    folder = tmp_path / "riser_soil"
    sources = {
        "riser/kernel.py": "from riser_soil.core.compiled import njit\nfrom riser_soil.riser.law import f\n",
        "riser/law.py": "from riser_soil.riser import (\n    numbers,\n)\n",
        "riser/numbers.py": "TWO = 2.0\n",
        "plots.py": "import riser_soil.riser.kernel\n",
    }
    for name, text in sources.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return folder


@pytest.mark.parametrize(
    ("name", "matters"),
    [("riser/kernel.py", True), ("riser/law.py", True), ("riser/numbers.py", True), ("plots.py", False)],
)
def test_edits_of_what_kernels_depend_on_change_the_version(package: Path, name: str, matters: bool) -> None:
    before = compiled.fingerprint(package)
    with (package / name).open("a") as file:
        file.write("# edited\n")
    assert (compiled.fingerprint(package) != before) == matters


def test_versions_of_numba_have_their_own_caches(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = compiled.fingerprint(package)
    monkeypatch.setattr(compiled.numba, "__version__", "0.1")
    assert compiled.fingerprint(package) != before


def test_the_package_depends_on_all_its_kernels() -> None:
    names = compiled._sources(compiled.PACKAGE).keys()
    assert {"riser/beam3d.py", "riser/beam2d.py", "sea/morison_law.py", "core/matrix.py"} <= names
    assert not {"whole_run.py", "__main__.py", "results/observer.py"} & names


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
    (reported,) = capfd.readouterr().err.splitlines()
    assert str(tmp_path / "file") in reported
    assert reported.endswith(f"{folder} is used")
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
    compiled.remove_old(tmp_path, keep=versions[7])
    left = set(tmp_path.iterdir())
    assert left == {*versions[:4], versions[7], *bystanders}


def test_versions_in_use_stay(tmp_path: Path) -> None:
    versions = [tmp_path / f"{k:016x}" for k in range(8)]
    for path in versions:
        path.mkdir()
    compiled.remove_old(tmp_path, keep=versions[0])
    assert all(path.is_dir() for path in versions)


KERNEL = """
import numpy as np
from riser_soil.riser.vectors import vector
vector(np.ones(3))
"""


def test_compiling_is_announced_once_by_the_first_rank(tmp_path: Path) -> None:
    def reported(rank: str) -> str:
        environment = os.environ | {"XDG_CACHE_HOME": str(tmp_path), "OMPI_COMM_WORLD_RANK": rank}
        environment.pop("NUMBA_CACHE_DIR", None)
        return subprocess.run([sys.executable, "-c", KERNEL], env=environment, capture_output=True, text=True).stderr

    assert reported("1") == ""
    assert not list(tmp_path.rglob("announced"))
    for path in tmp_path.rglob("*.nbi"):
        path.unlink()
    assert reported("0") == compiled.ANNOUNCEMENT + "\n"
    assert list(tmp_path.rglob("*.nbc"))
    assert reported("0") == ""


def test_processes_may_start_at_once(tmp_path: Path) -> None:
    environment = os.environ | {"XDG_CACHE_HOME": str(tmp_path)}
    environment.pop("NUMBA_CACHE_DIR", None)
    running = [subprocess.Popen([sys.executable, "-c", KERNEL], env=environment) for _ in range(4)]
    assert [process.wait(120) for process in running] == [0] * 4
    assert len(list((tmp_path / "riser_soil").iterdir())) == 1


def test_division_by_zero_is_no_crash() -> None:
    @compiled.njit
    def ratio(a: float, b: float) -> float:
        return a / b

    assert ratio(1.0, 0.0) == np.inf
