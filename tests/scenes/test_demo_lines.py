"""The worked cases of several lines run, and the page has the figures that a run gives."""

from __future__ import annotations

from pathlib import Path

import pytest

from demos.page import block
from riser_soil.checks.check import describe
from riser_soil.errors import SceneError
from riser_soil.results.read import Run
from riser_soil.scene.reader import read_scene
from riser_soil.whole_run import run
from tests.support.line_scenes import LAZY_S, lazy_s_by_catenaries

DEMO = Path(__file__).parents[2] / "demos" / "lines"
SHORT = ("stages.1.duration=0.5",)


def page_figures() -> dict[tuple[str, int], tuple[float, float]]:
    """The page's tensions by line and end: a run's tension and the catenaries' [kN]."""
    rows = [line.split("|") for line in block((DEMO / "README.md").read_text(), "tensions").splitlines() if "`" in line]
    names = [row[1].strip().split("`, ") for row in rows]
    values = [(float(row[2]), float(row[3])) for row in rows]
    return {(name.strip("`"), int(end == "end")): pair for (name, end), pair in zip(names, values, strict=True)}


def test_the_lazy_s_has_the_pages_tensions(tmp_path: Path) -> None:
    run(read_scene(DEMO / "lazy_s.yaml", SHORT), tmp_path)
    computed, catenaries = Run(tmp_path), lazy_s_by_catenaries()[1]
    page = page_figures()
    assert len(page) == 2 * len(LAZY_S)
    for (name, end), (tension, reference) in page.items():
        assert computed.of_line(name)["effective_tension"][0, -end] == pytest.approx(1e3 * tension, rel=1e-3)
        assert catenaries[name][end] == pytest.approx(1e3 * reference, rel=1e-3)
        assert tension == pytest.approx(reference, rel=0.01)


def test_the_mooring_runs_in_waves_and_current(tmp_path: Path) -> None:
    run(read_scene(DEMO / "mooring.yaml", SHORT), tmp_path)
    stage = Run(tmp_path).summary["stages"][1]
    assert abs(stage["energy"]["relative_residual"]) < 1e-3
    assert stage["clearance"]["east_north"]["distance"]["min"] > 20.0


def test_the_lazy_s_on_clay_is_built_without_a_warning() -> None:
    assert "no warnings" in describe(read_scene(DEMO / "lazy_s_on_clay.yaml")).splitlines()


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("lines.upper.end.position.1", "0.1"),
        ("bodies.arch.position.1", "0.1"),
        ("bodies.arch.centre_of_buoyancy.1", "0.1"),
        ("joints.tether_hung.between.1.offset.1", "0.1"),
        ("stages.1.bodies", "{arch: {loads: [{force: [0.0, 1.0, 0.0]}]}}"),
        ("stages.1.bodies", "{arch: {loads: [{moment: [0.0, 0.0, 1.0]}]}}"),
        ("stages.1.lines.upper.motion.end.harmonic.amplitude.1", "0.1"),
        ("water.waves.airy.direction_deg", "10.0"),
        ("seabed.direction_deg", "10.0"),
    ],
)
def test_nothing_leaves_the_plane_of_lines_that_keep_to_one(path: str, value: str) -> None:
    slope = ("seabed.slope_deg=1.0",) if path.startswith("seabed") else ()
    with pytest.raises(SceneError, match="leaves the lines' plane along x, but dimension is 2") as refused:
        read_scene(DEMO / "lazy_s_on_clay.yaml", (*slope, f"{path}={value}"))
    assert path.split(".")[1] in str(refused.value)


@pytest.mark.verify
def test_half_of_the_clay_bears_lines_in_a_plane_as_all_of_it_does(tmp_path: Path) -> None:
    """And as in space, as far as the geometry goes that forces are computed on: off by 1 % of a facet's area at most,
    in either as its motion was predicted. By a fiftieth of that settlements at rest differ by 3e-7, not by 4.5e-6.

    There friction keeps the pipe from sliding to a side, which round-off would choose.
    """
    friction = "contact.friction={axial: 1.0e-6, lateral: 0.3}"
    ways = {"half": (), "all": ("soil.symmetry=whole",), "held": (friction,), "space": ("dimension=3", friction)}
    ran = {}
    for way, overrides in ways.items():
        run(read_scene(DEMO / "lazy_s_on_clay.yaml", (*overrides, "stages.1.duration=1.0")), tmp_path / way)
        ran[way] = Run(tmp_path / way)
    half = ran["half"]
    for one, other, off in ((half, ran["all"], 2e-6), (ran["held"], ran["space"], 1e-5)):
        for stage in (0, 1):
            known, computed = (each.of_line("lower").summary["stages"][stage] for each in (one, other))
            assert computed["final"]["contact_force"] == pytest.approx(known["final"]["contact_force"], rel=1e-7)
            assert computed["soil"]["max_settlement"]["value"] == pytest.approx(
                known["soil"]["max_settlement"]["value"], rel=off
            )
    assert 2 * half.summary["dofs"]["soil"] == ran["all"].summary["dofs"]["soil"]


@pytest.mark.verify
def test_the_lazy_s_on_clay_has_the_pages_figures(tmp_path: Path) -> None:
    """Touchdown at rest, largest moment in heave, settlement: as far as the page shows digits."""
    rows = (line.split("|")[1:-1] for line in block((DEMO / "README.md").read_text(), "clay").splitlines())
    shown = {name.strip(): [float(cell.split()[0]) for cell in cells] for name, *cells in rows if "±" in cells[0]}
    run(read_scene(DEMO / "lazy_s_on_clay.yaml"), tmp_path)
    rest, heave = Run(tmp_path).of_line("lower").summary["stages"]
    assert rest["final"]["touchdown_arc"] == pytest.approx(shown["touchdown, arc length [m]"][0], abs=0.01)
    moment = shown["largest moment of `lower` [N.m]"][1]
    assert heave["extremes"]["max_bending_moment"]["max"] == pytest.approx(moment, abs=0.2)
    settled = [1e3 * stage["soil"]["max_settlement"]["value"] for stage in (rest, heave)]
    assert settled == pytest.approx(shown["settlement of the clay [mm]"], abs=0.06)
    assert abs(heave["energy"]["worst_residual"]["value"]) < 1e-5 * heave["energy"]["turned_over"]
