"""The README's commands run, its scenes compute what it says, and what it points to is there."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from riser_soil.results import Run
from riser_soil.results.netcdf import SERIES
from riser_soil.results.record import FIELDS
from riser_soil.scene.scene import Scene
from tests.on_ranks import ROOT, SHARED_CORES, environment, finished

pytestmark = pytest.mark.xdist_group("readme")

README = (ROOT / "README.md").read_text(encoding="utf-8")
FIRST_SCENE = ROOT / "demos/first_scene.yaml"
CLOSE = 1e-3


def blocks(language: str) -> list[str]:
    """The README's code blocks of a language."""
    return re.findall(rf"^```{language}\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)


COMMANDS = [line for block in blocks("sh") for line in block.splitlines()]
RUNNABLE = [c for c in COMMANDS if not c.startswith(("make ", "docker "))]


def bash(command: str, folder: Path) -> subprocess.CompletedProcess[str]:
    readers = {name: value for name, value in environment().items() if name not in SHARED_CORES}
    return finished(["bash", "-c", command], folder, readers)


@pytest.fixture(scope="module")
def newcomer(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with what the README's commands need."""
    folder = tmp_path_factory.mktemp("newcomer")
    (folder / "demos").symlink_to(ROOT / "demos")
    (folder / ".venv").symlink_to(sys.prefix)
    return folder


@pytest.fixture(scope="module")
def done(newcomer: Path) -> dict[str, subprocess.CompletedProcess[str]]:
    """All commands that can be run here, in their order."""
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
    promised = ["scene.yaml", "summary.json", "results.nc", "riser.xdmf", "riser.h5"]
    assert sorted(p.name for p in (newcomer / "results/first").iterdir()) == sorted(promised)
    assert {"soil.xdmf", "soil.h5"} < {p.name for p in (newcomer / "results/two_ranks").iterdir()}
    assert json.loads((newcomer / "scene.schema.json").read_text())["title"] == "Scene"
    assert (newcomer / "results/first.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("command", [c for c in COMMANDS if c.startswith("make ")])
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
    assert blocks("yaml")[0] == FIRST_SCENE.read_text(encoding="utf-8")


def quoted(row: str) -> list[float]:
    """The numbers of a row of the first scene's table."""
    line = next(line for line in README.splitlines() if line.startswith(f"| {row} |"))
    return [float(number) for number in re.findall(r"\d+\.\d+", line)]


@pytest.mark.parametrize(
    ("row", "path", "unit"),
    [
        ("top tension", ("end", "effective_tension"), 1e3),
        ("touchdown arc length", ("touchdown_arc",), 1.0),
        ("largest bending moment", ("max_bending_moment",), 1e3),
    ],
)
def test_first_scene_gives_the_quoted_numbers(first: Run, row: str, path: tuple[str, ...], unit: float) -> None:
    hang, heave = first.summary["stages"]
    final, extremes = below(hang["final"], path), below(heave["extremes"], path)
    static = final["value"] if isinstance(final, dict) else final
    at_rest, *dynamic = quoted(row)
    assert at_rest == pytest.approx(static / unit, rel=CLOSE)
    assert dynamic[-1] == pytest.approx(extremes["max"] / unit, rel=CLOSE)
    assert len(dynamic) == 1 or dynamic[0] == pytest.approx(extremes["min"] / unit, rel=CLOSE)


def test_check_by_hand(first: Run) -> None:
    """The catenary's top tension H + w h with the numbers as the README has them."""
    found = re.search(r"With H = ([\d.]+) kN.*?h = ([\d.]+) m this gives ([\d.]+) kN", README, re.DOTALL)
    weight = re.search(r"= ([\d.]+) N/m here", README)
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
    first, clay = blocks("yaml")
    (newcomer / "clay.yaml").write_text(first + clay, encoding="utf-8")
    ended = bash(".venv/bin/riser-soil run clay.yaml --set stages.1.duration=0.1", newcomer)
    assert ended.returncode == 0, ended.stderr
    run = Run(newcomer / "clay")
    found = re.search(r"the touchdown point moves to ([\d.]+) m", README)
    assert found
    assert run.summary["stages"][0]["final"]["touchdown_arc"] == pytest.approx(float(found[1]), rel=CLOSE)
    assert f"{len(run.soil_frame().cells):,} hexahedra" in README


def test_python(first: Run, newcomer: Path) -> None:
    (code,) = blocks("python")
    (newcomer / "read.py").write_text(code, encoding="utf-8")
    ended = bash(".venv/bin/python read.py", newcomer)
    assert ended.returncode == 0, ended.stderr
    assert ended.stdout == "largest moment 3837 N.m at arc 36.5 m; stages ['hang', 'heave']\n"


@pytest.mark.parametrize("target", sorted(set(re.findall(r"\]\(([^)]+)\)", README))))
def test_link(target: str) -> None:
    headings = re.findall(r"^#+ (.+)$", README, re.MULTILINE)
    anchors = ["#" + re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings]
    assert target in anchors or (ROOT / target).exists()


@pytest.mark.parametrize("path", sorted(set(re.findall(r"`((?:riser_soil|tests|demos|docker)/[\w/.]*)`", README))))
def test_path(path: str) -> None:
    assert (ROOT / path).exists() or path == "demos/touchdown_clay/results"


def test_words_of_the_table_are_known() -> None:
    table = README.split("| word | symbol | unit | meaning |")[1].split("\n\n")[0]
    words = {w for row in table.splitlines()[2:] for w in re.findall(r"\w+", row.split("|")[1]) if w != "or"}
    assert len(words) > 30
    assert words <= {*keys_of(Scene.model_json_schema(by_alias=True)), *SERIES, *FIELDS}


def keys_of(schema: Any) -> Iterator[str]:
    """All keys of the scene language."""
    if isinstance(schema, dict):
        yield from schema.get("properties", {})
    values = schema.values() if isinstance(schema, dict) else schema if isinstance(schema, list) else ()
    for value in values:
        yield from keys_of(value)
