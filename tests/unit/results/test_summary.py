"""summary.json: its structure, its extremes, and that it is JSON."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from riser_soil.core.output import angle_deg
from riser_soil.core.snapshot import Ledger, Record, StepRecord, StepStatistics
from riser_soil.results.figures import Extremes, final_state, pack
from riser_soil.results.limit_tally import LimitTally
from riser_soil.results.stage_tally import StageTally
from riser_soil.results.summary import Summary, plain_json
from tests.support.recorded_run import EI, FACTS, WEIGHT, Catenary, changed, record, stacked
from tests.support.said import line_with

ARC = np.linspace(0.0, 150.0, 301)
LINE = Catenary(32.0, 30.0)
END = {"position", "force", "resultant_force", "moment", "effective_tension", "angle_deg"}
PLACE = "touchdown_position"
SPAN = {"min", "max", "t_min", "t_max", "arc_min", "arc_max"}
CODE = {
    f"max_{name}_utilisation"
    for name in (
        *("code", "bursting", "hoop_buckling", "propagating_buckling", "combined_loading"),
        *("bend_radius", "tension_limit", "compression", "crushing", "capacity_curve"),
    )
}
WHOLE = {
    "touchdown_arc",
    "touchdown_points",
    "min_bend_radius",
    "max_bend_utilisation",
    "max_tension_utilisation",
    "max_wall_von_mises_stress",
    "max_stress_utilisation",
    "max_embedment",
    *CODE,
    "max_bending_moment",
    "max_curvature",
    "min_effective_tension",
    "min_wall_tension",
    "max_wall_tension",
    "max_penetration",
    "contact_force",
}


def strictly(text: str) -> Any:
    """JSON without the NaN and Infinity that Python would take."""

    def refuse(name: str) -> None:
        raise ValueError(name)

    return json.loads(text, parse_constant=refuse)


def test_final_state_of_a_catenary() -> None:
    final = final_state(pack(LINE.record(ARC)))
    assert set(final) == {"start", "end", PLACE} | WHOLE
    assert set(final["start"]) == set(final["end"]) == END
    assert final["start"]["force"] == pytest.approx([-WEIGHT * 32.0, 0.0, 0.0])
    assert final["end"]["force"] == pytest.approx([WEIGHT * 32.0, 0.0, WEIGHT * 120.0])
    assert final["end"]["resultant_force"] == pytest.approx(WEIGHT * math.hypot(32.0, 120.0))
    assert final["end"]["effective_tension"] == pytest.approx(WEIGHT * math.hypot(32.0, 120.0))
    assert final["end"]["angle_deg"] == pytest.approx(math.degrees(math.atan2(120.0, 32.0)))
    assert final["start"]["angle_deg"] == 0.0
    assert final["max_bending_moment"] == {"value": pytest.approx(EI / 32.0), "arc": 30.0}
    assert final["max_curvature"] == {"value": pytest.approx(1.0 / 32.0), "arc": 30.0}
    assert final["min_effective_tension"] == {"value": pytest.approx(WEIGHT * 32.0), "arc": 0.0}
    assert final["contact_force"] == pytest.approx(WEIGHT * 30.0)
    assert final["touchdown_arc"] == 30.0
    assert (final["touchdown_position"], final["touchdown_points"]) == ([30.0, 0.0, 0.15], 1.0)
    assert final["min_bend_radius"] == {"value": pytest.approx(32.0), "arc": 30.0}
    assert final["max_bend_utilisation"] == {"value": pytest.approx(20.0 / 32.0), "arc": 30.0}
    assert final["max_embedment"] == {"value": 0.003, "arc": 0.0}


def test_what_is_unknown_is_left_out() -> None:
    sometimes: tuple[str, ...] = ("wall_tension", "largest_bend_utilisation", "tension_utilisation", "embedment")
    sometimes += ("wall_von_mises_stress", "stress_utilisation", *(name.removeprefix("max_") for name in CODE))
    record = changed(LINE.record(ARC), **dict.fromkeys(sometimes))
    extremes = Extremes()
    extremes.update(0.0, pack(record))
    unknown = {"min_wall_tension", "max_wall_tension", "max_bend_utilisation", "max_embedment"}
    unknown |= {"max_tension_utilisation", "max_wall_von_mises_stress", "max_stress_utilisation", *CODE}
    for nested in (final_state(pack(record)), extremes.nested()):
        assert set(nested) == {"start", "end", PLACE} | WHOLE - unknown


def test_a_straight_pipe_has_no_bend_radius() -> None:
    straight = dict.fromkeys(("largest_curvature", "largest_curvature_arc"), np.zeros(()))
    final = final_state(pack(changed(LINE.record(ARC), **straight)))
    assert plain_json(final)["min_bend_radius"] == {"value": None, "arc": 0.0}


def test_a_pipe_bent_too_much_is_a_warning() -> None:
    assert exceeded(bent(20.1), bent(25.0)) == []
    assert len(exceeded(bent(19.9), bent(25.0))) == 1
    warnings = exceeded(bent(25.0), bent(16.0), bent(18.0))
    assert len(warnings) == 1
    line_with(warnings, "min_bend_radius", "1.25 times", "arc 30 m and 0.2 s", "radius is 16 m")


def bent(a: float) -> Record:
    """A catenary of this parameter [m], whose pipe may be bent to 20 m; weak in nothing else."""
    others = dict.fromkeys(("tension_utilisation", "stress_utilisation"))
    return changed(Catenary(a, 30.0).record(ARC), **others)


def exceeded(*records: Record) -> list[str]:
    """Warnings of limits that are exceeded at 0.1 s, 0.2 s and so on: in one batch, and in two with a restart."""
    times = 0.1 * np.arange(1, len(records) + 1)
    whole, begun, again = LimitTally(), LimitTally(), LimitTally()
    whole.update(times, stacked(records))
    begun.update(times[:1], stacked(records[:1]))
    again.restore(begun.state())
    again.update(times[1:], stacked(records[1:]))
    assert [*again.warnings("s")] == [*whole.warnings("s")]
    return [*whole.warnings("s")]


def test_pull_and_stress_beyond_their_limits_are_warnings() -> None:
    """The largest of all nodes and instants, nan where a line type gives none, with its own tension and stress."""
    tension = {"tension_utilisation": np.where(ARC < 100.0, np.nan, 1.5)} | {"effective_tension": 10.0 * ARC}
    stress = {"stress_utilisation": np.where(ARC == 40.0, 1.2, 0.5), "most_used_stress": 1.0e6 * ARC}
    calm, pulled = bent(25.0), changed(bent(25.0), **tension, **stress)
    known = changed(calm, tension_utilisation=0.5 * np.ones_like(ARC), stress_utilisation=np.zeros_like(ARC))
    warnings = exceeded(known, pulled, known)
    assert len(warnings) == 2
    line_with(warnings, "max_tension", "1.5 times", "arc 100 m and 0.2 s", "tension is 1000 N")
    line_with(warnings, "yield_stress", "1.2 times", "arc 40 m and 0.2 s", "stress is 4e+07 Pa")


@pytest.mark.parametrize(
    ("tangent", "angle"), [((0.0, 0.0, 1.0), 90.0), ((0.0, -1.0, 0.0), 0.0), ((-1.0, 0.0, -1.0), -45.0)]
)
def test_angle_from_the_horizontal(tangent: tuple[float, ...], angle: float) -> None:
    assert angle_deg(np.array(tangent)) == pytest.approx(angle)


def test_extremes_know_when() -> None:
    extremes = Extremes()
    for t, a in ((0.0, 32.0), (0.1, 35.0), (0.2, 30.0)):
        extremes.update(t, pack(Catenary(a, 30.0).record(ARC)))
    nested = extremes.nested()
    assert nested["end"]["force"]["max"][0] == pytest.approx(WEIGHT * 35.0)
    assert nested["end"]["force"]["t_max"][0] == 0.1
    assert nested["end"]["force"]["min"][0] == pytest.approx(WEIGHT * 30.0)
    assert nested["end"]["force"]["t_min"][0] == 0.2
    assert nested["max_curvature"] == {
        "min": pytest.approx(1.0 / 35.0),
        "max": pytest.approx(1.0 / 30.0),
        "t_min": 0.1,
        "t_max": 0.2,
        "arc_min": 30.0,
        "arc_max": 30.0,
    }


def test_extremes_know_where() -> None:
    extremes = Extremes()
    for t, (a, s0) in enumerate([(32.0, 30.0), (35.0, 40.0), (30.0, 20.0)]):
        extremes.update(t, pack(Catenary(a, s0).record(ARC)))
    nested = extremes.nested()
    assert (nested["max_bending_moment"]["arc_min"], nested["max_bending_moment"]["arc_max"]) == (40.0, 20.0)
    assert {"arc_min", "arc_max"} <= nested["min_effective_tension"].keys()
    assert "arc_max" not in nested["contact_force"] | nested["end"]["force"]


def test_extremes_mirror_the_final_state() -> None:
    extremes = Extremes()
    extremes.update(0.0, pack(LINE.record(ARC)))
    nested = extremes.nested()
    assert set(nested) == {"start", "end", PLACE} | WHOLE
    assert set(nested["start"]) == set(nested["end"]) == END
    for name in WHOLE:
        assert {"min", "max", "t_min", "t_max"} <= nested[name].keys() <= SPAN


def test_lifting_off_does_not_spoil_the_touchdown_extremes() -> None:
    extremes = Extremes()
    for t, arc in ((0.0, math.nan), (0.1, 20.0), (0.2, math.nan)):
        extremes.update(t, pack(changed(LINE.record(ARC), touchdown_arc=np.array(arc))))
    assert extremes.nested()["touchdown_arc"] == {"min": 20.0, "max": 20.0, "t_min": 0.1, "t_max": 0.1}


def test_never_touching_is_null(tmp_path: Path) -> None:
    summary = Summary(FACTS)
    stage = summary.begin_stage("hang", "static")
    stage.steps = 1
    free = {"touchdown_arc": np.float64(math.nan), "touchdown_position": np.full(3, math.nan)}
    free |= {"touchdown_points": np.int64(0), "max_penetration": np.float64(0.0), "contact_force_sum": np.zeros(3)}
    record = Record(ARC, LINE.riser(ARC) | free)
    stage.lines[""].extremes.update(1.0, pack(record))
    summary.write(tmp_path / "summary.json")
    written = strictly((tmp_path / "summary.json").read_text())["stages"][0]
    assert written["final"]["touchdown_arc"] is None
    assert written["extremes"]["touchdown_arc"] == {"min": None, "max": None, "t_min": None, "t_max": None}


def test_a_packed_vector_has_the_figures_in_the_order_of_the_file_and_their_places_behind() -> None:
    final = final_state(np.arange(float(pack(LINE.record(ARC)).size)))
    assert final["start"]["position"] == [0.0, 1.0, 2.0]
    assert final["end"]["angle_deg"] == 23.0
    assert final["touchdown_position"] == [25.0, 26.0, 27.0]
    assert final["max_bending_moment"] == {"value": 29.0, "arc": 52.0}
    assert final["contact_force"] == 41.0


def test_plain_json() -> None:
    value = {
        "a": np.float64(1.5),
        "b": [math.inf, np.nan],
        "c": np.arange(2),
        "d": np.bool_(True),
        "e": (None, "x"),
    }
    assert plain_json(value) == {"a": 1.5, "b": [None, None], "c": [0, 1], "d": True, "e": [None, "x"]}


def test_structure_of_the_file(tmp_path: Path) -> None:
    facts = replace(FACTS, warnings=("elements are long",), versions={"python": "3.11.2"})
    record(tmp_path, duration=1.0, facts=facts)
    summary = strictly((tmp_path / "summary.json").read_text())
    keys = {"title", "finished", "version", "versions", "warnings", "ranks", "parts", "dofs", "stages", "seconds"}
    assert set(summary) == keys | {"processor_seconds"}
    assert (summary["warnings"], summary["versions"]) == (["elements are long"], {"python": "3.11.2"})
    assert summary["finished"] is True
    assert summary["parts"] == {
        "built": ["riser", "soil", "contact"],
        "left_out": {"waves": "the scene has none"},
    }
    assert summary["dofs"] == {"riser": 900, "soil": 9000}
    assert summary["seconds"] == {"newton": 1.25}
    lay, heave = summary["stages"]
    assert {
        "name",
        "kind",
        "time",
        "steps",
        "newton_iterations",
        "step_cuts",
        "final",
        "extremes",
        "energy",
    } <= set(lay)
    assert (lay["kind"], lay["time"], lay["steps"], lay["newton_iterations"]) == ("static", 0.0, 2, 6)
    assert (heave["kind"], heave["steps"]) == ("dynamic", 10)
    assert heave["time"] == pytest.approx(1.0)
    assert set(heave["energy"]) == {*vars(Ledger()), "made", "relative_residual", "worst_residual"}
    assert heave["energy"]["worst_residual"] == {"value": 1e-6, "time": pytest.approx(0.1)}
    assert lay["energy"]["worst_residual"] == {"value": None, "time": None}


def test_energy_that_does_not_balance_is_a_warning() -> None:
    """1 J of 99 J is more than a hundredth, at its worst or at the end; the scheme's own share has its own warning."""
    off = balanced(*(Ledger(kinetic=99.0, turned_over=99.0, residual=residual) for residual in (-1.0, 0.1)))
    assert len(off.warnings) == 1
    line_with(off.warnings, "energy balance", "-1 J", "0.5 s", "1.01% of the 99 J")
    assert balanced(Ledger(turned_over=101.0, residual=1.0, numerical=1.0)).warnings == []
    greedy = balanced(Ledger(turned_over=99.0, numerical=-1.0))
    assert len(greedy.warnings) == 1
    line_with(greedy.warnings, "time scheme", "added 1 J", "1.01% of the 99 J", "smaller time_step")
    assert balanced(Ledger(residual=math.nan), kind="static").warnings == []


def balanced(*ledgers: Ledger, kind: str = "dynamic") -> StageTally:
    """A stage after steps of 0.5 s with these ledgers."""
    stage, health = StageTally(FACTS, "heave", kind), StepStatistics(3, 0.5, 0.0, 0)
    times = [0.5 * (n + 1) for n in range(len(ledgers))]
    stage.count(times, [StepRecord(t, health, ledger) for t, ledger in zip(times, ledgers, strict=True)])
    return stage
