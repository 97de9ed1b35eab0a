"""Wheel and source distribution in build/dist, checked: what they hold, and that the wheel works by itself.

    python scripts/dist.py

Nothing is fetched: it needs the environment of `make setup`.
"""

from __future__ import annotations

import argparse
import io
import os
import shutil
import subprocess
import sys
import tempfile
import zipfile
from contextlib import redirect_stdout
from pathlib import Path, PurePosixPath

from setuptools import build_meta

ROOT = Path(__file__).resolve().parents[1]
BESIDE = ("riser_soil/py.typed", "riser_soil/report/template/*.*")  # the modules


def main() -> None:
    """Build both, check them, tell their names and sizes."""
    parser = argparse.ArgumentParser(description="build and check wheel and source distribution")
    parser.add_argument("folder", nargs="?", type=Path, default=ROOT / "build" / "dist")
    folder = parser.parse_args().folder.resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    wheel, source = build(ROOT, folder)
    check_modules(wheel)
    check_source(source, wheel)
    check_command(wheel)
    for file in (wheel, source):
        print(f"{file}: {file.stat().st_size / 1e6:.2f} MB")


def build(project: Path, folder: Path) -> tuple[Path, Path]:
    """Wheel and source distribution of a copy of the project's own files, in which nothing old lies about."""
    with tempfile.TemporaryDirectory() as place:
        copy = Path(place) / "project"
        shutil.copytree(project / "riser_soil", copy / "riser_soil", ignore=shutil.ignore_patterns("__pycache__"))
        for name in ("pyproject.toml", "README.md", "LICENSE"):
            shutil.copy2(project / name, copy)
        return _built(copy, folder)


def _built(project: Path, folder: Path) -> tuple[Path, Path]:
    before = Path.cwd()
    os.chdir(project)
    try:
        with redirect_stdout(io.StringIO()):
            wheel, source = build_meta.build_wheel(str(folder)), build_meta.build_sdist(str(folder))
    finally:
        os.chdir(before)
    return folder / wheel, folder / source


def own_files() -> set[str]:
    """Modules of the package and what it needs beside them, as a wheel names them."""
    files = {path.relative_to(ROOT).as_posix() for path in (ROOT / "riser_soil").rglob("*.py")}
    beside = (path for name in BESIDE for path in ROOT.glob(name))
    return files | {path.relative_to(ROOT).as_posix() for path in beside}


def files_of(wheel: Path) -> set[str]:
    """Files of the package in a wheel."""
    with zipfile.ZipFile(wheel) as packed:
        return {name for name in packed.namelist() if name.startswith("riser_soil/")}


def check_modules(wheel: Path) -> None:
    """The wheel has the package's files, and no others but its own records."""
    if odd := sorted(files_of(wheel) ^ own_files()):
        sys.exit(f"{wheel}: does not hold the package as it is: {', '.join(odd[:5])} and {max(0, len(odd) - 5)} more")
    with zipfile.ZipFile(wheel) as packed:
        others = [name for name in packed.namelist() if name not in own_files() and ".dist-info/" not in name]
        if others or not any(name.endswith("/LICENSE") for name in packed.namelist()):
            sys.exit(f"{wheel}: holds {others}, or lacks the licence")


def check_source(source: Path, wheel: Path) -> None:
    """A wheel made from the source distribution is the same."""
    with tempfile.TemporaryDirectory() as place:
        shutil.unpack_archive(source, place)
        (project,) = Path(place).iterdir()
        again, _ = _built(project, Path(place))
        if odd := files_of(again) ^ files_of(wheel):
            sys.exit(f"{source}: makes another wheel: {', '.join(sorted(odd)[:5])}")


def check_command(wheel: Path) -> None:
    """The wheel, put into a folder by itself, has the version in its name, and writes and checks a scene."""
    with tempfile.TemporaryDirectory() as place:
        run = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-index", "--target"]
        subprocess.run([*run, f"{place}/site", str(wheel)], check=True)
        there = os.environ | {"PYTHONPATH": f"{place}/site"}
        own = [sys.executable, "-c", "import riser_soil; print(riser_soil.__file__, riser_soil.__version__)"]
        file, version = subprocess.run(
            own, check=True, cwd=place, env=there, capture_output=True, text=True
        ).stdout.split()
        if not PurePosixPath(file).is_relative_to(place) or version not in wheel.name:
            sys.exit(f"{wheel}: gives {file}, version {version}")
        command = [sys.executable, "-m", "riser_soil", "new", "mooring"]
        subprocess.run(command, check=True, cwd=place, env=there, stdout=subprocess.DEVNULL)


if __name__ == "__main__":
    main()
