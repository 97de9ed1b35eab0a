"""Steel catenary risers laid on clay, springs and hard floors, by Newton alone, where relaxation finds them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from riser_soil.assembly import Assembly
from riser_soil.assembly.laid_guess import laid_guess
from riser_soil.core.part import State
from riser_soil.core.snapshot import Record
from riser_soil.core.system import Timer
from riser_soil.errors import SolveError
from riser_soil.results.riser_record import riser_record
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import run_stage
from tests.support.driven_stage import Watcher, built
from tests.support.scenes import Mapping, static

MOST = 8  # Newton iterations in the step that lays the riser
PIPE = {"outer_diameter": 0.273, "inner_diameter": 0.222, "mass": 155.0, "EA": 4.1e9, "EI": 3.18e7, "GJ": 2.4e7}
STEEP, USUAL, WIDE = 1100.0, 1300.0, 1500.0  # m between the ends: hung off at 5, 10 and 17 deg
MOVED = [1300.0, 0.0, 1782.0], [1300.0, 0.0, 1778.0], [1300.0, 10.0, 1780.0], [1310.0, 0.0, 1780.0]


def clay(kind: str, su: float) -> Mapping:
    return {"kind": "hysteretic", "law": {"kind": kind, "su": su, "su_gradient": 1.5e3}}


CLAYS = "randolph-quiggin", "aubeny-biscontin"
GROUNDS: dict[str, Mapping] = {
    **{f"{kind} {su:g}": clay(kind, su) for kind in CLAYS for su in (3e2, 1.5e3, 2e4)},
    "soft springs": {"kind": "spring", "stiffness": 2e4},
    "hard springs": {"kind": "spring", "stiffness": 2e6},
    "rigid": {"kind": "rigid"},
}
LONG = (
    *(f"randolph-quiggin {su}" for su in (300, 1500)),
    *(f"aubeny-biscontin {su}" for su in (300, 1500, 20000)),
    *("soft springs", "hard springs"),
)
MARKED = [pytest.param(name, marks=[pytest.mark.verify] * (name in LONG)) for name in GROUNDS]


def scene(ground: str, *stages: Mapping, apart: float = USUAL, finer: float = 1.0, **more: Any) -> Mapping:
    """2,500 m of a pipe of 10.75 inches in 1,800 m of water, in elements of 20 to 2 m over how much finer."""
    fine, coarse = 2.0 / finer, 20.0 / finer
    sizes = (400.0, [coarse, fine]), (300.0, fine), (1800.0, [fine, coarse])
    return {
        "title": "Steel catenary riser",
        "water": {"density": 1025.0, "surface_level": 1800.0},
        "line_types": {"steel": PIPE},
        "riser": {
            "contents": {"density": 850.0},
            "segments": [{"line_type": "steel", "length": l, "element_length": size} for l, size in sizes],
            "start": {"position": [0.0, 0.0, 0.1365]},
            "end": {"position": [apart, 0.0, 1780.0]},
        },
        "seabed": GROUNDS[ground],
        "contact": {"friction": {"axial": 0.5, "lateral": 0.5}},
        "solver": {"tolerance": 1e-9},
        "stages": [static("lay"), *stages],
    } | more


@dataclass
class Laid(Watcher):
    """Watcher of a scene's static stages."""

    def __init__(self, assembly: Assembly) -> None:
        super().__init__(self._see)
        self.assembly, self.iterations, self.cuts = assembly, list[int](), 0
        self.end: list[Record] = []

    def _see(self, stepper: TimeStepper, step: AcceptedStep) -> None:
        self.iterations.append(step.solution.iterations)
        self.cuts += step.cuts
        self.end.append(riser_record(self.assembly.riser, stepper))


def laid(mapping: Mapping) -> Laid:
    assembly = built(mapping)
    watch, before = Laid(assembly), State.at_rest(0.0, assembly.size)
    for stage in assembly.scene.stages:
        before = run_stage(assembly, stage, before, watch, Timer.new())
    return watch


def require_easy(watch: Laid, most: int = MOST) -> None:
    assert (watch.relaxations, watch.cuts) == (0, 0)
    assert max(watch.iterations) <= most


@pytest.mark.parametrize("apart", [USUAL, *(pytest.param(x, marks=pytest.mark.verify) for x in (STEEP, WIDE))])
@pytest.mark.parametrize("ground", MARKED)
def test_newton_alone(ground: str, apart: float) -> None:
    """On elements of half the size, too, which need as many iterations."""
    for finer in (1.0, 2.0):
        require_easy(laid(scene(ground, apart=apart, finer=finer)))


@pytest.mark.parametrize(
    "ground",
    ["rigid", *(pytest.param(f"{law} 1500", marks=pytest.mark.verify) for law in CLAYS)],
)
def test_newton_alone_in_space(ground: str) -> None:
    """Newton's method alone lays it in space as in the plane."""
    space, plane = (laid(scene(ground, dimension=dimension)) for dimension in (3, 2))
    require_easy(space)
    assert space.end[0].position == pytest.approx(plane.end[0].position, abs=1e-7)


@pytest.mark.parametrize("changed", ["heights", "reversed", "clamped", "arched"])
def test_newton_alone_where_it_is_held_otherwise(changed: str) -> None:
    """With the lower end over the clay; with its ends the other way round; with an end that can't turn; with buoyancy
    that lifts it, so that it touches down three times.
    """
    mapping = scene("randolph-quiggin 1500")
    riser = mapping["riser"]
    if changed == "heights":
        riser["start"]["position"][2] = 3.0
    if changed == "reversed":
        riser["start"], riser["end"] = riser["end"], riser["start"]
        riser["segments"] = [
            given | {"element_length": size[::-1] if isinstance(size := given["element_length"], list) else size}
            for given in reversed(riser["segments"])
        ]
    if changed == "clamped":
        riser["start"]["rotation"] = "fixed"
    if changed == "arched":
        riser["attachments"] = [{"from": 100.0, "to": 160.0, "spacing": 10.0, "mass": 100.0, "volume": 2.0}]
    require_easy(laid(mapping))


@pytest.mark.parametrize(
    "ground", ["randolph-quiggin 1500", pytest.param("aubeny-biscontin 1500", marks=pytest.mark.verify)]
)
def test_where_relaxation_finds_it(ground: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Tension, touchdown, moment and friction to a millionth."""
    state, advance = laid(scene(ground)).end[0], TimeStepper.advance

    def fail_once(stepper: TimeStepper, *args: Any) -> AcceptedStep:
        monkeypatch.setattr(TimeStepper, "advance", advance)
        raise SolveError("made to fail")

    monkeypatch.setattr(TimeStepper, "advance", fail_once)
    relaxed = laid(scene(ground))
    assert relaxed.relaxations == 1
    expected = relaxed.end[0]
    for name in ("effective_tension", "bending_moment", "contact_force", "start_force", "end_force", "position"):
        value, other = getattr(state, name), getattr(expected, name)
        assert value == pytest.approx(other, abs=1e-6 * float(np.abs(other).max())), name


@pytest.mark.parametrize(
    "ground",
    [
        "rigid",
        *(pytest.param(f"{law} 1500", marks=pytest.mark.verify) for law in CLAYS),
        pytest.param("soft springs", marks=pytest.mark.verify),
    ],
)
def test_ends_that_move_need_no_relaxation(ground: str) -> None:
    """Up and down by 2 m, 10 m sideways and 10 m away, each in one load step: what lies is pressed and let go."""
    stages = [static(f"move {n}", move={"end": to}) for n, to in enumerate(MOVED)]
    require_easy(laid(scene(ground, *stages)), most=20)


@pytest.mark.parametrize("apart", [STEEP, USUAL])
def test_guess_touches_down_where_the_riser_does(apart: float) -> None:
    """Within an element or two, where the catenary misses it by half the length of the bend; its ends stay."""
    mapping = scene("rigid", apart=apart, finer=4.0)
    assembly = built(mapping)
    assert assembly.riser.seabed is not None
    assert assembly.riser.catenary is not None
    guess = laid_guess(assembly.scene, assembly.riser.seabed, assembly.riser.elements, (), assembly.riser.catenary)
    assert guess is not None
    placed, arc, axis = assembly.riser.line.x[:, 1], assembly.riser.line.arc, 0.5 * PIPE["outer_diameter"]
    touchdown = arc[laid(mapping).end[0].contact_force > 0.0][-1]
    guessed, of_cable = arc[placed + guess[:, 1] < axis][-1], arc[placed < axis + 1e-3][-1]
    assert abs(guessed - touchdown) < 2.5
    assert of_cable - touchdown > 0.5 * np.sqrt(PIPE["EI"] / assembly.riser.catenary.H)
    assert guess[[0, -1], 0] == pytest.approx([0.0, 0.0], abs=1e-9)
