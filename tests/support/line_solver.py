"""The line solver of a riser alone beside the methods of its parts, and beside SNES."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI

from benchmarks.stage import TimedStage, last_stage
from riser_soil.contact.contact import ContactResults
from riser_soil.contact.seabed_contact import SeabedContact
from riser_soil.core.arrays import Array
from riser_soil.core.part import Energy, Forces, Model, State
from riser_soil.core.system import System, Timer
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import MASS_ALONE, LineParts, acting_on
from riser_soil.riser.section_forces import (
    SectionForces,
    element_residual,
    nodal_residual,
    viscous_residual,
)
from riser_soil.solve.convergence import CONVERGED, StopLimits
from riser_soil.solve.inverse_mass import mass_of
from riser_soil.solve.line_solver import line_solver
from riser_soil.solve.line_system import LineSystem
from riser_soil.solve.packed_line import PackedLine
from riser_soil.solve.step_results import StepResults
from tests.support import sample_water
from tests.support.dense_chain import tangent
from tests.support.differences import WEIGHTS, error
from tests.support.sample_line import Sample, sample
from tests.support.sections import section_forces

# Parts whose kernels say what they turn over.
TURNING = "end spring", "contents", "morison", "vortices", "buoyancy", "seabed", "friction"
IN_WATER = (
    sample_water.current,
    sample_water.half_out_in_waves,
    sample_water.modules,
    sample_water.modules_half_out_in_waves,
    sample_water.modules_floating,
    sample_water.floating,
    sample_water.floating_in_waves,
)
SECTION_FORCES = (
    *("force", "moment", "about_axes", "effective_tension", "bending_moment", "moment_slope", "curvature"),
    *("curvature_beside", "curvature_slope", "tangent", "position", "end_force", "end_moment"),
    *("least_tension", "largest_moment", "largest_curvature"),
)
SCENES = Path(__file__).parent.parent / "scenes"


def all_parts(at: Sample) -> list[Any]:
    """One of each kind that has kernels."""
    makers: list[Callable[[Sample], Any]] = [Sample.beam, Sample.inertia, Sample.rotary, Sample.damping]
    makers += [Sample.contents, Sample.morison, Sample.turned_spring, Sample.attachments, Sample.forces, Sample.moments]
    return [make(at) for make in makers]


class Compiled:
    """Parts of a line in the loop, evaluated at a state."""

    def __init__(self, at: Sample, parts: list[Any], before: State, state: State) -> None:
        line = at.line
        free = np.zeros(line.size, dtype=bool)
        self.line = PackedLine(LineParts(line, parts), free, np.ones(line.size))
        self.riser = LineSystem([self.line], [])
        for part in parts:
            part.renew_kernel_data(before.t, state.t)
        v, a = state.v - WEIGHTS.shift_v * state.u, state.a - WEIGHTS.shift_a * state.u
        once = StopLimits(0.0, 0.0, 0.0, 1, 0, False)
        self.riser.begin(State(state.t, state.u, v, a), np.zeros(line.size), WEIGHTS, once)
        self.riser.evaluate()
        self.riser.write_tangent()

    def dense(self) -> Array:
        """The matrix (n, n) that was written to the band."""
        workspace = self.line.workspace
        n, b = workspace.pivots.size, len(workspace.band)
        K = np.zeros((n, n))
        for i in range(n):
            for j in range(max(0, i - b), min(n, i + b + 1)):
                K[i, j] = workspace.ab[i, j - i + b]
        return K


PIPE = "line_types.flexible."
IN_SPACE = ("dimension=3", "riser.segments.0.elements=12", PIPE + "GJ=2.0e4", "solver.tolerance=1e-9")
SWAYING = "stages.1.motion.end.harmonic={amplitude: [2.0, 6.0, 1.0], period: 7.0, ramp: 1.0}"
MIDPOINT = "stages.1.scheme={midpoint: {}}"
CASES = {
    "surge in a plane": ("catenary", ("dimension=2", "riser.segments.0.elements=15")),
    "surge in space, damped": ("catenary", (*IN_SPACE, PIPE + "damping={ratio: 0.02, frequency: 1.0}")),
    "sway": ("catenary", (*IN_SPACE, SWAYING)),
    "sway, damped": ("catenary", (*IN_SPACE, SWAYING, PIPE + "damping={ratio: 0.2, frequency: 0.1}")),
    "midpoint rule in a plane": ("catenary", ("dimension=2", "riser.segments.0.elements=15", MIDPOINT)),
    "midpoint rule in space": ("catenary", (*IN_SPACE, SWAYING, MIDPOINT)),
    "hose on a floor": ("tank", ("riser.segments.0.elements=40",)),
    "storm over clay": ("storm", ()),
    "vortices in a storm": ("storm", (PIPE + "vortex_force={}",)),
}


def walked(case: str, newton: str, steps: int, *more: str) -> TimedStage:
    scene, overrides = CASES[case]
    stage = last_stage(SCENES / f"{scene}.yaml", (*overrides, f"solver.newton={newton}", *more), Timer.new())
    stage.walk(steps)
    return stage


def require_kernels_of_parts(dimension: int) -> None:
    """Forces, tangent, energy and work of the loop are those of the methods of one part of each kind."""
    at = sample(dimension)
    require_kernels(at, all_parts(at))


def require_kernels(at: Sample, parts: list[Any]) -> None:
    """Forces, tangent, energy and work of the loop are those of the parts' methods."""
    before, state = at.state(2, t=0.4), at.state(1)
    compiled, expected = Compiled(at, parts, before, state), Forces.zeros(state.u.size)
    for part in parts:
        part.residual(state, expected)
    for group in ("inertia", "force", "end"):
        values = getattr(expected, group)
        forces = getattr(compiled.line.forces, group).ravel()
        assert np.abs(forces - values).max() <= 1e-12 * np.abs(expected.force).max()
    assert error(compiled.dense(), tangent(parts, state, WEIGHTS)) < 1e-12
    np.testing.assert_allclose(compiled.line.dofs.sizes.ravel(), at.line.magnitudes(state), rtol=1e-15)
    begun = State(before.t, 0.0 * before.u, before.v, before.a)
    for part in parts:
        part.renew_kernel_data(begun.t, state.t)
    compiled.riser.account(begun)
    energy, rows = Energy(*compiled.riser.energy), compiled.line.work
    stored: Energy = sum((part.energy(state) for part in parts), Energy())
    for name, expected_energy in vars(stored).items():
        assert getattr(energy, name) == pytest.approx(expected_energy, rel=1e-12)
    for part, row in zip((part for part in parts if part.name in TURNING), rows, strict=True):
        turned = part.work(begun, state)
        np.testing.assert_allclose(row, [*vars(turned).values()], rtol=1e-10)


def require_mass(at: Sample, parts: list[Any]) -> None:
    """Inverse of the mass, kinetic energy and bulk forces at an accepted state are those of the parts one by one."""
    system, accepted = System(MPI.COMM_SELF, Model([at.line], parts), Timer.new()), at.state(3, size=0.0)
    loop = line_solver(system)
    assert loop is not None
    inertial = [part for part in parts if "I" in part.traits.groups]
    mass, force = mass_of(at.line.nodes, at.line.prescribed, system.levers), at.state(4).v
    for _ in range(2):  # the second time projectors are known
        mass.K[...] = 0.0
        for part in inertial:
            part.tangent(State.at_rest(accepted.t, at.line.size), MASS_ALONE, {at.line.name: mass.K})
        accelerations = mass.accelerations(force)
        computed, scale = loop.mass.accelerations(accepted.t, force), np.abs(accelerations).max()
        np.testing.assert_allclose(computed, accelerations, rtol=0.0, atol=1e-10 * scale)
    expected = Forces.zeros(at.line.size)
    for part in parts:
        if "E" not in part.traits.groups:
            part.residual(accepted, expected)
    for name, group in vars(loop.bulk_forces(accepted)).items():
        scale = np.abs(expected.force).max()
        np.testing.assert_allclose(group, getattr(expected, name), rtol=0.0, atol=1e-12 * scale)
    other = at.state(5, size=0.0, t=0.7)
    for instant in (accepted, other, State(other.t, other.u, 2.0 * other.v, other.a)):  # what was placed last, or not
        kinetic = sum(part.energy(instant).kinetic for part in inertial)
        assert loop.mass.kinetic_energy(instant) == pytest.approx(kinetic, rel=1e-12)
    for instant in (accepted, other):
        require_element_residual(loop, at.line, parts, instant)
    system.destroy()


def require_tangles(dimension: int) -> None:
    """Elements that are folded, wound up or swing too far are those that the line tells of; in a plane an angle counts
    whole turns.
    """
    at, anything = sample(dimension, shaken=False), StopLimits(0.0, np.inf, 0.0, 1, 0, True)
    line, parts, messages = at.line, [at.beam()], []
    for node, turn in ((0, 0.0), (1, 0.1), (1, 0.3), (1, 2.0), (line.nodes - 1, 2.0), (line.nodes - 1, -3.5)):
        state = at.state(1, size=0.0)
        line.nodal(state.u)[node, -1] = turn
        compiled = Compiled(at, parts, state, state)
        compiled.riser.begin(state, np.zeros(line.size), WEIGHTS, anything)
        assert compiled.riser.solve() == CONVERGED
        messages.append(line.folding(*compiled.line.folding))
        assert messages[-1] == line.inadmissible(state, at.state(1, size=0.0))
    assert messages[0] == messages[1] == ""
    assert len(set(messages)) == {2: 4, 3: 5}[dimension]


def require_element_residual(results: StepResults, line: Line, parts: list[Any], accepted: State) -> None:
    """Forces within the elements are those of the parts' methods."""
    expected = element_residual(line, parts, accepted)
    residual, scale = results.element_residual(line, accepted), np.abs(expected).max()
    np.testing.assert_allclose(residual, expected, rtol=0.0, atol=1e-12 * scale)


def require_section_forces(compiled: TimedStage, snes: TimedStage) -> None:
    """Section forces at the state solved for last are those by the parts' methods, at that state and by SNES."""
    line, elements, line_results = compiled.assembly.riser.line, compiled.assembly.riser.elements, compiled.newton.lines
    assert line_results is not None
    state, other = compiled.stepper.now, snes.stepper.now
    forces = SectionForces(line, elements, line_results.section_input(line, state))
    parts = acting_on(line, compiled.system.model.parts)
    acting = viscous_residual(line, parts, state), nodal_residual(line, parts, state)
    own = section_forces(line, elements, state, element_residual(line, parts, state), *acting)
    other_line = snes.assembly.riser.line
    by_snes = SectionForces(other_line, elements, snes.newton.accepted.section_input(other_line, other))
    for name in SECTION_FORCES:
        values = np.asarray(getattr(forces, name))
        scale = np.abs(forces.moment if name == "end_moment" else values).max()  # pinned ends have none
        np.testing.assert_allclose(values, getattr(own, name), rtol=0.0, atol=1e-10 * scale, err_msg=name)
        np.testing.assert_allclose(values, getattr(by_snes, name), rtol=0.0, atol=1e-5 * scale, err_msg=name)


def require_contact_results(stage: TimedStage) -> None:
    """Results of contact after a step are those of the contact's methods."""
    for contact in stage.assembly.contacts:
        assert isinstance(contact, SeabedContact)
        sizes = stage.assembly.riser.line.nodes, contact.along.arc.size
        results = ContactResults.within(stage.newton.accepted.contact_results(contact, stage.stepper.now), *sizes)
        expected = ContactResults.within(contact.results(stage.stepper.now), *sizes)
        assert expected.force.any()
        for name, values in expected._asdict().items():
            scale = np.abs(values[np.isfinite(values)]).max()
            np.testing.assert_allclose(getattr(results, name), values, rtol=0.0, atol=1e-9 * scale, err_msg=name)


def require_iterations(compiled: TimedStage, snes: TimedStage) -> None:
    """Newton takes as many iterations as SNES; some more with contact, whose share of the tangent may then be all that
    is found anew.
    """
    if compiled.system.smooth:
        assert compiled.iterations == snes.iterations
    else:
        assert snes.iterations <= compiled.iterations <= 1.25 * snes.iterations


def require_steps_of_snes(case: str) -> None:
    """Iterations, states and energy exchanged of a scene's steps by the loop are those by SNES."""
    compiled, snes = (walked(case, newton, 25) for newton in ("compiled", "snes"))
    assert compiled.newton.lines is not None
    assert snes.newton.lines is None
    require_iterations(compiled, snes)
    place, expected_place = (stage.assembly.riser.line.positions3(stage.stepper.before) for stage in (compiled, snes))
    np.testing.assert_allclose(place, expected_place, rtol=0.0, atol=1e-9)
    computed, expected = compiled.stepper, snes.stepper
    parts = acting_on(compiled.assembly.riser.line, computed.system.model.parts)
    require_element_residual(compiled.newton.accepted, compiled.assembly.riser.line, parts, computed.now)
    require_section_forces(compiled, snes)
    require_contact_results(compiled)
    np.testing.assert_allclose(computed.before.v, expected.before.v, rtol=0.0, atol=1e-7)
    assert computed.energy.total == pytest.approx(expected.energy.total, rel=1e-9)
    assert compiled._taken.turned.keys() == snes._taken.turned.keys()
    for name, work in snes._taken.turned.items():
        mine = [*vars(compiled._taken.turned[name]).values()]
        np.testing.assert_allclose(mine, [*vars(work).values()], rtol=1e-6, atol=1e-6)
    assert compiled._taken.braking == pytest.approx(snes._taken.braking, rel=1e-6)
