"""Quasi-static stages: equilibria along tables and load histories, their steps, records and what they refuse."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.assembly import build
from riser_soil.assembly.motions import corner_count, corners, cycle_count
from riser_soil.checks.ground_plausibility import ground_warnings
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.system import Timer
from riser_soil.errors import SceneError
from riser_soil.results.read import Run
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.scene import Scene
from riser_soil.seabed.randolph_quiggin import RandolphQuiggin
from riser_soil.solve.step_control import PathSteps
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import run_stage
from riser_soil.whole_run import run
from tests.support.driven_stage import Watcher, built
from tests.support.equal_runs import unlike
from tests.support.left_run import leave_after
from tests.support.on_ranks import mpirun
from tests.support.said import line_with, lines_with, telling
from tests.support.scenes import LAY, Mapping, dynamic, prescribed, quasi_static, riser_scene, static, touchdown
from tests.support.stage_histories import stage_histories

L, EA = 10.0, 1.0e6
ROD: Mapping = {"EA": EA, "EI": 1.0e3, "mass": 50.0, "outer_diameter": 0.3, "submerged_weight": 0.0}
SAW = "t [-], x [m], y [m], z [m]\n0, 0, 0, 0\n1, 0.04, 0, 0\n2, 0.01, 0, 0\n4, 0.05, 0, 0\n"  # corners alone
PULLED = {"end": {"table": "saw.csv"}}


def saw(t: Array) -> Array:
    """Displacement of the end [m]: straight between the rows."""
    return np.interp(t, [0.0, 1.0, 2.0, 4.0], [0.0, 0.04, 0.01, 0.05])


def rod(*stages: Mapping, end: Any = None, **more: Any) -> Mapping:
    """A straight rod along x, fixed at its start."""
    start, there = prescribed(0.0, 0.0, 0.0, rotation="fixed"), end or prescribed(L, 0.0, 0.0)
    return riser_scene(*stages, pipe=ROD, length=L, elements=2, start=start, end=there, **more)


def scene(folder: Path, *stages: Mapping, table: str = SAW, **more: Any) -> Scene:
    (folder / "saw.csv").write_text(table, encoding="utf-8")
    return scene_from_mapping(rod(*stages, **more), folder)


def refusal(folder: Path, *stages: Mapping, **more: Any) -> str:
    with pytest.raises(SceneError) as caught:
        scene(folder, *stages, **more)
    assert len(str(caught.value).splitlines()) == 1
    return str(caught.value)


def test_tension_is_that_of_each_equilibrium_on_the_way(tmp_path: Path) -> None:
    """EA u/L at each record, u being straight between the table's rows; the clock is the table's."""
    stage = quasi_static(4.0, "cycles", time_step=0.4, motion=PULLED)
    run(scene(tmp_path, stage, output={"interval": 0.5}), tmp_path / "out")
    results = Run(tmp_path / "out")
    assert results.time == pytest.approx(np.arange(0.0, 4.01, 0.5))
    assert results["position"][:, -1, 0] == pytest.approx(L + saw(results.time), abs=1e-12)
    assert results["effective_tension"][:, 0] == pytest.approx(EA * saw(results.time) / L, rel=1e-6, abs=1e-6)
    assert results["kinetic_energy"].max() == 0.0


def test_summary_has_the_extremes_over_the_stage_and_no_balance_of_energy(tmp_path: Path) -> None:
    run(scene(tmp_path, quasi_static(3.0, "cycles", motion=PULLED), static("still")), tmp_path / "out")
    cycles, still = Run(tmp_path / "out").summary["stages"]
    assert (cycles["kind"], cycles["time"], cycles["steps"], cycles["method"]) == ("quasi-static", 3.0, 3, "newton")
    tension = cycles["extremes"]["end"]["effective_tension"]
    assert tension["max"] == pytest.approx(EA * 0.04 / L, rel=1e-6)
    assert (tension["min"], tension["t_min"], tension["t_max"]) == pytest.approx((0.0, 0.0, 1.0), abs=1e-6)
    assert cycles["energy"]["worst_residual"]["value"] is None
    assert "time_step" not in cycles["indicators"]
    assert cycles["warnings"] == []
    assert still["final"]["end"]["effective_tension"] == pytest.approx(EA * 0.03 / L, rel=1e-6)


def test_loads_follow_their_histories() -> None:
    """u = F L/EA under a force that goes up and down, all of it from the first step on without a history."""
    goes = {"at": "end", "force": [1000.0, 0.0, 0.0], "history": [[0.0, 0.0], [1.0, 1.0], [2.0, -0.5]], "keep": True}
    stays = {"at": "end", "force": [200.0, 0.0, 0.0]}
    stage = quasi_static(1.5, loads=[goes, stays], time_step=0.25)
    cycles, after = stage_histories(rod(stage, static("after"), end="free"))
    force = 200.0 + 1000.0 * np.interp(cycles.t, [0.0, 1.0, 2.0], [0.0, 1.0, -0.5])
    assert cycles.t == pytest.approx(np.arange(0.25, 1.51, 0.25))
    assert [x[-1, 0] for x in cycles.position] == pytest.approx(L * (1.0 + force / EA), rel=1e-9)
    assert after.end.effective_tension == pytest.approx(250.0, rel=1e-6)


def test_nothing_has_a_rate() -> None:
    """Swings whose supports would have speeds."""
    motion = {
        "start": {"rotation": {"axis": [0.0, 1.0, 0.0], "amplitude_deg": 1.0, "period": 1.0}},
        "end": {"harmonic": {"amplitude": [0.01, 0.0, 0.02], "period": 1.0}},
    }
    assembly = built(rod(quasi_static(1.0, motion=motion)))
    (stage,) = assembly.scene.stages

    def watch(stepper: TimeStepper, step: AcceptedStep) -> None:
        assert not stepper.now.v.any()
        assert not stepper.now.a.any()

    run_stage(assembly, stage, State.at_rest(0.0, assembly.size), Watcher(watch), Timer.new())
    assert assembly.riser.line.x[-1] == pytest.approx([L, 0.0], abs=1e-12)


CORNERS: list[tuple[Mapping, list[float]]] = [
    ({"motion": PULLED}, [1.0, 2.0, 3.5]),
    ({"loads": [{"at": "end", "force": [1.0, 0.0, 0.0], "history": [[0.0, 0.0], [0.7, 1.0], [9.0, 0.0]]}]}, [0.7, 3.5]),
    ({"motion": {"end": {"table": {"file": "saw.csv", "ramp": 0.3}}}}, [0.3, 1.0, 2.0, 3.5]),
]


@pytest.mark.parametrize(("more", "met"), CORNERS, ids=["table", "history", "ramp"])
def test_corners_are_met(more: Mapping, met: list[float], tmp_path: Path) -> None:
    made = scene(tmp_path, quasi_static(3.5, **more))
    (stage,) = made.stages
    assert stage.kind == "quasi-static"
    assert corners(made, stage) == pytest.approx(met)
    assert corner_count(made, stage) == pytest.approx(len(met), abs=3.0)


def test_a_period_has_four_and_twenty_corners(tmp_path: Path) -> None:
    motion = {"end": {"harmonic": {"amplitude": [0.01, 0.0, 0.0], "period": 2.0}}}
    made = scene(tmp_path, quasi_static(3.0, motion=motion))
    (stage,) = made.stages
    assert stage.kind == "quasi-static"
    assert corners(made, stage) == pytest.approx(np.arange(1, 37) / 12.0)


HELD_BACK: Mapping = {"at": "end", "force": [1.0, 0.0, 0.0]}
COUNTED: list[tuple[Mapping, float]] = [
    (quasi_static(4.0, motion=PULLED), 1.0),  # it turns twice
    (quasi_static(3.0, motion={"end": {"harmonic": {"amplitude": [0.01, 0.0, 0.0], "period": 0.5}}}), 6.0),
    (quasi_static(9.0, loads=[HELD_BACK | {"history": [[t, t % 2] for t in range(9)]}]), 3.5),
    (static(), 0.0),
]


@pytest.mark.parametrize(("stage", "cycles"), COUNTED, ids=["table", "periods", "history", "static"])
def test_cycles_are_counted(stage: Mapping, cycles: float, tmp_path: Path) -> None:
    made = scene(tmp_path, stage)
    assert cycle_count(made, made.stages[0]) == pytest.approx(cycles)


@pytest.mark.parametrize(
    ("kind", "duration", "warned"), [("kinematic-hardening", 100.0, True), ("iwan", 100.0, False)]
)
def test_many_cycles_on_clay_that_forgets_are_reported(kind: str, duration: float, warned: bool) -> None:
    swing = {"end": {"harmonic": {"amplitude": [0.0, 0.0, 0.01], "period": 10.0}}}
    given = touchdown(LAY, quasi_static(duration, motion=swing))
    given["soil"]["law"] = {"kind": kind, "su": 600.0, "E_over_su": 300.0, "nu": 0.49}
    warnings = lines_with(ground_warnings(built(given).riser), "lets go", "mean stress")
    assert len(warnings) == warned
    assert lines_with(warnings, "half of it", "0.69% shear strain", "10 cycles", "(limit 10)", "take iwan") == warnings


def walk(control: PathSteps, cut_at: int = -1) -> list[float]:
    out = [0.0]
    while not control.finished:
        if len(out) == cut_at:
            assert control.cut()
        out.append(control.target)
        control.accept(easy=True)
    return out


def test_steps_are_even_from_corner_to_corner() -> None:
    assert walk(PathSteps([0.0, 1.0, 1.3, 2.0], [2, 1, 3], 0.1)) == pytest.approx(
        [0.0, 0.5, 1.0, 1.3, 1.3 + 0.7 / 3, 1.3 + 1.4 / 3, 2.0]
    )


def test_a_step_that_is_cut_is_made_up_for_before_the_corner() -> None:
    assert walk(PathSteps([0.0, 1.0, 2.0], [1, 1], 0.1), cut_at=2) == pytest.approx([0.0, 1.0, 1.5, 2.0])
    control = PathSteps([0.0, 1.0], [1], 0.25)
    assert [control.cut() for _ in range(3)] == [True, True, False]


def test_steps_go_on_from_where_they_were_saved() -> None:
    one, other = (PathSteps([0.0, 1.0, 2.0], [2, 2], 0.1) for _ in range(2))
    for _ in range(3):
        one.accept(easy=True)
    one.cut()
    other.restore(one.state())
    assert walk(other) == pytest.approx([0.0, 1.75, 2.0])
    one.restore(other.state())
    assert one.finished


def test_a_load_that_comes_back_may_be_cut_on_its_way() -> None:
    """At the stage's end all loads are as at its beginning; a step to half of it is no less cut for that."""
    back = {"at": "end", "moment": [0.0, -100.0, 0.0], "history": [[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]]}
    stage = quasi_static(2.0, loads=[back])
    (cycle,) = stage_histories(rod(stage, end="free", solver={"max_iterations": 3}))
    assert max(cycle.cuts) > 0
    assert cycle.position[-1][-1] == pytest.approx([L, 0.0, 0.0], abs=1e-6)


def test_hysteretic_ground_answers_as_its_law_does(tmp_path: Path) -> None:
    """A pipe pressed in and lifted by its ends: the law along the same path, whatever the steps between the rows."""
    law: Mapping = {"kind": "randolph-quiggin", "su": 5.0e3}
    D, w = ROD["outer_diameter"], np.array([0.0, 0.03, 0.027, 0.03, 0.026, 0.06])
    rows = "".join(f"{t}, 0, 0, {-z}\n" for t, z in enumerate(w))
    (tmp_path / "path.csv").write_text("t [-], x [m], y [m], z [m]\n" + rows, encoding="utf-8")
    ends = [prescribed(x, 0.0, 0.5 * D, rotation="fixed") for x in (0.0, 1.0)]
    motion = {name: {"table": "path.csv"} for name in ("start", "end")}
    given = riser_scene(
        quasi_static(5.0, motion=motion, time_step=0.2),
        pipe=ROD | {"EI": 1e9},
        length=1.0,
        elements=1,
        start=ends[0],
        end=ends[1],
        riser={"initial": "straight"},
        seabed={"kind": "hysteretic", "law": law},
    )
    assembly = build(scene_from_mapping(given, tmp_path), MPI.COMM_SELF)
    forces: list[float] = []

    def watch(stepper: TimeStepper, step: AcceptedStep) -> None:
        assert assembly.riser.seabed is not None
        forces.append(float(assembly.riser.seabed.force_on_riser(stepper.now)[2]))

    run_stage(assembly, assembly.scene.stages[0], State.at_rest(0.0, assembly.size), Watcher(watch), Timer.new())
    formula = RandolphQuiggin(**law).of_pipe(D)
    history, expected = formula.initial_history((1,)), []
    for depth in np.concatenate([np.linspace(a, b, 6)[1:] for a, b in pairwise(w)]):
        answer = formula.update(np.array([depth]), history)
        history = answer.history
        expected.append(float(answer.force[0]))
    assert forces == pytest.approx(expected, rel=1e-6)


def pressed(stage: Mapping, folder: Path) -> Mapping:
    """What the summary tells of a stage in which a pipe is pressed into hysteretic clay by its ends, and lifted."""
    rows = "".join(f"{t}, 0, 0, {-z}\n" for t, z in enumerate((0.0, 0.01, 0.02, 0.03, 0.029, 0.028, 0.03, 0.04)))
    (folder / "path.csv").write_text("t [s], x [m], y [m], z [m]\n" + rows, encoding="utf-8")
    ends = {name: {"table": "path.csv"} for name in ("start", "end")}
    given = riser_scene(
        stage | {"motion": ends},
        pipe=ROD | {"EI": 1e9},
        length=1.0,
        elements=1,
        start=prescribed(0.0, 0.0, 0.15, rotation="fixed"),
        end=prescribed(1.0, 0.0, 0.15, rotation="fixed"),
        riser={"initial": "straight"},
        seabed={"kind": "hysteretic", "law": {"kind": "randolph-quiggin", "su": 5.0e3}},
    )
    run(scene_from_mapping(given, folder), folder / "out")
    (pushed,) = Run(folder / "out").summary["stages"]
    return dict(pushed)


def test_a_slow_dynamic_stage_has_no_impacts_and_makes_no_energy(tmp_path: Path) -> None:
    """The supports are paid for the mean force of each step and the ground takes that at its end: what the scheme books
    for it moves nothing.
    """
    stage = pressed(dynamic(7.0, 1.0), tmp_path)
    energy, impact = stage["energy"], stage["indicators"]["impact"]
    assert energy["numerical"] < -0.05 * energy["turned_over"]
    assert energy["ahead"] == pytest.approx(-energy["numerical"], rel=1e-3)
    assert abs(energy["made"]) < 1e-3 * energy["turned_over"]
    assert energy["dissipated_by"]["seabed_time_scheme"] > 0.05 * energy["turned_over"]
    assert impact["lost"] < 1e-3 * energy["dissipated_by"]["seabed_time_scheme"]
    assert not [each for each in stage["warnings"] if "impact lost" in each or "the time scheme" in each]


def test_a_stage_after_it_goes_on_from_there(tmp_path: Path) -> None:
    """In time, at rest where it was left."""
    stages = quasi_static(2.0, motion=PULLED), dynamic(0.2, 0.1)
    _, still = stage_histories(scene(tmp_path, *stages))
    assert still.end.effective_tension == pytest.approx(EA * 0.01 / L, rel=1e-6)
    assert max(still.energy) == pytest.approx(min(still.energy), rel=1e-9)


def test_a_run_left_in_it_ends_as_if_it_had_not_been_left(tmp_path: Path) -> None:
    given = scene(tmp_path, quasi_static(4.0, time_step=0.3, motion=PULLED), output={"checkpoint": {}})
    run(given, tmp_path / "alone")
    leave_after(5, given, tmp_path / "left")
    run(given, tmp_path / "left", restart=True)
    assert unlike(tmp_path / "alone", tmp_path / "left") == []


REFUSED: list[tuple[Mapping, str]] = [
    (quasi_static(5.0, motion=PULLED), "covers 0 to 4, but the stage lasts from 0 to 5"),
    (quasi_static(1.0, time_step=2.0), "time_step: value 2.0: must not exceed the stage's duration (1 s)"),
    (quasi_static(1.0, scheme={"midpoint": {}}), "scheme"),
    (quasi_static(1.0, move={"end": [1.0, 0.0, 0.0]}), "move"),
    (dynamic(4.0, 0.1, motion=PULLED), "t counts [-], and a dynamic stage goes by time"),
    (static(motion=PULLED), "motion"),
]


@pytest.mark.parametrize(("stage", "words"), REFUSED, ids=[words[:20] for _, words in REFUSED])
def test_what_does_not_belong_is_refused(stage: Mapping, words: str, tmp_path: Path) -> None:
    assert words in refusal(tmp_path, stage)


def test_a_vessel_that_answers_waves_is_refused(tmp_path: Path) -> None:
    rows = "frequency [rad/s], direction [deg], heave [m/m], heave phase [deg]\n0.1, 0, 1, 0\n2, 0, 1, 0\n"
    (tmp_path / "rao.csv").write_text(rows, encoding="utf-8")
    vessel = {"rao": "rao.csv", "reference": [0.0, 0.0, 0.0]}
    message = refusal(tmp_path, quasi_static(1.0, motion={"end": {"vessel": vessel}}))
    line_with(message, "vessel answers waves", "quasi-static stage", "vessel_history")


def test_two_rows_are_enough(tmp_path: Path) -> None:
    rows = "".join(f"{line}\n" for line in SAW.splitlines()[:3])
    (stretch,) = stage_histories(scene(tmp_path, quasi_static(1.0, motion=PULLED), table=rows))
    assert stretch.end.effective_tension == pytest.approx(EA * 0.04 / L, rel=1e-6)
    message = refusal(tmp_path, dynamic(1.0, 0.1, motion=PULLED), table=rows.replace("[-]", "[s]"))
    line_with(message, "table of 2 rows", "at least 4", "quasi-static")


def test_a_riser_with_two_free_ends_has_no_equilibrium(tmp_path: Path) -> None:
    mapping = rod(quasi_static(1.0), end="free") | {}
    mapping["riser"] |= {"start": "free", "unstressed": {"points": [[0, 0, 0], [L, 0, 0]]}}
    with pytest.raises(SceneError, match=telling("stages.0:", "two free ends", "no equilibrium")):
        scene_from_mapping(mapping, tmp_path)


@pytest.mark.verify
def test_ranks_agree(tmp_path: Path) -> None:
    """On soil that yields."""
    segment = Path(__file__).parents[3] / "demos/pipe_segment/scene.yaml"
    common = "-m", "riser_soil", "run", str(segment), "--set", "stages.0.duration=24", "-o"
    for ranks in (1, 2):
        done = mpirun(ranks, *common, str(tmp_path / f"on_{ranks}"))
        assert done.returncode == 0, done.stderr
    one, two = (Run(tmp_path / f"on_{ranks}")["contact_force_sum"] for ranks in (1, 2))
    assert two == pytest.approx(one, rel=1e-6, abs=1e-6)
