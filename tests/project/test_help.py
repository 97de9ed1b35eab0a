"""Every module that can be run tells what it does and takes when it is asked for help, and does nothing else."""

from __future__ import annotations

import runpy
import subprocess
import sys
from pathlib import Path

import pytest
from rich.markup import render
from typer.main import get_group

from riser_soil.__main__ import app

ROOT = Path(__file__).parents[2]
# VTK does not stand processes that have imported dolfinx.
ALONE = [ROOT / "riser_soil" / "plots" / f"{name}.py" for name in ("touchdown", "film")]


def runnable() -> list[Path]:
    places = (ROOT / name for name in ("riser_soil", "demos", "benchmarks", "meshes"))
    files = sorted(file for place in places for file in place.rglob("*.py"))
    return [file for file in files if file.name == "__main__.py" or '__name__ == "__main__"' in file.read_text()]


def test_the_modules_that_can_be_run_are_found() -> None:
    names = {str(file.relative_to(ROOT)) for file in runnable()}
    assert {"riser_soil/__main__.py", "benchmarks/__main__.py", "demos/waves/rao.py", "meshes/block.py"} < names


TOGETHER = [file for file in runnable() if file not in ALONE]


@pytest.mark.parametrize("file", TOGETHER, ids=lambda file: str(file.relative_to(ROOT)))
def test_help(file: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(sys, "argv", [str(file), "--help"])
    with pytest.raises(SystemExit) as ended:
        runpy.run_path(str(file), run_name="__main__")
    assert ended.value.code == 0
    assert "usage: " in capsys.readouterr().out.lower()


@pytest.mark.parametrize(("name", "takes"), [("touchdown", "[-h] folder png [magnify]"), ("film", "[-h]")])
def test_help_of_pictures_and_films(name: str, takes: str) -> None:
    call = [sys.executable, "-m", f"riser_soil.plots.{name}", "--help"]
    done = subprocess.run(call, capture_output=True, text=True, cwd=ROOT)
    assert done.returncode == 0
    assert f"usage: python -m riser_soil.plots.{name} {takes}" in done.stdout
    assert not done.stderr


COMMANDS = get_group(app).commands


@pytest.mark.parametrize("name", COMMANDS)
def test_help_shows_units_in_brackets(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Help is read as markup, which takes a bare [s] or [m] for a style: it strikes out what follows, unseen."""
    for option in COMMANDS[name].params:
        written = getattr(option, "help", None) or ""
        assert render(written).plain == written.replace("\\[", "["), option.name
