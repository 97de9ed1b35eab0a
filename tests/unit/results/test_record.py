"""The recorder and its folder: what is written when, and what a stopped run leaves behind."""

import io
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from rich.console import Console

from riser_soil.errors import ResultsError, SceneError, WriteError
from riser_soil.results import Run
from riser_soil.results.schedule import DueOutputs, Schedule, SimulatedTime
from riser_soil.results.screen import Progress, print_summary
from tests.support.equal_runs import datasets
from tests.support.recorded_run import (
    CATENARY_ARC,
    NOWHERE,
    SCENE,
    Catenary,
    a_recorder,
    block,
    record,
    soil,
    stacked,
    step,
)
from tests.support.said import telling
from tests.support.small_disk import files_of_at_most
from tests.support.vtk_reading import read_by_vtk

ROOT = Path(__file__).parents[3]


def times_due(schedule: Schedule, steps: list[float]) -> list[float]:
    schedule.begin_stage("dynamic")
    return [t for t in steps if schedule.due(t, last=False).series]


def test_summed_time_steps_still_hit_the_interval() -> None:
    steps = list(np.cumsum(np.full(100, 0.1)))
    assert times_due(Schedule(0.5), steps) == pytest.approx([0.5 * k for k in range(1, 21)])


def test_steps_that_miss_the_interval_are_written_at_the_next_one() -> None:
    assert times_due(Schedule(0.5), [0.3, 0.6, 0.9, 1.2, 1.9, 2.0]) == [0.6, 1.2, 1.9, 2.0]


def test_without_an_interval_every_step_is_written() -> None:
    assert times_due(Schedule(None), [0.1, 0.15, 0.2]) == [0.1, 0.15, 0.2]


def test_pictures_imply_the_series_and_each_has_its_pace() -> None:
    schedule = Schedule(0.4, 0.6)
    schedule.begin_stage("dynamic")
    due = {t: schedule.due(t, last=t == 1.3) for t in (0.4, 0.6, 0.7, 0.8, 1.3)}
    assert due[0.4] == DueOutputs(series=True, pictures=False)
    assert due[0.6] == DueOutputs(series=True, pictures=True)
    assert due[0.7] == DueOutputs(series=False, pictures=False)
    assert due[1.3] == DueOutputs(series=True, pictures=True)


def test_a_static_stage_is_written_once_at_its_end() -> None:
    schedule = Schedule(0.1)
    schedule.begin_stage("static")
    assert [schedule.due(t, last=t == 1.0).series for t in (0.3, 0.6, 1.0)] == [False, False, True]


def test_the_schedule_starts_anew_with_each_stage() -> None:
    schedule = Schedule(1.0)
    assert times_due(schedule, [1.0, 2.0]) == [1.0, 2.0]
    assert times_due(schedule, [0.5, 1.0]) == [1.0]


def test_statics_take_no_time_yet_time_grows() -> None:
    clock = SimulatedTime()
    stamps = []
    for kind, times in (
        ("static", [1.0]),
        ("static", [1.0]),
        ("dynamic", [0.1, 0.2]),
        ("static", [1.0]),
        ("dynamic", [0.1]),
    ):
        clock.begin_stage(kind)
        for t in times:
            clock.advance(t)
            stamps.append(clock.stamp())
    np.testing.assert_allclose(stamps, [0.0, 1e-6, 0.1, 0.2, 0.2 + 1e-6, 0.3], rtol=0.0, atol=1e-15)
    assert np.all(np.diff(stamps) > 0.0)


def test_intervals_thin_the_series_but_not_the_health_nor_the_extremes(tmp_path: Path) -> None:
    record(tmp_path, duration=2.0, interval=0.5)
    run = Run(tmp_path)
    np.testing.assert_allclose(run.time, [0.0, 0.5, 1.0, 1.5, 2.0], atol=1e-12)
    assert run["newton_iterations"].size == 22
    extremes = run.summary["stages"][1]["extremes"]["touchdown_arc"]
    assert extremes["t_min"] == pytest.approx(1.6)
    assert extremes["t_max"] == 0.0


def test_only_the_wanted_fields(tmp_path: Path) -> None:
    record(tmp_path, mesh=block(4, 3, 2), fields=("bending_moment", "von_mises_stress"))
    run = Run(tmp_path)
    assert run["bending_moment"].ndim == 2
    with pytest.raises(ResultsError, match="no curvature"):
        run["curvature"]
    assert set(run.soil_frame().fields) == {"von_mises_stress"}


def test_an_unknown_field_leaves_no_folder(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=telling("output.fields:", '"shear"', "allowed:", "effective_tension")):
        record(tmp_path / "run", fields=("shear",))
    assert not (tmp_path / "run").exists()


def test_a_finished_run_is_not_overwritten_without_force(tmp_path: Path) -> None:
    record(tmp_path, duration=1.0)
    before = {path: path.stat().st_mtime_ns for path in tmp_path.iterdir()}
    with pytest.raises(SceneError, match="finished run"):
        record(tmp_path)
    assert {path: path.stat().st_mtime_ns for path in tmp_path.iterdir()} == before
    record(tmp_path, duration=0.5, force=True)
    assert Run(tmp_path).time[-1] == pytest.approx(0.5)


def test_an_unfinished_run_is_overwritten_and_its_soil_goes(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("mine")
    record(tmp_path, mesh=block(4, 3, 2), finish=False)
    assert Run(tmp_path).has_soil
    assert not Run(tmp_path).finished
    record(tmp_path)
    assert sorted(p.name for p in tmp_path.iterdir()) == [
        "notes.txt",
        "results.nc",
        "riser.vtkhdf",
        "riser.xdmf",
        "scene.yaml",
        "summary.json",
    ]


def test_a_file_in_the_folder_s_place(tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("")
    with pytest.raises(SceneError, match=telling("taken:", "cannot be used")):
        record(tmp_path / "taken")


def test_an_error_keeps_the_accepted_steps_and_marks_them_unfinished(tmp_path: Path) -> None:
    record(tmp_path, duration=1.0, finish=False)
    run = Run(tmp_path)
    assert not run.finished
    assert run.time.size == 11
    assert run.summary["stages"][1]["final"] is not None
    with h5py.File(tmp_path / "results.nc") as file:
        assert file.attrs["finished"] == 0
    assert (tmp_path / "scene.yaml").read_text().endswith(f"\n{SCENE}")


def test_a_run_that_fails_keeps_its_last_accepted_step(tmp_path: Path) -> None:
    with a_recorder(tmp_path) as recorder:
        step(recorder, 0.1)
        step(recorder, 0.2, NOWHERE)
        step(recorder, 0.3, NOWHERE)
    run = Run(tmp_path)
    assert not run.finished
    np.testing.assert_allclose(run.time, [0.1, 0.3])
    times, frames = read_by_vtk(tmp_path / "riser.xdmf")
    assert times == run.time.tolist()
    np.testing.assert_array_equal(frames[-1]["points"], run["position"][-1])
    assert run["touchdown_arc"][-1] == run.summary["stages"][0]["final"]["touchdown_arc"]


def test_before_the_first_frame_there_is_nothing_to_draw(tmp_path: Path) -> None:
    """VTK's reader dies of a file without frames."""
    with a_recorder(tmp_path, mesh=block(4, 3, 2)):
        pass
    run = Run(tmp_path)
    assert run.time.size == run.soil_times.size == 0
    assert run.has_soil
    assert not list(tmp_path.glob("*.xdmf"))
    with pytest.raises(ResultsError, match="holds no frame yet"):
        run.soil_frame()


def test_load_steps_of_a_static_stage_that_fails(tmp_path: Path) -> None:
    with a_recorder(tmp_path, "static") as recorder:
        for load in (0.1, 0.2):
            step(recorder, load, NOWHERE)
    assert Run(tmp_path).time.tolist() == [0.0]


def test_the_last_step_is_written_once(tmp_path: Path) -> None:
    with a_recorder(tmp_path) as recorder:
        step(recorder, 0.1)
        recorder.record_last()
    assert Run(tmp_path).time.tolist() == [0.1]
    assert read_by_vtk(tmp_path / "riser.xdmf")[0] == [0.1]


@pytest.mark.parametrize("series", [False, True])
def test_riser_and_soil_keep_one_time_axis_where_a_run_fails(series: bool, tmp_path: Path) -> None:
    mesh, due = block(4, 3, 2), DueOutputs(series=series, pictures=False)
    with a_recorder(tmp_path, mesh=mesh) as recorder:
        step(recorder, 0.1, pictured=soil(mesh, 30.0))
        step(recorder, 0.2, due)
        recorder.record_last(soil(mesh, 29.0))
    assert Run(tmp_path).time.tolist() == [0.1, 0.2]
    assert Run(tmp_path).soil_times.tolist() == read_by_vtk(tmp_path / "riser.xdmf")[0] == [0.1, 0.2]


def test_without_the_soil_there_is_no_picture_of_the_last_step(tmp_path: Path) -> None:
    mesh = block(4, 3, 2)
    with a_recorder(tmp_path, mesh=mesh) as recorder:
        step(recorder, 0.1, pictured=soil(mesh, 30.0))
        step(recorder, 0.2, NOWHERE)
    assert Run(tmp_path).time.tolist() == [0.1, 0.2]
    assert Run(tmp_path).soil_times.tolist() == read_by_vtk(tmp_path / "riser.xdmf")[0] == [0.1]


def test_what_is_reported_of_how_far_a_run_came(tmp_path: Path) -> None:
    with a_recorder(tmp_path) as recorder:
        assert recorder.reached == f"before the first step; {tmp_path} holds no results yet"
        step(recorder, 0.25)
        message = f"in stage only at t = 0.25 s; {tmp_path} has the results up to there, marked unfinished"
        assert recorder.reached == message
        recorder.finish()
        assert recorder.reached == f"after the last stage; {tmp_path} has the whole run"


@pytest.mark.parametrize("interval", [None, 0.3])
def test_many_steps_at_once_are_recorded_as_one_by_one(tmp_path: Path, interval: float | None) -> None:
    for at_once in (1, 7, 64):
        record(tmp_path / str(at_once), interval=interval, picture_interval=0.6, at_once=at_once)
    one = Run(tmp_path / "1")
    for many in (Run(tmp_path / "7"), Run(tmp_path / "64")):
        assert many.summary == one.summary
        for file in ("results.nc", "riser.vtkhdf"):
            expected, found = numbers_in(one.folder / file), numbers_in(many.folder / file)
            assert found.keys() == expected.keys()
            for name, values in expected.items():
                np.testing.assert_array_equal(found[name], values, err_msg=name)


def numbers_in(path: Path) -> dict[str, Any]:
    """All datasets of an HDF5 file."""
    with h5py.File(path) as file:
        return {name: at[()] for name, at in datasets(file)}


def test_a_run_that_begins_in_motion_is_recorded_from_its_beginning(tmp_path: Path) -> None:
    with a_recorder(tmp_path) as recorder:
        recorder.begin_at({"": stacked([Catenary(32.0, 35.0).record(CATENARY_ARC)])})
        step(recorder, 0.1)
        recorder.finish()
    run = Run(tmp_path)
    assert run.time.tolist() == read_by_vtk(tmp_path / "riser.xdmf")[0] == [0.0, 0.1]
    assert run["step_time"].tolist() == [0.1]
    most = run.summary["stages"][0]["extremes"]["touchdown_arc"]
    assert (most["max"], most["t_max"]) == (35.0, 0.0)


def test_a_disk_that_is_full_ends_the_run_in_one_line(tmp_path: Path) -> None:
    recorder_of = a_recorder(tmp_path)
    recorder = recorder_of.__enter__()
    step(recorder, 0.1)
    recorder.flush()
    step(recorder, 0.2)
    message = telling("cannot be written:", "File too large", "make room")
    with files_of_at_most(100_000), pytest.raises(WriteError, match=message):
        recorder.flush()
    recorder.close()
    assert Run(tmp_path).time.tolist() == [0.1]
    assert not Run(tmp_path).finished
    assert not (tmp_path / ".riser_soil").exists()


def test_a_killed_run_leaves_a_readable_folder(tmp_path: Path) -> None:
    endless = (
        "from pathlib import Path\n"
        "from tests.support.recorded_run import block, record\n"
        f"folder = Path({str(tmp_path / 'run')!r})\n"
        "record(folder, duration=1e4, interval=0.1, picture_interval=5.0, mesh=block(8, 4, 2))\n"
    )
    process = subprocess.Popen([sys.executable, "-c", endless], cwd=ROOT)
    try:
        _wait_for_steps(tmp_path / "run", process)
    finally:
        os.kill(process.pid, signal.SIGKILL)
        process.wait()
    run = Run(tmp_path / "run")
    assert not run.finished
    assert run.time.size == run["position"].shape[0] > 1
    assert np.all(np.isfinite(run["position"]))
    assert run.soil_frame().fields["displacement"].shape[1] == 3


def _wait_for_steps(folder: Path, process: subprocess.Popen[bytes]) -> None:
    for _ in range(600):
        summary = folder / "summary.json"
        if summary.is_file() and any(s["steps"] > 10 for s in json.loads(summary.read_text())["stages"]):
            return
        assert process.poll() is None, "the run ended by itself"
        time.sleep(0.1)
    raise AssertionError("the run wrote nothing within a minute")


def test_recording_imports_no_drawing() -> None:
    code = (
        "import sys; from riser_soil.results import read, record, screen\n"
        "heavy = {'pyvista', 'vtk', 'vtkmodules', 'matplotlib', 'scipy', 'dolfinx', 'xarray', 'pandas'}\n"
        "print(sorted(heavy & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_a_folder_without_a_run(tmp_path: Path) -> None:
    with pytest.raises(ResultsError, match=telling(f"{tmp_path}:", "not the folder")):
        Run(tmp_path)


def test_the_screen_tells_the_main_results(tmp_path: Path) -> None:
    record(tmp_path, mesh=block(4, 3, 2))
    console = Console(width=140, record=True, file=io.StringIO())
    print_summary(Run(tmp_path).summary, console)
    text = console.export_text()
    assert "not balanced in statics" in text
    for words in (
        "top tension",
        "TDP, arc length",
        "at 30 m",
        "1.5192 kN m at 28.5 m  (1.5148 to 1.5625)",
        "5.8117 mm at (10, -0.833, 0) m, 0.1 s",
        "soil: most of its strength used",
        "3.00 on average",
        "newton",
        "1.25 s",
    ):
        assert words in text


def test_warnings_are_reported_on_the_screen(tmp_path: Path) -> None:
    record(tmp_path, mesh=block(4, 3, 2))
    summary = Run(tmp_path).summary
    assert "warning" not in shown(summary)
    summary["stages"][1]["warnings"].append(warned := "the energy [J] is 5.1% off: take a smaller time_step")
    assert f"warning: heave: {warned}\n" in shown(summary)


@pytest.mark.parametrize("upper", ["start", "end"])
def test_top_tension_is_the_upper_ends(upper: str, tmp_path: Path) -> None:
    record(tmp_path, mesh=block(4, 3, 2))
    summary = Run(tmp_path).summary
    summary["stages"] = summary["stages"][:1]
    for tension, end in enumerate(("start", "end"), start=1):
        final = summary["stages"][0]["final"][end]
        final["effective_tension"], final["position"][2] = 1e3 * tension, float(end == upper)
    (row,) = (line for line in shown(summary).splitlines() if "top tension" in line)
    assert f" {1 if upper == 'start' else 2} kN" in row


def shown(summary: dict[str, Any]) -> str:
    console = Console(width=120, record=True, file=io.StringIO())
    print_summary(summary, console)
    return console.export_text()


def test_progress_is_silent_off_a_terminal_and_on_other_ranks(capfd: pytest.CaptureFixture[str]) -> None:
    for enabled, console in (
        (True, Console(stderr=True)),
        (False, Console(stderr=True, force_terminal=True)),
    ):
        with Progress(enabled, console) as progress:
            progress.begin_stage("heave", "dynamic", 10.0)
            progress.update(5.0, 0.1, 3)
    captured = capfd.readouterr()
    assert captured.out + captured.err == ""


def test_progress_names_stage_time_step_and_iterations() -> None:
    console = Console(force_terminal=True, width=120, record=True, file=io.StringIO())
    with Progress(True, console) as progress:
        progress.begin_stage("heave", "dynamic", 10.0)
        progress.update(5.0, 0.1, 3)
    text = console.export_text()
    for words in ("heave", "50%", "t 5 of 10 s", "step 0.1 s", "Newton 3"):
        assert words in text
