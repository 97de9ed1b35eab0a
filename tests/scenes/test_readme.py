"""The commands of README.md and of the pages in docs run, and their scenes compute what the pages say."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from riser_soil.results import Run
from tests.support.on_ranks import ROOT, SHARED_CORES, environment, finished
from tests.support.pages import DOCS, README, blocks, flowing, text
from tests.support.said import line_with

pytestmark = pytest.mark.xdist_group("readme")

PAGES = [README, *DOCS]
EXPLAINED = ROOT / "docs/first_scene.md"
TUTORIAL = ROOT / "docs/tutorial_riser.md"
FIRST_SCENE = ROOT / "demos/first_scene.yaml"
CLOSE = 1e-3

COMMANDS = [line for page in PAGES for block in blocks(page, "sh") for line in block.splitlines()]
RUNNABLE = [c for c in COMMANDS if not c.startswith(("make ", "docker "))]
GOALS = sorted({goal for page in PAGES for goal in re.findall(r"`(make [\w-]+)`", text(page))})


def bash(command: str, folder: Path) -> subprocess.CompletedProcess[str]:
    readers = {name: value for name, value in environment().items() if name not in SHARED_CORES}
    return finished(["bash", "-c", command], folder, readers)


@pytest.fixture(scope="module")
def newcomer(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with what the pages' commands need."""
    folder = tmp_path_factory.mktemp("newcomer")
    (folder / "demos").symlink_to(ROOT / "demos")
    (folder / ".venv").symlink_to(sys.prefix)
    return folder


@pytest.fixture(scope="module")
def done(newcomer: Path) -> dict[str, subprocess.CompletedProcess[str]]:
    """All commands that can be run here, the README's first, in their order."""
    return {command: bash(command, newcomer) for command in RUNNABLE}


@pytest.fixture(scope="module")
def first(done: object, newcomer: Path) -> Run:
    return Run(newcomer / "results/first")


def test_there_are_commands_of_all_kinds() -> None:
    assert {c.split()[0] for c in COMMANDS} == {"make", "docker", "mpirun", ".venv/bin/riser-soil", ".venv/bin/python"}


@pytest.mark.parametrize("command", RUNNABLE)
def test_command(done: dict[str, subprocess.CompletedProcess[str]], command: str) -> None:
    assert done[command].returncode == 0, done[command].stderr


def test_commands_leave_what_they_promise(done: object, newcomer: Path) -> None:
    promised = ["scene.yaml", "summary.json", "results.nc", "riser.xdmf", "riser.vtkhdf"]
    assert sorted(p.name for p in (newcomer / "results/first").iterdir()) == sorted(promised)
    assert {"soil.xdmf", "soil.vtkhdf"} < {p.name for p in (newcomer / "results/two_ranks").iterdir()}
    assert json.loads((newcomer / "scene.schema.json").read_text())["title"] == "Scene"
    assert (newcomer / "results/first.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("command", sorted({*GOALS, *(c for c in COMMANDS if c.startswith("make "))}))
def test_goal_of_make(command: str) -> None:
    assert bash(command.replace("make", "make -n", 1), ROOT).returncode == 0


def test_docker_commands_fit_the_image() -> None:
    build, run = (c for c in COMMANDS if c.startswith("docker "))
    assert build in bash("make -n docker", ROOT).stdout
    image = (ROOT / "docker/Dockerfile").read_text()
    assert 'ENTRYPOINT ["riser-soil"]' in image
    assert "WORKDIR /results" in image
    assert image.index("scripts/setup.sh dependencies") < image.index("COPY . .")  # a layer of their own
    assert run.startswith(
        'docker run --rm --user "$(id -u):$(id -g)" -v "$PWD:/results" riser_soil run demos/first_scene.yaml'
    )


def test_echo_of_the_scene_runs_to_the_same_numbers(first: Run, newcomer: Path) -> None:
    again = bash(".venv/bin/riser-soil run results/first/scene.yaml -o results/again", newcomer)
    assert again.returncode == 0, again.stderr
    assert Run(newcomer / "results/again").summary["stages"] == first.summary["stages"]


def test_first_scene_is_the_file() -> None:
    assert blocks(README, "yaml") == [FIRST_SCENE.read_text(encoding="utf-8")]


def quoted(page: Path, row: str) -> list[float]:
    """The numbers of a row of a page's table, without error bars."""
    line = next(line for line in text(page).splitlines() if line.startswith(f"| {row} |"))
    return [float(number) for number in re.findall(r"(?<!± )\b\d+\.\d+", line)]


@pytest.mark.parametrize(("page", "folder"), [(README, "results/first"), (TUTORIAL, "results/steel_catenary")])
@pytest.mark.parametrize(
    ("row", "path", "unit"),
    [
        ("top tension", ("end", "effective_tension"), 1e3),
        ("touchdown arc length", ("touchdown_arc",), 1.0),
        ("largest bending moment", ("max_bending_moment",), 1e3),
    ],
)
def test_scenes_give_the_quoted_numbers(
    done: object, newcomer: Path, page: Path, folder: str, row: str, path: tuple[str, ...], unit: float
) -> None:
    hang, heave = Run(newcomer / folder).summary["stages"]
    final, extremes = below(hang["final"], path), below(heave["extremes"], path)
    static = final["value"] if isinstance(final, dict) else final
    at_rest, *dynamic = quoted(page, row)
    assert at_rest == pytest.approx(static / unit, rel=CLOSE)
    assert dynamic[-1] == pytest.approx(extremes["max"] / unit, rel=CLOSE)
    assert len(dynamic) == 1 or dynamic[0] == pytest.approx(extremes["min"] / unit, rel=CLOSE)


def test_check_by_hand(first: Run) -> None:
    """The catenary's top tension H + w h with the numbers as the page has them."""
    found = re.search(r"With H = ([\d.]+) kN.*?h = ([\d.]+) m this gives ([\d.]+) kN", flowing(EXPLAINED))
    weight = re.search(r"= ([\d.]+) N/m here", flowing(EXPLAINED))
    assert found
    assert weight
    H, h, top = (float(number) for number in found.groups())
    end = first.summary["stages"][0]["final"]["end"]
    assert pytest.approx(end["force"][0] / 1e3, rel=CLOSE) == H
    assert pytest.approx(top, rel=CLOSE) == H + float(weight[1]) * h / 1e3
    assert end["effective_tension"] / 1e3 == pytest.approx(top, rel=CLOSE)


def below(tree: dict[str, Any], path: tuple[str, ...]) -> Any:
    for key in path:
        tree = tree[key]
    return tree


def test_clay_under_the_first_scene(newcomer: Path) -> None:
    (first,), (clay,) = blocks(README, "yaml"), blocks(EXPLAINED, "yaml")
    (newcomer / "clay.yaml").write_text(first + clay, encoding="utf-8")
    ended = bash(".venv/bin/riser-soil run clay.yaml --set stages.1.duration=0.1", newcomer)
    assert ended.returncode == 0, ended.stderr
    run = Run(newcomer / "clay")
    found = re.search(r"the touchdown point moves to ([\d.]+) m", flowing(EXPLAINED))
    assert found
    assert run.summary["stages"][0]["final"]["touchdown_arc"] == pytest.approx(float(found[1]), rel=CLOSE)
    assert f"{len(run.soil_frame().cells):,} hexahedra" in flowing(EXPLAINED)


def test_python(first: Run, newcomer: Path) -> None:
    """The blocks one after the other, as one script, but those of python.md, which test_api.py runs."""
    code = [block for page in PAGES if page.name != "python.md" for block in blocks(page, "python")]
    (newcomer / "read.py").write_text("\n".join(code), encoding="utf-8")
    ended = bash(".venv/bin/python read.py", newcomer)
    assert ended.returncode == 0, ended.stderr
    period, moment, stiffness, by_pyvista, by_meshio, tension = ended.stdout.splitlines()
    line_with([period], "natural period", "11.59 s", "in plane")
    line_with([moment], "moment", "3837 N.m", "arc 36.5 m", "['hang', 'heave']")
    line_with([stiffness], "21991 Pa", "arc 25 m", "last cycle")
    line_with([by_pyvista], "t 20.0 s", "tension 0 N apart")
    line_with([by_meshio], "t 20.0 s", "150 nodes", "top at z 100.00 m")
    line_with([tension], "mean 89.12 kN", "deviation 8.19 kN")
