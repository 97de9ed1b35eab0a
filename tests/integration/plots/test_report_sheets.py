"""Sheets that reports draw: tornado, life with the required one, trough with the pipe, utilisations, cases by name."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from riser_soil.plots.album import trough
from riser_soil.plots.environment import peaked_spectrum
from riser_soil.plots.fatigue_life import Damage, life_sheet
from riser_soil.plots.histories import least_and_tightest
from riser_soil.plots.load_cases import Panel, draw_load_cases
from riser_soil.plots.sensitivity import Bar, tornado
from riser_soil.plots.utilisations import utilisation_sheet
from riser_soil.results import Run
from riser_soil.results.stage_records import stage_records
from tests.support.on_ranks import ROOT
from tests.support.recorded_run import RADIUS, block, record


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    folder = tmp_path_factory.mktemp("sheets") / "run"
    record(folder, duration=0.4, picture_interval=0.2, mesh=block(8, 4, 2))
    scene = (ROOT / "demos/first_scene.yaml").read_text(encoding="utf-8")
    (folder / "scene.yaml").write_text(scene, encoding="utf-8")
    return Run(folder)


def written(axes: Axes) -> list[str]:
    return [text.get_text() for text in axes.texts]


def test_the_widest_bar_of_a_tornado_is_on_top_and_each_end_has_its_names() -> None:
    bars = [Bar("soil", [("upper", 10.5)]), Bar("offset", [("far", 10.2), ("near", 13.0)]), Bar("drag", [("low", 9.9)])]
    axes = tornado("moment", "kN m", 10.0, bars).axes[0]
    assert [label.get_text() for label in axes.get_yticklabels()] == ["drag", "soil", "offset"]
    assert written(axes) == ["low", "upper", "near; far"]
    bars_drawn = [bar for bar in axes.patches if isinstance(bar, Rectangle)]
    ends = {(round(bar.get_x(), 9), round(bar.get_width(), 9)) for bar in bars_drawn}
    assert ends == {(10.0, 0.5), (10.0, 0.2), (10.0, 3.0), (10.0, -0.1)}


def test_life_has_the_hotspot_and_the_required_life_and_no_decades_for_nothing() -> None:
    arc = np.linspace(0.0, 100.0, 11)
    per_year = np.full((11, 2), 1e-12)
    per_year[4] = 1e-3, 1e-4
    axes = life_sheet(Damage(arc, np.array([90.0, 270.0]), per_year, (35.0, 45.0), 250.0)).axes[0]
    labels = axes.get_legend_handles_labels()[1]
    assert "hotspot, 1000 years at 40 m" in labels
    assert "required life times DFF, 250 years" in labels
    low, high = axes.get_ylim()
    assert low < 250.0
    assert high <= 1e7, "four decades above the shortest life"


def test_extremes_in_time_are_marked_with_their_places(run: Run) -> None:
    stage = stage_records(run)
    figure = least_and_tightest(stage)
    n = int(stage["min_bend_radius"].argmin())
    title = figure.axes[1].get_title(loc="right")
    least, arc = stage["min_bend_radius"][n], stage["min_bend_radius_arc"][n]
    assert title == f"{least:.4g} m at {stage.time[n]:.4g} s, arc length {arc:.4g} m"


def test_the_trough_has_the_pipes_underside(run: Run) -> None:
    stage = stage_records(run)
    axes = trough(stage).axes[0]
    (pipe,) = (line for line in axes.lines if line.get_label() == "underside of the pipe at the end")
    x, below = (np.asarray(values, float) for values in pipe.get_data())
    lowest = 1e3 * (RADIUS - stage["section_position"][-1, 0, 2])
    assert (x.min(), x.max()) == pytest.approx((-RADIUS, RADIUS))
    assert below.max() == pytest.approx(lowest)
    assert below.min() == pytest.approx(lowest - 1e3 * RADIUS)


def test_utilisations_share_a_sheet_with_their_limit(run: Run) -> None:
    stage = stage_records(run)
    axes = utilisation_sheet(stage, {"bend_utilisation": "bend radius"}).axes[0]
    assert axes.get_legend_handles_labels()[1] == ["bend radius", "limit"]
    assert axes.lines[0].get_ydata() == pytest.approx(np.nanmax(stage["bend_utilisation"], axis=0))


def test_few_cases_are_named_below_their_points(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    labels: list[list[str]] = []

    def look(figure: Figure, png: Path) -> Path:
        labels.append([label.get_text() for label in figure.axes[-1].get_xticklabels()])
        return png

    monkeypatch.setattr("riser_soil.plots.load_cases.save", look)
    draw_load_cases(tmp_path / "a.png", "t", [Panel(["near", "far"], "moment", "N.m", np.array([1.0, 2.0]))])
    assert labels == [["near", "far"]]


def test_a_spectrum_has_the_sea_that_it_is_asked_for() -> None:
    f, density = peaked_spectrum(4.0, 10.0, 3.3)
    energy = float(np.sum(0.5 * (density[1:] + density[:-1]) * np.diff(f)))
    assert 4.0 * energy**0.5 == pytest.approx(4.0, rel=0.02)
    assert f[density.argmax()] == pytest.approx(0.1, rel=0.02)
