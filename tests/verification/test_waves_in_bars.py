"""Waves along a bar: it strikes a rigid floor, or is pulled taut; with the speed v and c = sqrt(EA/m).

Until a wave returns from the other end the force is EA v/c = m c v, twice that where the wave meets a fixed end; a bar
that falls on a rigid floor stays there for 2 L/c and leaves with the speed that it came with.
K. F. Graff, Wave motion in elastic solids (1975), chapter 2.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from riser_soil.assembly import Assembly
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.system import Timer
from riser_soil.results.riser_record import riser_record
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import run_stage
from tests.support.driven_stage import Watcher, built
from tests.support.scenes import Mapping, dynamic, prescribed, riser_scene

L, MASS, EA, V = 10.0, 100.0, 1e8, 1.0
C = float(np.sqrt(EA / MASS))
PASS, FORCE = L / C, EA * V / C
RUN_UP = 0.5 * PASS  # s, over which an end takes up the speed v


def scene(steps: int, duration: float, elements: int, rho_inf: float, **more: Any) -> Mapping:
    """A weightless bar; `steps` in the time of a pass L/c; duration: in passes."""
    stage = {"scheme": {"generalized_alpha": {"rho_inf": rho_inf}}} | more.pop("stage", {})
    return riser_scene(
        dynamic(duration * PASS, PASS / steps, **stage),
        pipe={"EA": EA, "EI": 1e3, "mass": MASS},
        length=L,
        elements=elements,
        dimension=2,
        solver={"tolerance": 1e-9},
        **more,
    )


def swung(mapping: Mapping, axis: int, v: Array, look: Callable[[Assembly, TimeStepper], tuple[float, ...]]) -> Array:
    """Time and what `look` sees after each step; v (nn,): the nodes' first speeds along an axis of the plane [m/s]."""
    assembly, rows = built(mapping), list[tuple[float, ...]]()
    rates = np.zeros(assembly.size)
    assembly.riser.line.nodal(rates)[:, axis] = v
    before = State(0.0, np.zeros(assembly.size), rates, np.zeros(assembly.size))

    def watch(stepper: TimeStepper, step: AcceptedStep) -> None:
        rows.append((step.t / PASS, *look(assembly, stepper)))

    run_stage(assembly, assembly.scene.stages[0], before, Watcher(watch), Timer.new())
    return np.array(rows).T


class Strike:
    """A bar that touches the floor with its lower end as it falls: time of contact over 2 L/c, largest force and mean
    force in between over EA v/c, speed of rebound over v, energy over that of the fall.

    The floor's stiffness at the end node is that of an element, which no wave tells from more bar.
    """

    def __init__(self, steps: int, rho_inf: float = 0.8) -> None:
        h = L / steps
        bar = scene(
            steps,
            duration=3.0,
            elements=steps,
            rho_inf=rho_inf,
            start="free",
            end="free",
            riser={"initial": {"points": [[0.0, 0.0, 0.0], [0.0, 0.0, L]]}},
            seabed={"kind": "rigid", "level": 0.0, "contact_at": "axis"},
            contact={"method": "node", "stiffness": 2.0 * EA / h**2, "smoothing": 0.0},
        )

        def look(assembly: Assembly, stepper: TimeStepper) -> tuple[float, ...]:
            line = assembly.riser.line
            up = float(line.nodal(stepper.now.v)[:, 1] @ line.tributary_length) / L
            return assembly.ground_force(stepper.now), up, stepper.energy.total

        t, force, up, energy = swung(bar, 1, np.full(steps + 1, -V), look)
        between = (t > 0.5) & (t < 1.8)
        self.time = float(t[np.flatnonzero(force)[-1]]) / 2.0
        self.peak, self.mean = float(force.max()) / FORCE, float(force[between].mean()) / FORCE
        self.rebound, self.energy = float(up[-1]) / V, float(energy[-1]) / (0.5 * MASS * L * V**2)

    def __str__(self) -> str:
        return (
            f"contact {self.time:.4f} of 2L/c, force {self.mean:.5f} (at most {self.peak:.3f}) of EA v/c, rebound "
            f"{self.rebound:.4f} of v, energy {self.energy:.4f}"
        )


def test_bar_leaves_a_rigid_wall_after_two_passes() -> None:
    """Contact is of first order in the step: when the bar leaves, and the energy of the node that lands."""
    coarse, fine = Strike(20), Strike(40)
    assert abs(coarse.mean - 1.0) < 1e-3
    assert abs(fine.mean - 1.0) < 3e-4
    assert max(coarse.peak, fine.peak) < 1.03
    assert 1.0 <= fine.time < coarse.time < 1.06
    assert 0.96 < coarse.energy < fine.energy < 1.0
    assert 1.0 - fine.energy < 0.55 * (1.0 - coarse.energy)
    assert coarse.rebound < fine.rebound < 1.0


@pytest.mark.verify
@pytest.mark.parametrize("rho_inf", [0.8, 1.0])
def test_bar_against_a_rigid_wall_converges(rho_inf: float) -> None:
    strikes = {steps: Strike(steps, rho_inf) for steps in (20, 40, 80, 160)}
    for steps, strike in strikes.items():
        print(f"rho_inf {rho_inf}, {steps} steps in L/c: {strike}")
    lost = np.array([1.0 - strike.energy for strike in strikes.values()])
    late = np.array([strike.time - 1.0 for strike in strikes.values()])
    behind = np.array([1.0 - strike.rebound for strike in strikes.values()])
    assert np.all(lost[1:] < 0.55 * lost[:-1])
    assert np.log2(late[0] / late[-1]) / 3.0 > 0.7
    assert np.log2(behind[0] / behind[-1]) / 3.0 > 0.6, "dispersion widens a front to steps^(1/3)"
    assert abs(strikes[160].mean - 1.0) < 1e-4


def taut_peak(folder: Path, steps: int, elements: int, rho_inf: float = 0.8) -> float:
    """Largest force at the prescribed start over 2 m c v, as the end of a slack straight line moves off."""
    line = scene(
        steps,
        duration=2.2,
        elements=elements,
        rho_inf=rho_inf,
        start=prescribed(0.0, 0.0, 0.0),
        end=prescribed(L, 0.0, 0.0),
        riser={"initial": "straight"},
        stage={"motion": {"end": {"table": str(_moving_off(folder / "motion.csv"))}}},
    )
    _, force = swung(line, 0, np.zeros(elements + 1), lambda assembly, stepper: (_start_force(assembly, stepper),))
    return float(force.max()) / (2.0 * FORCE)


def _start_force(assembly: Assembly, stepper: TimeStepper) -> float:
    return -float(riser_record(assembly.riser, stepper).start_force[0])


def _moving_off(file: Path) -> Path:
    """The end reaches its speed over the run-up by a smooth step of five powers."""
    t = np.linspace(0.0, 2.5 * PASS, 2001)
    s = np.clip(t / RUN_UP, 0.0, 1.0)
    x = V * RUN_UP * (2.5 * s**4 - 3.0 * s**5 + s**6) + V * np.maximum(t - RUN_UP, 0.0)
    rows = (f"{time:.12g},{way:.15g},0,0" for time, way in zip(t, x, strict=True))
    file.write_text("\n".join(("t [s],x [m],y [m],z [m]", *rows)) + "\n")
    return file


def test_slack_line_pulled_taut_has_the_tension_of_the_wave(tmp_path: Path) -> None:
    """The tension is of second order in the step; the line is slack until its end moves."""
    errors = [taut_peak(tmp_path, steps, elements=40) - 1.0 for steps in (20, 40, 80)]
    assert errors[-1] < 5e-3
    assert np.log2(errors[0] / errors[-1]) / 2.0 > 1.8


@pytest.mark.verify
@pytest.mark.parametrize("rho_inf", [0.8, 1.0])
def test_slack_line_pulled_taut_converges(tmp_path: Path, rho_inf: float) -> None:
    for elements in (20, 40, 80, 160):
        errors = [taut_peak(tmp_path, steps, elements, rho_inf) - 1.0 for steps in (20, 40, 80, 160)]
        print(f"rho_inf {rho_inf}, {elements} elements, 20 to 160 steps in L/c: {np.array(errors)}")
        assert errors[-1] < 1.5e-3


def test_tether_that_snaps_taut_in_no_time_overshoots_by_a_sixth() -> None:
    """A line flies off along its axis until its start is stopped. At a front no mesh resolves a peak stays above m c v,
    however fine the steps; after it the force is m c v.
    """
    peaks = []
    for steps in (20, 40):
        line = scene(steps, 1.8, steps, 0.8, start=prescribed(0.0, 0.0, 0.0), end="free", riser={"initial": "straight"})
        speeds = np.full(steps + 1, V)
        speeds[0] = 0.0
        t, force = swung(line, 0, speeds, lambda assembly, stepper: (_start_force(assembly, stepper),))
        after = (t > 0.3) & (t < 1.7)
        assert abs(force[after].mean() / FORCE - 1.0) < 1e-3
        peaks.append(force.max() / FORCE)
    np.testing.assert_allclose(peaks, 1.155, atol=2e-3)
