"""Compilation of forms: kept for the processor and version, done once, by whoever comes first; what can go wrong."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from riser_soil.core import compiled
from riser_soil.errors import RiserSoilError
from riser_soil.soil.ffcx_compat import cell_kernel
from riser_soil.soil.weak_form import WeakForm
from tests.support.on_ranks import HANGS

CODE = """
from riser_soil.soil.ffcx_compat import cell_kernel
from riser_soil.soil.weak_form import WeakForm
cell_kernel(WeakForm("quadrilateral", 1, 3, True, (0, 2)).weight())
"""


def form() -> Any:
    return WeakForm("quadrilateral", 1, 3, True, (0, 2)).weight()


def machine_code(folder: Path) -> list[Path]:
    return sorted(folder.rglob("libffcx_*.so"))


def test_a_form_is_compiled_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: Any) -> None:
    monkeypatch.setattr(compiled, "FOLDER", tmp_path)
    (tmp_path / "announced").touch()
    cell_kernel(form())
    (first,) = machine_code(tmp_path)
    made = first.stat().st_mtime_ns
    cell_kernel(form())
    assert [file.stat().st_mtime_ns for file in machine_code(tmp_path)] == [made]
    assert capfd.readouterr() == ("", "")


def test_without_a_compiler_one_line_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: Any) -> None:
    monkeypatch.setattr(compiled, "FOLDER", tmp_path)
    (tmp_path / "announced").touch()
    monkeypatch.setenv("CC", "no-such-compiler")
    with pytest.raises(RiserSoilError, match=r"no-such-compiler.*install gcc") as error:
        cell_kernel(form())
    assert "\n" not in str(error.value)
    assert not machine_code(tmp_path)
    monkeypatch.delenv("CC")
    cell_kernel(form())
    assert len(machine_code(tmp_path)) == 1
    assert capfd.readouterr() == ("", "")


def test_processes_that_start_together_compile_once(tmp_path: Path) -> None:
    """Ranks and workers; what a killed process has left, a folder without a place, is in nobody's way."""
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
    begun = [subprocess.Popen([sys.executable, "-c", CODE], env=environment, stderr=subprocess.PIPE) for _ in range(3)]
    assert [process.communicate(timeout=HANGS)[1] for process in begun].count(b"") >= 2  # one may announce it
    assert [process.returncode for process in begun] == [0, 0, 0]
    (done,) = machine_code(tmp_path)
    left = done.parent.with_name("new-left")
    done.parent.rename(left)
    done = left / done.name
    done.with_suffix("").with_suffix(".c.cached").unlink()
    subprocess.run([sys.executable, "-c", CODE], env=environment, check=True, timeout=HANGS)
    assert len(machine_code(tmp_path)) == 2
