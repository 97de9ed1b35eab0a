"""Risers too long to hang in a bend that pipe and elements can follow: laid too far out, and brought to their place."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from riser_soil.errors import SolveError
from tests.support.runs import run_of
from tests.support.said import line_with, telling
from tests.support.scenes import Mapping, dynamic, prescribed, riser_scene, static

W, PIPE = 500.0, {"EA": 1e8, "EI": 1e4, "GJ": 1e4, "submerged_weight": 500.0, "outer_diameter": 0.2, "mass": 60.0}


def slack_scene(*end: float, length: float = 60.0, elements: int = 60, **more: Any) -> Mapping:
    stages = more.pop("stages", (static(),))
    start = prescribed(0.0, 0.0, 0.0)
    pipe = more.pop("pipe", PIPE)
    options: Mapping = {"pipe": pipe, "length": length, "elements": elements, "start": start, "end": prescribed(*end)}
    return riser_scene(*stages, **options, gravity=9.81, solver={"tolerance": 1e-11}, **more)


def test_hairpin_under_coinciding_ends(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Symmetric about the vertical; each end bears half the weight, and the loop's two legs push each other apart."""
    run = run_of(slack_scene(0.0, 0.0, 0.0), tmp_path)
    start, end = run["start_force"][-1], run["end_force"][-1]
    assert np.abs(start + end - [0.0, 0.0, 60.0 * W]).max() < 1e-8 * 60.0 * W
    assert start[2] == pytest.approx(30.0 * W, rel=1e-8)
    assert end[0] < 0.0
    position = run["position"][-1]
    assert position[:, 0] == pytest.approx(-position[::-1, 0], abs=1e-7)
    assert position[30, 2] == pytest.approx(-29.0, abs=0.5)
    assert np.linalg.norm(np.diff(position, axis=0), axis=1).sum() == pytest.approx(60.0, rel=5e-3)
    laying = run.summary["laying"]
    assert laying["slack"] > 1.0
    line_with(capsys.readouterr().out, "riser is slack:", f"{laying['slack']:.4g} m too far")


def test_a_taut_vertical_riser_is_not_called_slack(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Between ends farther apart than its length, it begins straight, in balance."""
    run = run_of(slack_scene(0.0, 0.0, 60.06), tmp_path)
    assert run["effective_tension"][-1].min() > 0.0
    assert "laying" not in run.summary
    assert "slack" not in capsys.readouterr().out


@pytest.mark.parametrize("dimension", [2, 3])
def test_top_above_the_bottom(dimension: int, tmp_path: Path) -> None:
    run = run_of(slack_scene(0.0, 0.0, 40.0, dimension=dimension), tmp_path)
    total = run["start_force"][-1] + run["end_force"][-1]
    assert np.abs(total - [0.0, 0.0, 60.0 * W]).max() < 1e-8 * 60.0 * W
    assert run["position"][-1, -1] == pytest.approx([0.0, 0.0, 40.0], abs=1e-12)
    assert run.summary["stages"][0]["method"] == "newton"


def test_some_slack_on_the_seabed_is_borne_in_compression(tmp_path: Path) -> None:
    """What the seabed bears and the ends carry is the weight."""
    seabed = {"kind": "rigid", "level": 0.0, "contact_at": "axis"}
    run = run_of(slack_scene(40.0, 0.0, 15.0, length=58.0, elements=116, seabed=seabed), tmp_path)
    total = run["start_force"][-1] + run["end_force"][-1] + run["contact_force_sum"][-1]
    assert np.abs(total - [0.0, 0.0, 58.0 * W]).max() < 1e-8 * 58.0 * W
    assert run["end_force"][-1, 0] < 0.0


def test_dynamics_may_come_first(tmp_path: Path) -> None:
    """The laid riser is at rest, and stays so."""
    run = run_of(slack_scene(0.0, 0.0, 40.0, stages=(dynamic(1.0, 0.1),)), tmp_path)
    assert np.ptp(run["end_force"], axis=0).max() < 1e-4 * 60.0 * W


def test_a_loop_too_tight_for_its_elements_is_reported(tmp_path: Path) -> None:
    seabed = {"kind": "rigid", "level": 0.0, "contact_at": "axis"}
    with pytest.raises(SolveError, match=r"is slack: .* \d[\d.e+-]* m beyond .*\(EI/w\)\^\(1/3\) = 2\.71 m"):
        run_of(slack_scene(40.0, 0.0, 15.0, length=200.0, elements=20, seabed=seabed), tmp_path)


def test_a_riser_that_stretches_beyond_all_measure_is_not_laid(tmp_path: Path) -> None:
    """Under its weight of 30 kN an EA of 1 N gives strains in the thousands: nothing is tried, and no time spent."""
    with pytest.raises(SolveError, match=telling("too soft", "beyond", "times", "60 m", "3e+04 N", "EA", "is 1 N")):
        run_of(slack_scene(0.0, 0.0, 40.0, pipe=PIPE | {"EA": 1.0}), tmp_path)


def test_a_slack_riser_may_stretch(tmp_path: Path) -> None:
    """An EA of its weight doubles its length, and it is laid all the same."""
    assert run_of(slack_scene(0.0, 0.0, 40.0, pipe=PIPE | {"EA": 60.0 * W}), tmp_path).summary["laying"]["slack"] > 0.0
