"""Load steps of static stages on soil: fine enough for clay that a pipe is pressed into; relaxation between them."""

from __future__ import annotations

import pytest

from riser_soil import stages
from riser_soil.contact.soil_contact import SOIL
from riser_soil.core.part import Field, Model, Part, State
from riser_soil.core.roles import owners
from riser_soil.core.saved_state import Saved, gathered
from riser_soil.core.system import System
from riser_soil.errors import SolveError
from riser_soil.scene.stages import StaticStage
from riser_soil.solve.dynamic_relaxation import RelaxationResult
from riser_soil.solve.step_control import Control
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from tests.support.driven_stage import built, soil_under, take
from tests.support.pushed_pipe import D, slice_of_soil
from tests.support.scenes import Mapping

CLAY: Mapping = {"kind": "von-mises", "su": 4.0e3, "E_over_su": 300.0, "nu": 0.49}


def steps(law: Mapping | None, pressed: float, up: float = 0.0, asked: int = 1) -> int:
    """Load steps of the second stage, in which a pipe that touches is pressed in by so much, or lifted [m]."""
    scene = slice_of_soil(2)
    first = scene["stages"][0]
    ends = {end: [*at[:2], 0.5 * D - pressed + up] for end, at in first["move"].items()}
    for at in first["move"].values():
        at[2] = 0.5 * D
    scene["stages"].append({"name": "then", "kind": "static", "move": ends})
    scene["solver"] = {"load_steps": asked}
    if law is not None:
        scene["soil"]["law"] = law
    assembly, sizes = built(scene), list[float]()

    def watch(system: System, step: AcceptedStep) -> None:
        sizes.append(step.dt)

    before = take(assembly, assembly.scene.stages[0])
    stage = assembly.scene.stages[1]
    assert isinstance(stage, StaticStage)
    take(assembly, stage, before, watch)
    return len(sizes)


@pytest.mark.parametrize(("law", "expected"), [(None, 1), (CLAY, 5)], ids=["elastic", "clay"])
def test_a_pipe_is_pressed_into_clay_by_little_at_a_time(law: Mapping | None, expected: int) -> None:
    assert steps(law, D / 32.0) == expected


def test_a_pipe_is_lifted_by_a_quarter_of_its_diameter_at_a_time() -> None:
    assert steps(CLAY, 0.0, up=0.6 * D) == 3


def test_more_load_steps_are_taken_where_they_are_asked_for() -> None:
    assert steps(None, D / 32.0, asked=7) == 7


def test_relaxation_that_leaves_another_pattern_of_contact_does_no_harm(monkeypatch: pytest.MonkeyPatch) -> None:
    """The first attempt fails, and so does relaxation, after it has chosen candidates for a riser that is lifted."""
    scene = slice_of_soil(2)
    assembly, tried = built(scene), list[float]()
    contact, usual = soil_under(assembly).contact, TimeStepper.advance
    assert contact is not None

    def relaxed(*_: object) -> RelaxationResult:
        lifted = State.at_rest(0.0, assembly.size)
        lifted.u[assembly.riser.line.translation_dofs[:, -1]] = D
        candidates = contact.blocks()[SOIL].shape
        contact.rebuild(lifted)
        assert contact.blocks()[SOIL].shape != candidates
        raise SolveError("no rest was found")

    def advance(stepper: TimeStepper, control: Control, most_cuts: int | None = None) -> AcceptedStep:
        tried.append(control.dt)
        if len(tried) == 1:
            raise SolveError("no convergence")
        return usual(stepper, control, most_cuts)

    monkeypatch.setattr(stages, "relax", relaxed)
    monkeypatch.setattr(TimeStepper, "advance", advance)
    state = take(assembly, assembly.scene.stages[0])
    assert tried[1] == 0.5 * tried[0]
    assert contact.force_on_soil(state)[2] < 0.0


def test_relaxation_that_fails_on_its_way_leaves_clay_and_riser_as_they_were(monkeypatch: pytest.MonkeyPatch) -> None:
    """Relaxation has pressed the pipe into clay by a tenth of its diameter when it gives up."""
    scene = slice_of_soil(2)
    scene["soil"]["law"] = CLAY
    assembly, saved, usual = built(scene), list[Saved](), TimeStepper.advance

    def relaxed(comm: object, model: Model, *_: object) -> RelaxationResult:
        saved.append(gathered(owners(model)))
        pressed = State.at_rest(0.0, assembly.size)
        pressed.u[assembly.riser.line.translation_dofs[:, -1]] = -0.1 * D
        assert assembly.soil is not None
        pressed.u[assembly.soil.whole.field.offset + assembly.soil.whole.field.size - 1] = -0.1 * D
        committing: list[Part | Field] = [*model.parts, *model.fields]
        for owner in committing:
            owner.commit(pressed)
        moved = gathered(owners(model))
        assert all((moved[name] != saved[0][name]).any() for name in ("fields/riser/x", "parts/soil/law/stress"))
        raise SolveError("no rest was found")

    def advance(stepper: TimeStepper, control: Control, most_cuts: int | None = None) -> AcceptedStep:
        if not saved:
            raise SolveError("no convergence")
        if len(saved) == 1:
            saved.append(gathered(owners(stepper.system.model)))
        return usual(stepper, control, most_cuts)

    monkeypatch.setattr(stages, "relax", relaxed)
    monkeypatch.setattr(TimeStepper, "advance", advance)
    take(assembly, assembly.scene.stages[0])
    before, after = saved
    assert set(before) == set(after)
    for name, value in before.items():
        assert after[name] == pytest.approx(value), name
