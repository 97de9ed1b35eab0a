"""What the demo and a small coupled run leave in their folders, read by other people's readers."""

from __future__ import annotations

import json
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray
from scipy.interpolate import griddata

from riser_soil import __version__
from riser_soil.core.arrays import Array
from riser_soil.results import Run
from riser_soil.stages import LAID_IN
from tests.support.on_ranks import HANGS, ROOT, environment, mpirun
from tests.support.scenes import LAY, Mapping, heave, touchdown
from tests.support.vtk_reading import read_by_vtk
from tests.support.watched_run import WatchedRun

HEXAHEDRON, POLYLINE = 12, 4
ON_NODES = ("effective_tension", "bending_moment", "curvature", "contact_force")

ENERGY = {"kinetic", "strain", "potential", "dissipated", "numerical", "made", "ahead", "work", "residual"}
ENERGY |= {"turned_over", "dissipated_by", "work_by", "relative_residual", "worst_residual"}
VECTORS, SCALARS = ("position", "force", "moment"), ("effective_tension", "angle_deg", "resultant_force")
WHOLE = ("touchdown_arc", "touchdown_points", "max_penetration", "contact_force")
PLACED = ("max_bending_moment", "max_curvature", "min_bend_radius", "min_effective_tension", "max_embedment")


riser_by_vtk = cache(read_by_vtk)


def test_vtk_reads_the_riser(on_block: WatchedRun) -> None:
    run = Run(on_block.folder)
    times, frames = riser_by_vtk(on_block.folder / "riser.xdmf")
    assert len(times) == 1 + 8, "the laid riser, then every half second"
    rows = np.searchsorted(run.time, np.array(times) - 1e-9)
    np.testing.assert_allclose(run.time[rows], times, atol=1e-12)
    for row, frame in zip(rows, frames, strict=True):
        assert frame["cell_types"].tolist() == [POLYLINE]
        np.testing.assert_array_equal(frame["points"], run["position"][row])
        for name in ON_NODES:
            np.testing.assert_array_equal(frame[f"point:{name}"], run[name][row])
    assert frames[-1]["point:contact_force"].max() > 500.0


def test_vtk_reads_the_soil(on_block: WatchedRun) -> None:
    run = Run(on_block.folder)
    times, frames = read_by_vtk(on_block.folder / "soil.xdmf")
    riser_times, _ = riser_by_vtk(on_block.folder / "riser.xdmf")
    assert times == riser_times, "both on one time axis"
    volume = 16.0 * 4.0 * 1.75
    for number, frame in enumerate(frames):
        assert set(frame["cell_types"].tolist()) == {HEXAHEDRON}
        assert frame["volumes"].sum() == pytest.approx(volume, rel=1e-9)
        own = run.soil_frame(number)
        np.testing.assert_array_equal(frame["points"], own.points)
        for place, name in (
            ("point", "displacement"),
            ("cell", "von_mises_stress"),
            ("cell", "equivalent_plastic_strain"),
        ):
            np.testing.assert_array_equal(frame[f"{place}:{name}"], own.fields[name])
    last = frames[-1]
    assert last["point:displacement"][:, 2].min() < -1e-3
    depth = -last["points"][:, 2].min()
    assert 100.0 < last["cell:von_mises_stress"].max() <= np.sqrt(3.0) * (2.0e3 + 1.5e3 * depth)
    assert last["cell:equivalent_plastic_strain"].min() >= 0.0


def test_pipe_lies_on_the_soil_in_the_files(on_block: WatchedRun) -> None:
    """The settlement told is that of the surface in the file, the underside lies in it by what force compresses, and by
    what the smooth surface of contact dips below flat facets.

    The first is f/k at a chord as wide as the diameter, with k ten times the soil's modulus, more on a narrower one.
    """
    run, k = Run(on_block.folder), 10.0 * 300.0 * 2.0e3
    frame = run.soil_frame()
    assert frame.time == run.time[-1]
    top = np.flatnonzero(frame.points[:, 2] > -1e-9)
    deformed = frame.points[top] + frame.fields["displacement"][top]
    x = run["position"][-1][:, 0]
    lying = (x > 21.0) & (x < 28.0)
    position, force = run["position"][-1][lying], run["contact_force"][-1][lying]
    below = griddata(deformed[:, :2], deformed[:, 2], position[:, :2])
    np.testing.assert_allclose(run["soil_settlement"][-1][lying], -below, atol=1e-12)
    assert below.max() < -2e-3
    compressed = below + 0.15 - position[:, 2]
    assert (compressed > 0.9 * force / k).all()
    assert compressed.max() < 0.03 * 0.075, "of a cell's width"


def test_xarray_opens_the_series(on_block: WatchedRun) -> None:
    with xarray.open_dataset(on_block.folder / "results.nc", engine="h5netcdf", decode_times=False) as data:
        nodes = 150
        sizes = {"time": 41, "step": 48, "arc": nodes, "component": 3, "section": 1, "offset": 61}
        assert dict(data.sizes) == sizes
        assert data.attrs["finished"] == 1
        assert data.attrs["title"] == "Touchdown on soft clay"
        assert data["position"].dims == ("time", "arc", "component")
        for name in ON_NODES:
            assert data[name].dims == ("time", "arc")
        for name in ("start_force", "end_force", "start_moment", "end_moment"):
            assert data[name].dims == ("time", "component")
        for name in ("newton_iterations", "time_step", "energy_residual"):
            assert data[name].dims == ("step",)
        for variable in data.data_vars.values():
            assert variable.attrs["long_name"]
            assert variable.attrs["units"]
        assert float(data["effective_tension"].sel(arc=148.0).isel(time=-1)) > 5e4
        np.testing.assert_array_equal(data["newton_iterations"][1:], [s.iterations for s in on_block.steps[1:]])
        assert data["newton_iterations"][0] >= on_block.steps[0].iterations, "with those of dynamic relaxation"
        assert np.isnan(data["energy_residual"][0])


def test_summary_is_as_documented(on_block: WatchedRun) -> None:
    summary = json.loads((on_block.folder / "summary.json").read_text(encoding="utf-8"))
    expected = {"title", "finished", "version", "versions", "ranks", "parts", "dofs", "stages", "seconds", "warnings"}
    assert set(summary) == expected | {"processor_seconds"}
    assert 0.0 < summary["processor_seconds"] < 3600.0
    assert (summary["finished"], summary["version"], summary["ranks"]) == (True, __version__, 1)
    assert set(summary["parts"]) == {"built", "left_out"}
    assert {"riser", "soil", "contact", "morison", "inertia"} <= set(summary["parts"]["built"])
    assert all(isinstance(reason, str) and reason for reason in summary["parts"]["left_out"].values())
    assert set(summary["dofs"]) == {"riser", "soil"}
    assert summary["dofs"]["riser"] == 3 * 150 - 4
    assert {"riser", "soil", "contact", "linear_solve"} <= set(summary["seconds"])
    documented = {"name", "kind", "time", "steps", "newton_iterations", "step_cuts", "final", "extremes", "energy"}
    documented |= {"most_newton_iterations", "method", "relaxations", "settlings", "branch_switches", "warnings"}
    documented |= {"soil", "indicators"}
    for stage in summary["stages"]:
        assert set(stage) == documented
        assert_final(stage["final"])
        assert_extremes(stage["extremes"])
        assert set(stage["energy"]) == ENERGY
        assert stage["warnings"] == []
    assert [(s["name"], s["kind"], s["time"], s["steps"]) for s in summary["stages"]] == [
        ("lay", "static", 0.0, 8),
        ("heave", "dynamic", 4.0, 40),
    ]
    lost = summary["stages"][1]["energy"]["dissipated_by"]
    assert sum(lost.values()) == pytest.approx(summary["stages"][1]["energy"]["dissipated"])
    assert lost["soil_plasticity"] > lost["soil_time_scheme"], "this clay yields"


def assert_final(final: Any) -> None:
    assert set(final) == {"start", "end", "touchdown_position", *WHOLE, *PLACED}
    assert len(final["touchdown_position"]) == 3
    for end in (final["start"], final["end"]):
        assert set(end) == {*VECTORS, *SCALARS}
        assert all(len(end[name]) == 3 for name in VECTORS)
        assert all(isinstance(end[name], float) for name in SCALARS)
    assert all(set(final[name]) == {"value", "arc"} for name in PLACED)
    assert all(isinstance(final[name], float) for name in WHOLE)


def assert_extremes(extremes: Any) -> None:
    kinds = {"min", "max", "t_min", "t_max"}
    assert set(extremes) == {"start", "end", "touchdown_position", *WHOLE, *PLACED}
    for end in (extremes["start"], extremes["end"]):
        assert all(set(end[name]) == kinds for name in (*VECTORS, *SCALARS))
    for name in (*WHOLE, *PLACED):
        assert set(extremes[name]) == kinds | ({"arc_min", "arc_max"} if name in PLACED else set())
        assert extremes[name]["min"] <= extremes[name]["max"]


def test_summary_agrees_with_the_series(on_block: WatchedRun) -> None:
    run = Run(on_block.folder)
    final, extremes = (run.summary["stages"][1][key] for key in ("final", "extremes"))
    np.testing.assert_array_equal(final["end"]["force"], run["end_force"][-1])
    assert final["touchdown_arc"] == run["touchdown_arc"][-1]
    assert final["contact_force"] == run["contact_force_sum"][-1, 2]
    assert_beside(run, final["max_bending_moment"], run["bending_moment"][-1])
    assert_beside(run, final["max_curvature"], run["curvature"][-1])
    assert final["min_effective_tension"]["value"] == run["effective_tension"][-1].min()
    top = run["end_force"][:, 2]
    force = extremes["end"]["force"]
    assert (force["min"][2], force["max"][2]) == (top.min(), top.max())
    assert (force["t_min"][2], force["t_max"][2]) == (run.time[top.argmin()], run.time[top.argmax()])
    assert run["curvature"].max() <= extremes["max_curvature"]["max"] < 1.01 * run["curvature"].max()


def assert_beside(run: Run, largest: Any, at_nodes: Array) -> None:
    """The largest value lies at the largest node or between it and the next ones, and is not much larger."""
    at, top = int(at_nodes.argmax()), at_nodes.max()
    assert run.arc[max(0, at - 1)] <= largest["arc"] <= run.arc[min(at + 1, run.arc.size - 1)]
    assert top <= largest["value"] < 1.01 * top


@pytest.mark.verify
def test_resolved_scene_computes_the_same_again(tmp_path: Path) -> None:
    """Bit by bit: nothing that matters is missing from scene.yaml or depends on chance."""
    given: Mapping = touchdown(LAY, heave(0.5), su=400.0, dimension=3)
    (tmp_path / "given.yaml").write_text(json.dumps(given), encoding="utf-8")
    for scene, out in (("given.yaml", "first"), ("first/scene.yaml", "second")):
        done = mpirun(1, "-m", "riser_soil", "run", scene, "-o", out, folder=tmp_path)
        assert done.returncode == 0, done.stderr
    first, second = Run(tmp_path / "first"), Run(tmp_path / "second")
    for name in ("position", "moment_vector", "contact_force", "end_force", "energy_residual", "newton_iterations"):
        np.testing.assert_array_equal(first[name], second[name], err_msg=name)
    one, other = (run.soil_frame().fields for run in (first, second))
    assert one["equivalent_plastic_strain"].max() > 0.0
    assert all(np.array_equal(one[name], other[name]) for name in one)
    texts = [(run.folder / "scene.yaml").read_text(encoding="utf-8") for run in (first, second)]
    assert texts[0] == texts[1]


def resident_memory(scene: Mapping, folder: Path) -> Array:
    """Resident memory [MB] of a run at each of its accepted steps."""
    (folder / "scene.yaml").write_text(json.dumps(scene), encoding="utf-8")
    script = ROOT / "tests/support/memory_of_run.py"
    call = [sys.executable, str(script), str(folder / "scene.yaml"), str(folder / "out")]
    done = subprocess.run(call, env=environment(), capture_output=True, text=True, timeout=HANGS, check=False)
    assert done.returncode == 0, done.stderr
    return np.array(json.loads((folder / "out" / "memory.json").read_text(encoding="utf-8")))


@pytest.mark.verify
@pytest.mark.parametrize("name", ["coupled", "riser"])
def test_memory_stays_flat_over_500_steps(name: str, tmp_path: Path) -> None:
    """Resident memory grows by less than 4 MB from step 100 to step 600; the states of 500 coupled steps kept would
    be 7 MB. Results are recorded every tenth step: those of every step would wait in memory for their turn on disk. So
    does the energy balance of the steps, which makes a step of some 2 MB somewhere on the way, once. Contact at nodes:
    the work arrays of surface contact are as large as what touches, and new largest ones hide what is kept. Of two
    runs the second counts: the first may compile a kernel on the way, which takes some MB, too.
    """
    scene = touchdown(LAY, heave(60.0), su=1000.0) | {"output": {"interval": 1.0}, "contact": {"method": "node"}}
    if name == "riser":
        del scene["soil"]
    for time in ("first", "again"):
        (tmp_path / time).mkdir()
        megabytes = resident_memory(scene, tmp_path / time)
    heaved = megabytes[-600:]
    assert len(megabytes) == 600 + (LAID_IN if name == "coupled" else 1)
    assert heaved[-1] - heaved[99] < 4.0


@pytest.mark.verify
def test_memory_stays_flat_over_10000_steps(tmp_path: Path) -> None:
    """A riser in waves and current: less than 3 MB from step 1,000 on; the states of its steps would be 30 MB."""
    waves = {"jonswap": {"Hs": 0.5, "Tp": 4.0, "components": 20}}
    water = {"density": 1025.0, "surface_level": 8.0, "current": {"profile": [[0.0, 0.3, 0.0]]}, "waves": waves}
    scene = touchdown(LAY, heave(1000.0)) | {"output": {"interval": 10.0}, "water": water}
    del scene["soil"]
    megabytes = resident_memory(scene, tmp_path)
    assert len(megabytes) >= 10001  # a step that is cut counts as several
    assert megabytes[-1] - megabytes[1000] < 3.0
