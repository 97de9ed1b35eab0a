"""Statics return stable equilibria only; where Newton finds none, relaxation does, or the failure is told.

Negative pivots of a riser over soil that it does not touch are those of the whole, and the soil's are counted once.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.core.part import Model, State
from riser_soil.core.system import System, Timer
from riser_soil.results import Run
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.solve import direct_solver, stability
from riser_soil.solve.buckling_mode import stabilising_drag
from riser_soil.solve.stability import PivotCounter, unstable_modes
from riser_soil.solve.time_scheme import Static
from riser_soil.whole_run import run
from tests.support.above_soil import hanging
from tests.support.driven_stage import FirstStep, built
from tests.support.toy_chain import Chain, Floor, Springs

PIPE = {"EA": 1e7, "EI": 1e3, "submerged_weight": 100.0}
EULER = np.pi**2 * 1e3 / 10.0**2


def strut(shortening: float, side_load: float) -> dict[str, object]:
    """A pinned strut 10 m long without weight, pushed together; loaded across at its middle."""
    load = {"at": 5.0, "force": [0.0, 0.0, side_load]}
    return {
        "gravity": 0.0,
        "line_types": {"bar": PIPE | {"submerged_weight": 0.0}},
        "riser": {
            "segments": [{"line_type": "bar", "length": 10.0, "elements": 10}],
            "start": {"position": [0.0, 0.0, 0.0]},
            "end": {"position": [10.0, 0.0, 0.0]},
            "initial": "straight",
        },
        "stages": [
            {"name": "push", "kind": "static", "move": {"end": [10.0 - shortening, 0.0, 0.0]}, "loads": [load]}
        ],
    }


def thrust(scene: dict[str, object], folder: Path) -> float:
    """Compression at the start [N]."""
    run(scene_from_mapping(scene), folder)
    return float(Run(folder).summary["stages"][0]["final"]["start"]["force"][0])


def test_below_the_buckling_load_a_strut_stays_straight(tmp_path: Path) -> None:
    shortening = 0.5 * EULER / PIPE["EA"] * 10.0
    assert thrust(strut(shortening, 0.0), tmp_path) == pytest.approx(0.5 * EULER, rel=1e-6)


def test_above_it_a_straight_strut_is_nudged_and_buckles(tmp_path: Path) -> None:
    """Straight it would carry 10 Euler loads and more."""
    assert thrust(strut(0.1, 0.0), tmp_path) == pytest.approx(EULER, rel=0.05)
    assert Run(tmp_path).summary["stages"][0]["method"] == "relaxation"


def test_a_side_load_lets_it_buckle(tmp_path: Path) -> None:
    """A buckled strut carries about Euler's load, growing slowly with the shortening."""
    assert thrust(strut(0.1, 1.0), tmp_path) == pytest.approx(EULER, rel=0.05)


def test_a_cantilever_laid_out_level_falls_to_hang(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Newton's method alone does not get there; the line ends up hanging with its weight as top tension."""
    scene = {
        "line_types": {"hose": PIPE},
        "riser": {
            "segments": [{"line_type": "hose", "length": 50.0, "elements": 25}],
            "start": {"position": [0.0, 0.0, 100.0]},
            "end": "free",
        },
        "stages": [{"name": "hang", "kind": "static"}],
    }
    run(scene_from_mapping(scene), tmp_path)
    stage = Run(tmp_path).summary["stages"][0]
    final = stage["final"]
    assert (stage["method"], stage["relaxations"]) == ("relaxation", 1)
    assert final["start"]["force"] == pytest.approx([0.0, 0.0, 5000.0], abs=1e-2)
    assert final["end"]["position"] == pytest.approx([0.0, 0.0, 50.0 - 0.0125], abs=1e-3)
    assert "dynamic relaxation was needed" in capsys.readouterr().out


def test_a_line_laid_out_straight_sags_and_does_not_fold(tmp_path: Path) -> None:
    """Newton's first step throws the untensioned line far down; from there it finds a stable tangle of folded elements.

    The tension of a shallow sag is (EA w^2 L^2/24)^(1/3) (Irvine, Cable Structures, 1981, section 2.3).
    """
    scene = {
        "line_types": {"pipe": {"EA": 1e8, "EI": 2e4, "submerged_weight": 490.5}},
        "riser": {
            "segments": [{"line_type": "pipe", "length": 50.0, "elements": 50}],
            "start": {"position": [0.0, 0.0, 0.0]},
            "end": {"position": [50.0, 0.0, 0.0]},
            "initial": "straight",
        },
        "stages": [{"name": "sag", "kind": "static"}],
    }
    tension = (1e8 * 490.5**2 * 50.0**2 / 24.0) ** (1.0 / 3.0)
    assert -thrust(scene, tmp_path) == pytest.approx(tension, rel=5e-3)


def test_a_sagging_line_does_not_wind_up_its_end_spring(tmp_path: Path) -> None:
    """Newton's method from a straight line comes back wound up by thousands of turns, which a spring would count."""
    scene = {
        "line_types": {"hose": PIPE},
        "riser": {
            "segments": [{"line_type": "hose", "length": 50.0, "elements": 25}],
            "start": {"position": [0.0, 0.0, 0.0], "rotation": {"stiffness": 10.0}},
            "end": {"position": [50.0, 0.0, 0.0]},
            "initial": "straight",
        },
        "stages": [{"name": "sag", "kind": "static"}],
    }
    run(scene_from_mapping(scene), tmp_path)
    moment = Run(tmp_path).summary["stages"][0]["final"]["start"]["moment"]
    assert 0.0 < np.linalg.norm(moment) < 10.0 * np.pi / 2.0


def test_a_riser_that_cannot_move_is_pressed_into_soil(tmp_path: Path) -> None:
    """One element held at both ends has no unknowns: on its cushion, before the soil, there are none at all."""
    ends = {place: {"position": [x, 0.0, 0.15], "rotation": "fixed"} for place, x in (("start", 0.0), ("end", 0.3))}
    soil = {"block": {"x": [0.1, 0.2], "y": [-0.5, 0.5], "depth": 0.5}, "law": {"kind": "linear-elastic", "E": 1e6}}
    soil["law"] |= {"nu": 0.3}
    soil["mesh"] = {"size_at_riser": {"along": 0.1, "across": 0.05}, "size_far": 0.25}
    scene = {
        "dimension": 2,
        "line_types": {"pipe": PIPE | {"outer_diameter": 0.3}},
        "riser": {"segments": [{"line_type": "pipe", "length": 0.3, "elements": 1}], "initial": "straight"} | ends,
        "soil": soil,
        "stages": [
            {"name": "press", "kind": "static", "move": {"start": [0.0, 0.0, 0.147], "end": [0.3, 0.0, 0.147]}}
        ],
    }
    run(scene_from_mapping(scene), tmp_path)
    assert Run(tmp_path).summary["stages"][0]["final"]["contact_force"] > 0.0


@pytest.mark.parametrize(
    ("stiffness", "certain", "possible"), [(1e-9, 0, 0), (2e-13, 0, 1), (0.0, 0, 1), (-2e-13, 0, 1), (-1e-9, 1, 1)]
)
def test_round_off_neither_makes_nor_hides_an_unstable_mode(stiffness: float, certain: int, possible: int) -> None:
    """Two masses on a spring of 1000 N/m between them, each on such a floor: rows of 2000 N/m, known to 4e-13."""
    chain = Chain(np.array([-1.0, -0.5]))
    system = System(MPI.COMM_SELF, Model([chain], [Springs(chain, 0.5, 1e3), Floor(chain, stiffness)]), Timer.new())
    state, weights = State.at_rest(1.0, chain.size), Static().weights(0.0)
    counts = [unstable_modes(PivotCounter(system), state, weights, 1.0, doubtful) for doubtful in (False, True)]
    assert counts == [certain, possible]
    system.destroy()


def test_the_least_stabilising_drag() -> None:
    assert stabilising_drag(1e4, lambda drag: drag > 3.0) == pytest.approx(1e4 / 2**11)
    assert stabilising_drag(1e-3, lambda drag: drag > 3.0) == pytest.approx(1e-3 * 2**12)


@pytest.fixture
def system() -> Iterator[System]:
    scene = hanging()
    scene["stages"] = scene["stages"][:1]
    step = FirstStep(built(scene))
    step.matrix(np.zeros(step.free))
    yield step.system
    step.system.destroy()


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """What has been factorised: "whole" or "soil"."""
    calls, usual, behind = list[str](), stability.negative_pivots, direct_solver.negative_pivots_behind

    def of_whole(system: System) -> int:
        calls.append("whole")
        return usual(system)

    def of_soil(system: System, rows: int) -> int:
        calls.append("soil")
        return behind(system, rows)

    monkeypatch.setattr(stability, "negative_pivots", of_whole)
    monkeypatch.setattr(direct_solver, "negative_pivots_behind", of_soil)
    return calls


def lower(system: System, first: int, count: int) -> None:
    """Make some rows of the matrix' diagonal negative, far beyond what is beside it."""
    more = system.numbering.zeros()
    more[first : first + count] = -1e12
    system.matrix.add_to_diagonal(more)


def test_a_riser_over_soil_has_pivots_of_its_own(system: System, asked: list[str]) -> None:
    pivots = PivotCounter(system)
    lower(system, 3, 2)
    assert pivots.count() == direct_solver.negative_pivots(system) == 2
    lower(system, 9, 1)
    assert pivots.count() == direct_solver.negative_pivots(system) == 3
    assert asked == ["soil"]


def test_soil_that_has_changed_is_counted_again(system: System, asked: list[str]) -> None:
    pivots = PivotCounter(system)
    assert pivots.count() == 0
    lower(system, system.line_rows + 5, 4)
    assert pivots.count() == direct_solver.negative_pivots(system) == 4
    assert asked == ["soil", "soil"]


def test_what_touches_is_counted_together(system: System, asked: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(System, "couples", property(lambda _: True))
    assert PivotCounter(system).count() == 0
    assert asked == ["whole"]
