"""The package in Python: scenes from files and dicts, runs, their datasets while others have the file open."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import h5py
import nbclient
import nbformat
import numpy as np
import pytest
import xarray as xr
from ruamel.yaml import YAML

import riser_soil
from riser_soil import Run, Scene, run
from riser_soil.errors import ResultsError, SceneError
from riser_soil.results import folder as run_folder
from tests.support.on_ranks import ROOT
from tests.support.pages import DOCS, blocks
from tests.support.recorded_run import block, record
from tests.support.said import telling

FIRST = ROOT / "demos/first_scene.yaml"
TWENTY_SEEDS = next(text for text in blocks(ROOT / "docs/python.md", "python") if "range(1, 21)" in text)


@pytest.fixture(scope="module")
def hung(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """The first scene at rest and in a step of heave, with some elements."""
    return run(small(), tmp_path_factory.mktemp("api") / "first", quiet=True)


def small() -> Scene:
    changes = {"riser.segments.0.element_length": 2.5, "riser.segments.1.element_length": 7.0}
    return Scene.from_file(FIRST).changed(changes | {"stages.1.duration": 0.1, "stages.1.name": "slow heave"})


def test_the_package_costs_nothing_before_it_is_used() -> None:
    heavy = "('riser_soil.', 'numpy', 'pydantic', 'typer')"
    ask = f"import sys, riser_soil; print(sorted(name for name in sys.modules if name.startswith({heavy})))"
    assert subprocess.run([sys.executable, "-c", ask], capture_output=True, text=True, check=True).stdout == "[]\n"
    assert {"Run", "Scene", "run"} <= set(dir(riser_soil))
    missing = "walk"
    with pytest.raises(AttributeError, match="has no attribute 'walk'"):
        getattr(riser_soil, missing)


def test_run_stays_a_function_however_much_is_imported(hung: Run) -> None:
    assert hung.finished
    assert riser_soil.run is run
    assert not (Path(riser_soil.__file__).parent / "run.py").exists()


@pytest.mark.parametrize("file", [str(FIRST), FIRST])
def test_scenes_from_files_and_dicts_are_the_same(file: str | Path) -> None:
    data = YAML(typ="safe").load(FIRST.read_text(encoding="utf-8"))
    data["riser"]["start"]["position"] = np.array([0.0, 0.0, 0.15])
    data["riser"]["segments"] = tuple(data["riser"]["segments"])
    data["line_types"]["flexible"]["EA"] = np.float64(3e8)
    assert Scene.from_dict(data).model == Scene.from_file(file).model
    assert isinstance(data["riser"]["segments"], tuple)


def test_a_changed_scene_is_another_one() -> None:
    scene = Scene.from_file(FIRST)
    changed = scene.changed({"riser.segments.0.element_length": np.float64(0.25), "gravity": 9.8})
    assert (changed.model.line.segments[0].element_length, changed.model.gravity) == (0.25, 9.8)
    assert (scene.model.line.segments[0].element_length, scene.model.gravity) == (0.5, 9.81)
    assert (scene.name, scene.changed({"output.directory": "there"}).name) == ("first_scene", "there")


def test_mistakes_are_reported_with_their_place() -> None:
    scene = Scene.from_file(FIRST)
    with pytest.raises(SceneError, match=r"^gravity = -1\.0: gravity: value -1\.0:"):
        scene.changed({"gravity": -1.0})
    with pytest.raises(SceneError, match=r"^riser\.segments\.7 = 1: riser\.segments: .*0 to 1\b"):
        scene.changed({"riser.segments.7": 1})
    with pytest.raises(SceneError, match=r"first_scene\.yaml:13: riser: too long"), scene.placing_errors():
        raise SceneError("riser: too long")
    with pytest.raises(SceneError, match=telling("nowhere.yaml:", "no such file")):
        run("nowhere.yaml")
    with pytest.raises(SceneError, match=r"^scene: line_types: missing"):
        run({"riser": {}})


def test_quiet_is_silent_and_a_finished_run_is_not_overwritten_by_chance(
    hung: Run, capfd: pytest.CaptureFixture[str]
) -> None:
    again = run(small(), hung.folder, force=True, quiet=True)
    assert capfd.readouterr() == ("", "")
    with pytest.raises(SceneError, match="holds a finished run"):
        run(small(), hung.folder)
    run(small(), str(hung.folder), force=True)
    assert "top tension" in capfd.readouterr().out
    np.testing.assert_array_equal(again["end_force"], hung["end_force"])


def test_the_dataset_has_names_units_and_words(hung: Run) -> None:
    data = hung.dataset
    assert data.position.dims == ("time", "arc", "component")
    assert (data.position.attrs["units"], data.arc.attrs["units"], data.time.attrs["units"]) == ("m", "m", "s")
    np.testing.assert_array_equal(data.position.sel(component="z"), hung["position"][:, :, 2])
    assert data.stage_name.values.tolist() == ["hang", "slow_heave"]
    assert data.newton_iterations.where(data.step_stage_name == "hang", drop=True).size == 1
    assert data.effective_tension.sel(arc=20.0, method="nearest").sizes == {"time": 2}
    assert all({"units", "long_name"} <= set(variable.attrs) for variable in data.data_vars.values())


def test_a_run_without_a_record_yet_has_a_dataset(tmp_path: Path) -> None:
    record(tmp_path, mesh=block(4, 3, 2), duration=0.0)
    data = Run(tmp_path).dataset
    assert data.sizes["arc"] > 1
    assert data.stage_name.dtype.kind == "U"


def test_others_may_have_the_file_open(hung: Run) -> None:
    """xarray with HDF5's lock; h5py without; both while the scene is run again into the same folder."""
    series = hung.folder / run_folder.SERIES
    with xr.open_dataset(series) as by_xarray:
        assert by_xarray.position.sel(component="z").shape == by_xarray.bending_moment.shape
        np.testing.assert_array_equal(hung.dataset.end_force, by_xarray.end_force)
        lighter = run(small().changed({"gravity": 9.0}), hung.folder, force=True, quiet=True).dataset
        assert lighter.sizes["time"] == by_xarray.sizes["time"]
        assert (lighter.end_force.sel(component="z") < by_xarray.end_force.sel(component="z")).all()
    with h5py.File(series, "r", locking=False):
        assert hung.dataset.sizes["time"] == hung["time"].size == 2
    run(small(), hung.folder, force=True, quiet=True)


def test_a_broken_file_is_reported_in_one_line(tmp_path: Path) -> None:
    (tmp_path / run_folder.SERIES).write_bytes(b"no HDF5")
    with pytest.raises(ResultsError, match=r"results\.nc: cannot be read"):
        _ = Run(tmp_path).dataset


def test_twenty_seeds(
    hung: Run, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The example of docs/python.md with its computation replaced."""
    seeds, done = [], SimpleNamespace(dataset=hung.dataset)

    def fake_run(scene: Scene, folder: str, quiet: bool) -> SimpleNamespace:
        assert scene.model.water is not None
        assert scene.model.water.waves is not None
        assert scene.model.water.waves.jonswap is not None
        assert folder == f"results/seed_{scene.model.water.waves.jonswap.seed}"
        seeds.append(scene.model.water.waves.jonswap.seed)
        return done

    monkeypatch.chdir(ROOT)
    monkeypatch.setitem(sys.modules, "riser_soil", SimpleNamespace(Scene=Scene, run=fake_run, Run=Run))
    exec(TWENTY_SEEDS, {})
    assert seeds == list(range(1, 21))
    assert capsys.readouterr().out.startswith("largest top tension: 8")


def test_what_the_page_does_with_results(hung: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    """The page's code runs with the first scene's run in the place of that in results/first."""
    monkeypatch.chdir(ROOT)
    page = next(page for page in DOCS if page.name == "python.md")
    scenes, _, results = blocks(page, "python")
    exec(scenes, {})
    exec(results.replace("results/first", str(hung.folder)).replace('"heave"', '"slow_heave"'), {})


def test_the_notebook_runs(tmp_path: Path) -> None:
    """demos/first_scene.ipynb as a user would run it, with a shorter duration."""
    (tmp_path / FIRST.name).write_bytes(FIRST.read_bytes())
    notebook = nbformat.read(ROOT / "demos/first_scene.ipynb", as_version=4)
    for cell in notebook.cells:
        cell.source = cell.source.replace('"stages.1.duration": 5.0', '"stages.1.duration": 0.5')
    nbclient.NotebookClient(notebook, timeout=600, resources={"metadata": {"path": str(tmp_path)}}).execute()
    _, loud, data, _, quiet = (cell.outputs for cell in notebook.cells if cell.cell_type == "code")
    assert "top tension" in "".join(output.text for output in loud)
    assert "effective_tension" in data[0].data["text/plain"]
    assert [output.output_type for output in quiet] == ["execute_result"]
    assert Run(tmp_path / "results/notebook").finished


@pytest.mark.verify
def test_two_seeds_of_the_example(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The example as a short script."""
    short = TWENTY_SEEDS.replace("range(1, 21)", "(1, 2)").replace("demos/waves", str(ROOT / "demos/waves"))
    short = short.replace('{"water', '{"stages.1.duration": 2.0, "water.waves.ramp": 1.0, "water')
    done = subprocess.run([sys.executable, "-c", short], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert done.stdout.startswith("largest top tension: ")
    assert done.stdout.count("\n") == 1
    first, second = (Run(tmp_path / f"results/seed_{seed}")["end_force"][-1] for seed in (1, 2))
    assert not np.allclose(first, second, rtol=1e-3)
