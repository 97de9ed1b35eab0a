"""The pictures of riser-soil plot, by what they put on their axes and what files they leave."""

from __future__ import annotations

import io
import warnings
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.patches import StepPatch
from PIL import Image
from rich.console import Console
from typer.testing import CliRunner

from riser_soil.__main__ import app
from riser_soil.core.outputs import ALONG_RISER
from riser_soil.errors import ResultsError
from riser_soil.plots import film
from riser_soil.plots.album import album, pictures
from riser_soil.plots.curves import Curves, envelope, sheet
from riser_soil.plots.histories import energy
from riser_soil.plots.progress import DrawingProgress
from riser_soil.plots.ranges import draw_range, mean_in_time, names, range_sheet
from riser_soil.plots.scales import axis_words, metres
from riser_soil.plots.shape import filmed_records, seabed_under, snapshots
from riser_soil.plots.side_by_side import sheets
from riser_soil.report.report import write_report
from riser_soil.report.report_file import of_folders
from riser_soil.results import Run
from riser_soil.results.stage_records import stage_records
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.whole_run import run as run_scene
from tests.support.on_ranks import ROOT
from tests.support.recorded_run import record
from tests.support.said import line_with
from tests.support.scenes import prescribed, riser_scene, static

SCENE = (ROOT / "demos/first_scene.yaml").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """A riser alone, in 1 s of motion, on the first scene's seabed."""
    folder = tmp_path_factory.mktemp("album") / "run"
    record(folder, duration=1.0)
    (folder / "scene.yaml").write_text(SCENE, encoding="utf-8")
    return Run(folder)


def test_every_number_along_the_riser_has_a_range_graph(run: Run) -> None:
    stage = stage_records(run)
    expected = [output.name for output in ALONG_RISER if not output.vector and output.name in run.variables]
    assert names(stage) == [name for name in expected if np.isfinite(run[name]).any()]
    assert {"effective_tension", "bending_moment", "bend_utilisation", "slip"} <= {*names(stage)}
    assert axis_words("stress", "Pa") == ("stress [MPa]", 1e-6)


def test_a_range_is_least_mean_and_largest_of_the_stage(run: Run) -> None:
    _, (axes,) = sheet(1, 1)
    draw_range(axes, stage_records(run), "bending_moment")
    most, mean, least = (np.asarray(line.get_ydata()) for line in axes.lines)
    values = 1e-3 * run["bending_moment"]
    assert most == pytest.approx(values.max(axis=0))
    assert least == pytest.approx(values.min(axis=0))
    assert ((least <= mean) & (mean <= most)).all()
    line_with(axes.get_ylabel().replace("\n", " "), "bending moment", "magnitude [kN m]")
    largest, arc = values.max(), run.arc[values.max(axis=0).argmax()]
    assert axes.get_legend_handles_labels()[1][0] == f"max, largest {largest:.4g} at {arc:.4g} m"


def test_limits_are_drawn_by_element_where_the_quantity_comes_near_them(tmp_path: Path) -> None:
    """A pipe of which the upper half may be bent less; a tension far below its limit is left to the legend."""
    pipe = {"EA": 1.0e8, "EI": 1.0e3, "mass": 20.0, "submerged_weight": 100.0, "max_tension": 1.0e9}
    ends = {"start": prescribed(0.0, 0.0, 10.0), "end": prescribed(30.0, 0.0, 10.0)}
    more = ends | {"riser": {"initial": "catenary"}, "gravity": 9.81}
    scene = riser_scene(static(), pipe=pipe | {"min_bend_radius": 8.0}, length=40.0, elements=4, **more)
    scene["line_types"]["stiff"] = scene["line_types"]["pipe"] | {"min_bend_radius": 10.0}
    halves = [{"line_type": name, "length": 20.0, "elements": 2} for name in ("pipe", "stiff")]
    scene["riser"]["segments"] = halves
    run_scene(scene_from_mapping(scene), tmp_path / "run")
    stage = stage_records(Run(tmp_path / "run"))
    axes = range_sheet(stage, "curvature").axes[0]
    (limit,) = [each for each in axes.patches if isinstance(each, StepPatch) and each.get_label() == "limit"]
    assert limit.get_data()[0] == pytest.approx([0.125, 0.125, 0.1, 0.1])
    assert limit.get_data()[1] == pytest.approx([0.0, 10.0, 20.0, 30.0, 40.0])
    of_tension = range_sheet(stage, "effective_tension").axes[0]
    assert "limit, 1e+06: above the graph" in of_tension.get_legend_handles_labels()[1]


def test_a_range_is_shown_near_the_touchdown_points_too(run: Run) -> None:
    whole, close = range_sheet(stage_records(run), "bending_moment").axes
    touchdown = run["touchdown_arc"]
    assert whole.get_xlim() == pytest.approx((run.arc[0], run.arc[-1]))
    low, high = close.get_xlim()
    assert low <= np.nanmin(touchdown) <= np.nanmax(touchdown) <= high < run.arc[-1]


def test_what_is_unknown_near_the_touchdown_points_is_not_shown_there(run: Run, tmp_path: Path) -> None:
    """A utilisation of the upper half of a riser, of another line type than what touches down."""
    folder = tmp_path / "half"
    record(folder, duration=0.3)
    (folder / "scene.yaml").write_text(SCENE, encoding="utf-8")
    with h5py.File(folder / "results.nc", "r+") as file:
        file["code_utilisation"][:, file["arc"][...] < 75.0] = np.nan
    (whole,) = range_sheet(stage_records(Run(folder)), "code_utilisation").axes
    assert whole.get_xlim()[1] == pytest.approx(run.arc[-1])
    assert len(range_sheet(stage_records(Run(folder)), "bursting_utilisation").axes) == 2


def test_the_shape_shows_extremes_once_and_one_cycle(run: Run) -> None:
    axes = snapshots(stage_records(run)).axes[0]
    words = [text for text in axes.get_legend_handles_labels()[1] if text.endswith(" s")]
    assert words[0].startswith("one cycle, ")
    stage = stage_records(run)
    worst = run.time[stage.records[stage["bending_moment"].max(axis=1).argmax()]]
    assert next(text for text in words if "largest bending moment" in text).endswith(f": {worst:.4g} s")
    assert len({text.rpartition(": ")[2] for text in words[1:]}) == len(words) - 1


def test_a_mean_counts_time_not_records() -> None:
    assert mean_in_time(np.array([0.0, 1.0, 4.0]), np.array([[0.0], [1.0], [4.0]])) == pytest.approx(2.0)
    assert mean_in_time(np.array([2.0]), np.array([[3.0]])) == pytest.approx(3.0)


def test_a_stage_of_one_record_is_a_line(run: Run) -> None:
    _, (axes,) = sheet(1, 1)
    draw_range(axes, stage_records(run, "lay"), "effective_tension")
    assert len(axes.lines) == 1
    assert axes.lines[0].get_ydata() == pytest.approx(1e-3 * run["effective_tension"][0])


def test_a_band_without_width_is_still_a_line(run: Run) -> None:
    figure, (axes,) = sheet(1, 1)
    axes.grid(visible=False)
    envelope(axes, run, "effective_tension", since=float(run.time[-1]))
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    pixels = np.asarray(canvas.buffer_rgba()).astype(int)[..., :3]
    blue = (pixels[..., 2] - pixels[..., 0]) > 60
    assert blue.any(axis=0).mean() > 0.5, "across most of the sheet"


def test_what_acts_near_touchdown_is_shown_from_close_by(run: Run) -> None:
    _, (close, whole) = sheet(1, 2)
    draw_range(close, stage_records(run), "contact_force")
    draw_range(whole, stage_records(run), "bending_moment")
    assert close.get_xlim()[1] < 40.0
    assert whole.get_xlim()[1] == pytest.approx(run.arc[-1])


def test_a_file_in_the_place_of_the_folder_is_reported(run: Run, tmp_path: Path) -> None:
    (tmp_path / "there").write_text("mine", encoding="utf-8")
    done = CliRunner().invoke(app, ["plot", str(run.folder), "--what", "energy", "-o", str(tmp_path / "there")])
    assert done.exit_code == 2
    assert f"{tmp_path / 'there'}: " in done.output
    assert (tmp_path / "there").read_text(encoding="utf-8") == "mine"


def test_the_names_of_energies_stand_above_their_curves(run: Run) -> None:
    figure = energy(stage_records(run))
    FigureCanvasAgg(figure).draw()
    stored, _ = figure.axes
    names_of_curves = stored.get_legend()
    assert names_of_curves is not None
    assert names_of_curves.get_window_extent().y0 >= stored.get_window_extent().y1
    assert names_of_curves.get_window_extent().x0 >= 0.0


def test_all_pictures_of_a_riser_alone(run: Run, tmp_path: Path) -> None:
    there = {each.name for each in pictures(stage_records(run))}
    assert {"history_ends", "history_touchdown", "history_extremes", "shape", "energy", "solver"} <= there
    assert {each.name for each in pictures(stage_records(run, "lay"))} >= {"range_curvature", "shape"}
    done = CliRunner().invoke(
        app, ["plot", str(run.folder), "-o", str(tmp_path), "--what", "shape,range_slip", "--what", "solver"]
    )
    assert done.exit_code == 0, done.output
    assert sorted(file.name for file in tmp_path.iterdir()) == ["range_slip.png", "shape.png", "solver.png"]
    line_with(done.output, f"{tmp_path / 'shape.png'}:", "shape", "heave", "0 to 1 s")


def test_a_film_is_drawn_where_it_is_asked_for(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """`plot` alone draws all else; each picture is reported before it is drawn, and the last one after it."""
    progress: list[tuple[str, int, int]] = []
    monkeypatch.setattr(DrawingProgress, "show", lambda _, *given: progress.append(given))
    monkeypatch.setattr("riser_soil.plots.album.picture", lambda _, file: Path(file).touch())
    monkeypatch.setattr("riser_soil.plots.album.film", lambda _, file, **given: Path(file).touch())
    monkeypatch.setattr("riser_soil.plots.album.save", lambda _, file: file.touch())
    drawn = [*(each.name for each in pictures(stage_records(run))), "touchdown"]
    for asked, films in (([], []), (["--film"], ["film"]), (["--what", "shape", "--film"], ["film"])):
        progress.clear()
        folder = tmp_path / str(len(asked))
        done = CliRunner().invoke(app, ["plot", str(run.folder), "-o", str(folder), *asked])
        assert done.exit_code == 0, done.output
        expected = [*(["shape"] if "shape" in asked else drawn), *films]
        assert sorted(file.stem for file in folder.iterdir()) == sorted(expected)
        count = len(expected)
        assert progress == [*((name, n, count) for n, name in enumerate(expected)), (expected[-1], count, count)]
        monkeypatch.setattr("riser_soil.plots.album.Picture.draw", lambda _: None)  # all can be drawn, as was seen


def test_frames_of_a_film_and_pictures_of_a_report_are_reported(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Curves, "content", lambda *_: b"<svg/>")
    progress: list[tuple[str, int, int]] = []
    film(run.folder, tmp_path / "riser.gif", period=0.3, on_progress=lambda *given: progress.append(given))
    assert progress == [("film: frames", n, 4) for n in range(5)]
    progress.clear()
    page = write_report(of_folders([run.folder], {}), tmp_path / "report.html", lambda *given: progress.append(given))
    drawn = page.read_text(encoding="utf-8").count("<img ")
    assert [(done, count) for _, done, count in progress] == [(n, drawn) for n in range(drawn)]
    assert any("shape" in words.lower() for words, _, _ in progress)


def test_progress_of_drawing_shows_number_and_per_cent() -> None:
    console = Console(force_terminal=True, width=120, record=True, file=io.StringIO())
    with DrawingProgress(console) as progress:
        progress.show("shape", 3, 12)
    text = console.export_text()
    for words in ("shape", "3/12", "25%"):
        assert words in text
    with DrawingProgress(Console(file=io.StringIO())) as progress:
        progress.show("shape", 3, 12)


@pytest.mark.parametrize(("ending", "begins"), [("svg", b"<?xml"), ("pdf", b"%PDF")])
def test_curves_in_other_formats_are_the_same_each_time(run: Run, tmp_path: Path, ending: str, begins: bytes) -> None:
    made = [next(iter(album(run, tmp_path / name, ["range_slip"], ending)))[0] for name in "ab"]
    one, other = (file.read_bytes() for file in made if file is not None)
    assert one.startswith(begins)
    assert one == other


def test_the_seabed_is_drawn_where_it_is(run: Run) -> None:
    assert seabed_under(run, np.array([[0.0, 0.0, 5.0], [50.0, 0.0, 9.0]])) == pytest.approx([0.0, 0.0])
    figure = next(each for each in pictures(stage_records(run)) if each.name == "shape").draw()
    seabed = [line for line in figure.axes[1].lines if line.get_label() == "seabed"]
    assert seabed[0].get_ydata() == pytest.approx(0.0)


def test_a_single_node_near_the_lowest_point_has_room_around_it(tmp_path: Path) -> None:
    """Elements are long there: its place is in the middle of the picture, drawn without a complaint."""
    ends = {"start": prescribed(0.0, 0.0, 10.0), "end": prescribed(30.0, 0.0, 10.0)}
    pipe = {"EA": 1.0e8, "EI": 1.0, "mass": 20.0, "submerged_weight": 100.0}
    more = ends | {"riser": {"initial": "catenary"}, "gravity": 9.81}
    scene = riser_scene(static(), pipe=pipe, length=40.0, elements=4, **more)
    run_scene(scene_from_mapping(scene), tmp_path / "run")
    hung = Run(tmp_path / "run")
    with warnings.catch_warnings(action="error"):
        axes = snapshots(stage_records(hung)).axes[1]
    for (low, high), value in zip((axes.get_xlim(), axes.get_ylim()), hung["position"][-1, 2, [0, 2]], strict=True):
        assert low < value - 1.0 < value + 1.0 < high


def test_a_film_of_a_riser_alone(run: Run, tmp_path: Path) -> None:
    with Image.open(film(run.folder, tmp_path / "riser.gif", period=0.3)) as opened:
        gif: Any = opened  # Pillow declares n_frames of its readers alone
        assert (gif.size, gif.n_frames) == ((960, 540), 4)
        first = np.asarray(gif.convert("RGB")).astype(int)
        gif.seek(2)
        assert np.abs(np.asarray(gif.convert("RGB")).astype(int) - first).max() > 50
    assert len(filmed_records(stage_records(run), 5)) == 5
    with pytest.raises(ResultsError, match="nothing to colour"):
        film(run.folder, tmp_path / "no.gif", field="settlement")


def test_runs_on_one_sheet(run: Run) -> None:
    drawn = [*sheets({"one": run, "other": run}, None)]
    line_with(drawn[0].caption, "effective tension", "along the riser", "heave")
    assert len(drawn[0].draw().axes[0].lines) == 4
    line_with(drawn[-1].caption, "top tension", "TDP", "in time", "heave")
    assert [*sheets({"one": run}, None)] == []


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--what", "waves"], '"waves" is not among the pictures of this run; it has ranges, histories'),
        (["--what", "energy", "--stage", "lay"], "--what energy: the stage has nothing to draw for it"),
        (["--stage", "storm"], '"storm" is no stage of the run with records; it has lay, heave'),
        (["--format", "gif"], '--format "gif": must be one of png, svg, pdf'),
    ],
)
def test_what_cannot_be_drawn_is_said(run: Run, tmp_path: Path, arguments: list[str], says: str) -> None:
    done = CliRunner().invoke(app, ["plot", str(run.folder), "-o", str(tmp_path / "plots"), *arguments])
    assert done.exit_code == 2
    assert says in done.output
    assert not (tmp_path / "plots").exists()


def test_sizes_read_well() -> None:
    assert [metres(length) for length in (1543.2, 100.0, 99.94, 2.5)] == ["1543 m", "100 m", "99.9 m", "2.5 m"]


COMMANDS = [command.name or command.callback.__name__ for command in app.registered_commands if command.callback]


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_helps(command: str) -> None:
    done = CliRunner().invoke(app, [command, "--help"])
    assert done.exit_code == 0
    assert f"Usage: root {command}" in done.output
