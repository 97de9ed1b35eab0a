"""Curves drawn from result files, looked at by what they put on the axes."""

from pathlib import Path

import numpy as np
import pytest

from riser_soil.plots.curves import along_arc, end_reactions, end_tension, envelope, instants, save, shapes, sheet
from riser_soil.results import Run
from riser_soil.results.netcdf import SERIES
from tests.support.recorded_run import record
from tests.support.said import line_with


@pytest.fixture
def run(tmp_path: Path) -> Run:
    record(tmp_path)
    return Run(tmp_path)


def test_shapes_lie_in_the_plane_of_the_ends(run: Run) -> None:
    _, (axes,) = sheet(1, 1)
    shapes(axes, run, at=[0, -1])
    x, z = axes.lines[1].get_data()
    position = run["position"][-1]
    assert x == pytest.approx(position[:, 0] - position[0, 0])
    assert z == pytest.approx(position[:, 2])
    assert axes.get_legend_handles_labels()[1] == ["t = 0 s", "t = 2 s"]


def test_moment_along_the_arc_and_its_envelope(run: Run) -> None:
    _, (left, right) = sheet(1, 2)
    along_arc(left, run, "bending_moment", label="at the end")
    assert left.lines[0].get_data()[1] == pytest.approx(1e-3 * run["bending_moment"][-1])
    assert left.get_ylabel().endswith("[kN m]")
    envelope(right, run, "bending_moment", since=1.0)
    low, high = right.dataLim.intervaly
    moments = 1e-3 * run["bending_moment"][run.time >= 1.0]
    assert [low, high] == pytest.approx([moments.min(), moments.max()])


def test_reactions_and_tension_in_time(run: Run, tmp_path: Path) -> None:
    figure, panels = sheet(3, 2)
    end_reactions(panels[:4], {"one": run, "other": run}, since=0.5)
    window = run.time >= 0.5
    assert panels[3].lines[1].get_data()[1] == pytest.approx(1e-3 * run["end_force"][window, 2])
    line_with(panels[0].get_ylabel(), "H at end A", "[kN]", "+ towards end A")
    end_tension(panels[4], run)
    assert panels[4].lines[0].get_data()[1] == pytest.approx(1e-3 * run["effective_tension"][:, -1])
    assert save(figure, tmp_path / "curves.png").read_bytes().startswith(b"\x89PNG")


def test_instants_are_spread_over_the_records(run: Run) -> None:
    assert np.allclose(run.time[instants(run, 0.5, 1.5, 3)], [0.5, 1.0, 1.5])


def test_contact_force_has_a_sign_as_the_ground_may_hold_the_riser_by_suction(run: Run) -> None:
    _, (axes,) = sheet(1, 1)
    along_arc(axes, run, "contact_force")
    line_with(axes.get_ylabel(), "contact force", "[kN/m]", "+ pushes")
    line_with(SERIES["contact_force"].sign, "positive", "ground pushes")


def test_whatever_lies_along_the_riser_can_be_drawn(run: Run) -> None:
    _, (axes,) = sheet(1, 1)
    along_arc(axes, run, "slip")
    assert axes.lines[0].get_data()[1] == pytest.approx(run["slip"][-1])
    line_with(axes.get_ylabel(), "way", "slid", "seabed", "[m]")
