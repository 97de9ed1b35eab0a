"""The compliance of elastic soil is kept from run to run: no other soil's, nothing damaged, the same bits."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from riser_soil.checks.check import describe
from riser_soil.core import compiled
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.part import State
from riser_soil.core.system import Timer
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.soil import compliance as kept_compliance
from riser_soil.soil.compliance import Compliance
from riser_soil.stages import run_stage
from tests.support.driven_stage import Watcher, built, soil_under
from tests.support.said import line_with
from tests.support.scenes import LAY, Mapping, touchdown

SWITCH = "RISER_SOIL_COMPLIANCE"
CLAY: Mapping = {"kind": "linear-elastic", "E": 4.0e5, "nu": 0.45}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where this test's runs keep compliance."""
    monkeypatch.delenv(SWITCH)
    kernels_in(tmp_path / "riser_soil" / ("0" * 16), monkeypatch)
    return tmp_path / "riser_soil" / "compliance"


def kernels_in(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Stand-in for the compiler's environment, as far as the compliance asks for it."""
    environment = SimpleNamespace(FOLDER=folder, NAME=compiled.NAME, tell=compiled.tell)
    monkeypatch.setattr(kept_compliance, "compiled", environment)


@pytest.fixture
def factorised(monkeypatch: pytest.MonkeyPatch) -> list[Compliance]:
    """Soils whose stiffness has been factorised."""
    usual, done = Compliance._factorised, list[Compliance]()

    def counted(compliance: Compliance) -> Any:
        done.append(compliance)
        return usual(compliance)

    monkeypatch.setattr(Compliance, "_factorised", counted)
    return done


def scene(law: Mapping = CLAY, size: float = 0.5) -> Mapping:
    mapping = touchdown(LAY, kind="hex", dimension=2)
    mapping["soil"] |= {"law": law, "mesh": {"kind": "hex", "size_at_riser": size, "size_far": 1.0}}
    return mapping


def compliance(mapping: Mapping | None = None) -> Compliance:
    condensed = soil_under(built(mapping or scene())).condensed
    assert condensed is not None
    return condensed.top.compliance


def nodes_of(kept: Compliance, *groups: int) -> IntArray:
    """One node of each of some groups, the last one first."""
    return np.array([np.flatnonzero(kept._group == group)[3] for group in reversed(groups)])


def answers(kept: Compliance, *groups: int) -> tuple[Array, Array]:
    """Columns of a node of each of some groups, and the whole soil's displacement by forces on them."""
    nodes = nodes_of(kept, *groups)
    forces = np.zeros((len(kept.top) // 3, 3))
    forces[nodes] = np.random.default_rng(1).normal(size=(len(nodes), 3))
    return kept.columns(nodes), kept.displacement(forces.ravel())


def assert_same(got: tuple[Array, Array], wanted: tuple[Array, Array]) -> None:
    for one, other in zip(got, wanted, strict=True):
        np.testing.assert_array_equal(one, other)
        assert np.abs(other).max() > 0.0


@pytest.fixture
def anew(monkeypatch: pytest.MonkeyPatch) -> tuple[Array, Array]:
    """Found without what other runs have kept."""
    with monkeypatch.context() as patch:
        patch.setenv(SWITCH, "off")
        return answers(compliance(), 0, 2)


def test_a_second_run_factorises_nothing(
    folder: Path, anew: tuple[Array, Array], factorised: list[Compliance], capfd: pytest.CaptureFixture[str]
) -> None:
    first = compliance()
    assert not first.on_disk
    assert_same(answers(first, 0, 2), anew)
    assert factorised == [first]
    second = compliance()
    assert second.on_disk
    assert_same(answers(second, 0, 2), anew)
    assert factorised == [first]
    assert [path.suffix for path in folder.glob("*/*")] == [".columns"] * 2
    assert capfd.readouterr().err == ""


def test_a_run_adds_to_what_another_has_kept(
    folder: Path, anew: tuple[Array, Array], factorised: list[Compliance]
) -> None:
    answers(compliance(), 2)
    (kept,) = folder.glob("*/*")
    written = kept.stat().st_mtime_ns
    second = compliance()
    assert_same(answers(second, 0, 2), anew)
    assert len(factorised) == 2
    assert kept.stat().st_mtime_ns == written
    assert len(list(folder.glob("*/*"))) == 2
    assert_same(answers(compliance(), 0, 2), anew)
    assert len(factorised) == 2


def test_runs_at_once_do_not_disturb_each_other(
    folder: Path, anew: tuple[Array, Array], capfd: pytest.CaptureFixture[str]
) -> None:
    """Both find nothing and keep what they have found; then all of it is removed, as a third might do for room."""
    runs = [compliance(), compliance()]
    for run in runs:
        answers(run, 0)
    shutil.rmtree(folder)
    for run in runs:
        assert_same(answers(run, 0, 2), anew)
    assert [path.name for path in folder.glob("*/*")] == ["2.columns"]
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize(
    "other", [scene(CLAY | {"E": 4.0e5 * (1.0 + 1e-15)}), scene(CLAY | {"nu": 0.44}), scene(size=0.45)]
)
def test_another_law_or_mesh_has_another_compliance(other: Mapping, folder: Path, factorised: list[Compliance]) -> None:
    answers(compliance(), 0)
    another = compliance(other)
    assert not another.on_disk
    answers(another, 0)
    assert len(factorised) == len(list(folder.iterdir())) == 2


def test_another_riser_on_the_same_soil_has_the_same(folder: Path) -> None:
    answers(compliance(), 0)
    mapping = scene()
    mapping["contact"] = {"method": "surface", "smoothing": 1e-3}
    assert compliance(mapping).on_disk


def test_what_decides_the_last_digits_is_part_of_the_name(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    answers(compliance(), 0)
    with monkeypatch.context() as patch:
        patch.setenv("OMP_NUM_THREADS", "3")
        assert not compliance().on_disk
    with monkeypatch.context() as patch:
        patch.setattr(kept_compliance, "FORMAT", kept_compliance.FORMAT + 1)
        assert not compliance().on_disk
    assert compliance().on_disk


def flip_a_bit(file: Path) -> None:
    content = bytearray(file.read_bytes())
    content[len(content) // 2] ^= 1
    file.write_bytes(content)


def cut(file: Path) -> None:
    file.write_bytes(file.read_bytes()[:-8])


def empty(file: Path) -> None:
    file.write_bytes(b"")


def exchange(file: Path) -> None:
    """The other group's columns, in a file that is whole."""
    shutil.copy(next(path for path in file.parent.iterdir() if path != file), file)


@pytest.mark.parametrize("damage", [flip_a_bit, cut, empty, exchange])
def test_a_damaged_file_counts_as_none(
    damage: Callable[[Path], None],
    folder: Path,
    anew: tuple[Array, Array],
    factorised: list[Compliance],
    capfd: pytest.CaptureFixture[str],
) -> None:
    answers(compliance(), 0, 2)
    (file,) = folder.glob("*/2.columns")
    whole = file.read_bytes()
    damage(file)
    assert file.read_bytes() != whole
    assert_same(answers(compliance(), 0, 2), anew)
    assert len(factorised) == 2
    assert file.read_bytes() == whole
    assert capfd.readouterr().err == ""


def test_a_run_goes_on_where_nothing_can_be_kept(
    folder: Path, anew: tuple[Array, Array], capfd: pytest.CaptureFixture[str]
) -> None:
    folder.parent.mkdir()
    folder.write_text("in the way")
    assert_same(answers(compliance(), 0, 2), anew)
    (line,) = capfd.readouterr().err.splitlines()
    line_with([line], "soil's compliance", "not kept")
    assert str(folder) in line


def test_a_disk_that_is_nearly_full_is_left_alone(
    folder: Path, anew: tuple[Array, Array], monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(kept_compliance, "FREE_DISK", 1 << 60)
    assert_same(answers(compliance(), 0, 2), anew)
    assert not list(folder.rglob("*.columns"))
    assert len(capfd.readouterr().err.splitlines()) == 1


def test_memory_has_no_more_than_some_columns(
    folder: Path, anew: tuple[Array, Array], monkeypatch: pytest.MonkeyPatch, factorised: list[Compliance]
) -> None:
    """Those that are not there any more are solved for again, with the same factors and bits."""
    monkeypatch.setattr(kept_compliance, "FREE_DISK", 1 << 60)
    monkeypatch.setattr("riser_soil.soil.compliance.MEMORY", 1)
    kept = compliance()
    for _ in range(2):
        assert_same(answers(kept, 0, 2), anew)
        assert len(kept._groups) == 1
    assert factorised == [kept]


def test_the_soils_not_used_for_longest_make_workspace(
    folder: Path, anew: tuple[Array, Array], monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    soils = [scene(CLAY | {"E": E}) for E in (1.0e5, 2.0e5, 3.0e5)]
    for soil in soils:
        answers(compliance(soil), 0)
    places = [compliance(soil)._files._folder for soil in soils]
    again = places.index(next(folder.iterdir()))  # the one that would go first, were it not used again
    answers(compliance(soils[again]), 0)
    each = next(folder.glob("*/*")).stat().st_size
    monkeypatch.setattr(kept_compliance, "DISK", 3 * each + each // 2)
    answers(compliance(), 0)
    oldest = 1 if again == 0 else 0
    assert [compliance(soil).on_disk for soil in soils] == [n != oldest for n in range(3)]
    monkeypatch.setattr(kept_compliance, "DISK", each + each // 2)
    assert capfd.readouterr().err == ""
    assert_same(answers(compliance(), 0, 2), anew)
    assert len(list(folder.glob("*/*"))) == 1
    assert len(capfd.readouterr().err.splitlines()) == 1


def test_nothing_is_kept_or_read_where_it_is_switched_off(
    folder: Path, monkeypatch: pytest.MonkeyPatch, factorised: list[Compliance]
) -> None:
    answers(compliance(), 0)
    kept = sorted(folder.rglob("*"))
    monkeypatch.setenv(SWITCH, "off")
    of_program = compliance()
    assert not of_program.on_disk
    answers(of_program, 0, 2)
    assert len(factorised) == 2
    assert sorted(folder.rglob("*")) == kept


def test_a_temporary_folder_that_stands_alone_keeps_it_within(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    alone = folder.parents[1] / "riser_soil-abc"
    kernels_in(alone, monkeypatch)
    answers(compliance(), 0)
    assert len(list(alone.glob("compliance/*/*.columns"))) == 1


def test_runs_repeat_to_the_bit(folder: Path, factorised: list[Compliance]) -> None:
    first, second = laid(), laid()
    assert len(factorised) == 1
    assert_same(second, first)


def laid() -> tuple[Array, Array]:
    """Where the riser is laid, and the displacement of the soil under it."""
    assembly = built(scene())
    state = run_stage(assembly, assembly.scene.stages[0], State.at_rest(0.0, assembly.size), Watcher(), Timer.new())
    soil = soil_under(assembly).recovered()
    assert soil is not None
    return assembly.riser.line.positions3(state), soil.output_fields().displacement


def test_check_tells_what_is_at_hand(folder: Path) -> None:
    line = "soil: what earlier runs have found of its compliance is at hand"
    assert line not in describe(scene_from_mapping(scene()))
    answers(compliance(), 0)
    assert line in describe(scene_from_mapping(scene()))
