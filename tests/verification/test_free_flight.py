"""A flexible beam in free flight, and one that a hub spins up: Simo & Vu-Quoc's examples.

J. C. Simo & L. Vu-Quoc, On the dynamics of flexible beams under large overall motions, J. Appl. Mech. 53 (1986), and On
the dynamics in space of rods undergoing large motions, Comput. Methods Appl. Mech. Engng 66 (1988). Their beams have
shear, which is left out here.
"""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.system import Timer
from riser_soil.solve.step_control import StepControl
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import run_stage
from tests.support.driven_stage import Watcher, built
from tests.support.momentum import momentum
from tests.support.scenes import AVERAGE, Mapping, dynamic, prescribed, riser_scene
from tests.support.stage_histories import stage_histories

MIDPOINT: Mapping = {"midpoint": {}}
PULSE = {
    2: {"force": [8.0, 0.0, 0.0], "moment": [0.0, 80.0, 0.0], "history": [[0.0, 1.0], [2.5, 1.0], [2.5001, 0.0]]},
    3: {"force": [20.0, 0.0, 0.0], "moment": [0.0, 200.0, 100.0], "history": [[0.0, 0.0], [2.5, 1.0], [5.0, 0.0]]},
}
IMPULSE = {2: 20.0, 3: 50.0}  # N s
BENDING = {2: 100.0, 3: 500.0}
QUIET = {2: 2.6, 3: 5.0}


def spaghetti(dimension: int, dt: float, duration: float, scheme: Any) -> Mapping:
    """A free beam, inclined by 4:3, whose lower end gets a pulse of force and moment."""
    pipe = {"EA": 1e4, "EI": BENDING[dimension], "GJ": 500.0, "mass": 1.0, "rotary_inertia": 10.0}
    return riser_scene(
        dynamic(duration, dt, scheme=scheme, loads=[{"at": "end", **PULSE[dimension]}]),
        pipe=pipe,
        length=10.0,
        elements=10,
        start="free",
        end="free",
        dimension=dimension,
        riser={"initial": {"points": [[0.0, 0.0, 8.0], [6.0, 0.0, 0.0]]}},
        solver={"tolerance": 1e-11},
    )


POINT: Mapping = {"kind": "point", "mass": 2.0}
RIGID: Mapping = {"kind": "rigid", "mass": 2.0, "inertia": [1.0, 2.5, 2.0], "centre_of_gravity": [0.3, -0.2, 0.4]}


def hinged(dt: float, duration: float, body: Mapping) -> Mapping:
    """Two such beams that a hinge joins, a body at the end of the second; the first gets the pulse."""
    scene = dict(spaghetti(3, dt, duration, MIDPOINT))
    riser, stage = scene.pop("riser"), scene["stages"][0]
    del scene["dimension"]
    places = {"first": [[0.0, 0.0, 8.0], [6.0, 0.0, 0.0]], "second": [[6.0, 0.0, 0.0], [12.0, 3.0, 7.4162]]}
    lines = {name: riser | {"initial": {"points": points}} for name, points in places.items()}
    ends = [{"line": "first", "at": "end"}, {"line": "second", "at": "start"}]
    hinge = {"kind": "pinned", "between": ends, "position": [6.0, 0.0, 0.0]}
    kind = "clamped" if body["kind"] == "rigid" else "pinned"
    carries = {"kind": kind, "between": [{"line": "second", "at": "end"}, {"body": "mass"}]}
    stage["lines"] = {"first": {"loads": [load | {"at": "start"} for load in stage.pop("loads")]}}
    bodies = {"mass": body | {"position": places["second"][1]}}
    return scene | {"lines": lines, "bodies": bodies, "joints": {"hinge": hinge, "carries": carries}}


class Flight:
    """What is seen after each step: time, momenta (n, 3), energy, and at the end the tips' positions (2, 3)."""

    def __init__(
        self, dimension: int, dt: float, duration: float = 15.0, scheme: Any = MIDPOINT, scene: Mapping | None = None
    ) -> None:
        assembly = built(scene or spaghetti(dimension, dt, duration, scheme))
        rows = list[tuple[float, Array, Array, float, int]]()

        def watch(stepper: TimeStepper, step: AcceptedStep) -> None:
            rows.append((step.t, *momentum(assembly, stepper), stepper.energy.total, step.solution.iterations))

        run_stage(assembly, assembly.scene.stages[0], State.at_rest(0.0, assembly.size), Watcher(watch), Timer.new())
        columns = zip(*rows, strict=True)
        self.t, self.linear, self.angular, self.energy, self.iterations = (np.array(c) for c in columns)
        self.quiet = self.t > QUIET[dimension]
        first = next(iter(assembly.lines.values())).line
        self.tips = first.to_global(first.x)[[0, -1]]

    def drift(self, values: Array) -> float:
        """Largest change of a momentum after the pulse, relative to what it is then."""
        after = values[self.quiet]
        return float(np.linalg.norm(after - after[0], axis=1).max() / np.linalg.norm(after[0]))

    @property
    def energy_range(self) -> float:
        after = self.energy[self.quiet]
        return float(np.ptp(after) / after[0])


@pytest.mark.parametrize("dimension", [pytest.param(2, marks=pytest.mark.verify), 3])
def test_midpoint_rule_keeps_momentum_to_round_off(dimension: int) -> None:
    flight = Flight(dimension, 0.05)
    assert flight.linear[-1] == pytest.approx([IMPULSE[dimension], 0.0, 0.0], abs=1e-9)
    assert flight.drift(flight.linear) < 1e-10
    assert flight.drift(flight.angular) < 1e-10
    assert flight.energy_range < (1e-2 if dimension == 2 else 5e-4)


@pytest.mark.parametrize("body", [pytest.param(POINT, marks=pytest.mark.verify), RIGID])
def test_lines_and_a_body_that_are_joined_keep_momentum_to_round_off(body: Mapping) -> None:
    """Joints act in the middle of the step, too, one side against the other at one place."""
    flight = Flight(3, 0.05, scene=hinged(0.05, 8.0, body))
    assert flight.linear[-1] == pytest.approx([IMPULSE[3], 0.0, 0.0], abs=1e-7)
    assert flight.drift(flight.linear) < 1e-9
    assert flight.drift(flight.angular) < 1e-9
    assert flight.energy_range < 1e-3


def test_snes_finds_the_flight_of_a_rigid_body_that_the_line_solver_finds() -> None:
    scene = dict(hinged(0.05, 0.5, RIGID))
    compiled, snes = (
        Flight(3, 0.05, scene=scene | {"solver": {"tolerance": 1e-11, "newton": newton}})
        for newton in ("compiled", "snes")
    )
    np.testing.assert_allclose(compiled.tips, snes.tips, rtol=0.0, atol=1e-10)
    np.testing.assert_allclose(compiled.angular, snes.angular, rtol=0.0, atol=1e-8)


@pytest.mark.verify
def test_energy_errs_in_second_order() -> None:
    ranges = np.array([Flight(3, dt, 8.0).energy_range for dt in (0.05, 0.025, 0.0125)])
    assert np.all(np.log2(ranges[:-1] / ranges[1:]) > 1.9)


def test_midpoint_rule_is_of_second_order_and_agrees_with_newmarks() -> None:
    tips = [Flight(3, dt, 5.0).tips for dt in (0.05, 0.025, 0.0125)]
    first, second = (np.linalg.norm(a - b) for a, b in pairwise(tips))
    assert np.log2(first / second) == pytest.approx(2.0, abs=0.15)
    assert np.linalg.norm(Flight(3, 0.0125, 5.0, AVERAGE).tips - tips[-1]) < 2.0 * second


@pytest.mark.parametrize("dimension", [2, 3])
def test_newmarks_scheme_keeps_momentum_to_second_order(dimension: int) -> None:
    """Rotation vectors of a step do not add up as its rates do, so that both momenta drift."""
    drifts = []
    for dt in (0.05, 0.025):
        flight = Flight(dimension, dt, scheme=AVERAGE)
        drifts.append([flight.drift(flight.linear), flight.drift(flight.angular)])
    assert np.all(np.log2(np.array(drifts[0]) / drifts[1]) > 1.7)
    assert 1e-5 < drifts[1][1] < 1e-3


def test_newton_converges_quadratically_in_flight() -> None:
    """About four iterations to eleven digits, with the tangent of the iteration before where that will do."""
    assert Flight(3, 0.025, 10.0).iterations.mean() < 4.5


@pytest.mark.verify
@pytest.mark.parametrize("dimension", [2, 3])
def test_long_flight(dimension: int) -> None:
    flight = Flight(dimension, 0.025, 100.0)
    assert flight.drift(flight.linear) < 1e-8
    assert flight.drift(flight.angular) < 1e-8
    after = flight.energy[flight.quiet]
    assert after.max() < after[0] * (1.0 + 1e-3)
    assert after.min() > after[0] * (1.0 - (4e-3 if dimension == 2 else 4e-4))


# A beam on a hub that spins up to 6 rad/s in 15 s

LENGTH, EA, EI, MASS, SPEED = 10.0, 2.8e7, 1.4e4, 1.2, 6.0


W = 2.0 * np.pi / 15.0


def hub_angle(t: Array) -> Array:
    """psi(t) [rad]."""
    return np.where(t < 15.0, 0.4 * (0.5 * t**2 + (np.cos(W * t) - 1.0) / W**2), SPEED * t - 45.0)


def spin_up(folder: Path, axis: Array, along: Array, dimension: int) -> tuple[Array, Array]:
    """Times, and the tip along the hub's direction, across it and along the axis (n, 3), seen from the turning hub."""
    t = np.linspace(0.0, 20.0, 2001)
    rows = np.column_stack([t, np.zeros((t.size, 3)), np.degrees(hub_angle(t))[:, None] * axis])
    header = "t [s], x [m], y [m], z [m], rx [deg], ry [deg], rz [deg]"
    np.savetxt(folder / "hub.csv", rows, "%.14g", ", ", header=header, comments="")
    scene = riser_scene(
        dynamic(20.0, 0.02, motion={"start": {"table": str(folder / "hub.csv")}}),
        pipe={"EA": EA, "EI": EI, "GJ": EI, "mass": MASS},
        length=LENGTH,
        elements=6,
        start=prescribed(0.0, 0.0, 0.0, rotation="fixed"),
        end="free",
        dimension=dimension,
        solver={"tolerance": 1e-9},
        riser={"initial": {"points": [[0.0, 0.0, 0.0], list(LENGTH * along)]}},
    )
    history = stage_histories(scene)[-1]
    tip, time, across = np.array(history.position)[:, -1], np.array(history.t), np.cross(axis, along)
    c, s = np.cos(hub_angle(time)), np.sin(hub_angle(time))
    x, y = tip @ along, tip @ across
    return time, np.stack([c * x + s * y, c * y - s * x, tip @ axis], axis=1)


@pytest.mark.verify
def test_spin_up(tmp_path: Path) -> None:
    """The tip lags while the hub accelerates; then the beam is straight and longer by rho A w^2 L^3 / (3 EA).

    The hub turns by twelve turns, in the plane and about an axis oblique to all coordinates.
    """
    t, tip = spin_up(tmp_path, np.array([0.0, -1.0, 0.0]), np.array([1.0, 0.0, 0.0]), 2)
    steady = t > 16.0
    assert pytest.approx(5.14e-4, rel=1e-3) == MASS * SPEED**2 * LENGTH**3 / (3.0 * EA)
    assert tip[steady, 0].mean() - LENGTH == pytest.approx(5.14e-4, rel=5e-3)
    assert np.abs(tip[steady, 1]).max() < 1e-2
    assert tip[:, 1].min() == pytest.approx(-0.574, abs=2e-3)
    _, oblique = spin_up(tmp_path, np.array([0.48, 0.64, 0.6]), np.array([0.8, -0.6, 0.0]), 3)
    assert np.abs(oblique - tip).max() < 1e-6


# Rotations of many turns

TOP = {"EA": 1e6, "EI": 1e5, "GJ": 1e5, "mass": 60.0, "rotary_inertia": 20.0}


def test_frames_stay_orthonormal_through_a_hundred_turns() -> None:
    """A pipe tossed with a spin of ten turns a second about its axis and a tumble."""
    spin, dt = 20.0 * np.pi, 0.01
    stage = dynamic(10.0, dt, scheme=MIDPOINT)
    points = {"initial": {"points": [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]]}}
    more = {"riser": points, "dimension": 3, "solver": {"tolerance": 1e-10}}
    assembly = built(riser_scene(stage, pipe=TOP, length=2.0, elements=2, start="free", end="free", **more))
    before = State.at_rest(0.0, assembly.size)
    rates = before.v.reshape(-1, 6)
    rates[:, 2], rates[:, 3:] = [-0.5, 0.0, 0.5], [spin, -0.5, 0.0]
    momenta = list[Array]()

    def watch(stepper: TimeStepper, step: AcceptedStep) -> None:
        momenta.append(momentum(assembly, stepper)[1])

    after = run_stage(assembly, assembly.scene.stages[0], before, Watcher(watch), Timer.new())
    turns = np.array([assembly.riser.line.frames.turn(np.zeros((3, 3))).at(node) for node in range(3)])
    assert np.abs(turns @ np.swapaxes(turns, 1, 2) - np.eye(3)).max() < 1e-13
    assert np.linalg.norm(momenta[-1] - momenta[0]) < 1e-9 * np.linalg.norm(momenta[0])
    assert after.v.reshape(-1, 6)[:, 3] == pytest.approx(np.full(3, spin), rel=1e-2)


def test_steps_of_changing_size_keep_momentum(monkeypatch: pytest.MonkeyPatch) -> None:
    """Newton's method may need cuts: here every third step is a quarter of the others."""
    usual, count = TimeStepper.advance, iter(range(10000))

    def advance(stepper: TimeStepper, control: StepControl) -> AcceptedStep:
        if next(count) % 3 == 0:
            assert control.cut()
            assert control.cut()
        return usual(stepper, control)

    monkeypatch.setattr(TimeStepper, "advance", advance)
    flight = Flight(3, 0.05, 10.0)
    assert np.unique(np.round(np.diff(flight.t), 9)).size > 1
    assert flight.drift(flight.angular) < 1e-10
    assert flight.energy_range < 5e-4
