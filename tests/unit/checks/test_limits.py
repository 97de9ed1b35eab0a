"""A scene's size is told before anything is built; what exceeds the machine is refused with the numbers."""

from __future__ import annotations

import re
import resource
from pathlib import Path

import pytest
from mpi4py import MPI
from typer.testing import CliRunner

from riser_soil.__main__ import app
from riser_soil.assembly import build
from riser_soil.checks import limits
from riser_soil.checks.check import describe, memory
from riser_soil.checks.estimate import size_of
from riser_soil.checks.inventory import unknowns
from riser_soil.errors import SceneError
from riser_soil.scene.reader import scene_from_mapping
from tests.support.bad_scenes import GOOD
from tests.support.said import line_with
from tests.support.scenes import LAY, Mapping, heave, touchdown

COMM = MPI.COMM_SELF


def with_mesh(**mesh: object) -> Mapping:
    scene = touchdown(LAY, heave(1.0))
    scene["soil"]["mesh"] = mesh
    return scene


@pytest.mark.parametrize(
    ("scene", "within"),
    [
        (touchdown(LAY), 0.0),
        (with_mesh(kind="hex", size_at_riser=0.2, size_far=0.7), 0.0),
        (with_mesh(kind="hex", size_at_riser={"along": 0.5, "across": 0.05}, size_far=0.5), 0.0),
        (with_mesh(kind="tet", size_at_riser=0.4, size_far=0.4), 0.5),
        (with_mesh(kind="tet", size_at_riser=0.2, size_far=0.9), 0.5),
    ],
)
def test_numbers_are_those_of_what_is_built(scene: Mapping, within: float) -> None:
    read = scene_from_mapping(scene)
    size, assembly = size_of(read), build(read, COMM)
    assert assembly.soil is not None
    assert size.elements == assembly.riser.line.length.size
    assert size.cells == pytest.approx(assembly.soil.whole.blocks()["soil"].shape[0], rel=within or 1e-15)
    assert size.soil_unknowns == pytest.approx(unknowns(COMM, assembly.soil.whole.field), rel=within or 0.3)
    assert size.memory(1) == pytest.approx(memory(assembly), rel=0.1)


def timed(**changes: object) -> Mapping:
    scene = {key: value for key, value in touchdown(LAY, heave(4.0)).items() if key != "soil"}
    scene["stages"][1] |= {key: value for key, value in changes.items() if key != "output"}
    return {**scene, "output": changes.get("output", {})}


@pytest.mark.parametrize(
    ("scene", "steps", "records", "pictures"),
    [
        (timed(time_step=0.1), 41, 41, 41),
        (timed(time_step=0.1, output={"interval": 0.5}), 41, 10, 10),
        (timed(time_step=0.1, output={"interval": 0.5, "xdmf_interval": 2.0}), 41, 10, 4),
        (timed(time_step="auto", output={"interval": 0.5}), 21, 10, 10),
        (timed(time_step="auto", output={"interval": 0.01}), 401, 402, 402),
    ],
)
def test_steps_and_records(scene: Mapping, steps: float, records: float, pictures: float) -> None:
    size = size_of(scene_from_mapping(scene))
    assert (size.steps, size.records, size.pictures) == pytest.approx((steps, records, pictures), abs=1.0)


TOO_LARGE = {
    "soil.mesh": ("soil.mesh.size_at_riser=1.0e-3", "cells of soil need about", "take larger cells or a smaller block"),
    "riser.segments": ("riser.segments.0.elements=1000000", "1000000 elements", "take longer elements"),
    "output.interval": ("output.interval=1.0e-9", "automatic steps that hit 1.5e+10 output times", "a longer interval"),
}


@pytest.mark.parametrize("command", [["check"], ["run", "-o", "out"]])
@pytest.mark.parametrize("path", TOO_LARGE)
def test_what_exceeds_the_memory_is_refused_with_the_numbers(
    path: str, command: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(limits, "available_memory", lambda: 3e9)
    change, what, remedy = TOO_LARGE[path]
    text = GOOD if path == "soil.mesh" else GOOD.partition("soil:")[0] + "stages:" + GOOD.partition("stages:")[2]
    (tmp_path / "case.yaml").write_text(text.replace("time_step: 0.1", "time_step: auto"))
    done = CliRunner().invoke(app, [*command, "case.yaml", "--set", change])
    assert done.exit_code == 2
    assert f": {path}: " in done.stderr
    for part in (what, " GB of memory, and 3 GB are available; ", remedy):
        assert part in done.stderr
    assert [file.name for file in tmp_path.iterdir()] == ["case.yaml"]


def test_what_may_not_fit_into_the_memory_is_warned_of_with_the_numbers(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The forecast is within 30 %: what may fit is not refused, and what may not is told."""
    scene = scene_from_mapping(with_mesh(kind="hex", size_at_riser=0.1, size_far=0.1))
    need, numbers = size_of(scene).memory(1), r"soil\.mesh: .* of memory, .* available; "
    for share, count in ((0.8, 1), (1.25, 1), (1.35, 0)):
        monkeypatch.setattr(limits, "available_memory", lambda share=share: share * need)
        warnings = limits.tight(limits.size_that_fits(scene, tmp_path, COMM), COMM)
        assert len(warnings) == count
        assert all(re.match("the run may end.*: " + numbers, warning) for warning in warnings)
    monkeypatch.setattr(limits, "available_memory", lambda: 0.75 * need)
    with pytest.raises(SceneError, match=numbers):
        limits.size_that_fits(scene, tmp_path, COMM)


def test_a_warning_of_memory_is_in_the_report(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = scene_from_mapping(touchdown(LAY))
    need = size_of(scene).memory(1)
    monkeypatch.setattr(limits, "available_memory", lambda: need)
    line_with(describe(scene), "warning:", "may end", "want of memory")


def test_what_exceeds_the_disk_is_refused_with_the_numbers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = scene_from_mapping(timed(time_step=1e-4))
    need = size_of(scene).disk
    monkeypatch.setattr(limits, "free_disk", lambda folder: 1.01 * need)
    limits.size_that_fits(scene, tmp_path, COMM)
    monkeypatch.setattr(limits, "free_disk", lambda folder: 0.99 * need)
    with pytest.raises(SceneError, match=r"^output\.interval: 4e\+04 records .* \d.* on disk, .* free"):
        limits.size_that_fits(scene, tmp_path, COMM)


def test_a_long_run_is_warned_of_with_its_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """The run's records take some 40 GB, which a machine may have or not."""
    monkeypatch.setattr(limits, "free_disk", lambda folder: 1e12)
    patient = scene_from_mapping(timed(duration=4.0e6, output={"interval": 1.0e4}))
    report = describe(patient)
    assert re.search(r"\d h\b", line_with(report, "warning:", "takes about", "4e+07 steps", "36 elements", "duration"))
    assert "the run takes about" not in describe(scene_from_mapping(timed()))


@pytest.mark.parametrize(
    ("seconds", "words"), [(0.5, "0.5 s"), (90.0, "90 s"), (600.0, "10 min"), (1e5, "28 h"), (1e9, "32 years")]
)
def test_times_in_words(seconds: float, words: str) -> None:
    assert limits.in_words(seconds) == words


def test_the_least_of_the_limits_holds(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "meminfo").write_text("MemTotal: 9000 kB\nMemAvailable:  5000 kB\n")
    (tmp_path / "memory.max").write_text("4000000\n")
    (tmp_path / "memory.current").write_text("1000000\n")
    (tmp_path / "memory.stat").write_text("anon 5\ninactive_file 200000\n")
    monkeypatch.setattr(limits, "_MEMORY", tmp_path / "meminfo")
    monkeypatch.setattr(limits, "_GROUPS", ((tmp_path, "memory.max", "memory.current"),))
    monkeypatch.setattr(resource, "getrlimit", lambda kind: (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
    assert limits.available_memory() == 3_200_000
    (tmp_path / "memory.max").write_text("max\n")
    assert limits.available_memory() == 5_120_000
    (tmp_path / "status").write_text("VmSize:\t 1000 kB\n")
    monkeypatch.setattr(limits, "_STATUS", tmp_path / "status")
    monkeypatch.setattr(resource, "getrlimit", lambda kind: (2_048_000, resource.RLIM_INFINITY))
    assert limits.available_memory() == 1_024_000


def test_the_disk_is_that_of_the_folder_to_be(tmp_path: Path) -> None:
    assert limits.free_disk(tmp_path / "not" / "yet") == pytest.approx(limits.free_disk(tmp_path), rel=0.01)
