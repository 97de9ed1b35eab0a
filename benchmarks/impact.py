"""A pipe falls on a rigid floor, level and tilted: what energy each method makes or takes, and whether it converges.

On the package's own riser, time loop and contact; see docs/impact.md, whose tables this prints.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
from mpi4py import MPI

from benchmarks.impact_methods import Averaged, DiscreteGradient
from riser_soil.assembly import Assembly, build
from riser_soil.assembly.scales import contact_radius
from riser_soil.contact.law import Penalty
from riser_soil.contact.seabed_contact import SeabedContact
from riser_soil.core.part import Model, Part, State
from riser_soil.core.system import System, Timer
from riser_soil.errors import SolveError
from riser_soil.riser.stations import gauss
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.stages import DynamicStage
from riser_soil.seabed.grounds import Plane
from riser_soil.solve.newton import Newton
from riser_soil.solve.newton_settings import NewtonSettings
from riser_soil.solve.step_control import StepControl
from riser_soil.solve.time_scheme import GeneralizedAlpha
from riser_soil.solve.time_stepper import TimeStepper
from tests.support.scenes import DROP, FALLING_LENGTH, FALLING_WEIGHT, Mapping, flat, tilted
from tests.support.stage_histories import Energies

Fall = Callable[[float, float, float], Mapping]
STIFFNESSES = tuple(10.0**p for p in range(4, 10))  # N/m2
TIME_STEPS = (0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002)  # s
DURATION = 1.6  # s; the pipe lands after 0.6 s
PAIR = (1e7, 0.02)
SHORTEST = 1.0 / 16.0  # of a time step
# Of the fall [m], on average, to where the pipe lies.
HEIGHT: dict[Fall, float] = {flat: DROP - 0.15, tilted: 2.0 * DROP - 0.15}
ROUND_OFF = 1e-8
ALL_WELCOME = np.inf  # energy from nowhere is what is measured: no step is refused for it

FULLY_IMPLICIT, AVERAGED, DISCRETE = "at the end of the step", "averaged", "discrete gradient"
SCHEMES = {
    "average acceleration": GeneralizedAlpha.newmark(),
    "HHT-alpha, -0.1": GeneralizedAlpha(0.0, 0.1, 0.25 * 1.1**2, 0.6),
    "generalised-alpha, rho_inf 1": GeneralizedAlpha.from_rho_inf(1.0),
    "generalised-alpha, rho_inf 0.8": GeneralizedAlpha.from_rho_inf(0.8),
    "generalised-alpha, rho_inf 0.5": GeneralizedAlpha.from_rho_inf(0.5),
    "generalised-alpha, rho_inf 0": GeneralizedAlpha.from_rho_inf(0.0),
}
DEFAULT = ("generalised-alpha, rho_inf 0.8", FULLY_IMPLICIT)
METHODS = (
    *product(SCHEMES, (AVERAGED,)),
    *product(SCHEMES, (FULLY_IMPLICIT,)),
    ("average acceleration", DISCRETE),
    ("generalised-alpha, rho_inf 0.8", DISCRETE),
)
Method = tuple[str, str]


@dataclass(frozen=True)
class Outcome:
    """Energies of one run: largest gain and what is left at the end, as shares of what the pipe falls with; steps, and
    those that were cut; finished: whether it got to the end.
    """

    gain: float
    left: float
    steps: int
    cuts: int
    finished: bool


def outcome(method: Method, fall: Fall, k: float, dt: float, duration: float = DURATION) -> Outcome:
    """Run one method at a contact stiffness k [N/m2] and a time step dt [s]."""
    energies, finished = Energies(), True
    try:
        _take(method, fall(k, dt, duration), energies)
    except SolveError:
        finished = False
    with np.errstate(over="ignore", invalid="ignore"):
        share = energies.gain / (HEIGHT[fall] * FALLING_WEIGHT * FALLING_LENGTH) if energies.steps else np.zeros(1)
    return Outcome(max(0.0, float(share.max())), 1.0 + float(share[-1]), energies.steps, energies.cuts, finished)


def _take(method: Method, scene: Mapping, energies: Energies) -> None:
    assembly = build(scene_from_mapping(scene), MPI.COMM_SELF)
    stage = assembly.scene.stages[0]
    assert isinstance(stage, DynamicStage)
    assert isinstance(stage.time_step, float)
    system = System(assembly.comm, _model(assembly, stage, method[1]), Timer.new())
    solver = assembly.scene.solver
    newton = Newton(system, NewtonSettings(solver.tolerance, solver.max_iterations, assembly.scales.force_floor))
    try:
        rest = State.at_rest(0.0, assembly.size)
        stepper = TimeStepper(system, newton, SCHEMES[method[0]], rest, largest_gain=ALL_WELCOME)
        energies.begin_stage(stage, stepper)
        control = StepControl(stage.duration, stage.time_step, SHORTEST * stage.time_step)
        while not control.finished:
            step = stepper.advance(control)
            stepper.commit(step, control)
            energies.record(stepper, step, control.finished)
    finally:
        newton.destroy()
        system.destroy()


def _model(assembly: Assembly, stage: DynamicStage, contact: str) -> Model:
    """The stage's parts, its contact replaced."""
    model = assembly.begin(stage)
    parts = [part for part in model.parts if part is not assembly.riser.seabed]
    return replace(model, parts=[*parts, _contact(assembly, contact)])


def _contact(assembly: Assembly, contact: str) -> Part:
    assert assembly.riser.seabed is not None
    if contact == FULLY_IMPLICIT:
        return assembly.riser.seabed
    if contact == AVERAGED:
        return Averaged(assembly.riser.seabed)
    law = DiscreteGradient(Penalty(assembly.riser.contact_stiffness["seabed"], 1e-3))
    radius = contact_radius(assembly.scene, assembly.riser.elements)
    return SeabedContact(assembly.riser.line, radius, Plane.level(-DROP), law, gauss(5))


def over_all(method: Method, pairs: Iterable[tuple[float, float]]) -> list[Outcome]:
    """Level and tilted falls, at all pairs of stiffness and time step."""
    return [outcome(method, fall, k, dt) for fall, (k, dt) in product((flat, tilted), pairs)]


def full_table(methods: Sequence[Method] = METHODS) -> Iterator[str]:
    """Markdown: over all stiffnesses and time steps."""
    runs = len(STIFFNESSES) * len(TIME_STEPS) * len(HEIGHT)
    yield f"| time scheme | contact | largest gain | left, median | left, most | steps cut | lost, of {runs} |"
    yield "|---|---|---|---|---|---|---|"
    for method in methods:
        outcomes = over_all(method, product(STIFFNESSES, TIME_STEPS))
        ended = [f.left for f in outcomes if f.finished] or [np.nan]
        cuts = sum(f.cuts for f in outcomes) / sum(f.steps for f in outcomes)
        lost = sum(not f.finished for f in outcomes)
        yield _row(method, max(f.gain for f in outcomes), float(np.median(ended)), max(ended), cuts, lost)


def pair_table(methods: Sequence[Method] = METHODS) -> Iterator[str]:
    """Markdown: at one stiffness and time step."""
    yield "| time scheme | contact | gain, level | left, level | gain, tilted | left, tilted |"
    yield "|---|---|---|---|---|---|"
    for method in methods:
        level, slanting = over_all(method, [PAIR])
        yield _row(method, level.gain, level.left, slanting.gain, slanting.left)


def _row(method: Method, *figures: float) -> str:
    return f"| {' | '.join((*method, *map(_figure, figures)))} |"


def _figure(value: float) -> str:
    """Counts as they are, shares in %."""
    if isinstance(value, int):
        return str(value)
    return f"{100.0 * value:.3g} %" if abs(value) > ROUND_OFF else "0 %"


def report() -> None:
    """At one pair, in seconds; the full table takes minutes."""
    _print(pair_table())


def _print(rows: Iterator[str]) -> None:
    for row in rows:
        print(row, flush=True)


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    report()
    _print(full_table())
