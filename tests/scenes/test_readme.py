"""The commands of README.md and of the pages in docs run, and their scenes compute what the pages say."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from demos.figures import QUICK, Texts, quick_figures
from demos.page import all_pages, places
from demos.touchdown_clay.run import PAGE as DEMO
from riser_soil.results import Run
from tests.support.on_ranks import ROOT, SHARED_CORES, environment, finished
from tests.support.pages import DOCS, README, blocks, same_figures, text
from tests.support.said import line_with

pytestmark = pytest.mark.xdist_group("readme")

PAGES = [README, *DOCS]
FIRST_SCENE = ROOT / "demos/first_scene.yaml"

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


@pytest.fixture(scope="module")
def figures(done: object, newcomer: Path) -> Texts:
    """Figures of quick scenes, from the runs that the pages' commands made, and a few more."""
    return quick_figures(newcomer)


TOLD = [
    pytest.param(page, name, id=f"{page.relative_to(ROOT)}: {name}")
    for page in all_pages()
    for name in places(page.read_text(encoding="utf-8"))
    if name.startswith(QUICK)
]


@pytest.mark.parametrize(("page", "name"), TOLD)
def test_figures_of_quick_scenes(page: Path, name: str, figures: Texts) -> None:
    """What the pages tell is what the scenes give; `make figures` writes it anew."""
    for sentence in places(page.read_text(encoding="utf-8"))[name]:
        assert same_figures(sentence, figures[name]), f"{sentence} is told of {name}, and runs give {figures[name]}"


def test_all_figures_of_quick_scenes_are_told(figures: Texts) -> None:
    names = [name for page in all_pages() for name in places(page.read_text(encoding="utf-8"))]
    assert {name for name in names if name.startswith(QUICK)} == figures.keys()


def test_check_by_hand(first: Run, figures: Texts) -> None:
    """The catenary's top tension H + w h is the run's."""
    tension = first.summary["stages"][0]["final"]["end"]["effective_tension"]
    assert float(figures["first by hand"]) == pytest.approx(tension / 1e3, rel=1e-3)


def test_figures_of_the_demo_are_those_of_its_tables() -> None:
    """In all pages alike; its long test compares them with a run."""
    rows = [row.split("|") for row in text(DEMO).splitlines() if row.count("|") == 4]
    table = {row[1].strip(): [float(number) for number in re.findall(r"[\d.]+", f"{row[2]} {row[3]}")] for row in rows}
    settled, strength = table["deepest settlement of the clay [mm]"], table["most of the strength used [-]"]
    figures: dict[str, set[str]] = {}
    for page in all_pages():
        for name, texts in places(page.read_text(encoding="utf-8")).items():
            figures.setdefault(name, set()).update(texts)
    shown = [float(each) for name in ("demo laid", "demo deepest") for each in figures[name]]
    assert shown == pytest.approx(settled, abs=0.051)
    assert figures["demo strength"] == {f"{strength[1]:.2f}"}
    assert {name: texts for name, texts in figures.items() if name.startswith("demo ") and len(texts) > 1} == {}


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
