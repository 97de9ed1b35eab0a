"""Load cases without a solver: cases that are done are kept, failed ones are rows; tables, progress, bad input."""

from __future__ import annotations

import csv
import io
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray
from rich.console import Console
from typer.testing import CliRunner

from riser_soil.cases import case_files
from riser_soil.cases.case_values import case_values
from riser_soil.cases.progress import CaseProgress
from riser_soil.cases.sweep import CASES
from riser_soil.commands.app import app
from riser_soil.results.read import Run
from riser_soil.variants import dask_workers, one_run
from riser_soil.variants.runs_folder import Outcome
from tests.support.case_files import case_file
from tests.support.recorded_run import WEIGHT, record
from tests.support.said import line_with, lines_with

SWEEP = "product: {line_types.pipe.EI: [100.0, 200.0], riser.end.position.0: [8.0, 9.0]}"
NAMES = ["EI=100-position_0=8", "EI=100-position_0=9", "EI=200-position_0=8", "EI=200-position_0=9"]
FINISHED = "import sys, shutil; shutil.copytree(sys.argv[1], sys.argv[2], dirs_exist_ok=True)"
Fake = Callable[[str], None]


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A finished run's folder, but for its scene."""
    folder = tmp_path_factory.mktemp("recorded")
    record(folder, duration=7.0, interval=0.1)
    (folder / "scene.yaml").unlink()
    return folder


@pytest.fixture
def fake(monkeypatch: pytest.MonkeyPatch, recorded: Path) -> Fake:
    """Puts a piece of Python in the place of `riser-soil run`; its arguments: a finished run, the case's folder."""

    def put(code: str) -> None:
        monkeypatch.setattr(one_run, "command", lambda made: [sys.executable, "-c", code, str(recorded), str(made)])

    put(FINISHED)
    return put


@pytest.fixture
def invoke(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Callable[..., Any]:
    """The command in a folder with sweep.yaml; its cases are computed one by one."""
    monkeypatch.chdir(tmp_path)

    def invoked(*options: str) -> Any:
        jobs = () if {"--jobs", "--scheduler"} & set(options) else ("--jobs", "1")
        return CliRunner().invoke(app, ["cases", "sweep.yaml", *jobs, *options])

    return invoked


def rows(file: Path) -> list[dict[str, str]]:
    with file.open(newline="", encoding="utf-8") as opened:
        return list(csv.DictReader(opened))


def test_values_of_a_run(recorded: Path) -> None:
    """The recorded catenary: touchdown at 30 - 2 sin t, parameter 32 + sin t [m], recorded each 0.1 s of 7 s."""
    t = np.arange(21, 71) * 0.1
    values = {value.key: value for value in case_values(recorded, since=2.05)}
    arc, a = 30.0 - 2.0 * np.sin(t), 32.0 + np.sin(t)
    expected = {
        "heave: touchdown arc": arc,
        "heave: contact force": WEIGHT * arc,
        "heave: least effective tension": WEIGHT * a,
        "heave: top tension": WEIGHT * np.hypot(a, 148.0 - arc),
    }
    for key, series in expected.items():
        assert values[f"{key}, mean"].value == pytest.approx(series.mean(), rel=1e-9)
        assert values[f"{key}, standard deviation"].value == pytest.approx(series.std(), rel=1e-6)
    assert values["heave: top tension, mean"].unit == "N"
    assert values["heave: top tension, mean"].sign == "positive in tension"
    assert values["heave: top tension, standard deviation"].sign == ""
    assert values["heave: largest touchdown arc"].value == pytest.approx(Run(recorded)["touchdown_arc"].max())
    assert "lay: touchdown arc, mean" not in values


def test_an_extreme_within_the_transient_is_that_of_the_records_behind_it(recorded: Path) -> None:
    """Touchdown at 30 - 2 sin t: the least arc is that of t = 1.57 s, before 2.05 s, the largest that of 4.71 s."""
    samples = {value.key: value.sample for value in case_values(recorded, since=2.05)}
    least, largest = samples["heave: least touchdown arc"], samples["heave: largest touchdown arc"]
    assert least == pytest.approx((30.0 - 2.0 * np.sin(2.1), True, 4.95))
    assert largest == pytest.approx((32.0, False, 4.95), rel=1e-5)
    assert samples["lay: touchdown arc"] is None
    assert samples["heave: touchdown arc, mean"] is None
    all_of_it = {value.key: value.sample for value in case_values(recorded, since=0.0)}
    assert all_of_it["heave: least touchdown arc"] == pytest.approx((28.0, True, 7.0), rel=1e-4)


def test_extremes_of_cases_without_seeds_are_those_of_the_runs(
    tmp_path: Path, fake: Fake, invoke: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    case_file(tmp_path, SWEEP)
    monkeypatch.setattr(case_files, "draw_load_cases", lambda png, title, panels: png.touch())
    done = invoke()
    assert done.exit_code == 0
    line_with(done.stdout, "top tension [kN]")
    assert "warning" not in done.stdout
    table = rows(tmp_path / "sweep/characteristic.csv")
    assert list(dict.fromkeys(row["group"] for row in table)) == NAMES
    row = next(row for row in table if row["quantity"] == "heave: top tension")
    tension = max(Run(tmp_path / "sweep/cases" / NAMES[0])["effective_tension"][2:, -1])
    assert (row["of seeds"], row["seeds"], row["characteristic"], row["low"]) == (f"{tension:.8g}", "1", "", "")


def test_a_full_disk_ends_the_call_and_keeps_what_is_done(
    tmp_path: Path, fake: Fake, invoke: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Further cases would fail for it, too. What the one has written is gone; a second call does what is missing."""
    case_file(tmp_path, SWEEP)
    monkeypatch.setattr(case_files, "draw_load_cases", lambda png, title, panels: png.touch())
    full = "if '=200-position_0=8' in sys.argv[2]: print('results.nc: No space left on device'); sys.exit(4)"
    fake(f"import sys\n{full}\n{FINISHED}")
    ended = invoke()
    assert ended.exit_code == 4
    says = (NAMES[2], "No space left", "2 of 4 cases had ended", "sweep keeps them", "call again to go on")
    line_with(ended.stderr.splitlines(), *says)
    assert sorted(each.name for each in (tmp_path / "sweep" / CASES).iterdir()) == NAMES[:2]
    assert not (tmp_path / "sweep/cases.csv").exists()
    fake(FINISHED)
    again = invoke()
    assert again.exit_code == 0
    line_with(again.stdout, "4 cases", "2 of them done")
    assert [row["status"] for row in rows(tmp_path / "sweep/cases.csv")] == ["0"] * 4


def test_tables_of_all_cases(tmp_path: Path, fake: Fake, invoke: Callable[..., Any]) -> None:
    """One that fails is a row with its reason; the command says so, and its status is 3."""
    case_file(tmp_path, SWEEP)
    fake(f"import pathlib, sys\nif '=200-position_0=9' in sys.argv[2]: sys.exit('out of soil')\n{FINISHED}")
    done = invoke()
    assert done.exit_code == 3
    assert done.stderr == line_with(done.stderr, "failed:", "EI=200-position_0=9", "sweep/cases.csv") + "\n"
    line_with(done.stdout, "4 of 4:", "EI=200-position_0=9:", "failed", "status 1:", "out of soil")
    line_with(done.stdout, "3 of 4 cases", "tables", "sweep")
    table = rows(tmp_path / "sweep/cases.csv")
    assert [(row["case"], row["line_types.pipe.EI"], row["status"], row["reason"]) for row in table] == [
        (NAMES[0], "100.0", "0", ""),
        (NAMES[1], "100.0", "0", ""),
        (NAMES[2], "200.0", "0", ""),
        (NAMES[3], "200.0", "1", "out of soil"),
    ]
    tension = max(Run(tmp_path / "sweep/cases" / NAMES[0])["effective_tension"][2:, -1])
    assert [row["heave: top tension [N]"] for row in table] == [f"{tension:.8g}"] * 3 + [""]
    extremes = {row["quantity"]: row for row in rows(tmp_path / "sweep/extremes.csv")}
    assert extremes["heave: top tension"]["largest"] == f"{tension:.8g}"
    assert (extremes["heave: top tension"]["in case"], extremes["heave: top tension"]["cases"]) == (NAMES[0], "3")
    with xarray.open_dataset(tmp_path / "sweep/cases.nc", engine="h5netcdf") as opened:
        tables: Any = opened  # numpy's versions type lists differently
        assert tables["case"].values.tolist() == NAMES
        assert tables["set_line_types_pipe_EI"].values.tolist() == [100.0, 100.0, 200.0, 200.0]
        assert tables["status"].values.tolist() == [0, 0, 0, 1]
        assert tables["reason"].values.tolist() == ["", "", "", "out of soil"]
        top = tables["heave_top_tension"]
        assert (top.attrs["units"], top.attrs["stage"], top.attrs["sign_convention"]) == (
            "N", "heave", "positive in tension",
        )  # fmt: skip
        assert top.values == pytest.approx([tension] * 3 + [np.nan], nan_ok=True)
    assert (tmp_path / "sweep/cases.png").read_bytes().startswith(b"\x89PNG")


def test_a_second_call_does_what_failed_and_what_is_new(
    tmp_path: Path, fake: Fake, invoke: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    case_file(tmp_path, SWEEP)
    monkeypatch.setattr(case_files, "draw_load_cases", lambda png, title, panels: png.touch())
    fake(f"import pathlib, sys\nif '=200-position_0=9' in sys.argv[2]: sys.exit('out of soil')\n{FINISHED}")
    assert invoke().exit_code == 3
    fake(FINISHED)
    again = invoke()
    assert again.exit_code == 0
    first, second, *_ = again.stdout.splitlines()
    line_with([first], "4 cases", "3 of them done")
    line_with([second], "4 of 4:", "EI=200-position_0=9:", "done")
    case_file(tmp_path, SWEEP.replace("[100.0, 200.0]", "[100.0, 300.0]"))
    line_with(invoke().stdout.splitlines()[:1], "4 cases", "2 of them done")
    assert invoke("--set", "gravity=9.8").stdout.startswith("4 cases\n")


@pytest.mark.parametrize(
    ("there", "options", "says"),
    [
        ("sweep/mine", (), "sweep: holds something else than load cases, mine; choose another with -o FOLDER"),
        ("sweep/cases/EI=100-position_0=8/mine", (), "is no case's folder, and would be replaced; move it away"),
        ("sweep", (), "sweep: is a file, not a folder; choose another result folder with -o FOLDER"),
        ("x", ("--jobs", "0"), "--jobs 0: must be 1 or more, and does not go with --scheduler"),
        ("x", ("--jobs", "2", "--scheduler", "tcp://a:1"), "--jobs 2: must be 1 or more, and does not go with"),
        ("x", ("--limit", "0"), "--limit 0: must be greater than 0"),
        ("x", ("--set", "gravity=-1"), "--set gravity=-1: gravity: value -1: must be at least 0"),
    ],
)
def test_bad_input_is_reported_in_one_line(
    tmp_path: Path, invoke: Callable[..., Any], there: str, options: tuple[str, ...], says: str
) -> None:
    case_file(tmp_path, SWEEP if "--set" not in options else "table: [{name: a, set: {title: x}}]")
    (tmp_path / there).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / there).touch()
    before = sorted(tmp_path.rglob("*"))
    done = invoke(*options)
    assert done.exit_code == 2
    (line,) = done.stderr.splitlines()
    assert says in line
    assert sorted(tmp_path.rglob("*")) == before


def test_a_scheduler_that_does_not_answer_leaves_all_as_it_was(
    tmp_path: Path, fake: Fake, invoke: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    case_file(tmp_path, SWEEP)
    monkeypatch.setattr(case_files, "draw_load_cases", lambda png, title, panels: png.touch())
    assert invoke("-o", "done").exit_code == 0
    case_file(tmp_path, SWEEP.replace("100.0", "300.0"))
    before = sorted(tmp_path.rglob("*"))
    monkeypatch.setattr(dask_workers, "CONNECTING", "0.1s")
    for folder in ("done", "new"):
        nobody = invoke("-o", folder, "--scheduler", "tcp://127.0.0.1:9")
        assert nobody.exit_code == 2
        line_with(nobody.stderr.splitlines()[:1], "--scheduler tcp://127.0.0.1:9:", "nobody answers")
        assert sorted(tmp_path.rglob("*")) == before


@pytest.mark.parametrize("terminal", [True, False])
def test_progress_is_a_table_on_a_terminal_and_lines_elsewhere(
    terminal: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    """Twelve cases of two sea states, nine of them done before."""
    groups = {f"{sea}{n}": (sea, "far") for sea in ("mild", "storm") for n in range(6)}
    console = Console(force_terminal=terminal, stderr=True, width=80, height=20)
    todo = {"storm3", "storm4", "storm5"}
    with CaseProgress(groups, todo, lambda: {"storm4", "storm5"}, console) as progress:
        progress.add(Outcome("storm3", "", 0, seconds=1.5))
        progress.add(Outcome("storm4", "", 3, "no convergence"))
        Console(width=80, file=(table := io.StringIO())).print(progress.table())
    out, err = capsys.readouterr()
    assert "11 of 12:" in line_with(out + err, "storm4:", "failed", "status 3:", "no convergence")
    assert ["10 of 12:" in line for line in lines_with(out, "storm3:", "done", "1.5 s")] == [True] * (not terminal)
    assert ("11 of 12 ended" in err) is terminal
    assert progress.ended == 11
    shown = [[cell.strip() for cell in line.split("│")[1:-1]] for line in table.getvalue().splitlines()]
    assert [row for row in shown if row] == [
        ["mild, far", "6", "", "", "", ""],
        ["storm, far", "4", "1", "", "1", "0.75"],
        ["all", "10", "1", "", "1", "0.75"],
    ]


def test_a_table_of_progress_has_no_more_rows_than_the_screen() -> None:
    labels = [(sea, place) for sea in ("a", "b", "c", "d") for place in ("near", "far")]
    groups = {f"{sea}-{place}-{n}": (sea, place) for sea, place in labels for n in range(3)}
    high, low = (CaseProgress(groups, set(), set, Console(height=height)).table().row_count for height in (40, 13))
    assert (high, low) == (9, 5)
