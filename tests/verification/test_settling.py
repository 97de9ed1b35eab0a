"""A riser heavier than clay as it is bears: it sinks until it is borne, or is told to sink on."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil import stages
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.system import Timer
from riser_soil.errors import SolveError
from riser_soil.solve import settling
from riser_soil.stages import run_stage
from tests.support.driven_stage import Watcher, built, soil_under
from tests.support.said import telling
from tests.support.scenes import Mapping
from tests.support.sinking_pipe import SU, D, sink, sinking

CELLS, ARM, LOAD_STEPS = 8, 30.0, 8  # across the pipe; diameters from its hinge to the slice; of its weight


def resting(load: float) -> Mapping:
    """A stiff pipe that hangs on a hinge far away and lies on the slice, whose weight loads that by `load` su D."""
    scene, arm = sinking(CELLS, 0.25, LOAD_STEPS), ARM * D
    lengths, counts = (arm, D), (10, 1)
    ends = {"start": {"position": [-arm, 0.0, 0.5 * D], "rotation": "free"}, "end": "free", "initial": "straight"}
    segments = [{"line_type": "pipe", "length": a, "elements": n} for a, n in zip(lengths, counts, strict=True)]
    about_hinge = (arm + 0.5 * D) / (0.5 * sum(lengths) ** 2)
    pipe = scene["line_types"]["pipe"] | {"submerged_weight": load * SU * D * D / CELLS * about_hinge, "EI": 1e10}
    stages = [{"name": "rest", "kind": "static"}]
    return scene | {"riser": {"segments": segments, **ends}, "line_types": {"pipe": pipe}, "stages": stages}


class Rested:
    """Embedment over D and load over su D at the slice; how often the pipe settled."""

    def __init__(self, load: float) -> None:
        assembly, watcher = built(resting(load)), Watcher()
        end = run_stage(assembly, assembly.scene.stages[0], State.at_rest(0.0, assembly.size), watcher, Timer.new())
        contact, x = soil_under(assembly).contact, assembly.riser.line.positions3(end)
        assert contact is not None
        self.w = 0.5 - float(np.interp(0.5 * D, x[:, 0], x[:, 2])) / D
        self.V = -float(contact.force_on_soil(end)[2]) / (SU * D * D / CELLS)
        self.settled = watcher.settlings


@pytest.mark.verify
def test_a_pipe_settles_to_where_one_that_is_pushed_bears_its_weight() -> None:
    """Loads at the same embedment: 2.70 beside 2.74, on cells whose stairs are 3 % of it."""
    rested, pushed = Rested(2.7), sink(sinking(CELLS, 0.1, 40))
    print(f"{rested.settled} settlings to {rested.w:.4f} D, bearing {rested.V:.3f}; pushed {pushed.at(rested.w):.3f}")
    assert rested.settled > 0
    assert pytest.approx(2.7, rel=2e-4) == rested.V, "all of the weight, but for the pipe's lean"
    assert pushed.at(rested.w) == pytest.approx(rested.V, rel=0.02)


@pytest.mark.verify
def test_settling_ends_where_the_clay_bears_all(monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where no equilibrium without the drag is taken, as where one is judged unstable: it went on to an error."""
    usual, step = Rested(2.7), settling._Settling._step

    def with_drag_alone(self: settling._Settling, drag: float) -> Array | None:
        return step(self, drag) if drag else None

    monkeypatch.setattr(settling._Settling, "_step", with_drag_alone)
    rested = Rested(2.7)
    assert rested.settled > 0
    assert usual.w == pytest.approx(rested.w, rel=1e-3)


@pytest.mark.verify
def test_steps_half_as_long_settle_the_pipe_as_deep(monkeypatch: pytest.MonkeyPatch) -> None:
    """To 1 %, 0.3 % of the load."""
    usual = Rested(2.7)
    monkeypatch.setattr(settling, "LONGEST", 0.5 * settling.LONGEST)
    monkeypatch.setattr(settling, "ALLOWED", 0.5 * settling.ALLOWED)
    assert Rested(2.7).w == pytest.approx(usual.w, rel=0.015)


@pytest.mark.verify
def test_a_pipe_that_nothing_bears_is_told_to_sink_on(monkeypatch: pytest.MonkeyPatch) -> None:
    """Eight times su D in all: beyond a twentieth of a diameter it is not waited for here."""
    monkeypatch.setattr(settling, "DEEPEST", 0.05)
    monkeypatch.setattr(settling, "LOOKED_AT", 0.02)
    with pytest.raises(SolveError, match=r"arc 9\.15 m: .*0\.00\d+ m .*= \d.* bears 0\.\d+\b"):
        Rested(8.0)


@pytest.mark.verify
def test_a_pipe_that_its_supports_push_far_does_not_settle(monkeypatch: pytest.MonkeyPatch) -> None:
    """By D/30 a step, farther than a riser may sink of itself."""

    def refuse(self: settling._Settling, drag: float) -> Array | None:
        raise AssertionError("it settles")

    monkeypatch.setattr(stages, "PRESSED_BY", 1 / 30)
    monkeypatch.setattr(settling._Settling, "_step", refuse)
    sunk = sink(sinking(CELLS, 0.1, 3))
    print(sunk.w, sunk.V)
    assert sunk.w[-1] == pytest.approx(0.1)
    assert sunk.w.size < 20, "load steps, cut where a facet's area would be off the geometry of its forces, too"
    assert sunk.V[-1] == pytest.approx(sink(sinking(CELLS, 0.1, 40)).V[-1], rel=0.1)


def test_a_pipe_that_creeps_is_told_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(settling, "MOST_STEPS", 2)
    with pytest.raises(SolveError, match=telling("creeps on", "not borne", "2 steps")):
        Rested(2.7)
