"""The project's wheel, installed by pip into an empty environment, runs the first scene: no PETSc, MPI or dolfinx."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

from tests.support.on_ranks import ROOT

LARGEST = 360.0  # MB of the environment without pip; 173 of them are LLVM, which llvmlite brings, and 73 numpy
ABSENT = ("petsc4py", "mpi4py", "dolfinx", "gmsh", "scipy", "matplotlib", "pyvista", "xarray")


def called(command: Sequence[object], folder: Path) -> str:
    """Standard output of a command that must succeed, without this process's Python path."""
    mine = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "OMPI_", "PMIX_"))}
    done = subprocess.run([str(word) for word in command], cwd=folder, env=mine, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def size(folder: Path) -> float:
    """MB of the files in a folder, without pip, which is no part of what it installs."""
    paths = (path for path in folder.rglob("*") if path.is_file() and not path.is_symlink() and "pip" not in path.parts)
    return sum(path.stat().st_size for path in paths) / 1e6


@pytest.mark.verify
def test_the_wheel_alone_runs_the_first_scene(tmp_path: Path) -> None:
    """Its top tension at rest is that of docs/first_scene.md."""
    source = tmp_path / "source"
    for name in ("riser_soil", "pyproject.toml", "README.md", "LICENSE"):
        copy = shutil.copytree if (ROOT / name).is_dir() else shutil.copy
        source.mkdir(exist_ok=True)
        copy(ROOT / name, source / name)
    built = ("-m", "pip", "wheel", "--no-deps", "--no-build-isolation", "-w", tmp_path, source)
    called([sys.executable, *built], tmp_path)
    (wheel,) = tmp_path.glob("riser_soil-*.whl")
    called([sys.executable, "-m", "venv", "alone"], tmp_path)
    programs = tmp_path / "alone/bin"
    called([programs / "python", "-m", "pip", "install", wheel], tmp_path)
    look = "import importlib.util as look, sys; print(*(n for n in sys.argv[1:] if look.find_spec(n)))"
    assert called([programs / "python", "-c", look, *ABSENT], tmp_path).split() == []
    assert size(tmp_path / "alone") < LARGEST
    shutil.copy(ROOT / "demos/first_scene.yaml", tmp_path)
    called([programs / "riser-soil", "run", "first_scene.yaml", "-o", "results"], tmp_path)
    stages = json.loads((tmp_path / "results/summary.json").read_text())["stages"]
    assert stages[0]["final"]["end"]["resultant_force"] == pytest.approx(87.82e3, abs=10.0)
