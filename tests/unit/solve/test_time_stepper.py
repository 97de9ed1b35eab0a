"""The time loop on a chain of masses: order, energy, impact, step cuts and honest failure."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.core.part import Forces, LineField, Model, Part, State
from riser_soil.core.system import System, Timer
from riser_soil.errors import SolveError
from riser_soil.results import Run
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.solve.inverse_mass import InverseMass
from riser_soil.solve.newton import Newton
from riser_soil.solve.newton_settings import NewtonSettings
from riser_soil.solve.step_control import StepControl
from riser_soil.solve.time_scheme import GeneralizedAlpha, Midpoint, Scheme
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.whole_run import run
from tests.support.toy_chain import Chain, Floor, Inertia, Springs

AVERAGE = GeneralizedAlpha.newmark()


def walk_through(
    chain: LineField, parts: list[Part], scheme: Scheme, v0: np.ndarray, end: float, dt: float, tolerance: float = 1e-11
) -> list[AcceptedStep]:
    system = System(MPI.COMM_SELF, Model([chain], parts), Timer.new())
    newton = Newton(system, NewtonSettings(tolerance, 20, 1e-12))
    nothing = np.zeros_like(v0)
    stepper = TimeStepper(system, newton, scheme, State(0.0, nothing, v0.copy(), nothing))
    control = StepControl(end, dt, dt / 8)
    steps = []
    while not control.finished:
        steps.append(stepper.advance(control))
        stepper.commit(steps[-1], control)
    newton.destroy()
    system.destroy()
    return steps


def oscillate(scheme: Scheme, dt: float) -> float:
    """Height of the free end of a nonlinear chain after 3 s, the other end prescribed."""
    chain = Chain(np.arange(4.0), prescribed=True)
    parts: list[Part] = [Springs(chain, 1.0, 20.0, 50.0), Inertia(chain, 1.0)]
    walk_through(chain, parts, scheme, np.array([0.0, 0.3, 0.1, 0.8]), 3.0, dt)
    return float(chain.z[-1])


@cache
def nearly_exact() -> float:
    return oscillate(AVERAGE, 0.001)


@pytest.mark.parametrize(
    "scheme",
    [AVERAGE, GeneralizedAlpha.from_rho_inf(0.6), GeneralizedAlpha.newmark(0.3, 0.5), Midpoint()],
)
def test_second_order_in_time(scheme: Scheme) -> None:
    steps = [0.03, 0.015, 0.0075]
    z = [oscillate(scheme, dt) for dt in steps]
    errors = np.abs(np.array(z) - nearly_exact())
    orders = np.log2(errors[:-1] / errors[1:])
    assert orders[-1] == pytest.approx(2.0, abs=0.15)


def test_spectral_radius_one_is_the_average_acceleration() -> None:
    assert oscillate(GeneralizedAlpha.from_rho_inf(1.0), 0.03) == pytest.approx(oscillate(AVERAGE, 0.03), rel=1e-9)


@pytest.mark.parametrize("scheme", [AVERAGE, Midpoint()])
def test_average_acceleration_and_midpoint_rule_keep_the_energy_of_a_linear_chain(scheme: Scheme) -> None:
    chain = Chain(np.arange(6.0), prescribed=True)
    inertia = Inertia(chain, 1.0)
    parts: list[Part] = [Springs(chain, 1.0, 50.0, weight=2.0), inertia]
    v0 = np.array([0.0, 1.0, -1.0, 0.5, 0.2, 2.0])
    start = 0.5 * float(inertia.nodal() @ v0**2)
    energies = [s.energy.total for s in walk_through(chain, parts, scheme, v0, 100.0, 0.1)]
    assert len(energies) == 1000
    assert np.ptp(energies) < 1e-8 * start


@pytest.mark.parametrize("scheme", [AVERAGE, GeneralizedAlpha.from_rho_inf(0.8), GeneralizedAlpha.newmark(0.36, 0.7)])
@pytest.mark.parametrize("stiffness", [1e4, 1e6, 1e8])
@pytest.mark.parametrize("dt", [0.1, 0.02, 0.004])
def test_impact_never_gains_energy(scheme: Scheme, stiffness: float, dt: float) -> None:
    """A chain falls on a floor. Contact itself never gives energy; the total stays at or below the start's."""
    chain = Chain(1.0 + 0.5 * np.arange(5.0))
    springs, inertia = Springs(chain, 0.5, 2e4, weight=9.81), Inertia(chain, 1.0)
    floor = Floor(chain, stiffness)
    at_rest = State.at_rest(0.0, 5)
    start = springs.energy(at_rest).total
    steps = walk_through(chain, [springs, inertia, floor], scheme, np.zeros(5), 2.0, dt, 1e-9)
    assert min(s.dissipated for s in steps) > -1e-9 * start
    assert max(s.energy.total for s in steps) <= start * (1.0 + 1e-6)
    assert sum(s.dissipated for s in steps) > 0.0


@pytest.mark.parametrize(("height", "touches"), [(9.0, False), (0.1, True)])
def test_accelerations_of_contact_are_solved_for_where_something_touches(
    height: float, touches: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A chain that swings over a floor, so high that it never gets there, moves as one without a floor."""
    asked, accelerations = list[float](), InverseMass.accelerations

    def counted(mass: InverseMass, t: float, force: np.ndarray) -> np.ndarray:
        asked.append(t)
        return accelerations(mass, t, force)

    monkeypatch.setattr(InverseMass, "accelerations", counted)
    ends = []
    for floor in (True, False):
        chain = Chain(height + np.arange(4.0))
        parts: list[Part] = [Springs(chain, 1.0, 20.0), Inertia(chain, 1.0)]
        parts += [Floor(chain, 1e4)] if floor else []
        walk_through(chain, parts, AVERAGE, np.array([-1.0, 0.3, 0.1, 0.8]), 3.0, 0.03)
        ends.append(chain.z)
    assert (max(asked) > 0.0) == touches
    assert (ends[0] == pytest.approx(ends[1], rel=1e-12)) != touches


class Unsolvable(Springs):
    """A force without any root: Newton can only fail."""

    def residual(self, state: State, forces: Forces) -> None:
        forces.force += 1.0 + self.chain.heights(state) ** 2


def test_failure_names_the_place_and_the_step() -> None:
    chain = Chain(np.zeros(3))
    with pytest.raises(SolveError, match=r"smallest step 0\.0125.*mass \d"):
        walk_through(chain, [Unsolvable(chain, 1.0, 1.0), Inertia(chain, 0.0)], AVERAGE, np.zeros(3), 1.0, 0.1)


def test_a_smooth_start_from_rest_needs_no_cuts(tmp_path: Path) -> None:
    """Without gravity the first steps turn over less than round-off; their balance says nothing."""
    harmonic = {"amplitude": [0.0, 0.0, 0.5], "period": 4.0, "ramp": 1.0}
    stage = {"name": "go", "kind": "dynamic", "duration": 1e-3, "time_step": 1e-4}
    scene = {
        "gravity": 0.0,
        "line_types": {"pipe": {"outer_diameter": 0.2, "mass": 50.0, "EA": 1e8, "EI": 2e4}},
        "riser": {
            "segments": [{"line_type": "pipe", "length": 50.0, "elements": 25}],
            "start": {"position": [0.0, 0.0, 0.0]},
            "end": {"position": [50.0, 0.0, 0.0]},
        },
        "stages": [stage | {"motion": {"end": {"harmonic": harmonic}}}],
    }
    run(scene_from_mapping(scene), tmp_path)
    assert Run(tmp_path).summary["stages"][0]["step_cuts"] == 0
