"""The first and the last state of a run in its files, whatever it begins with and however it ends."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from riser_soil.errors import Interruption, SolveError
from riser_soil.results import Run
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.solve.step_control import Control
from riser_soil.solve.time_scheme import Static
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.whole_run import run
from tests.support.scenes import LAY, Mapping, heave, touchdown


@pytest.fixture
def failing_after(monkeypatch: pytest.MonkeyPatch) -> list[BaseException]:
    """The run ends at its 8th step in motion, by what the test puts into the list."""
    usual, count, ends = TimeStepper.advance, [0], list[BaseException]()

    def advance(stepper: TimeStepper, control: Control, most_cuts: int | None = None) -> AcceptedStep:
        count[0] += not isinstance(stepper.scheme, Static)
        if count[0] == 8:
            raise ends[0]
        return usual(stepper, control, most_cuts)

    monkeypatch.setattr(TimeStepper, "advance", advance)
    return ends


@pytest.mark.parametrize("soil", [False, True])
@pytest.mark.parametrize("end", [SolveError("no convergence"), Interruption(15)])
def test_the_last_accepted_step_is_in_all_files(
    soil: bool, end: BaseException, failing_after: list[BaseException], tmp_path: Path
) -> None:
    """After a static stage and seven steps of 0.1 s, none of which was due."""
    mapping: Mapping = touchdown(LAY, heave(3.0), su=1000.0) | {"output": {"interval": 1.0}}
    if not soil:
        del mapping["soil"]
    failing_after.append(end)
    with pytest.raises(type(end)):
        run(scene_from_mapping(mapping), str(tmp_path))
    results = Run(tmp_path)
    assert not results.finished
    assert results.time == pytest.approx([0.0, 0.7])
    stage = results.summary["stages"][1]
    assert (stage["steps"], stage["time"]) == (7, pytest.approx(0.7))
    assert stage["final"]["end"]["force"] == results["end_force"][-1].tolist()
    if soil:
        assert results.soil_times.tolist() == results.time.tolist()
        assert results.soil_frame().fields["displacement"][:, 2].min() < 0.0
        first, last = (results.soil_frame(number).fields["displacement"] for number in (0, 1))
        assert not np.array_equal(first, last)


def test_a_run_that_begins_in_motion_has_its_beginning(tmp_path: Path) -> None:
    mapping: Mapping = touchdown(heave(0.3)) | {"output": {"interval": 0.1}}
    del mapping["soil"]
    run(scene_from_mapping(mapping), tmp_path)
    results = Run(tmp_path)
    assert results.time == pytest.approx([0.0, 0.1, 0.2, 0.3])
    assert results["position"][0, -1] == pytest.approx([22.5, 0.0, 15.0])
    assert np.all(np.isfinite(results["bending_moment"][0]))
    assert results.summary["stages"][0]["steps"] == 3
