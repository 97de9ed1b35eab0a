"""Programs beside each other: the quantities of a run that is known in full, errors, and which accuracies count."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from mpi4py import MPI

from benchmarks.peers.case import CASES, CATENARY, TANK, Case, Record, catenary
from benchmarks.peers.judge import (
    MOMENT,
    RANGE,
    Judged,
    apart,
    cheapest,
    consensus,
    errors,
    front,
    kept_error,
    quantities,
)
from benchmarks.peers.refinement import PROGRAMS
from benchmarks.peers.riser import scene_of
from riser_soil.assembly import build
from riser_soil.assembly.motions import set_motion
from riser_soil.scene.reader import scene_from_mapping

RUNS = [
    Judged(20, 0.2, seconds=1.0, error=0.001),  # by luck: none of those that refine it is as good
    Judged(20, 0.1, seconds=2.0, error=0.02),
    Judged(40, 0.2, seconds=3.0, error=0.009),
    Judged(40, 0.1, seconds=4.0, error=0.005),
]


def test_a_lucky_run_does_not_count() -> None:
    assert [kept_error(run, RUNS) for run in RUNS] == [0.02, 0.02, 0.009, 0.005]
    assert cheapest(RUNS, 0.01) is RUNS[2]
    assert cheapest(RUNS, 0.02) is RUNS[0]
    assert cheapest(RUNS, 0.004) is None


def test_the_front_is_that_of_kept_errors() -> None:
    assert front(RUNS) == [(1.0, 0.02), (3.0, 0.009), (4.0, 0.005)]
    assert front(RUNS[::-1]) == front(RUNS)


def test_each_quantity_is_the_median_of_the_programs() -> None:
    assert consensus([{"a": 1.0}, {"a": 9.0}, {"a": 2.0}]) == {"a": 2.0}


def test_tensions_err_in_parts_of_the_greatest_at_their_end() -> None:
    agreed = {"top min": 10.0, "top max": 100.0, MOMENT: 5.0}
    shares = errors({"top min": 11.0, "top max": 100.0, MOMENT: 6.0}, agreed)
    assert shares == pytest.approx({"top min": 0.01, "top max": 0.0, MOMENT: 0.2})


def test_finest_runs_are_as_far_apart_as_their_worst_pair() -> None:
    least, greatest = (10.0, 13.0, 11.0), (100.0, 100.0, 101.0)
    finest = [{"top min": low, "top max": high} for low, high in zip(least, greatest, strict=True)]
    assert apart(finest) == pytest.approx(0.03)


def travelling(case: Case) -> Record:
    """A line on the floor that rises with a curvature of 0.02/m from an arc that goes from 18 to 22 m and back."""
    t = np.arange(0.0, case.duration + 0.05, 0.1)
    arc = np.linspace(0.0, case.length, 161)
    wave = np.sin(2.0 * np.pi * t / case.period)
    height = 0.01 * np.maximum(arc - 20.0 - 2.0 * wave[:, None], 0.0) ** 2
    position = np.stack([np.broadcast_to(arc, height.shape), height], axis=2)
    moment = 7.0 - 0.01 * (arc - 25.03) ** 2 + 0.2 * wave[:, None]
    return Record(t, 200.0 + 50.0 * wave, 2000.0 - 100.0 * wave, arc, moment, position, seconds=1.0)


def test_quantities_are_found_between_records_and_stations() -> None:
    values = quantities(TANK, travelling(TANK))
    assert values == pytest.approx(
        {"top min": 1900.0, "top max": 2100.0, "bottom min": 150.0, "bottom max": 250.0, MOMENT: 7.2, RANGE: 4.0},
        rel=1e-4,
    )


def test_what_happens_before_the_extremes_are_taken_is_not_seen() -> None:
    record = travelling(TANK)
    startled = replace(record, moved=np.where(record.time < TANK.since - 0.05, 9e9, record.moved))
    assert quantities(TANK, startled) == quantities(TANK, record)


@pytest.mark.parametrize("case", CASES.values(), ids=list(CASES))
def test_the_end_moves_as_in_our_scene(case: Case) -> None:
    scene = scene_from_mapping(scene_of(case, 20, 0.1, "snes"))
    end = build(scene, MPI.COMM_SELF).riser.line.end
    set_motion(end, "end", np.array([case.end[0], 0.0, case.end[1]]), scene.stages[-1], None)
    assert end.motion is not None
    for t in (0.0, 0.3 * case.period, 0.9 * case.period, 2.2 * case.period):
        ours = [values[[0, 2]] for values in end.motion(t)]
        assert np.array(case.moved_end(t)) == pytest.approx(np.array(ours), abs=1e-12)


@pytest.mark.parametrize("case", CASES.values(), ids=list(CASES))
def test_a_first_guess_is_as_long_as_the_line_and_ends_where_it_does(case: Case) -> None:
    points = catenary(case, 4001)
    assert points[[0, -1]] == pytest.approx(np.array([case.start, case.end]), abs=1e-6)
    assert np.linalg.norm(np.diff(points, axis=0), axis=1).sum() == pytest.approx(case.length, rel=1e-5)


def test_the_weight_is_that_of_the_catenary_demo() -> None:
    assert pytest.approx(346.1, abs=0.05) == CATENARY.weight


def test_each_program_keeps_files_of_its_own() -> None:
    assert len({program.stem for program in PROGRAMS}) == len(PROGRAMS)
    for program in PROGRAMS:
        for case in CASES:
            sizes = list(program.runs(case))
            assert len(set(sizes)) == len(sizes)
            assert all(sizes[-1][0] >= elements and sizes[-1][1] <= step for elements, step in sizes)
