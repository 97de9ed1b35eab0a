"""Dynamic relaxation: pseudo-time steps with artificial drag, until there is equilibrium without it.

Used when Newton's method finds no equilibrium from the shape that a static stage starts with, and reported when used.
The pseudo-time path has no physical meaning: the history of the ground is updated at its end only.
An unstable equilibrium that it reaches is left in the buckling mode: the first displacement is small, and the drag is
such that the mode grows by a constant factor in each step, until the tangent is stable without drag.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.communicator import Communicator, destroyed_together
from riser_soil.core.part import Energy, Forces, MatrixBlock, Model, State, Traits, Weights, Work
from riser_soil.core.roles import with_role
from riser_soil.core.saved_state import Stateful
from riser_soil.core.system import System, Timer
from riser_soil.errors import SolveError
from riser_soil.riser.line import Line
from riser_soil.solve.buckling_mode import buckling_mode, stabilising_drag
from riser_soil.solve.newton import Newton
from riser_soil.solve.newton_settings import NewtonSettings
from riser_soil.solve.step import NotConvergedError, Solution, Step, UnstableError

if TYPE_CHECKING:
    from riser_soil.bodies.body import MovingBody

FREE_FALL = 0.1  # the first step lets the riser fall by about this many element lengths
STIFFEST = 1e8  # drag over the first
MOST_STEPS = 2000
NUDGE = 1e-4  # element lengths: the first move away from an unstable equilibrium
NEAR = 1.0  # element lengths to an unstable equilibrium that is left
MOST_ATTEMPTS = 50  # at an equilibrium without drag
QUICK = 6  # Newton iterations up to which the drag is lowered
NEARLY_THERE = 1e-2  # largest increment, in element lengths, from which equilibrium without drag is tried


class Relaxation:
    """Part "relaxation": viscous drag on a pseudo-time step, `drag` times tributary length times translation.

    Rotation meets the drag of a rod of the tributary length that turns about its middle; that of a body, of its lever.

    drag: N/m2, force per length and displacement in one step; large values allow small steps only. It may be changed
    between steps. The forces vanish with the increment, so that what it converges to is an equilibrium without it.
    lengths: of line [m] in whose place a body stands. places (nn,): by line 1 at nodes that are dragged, else 0; all of
    them at first.
    """

    name, traits = "relaxation", Traits("F", symmetric=True)

    def __init__(self, lines: Sequence[Line], drag: float, lengths: Mapping[MovingBody, float] | None = None) -> None:
        self.lines, self.drag, self._lengths = lines, drag, lengths or {}
        self.fields: list[Line | MovingBody] = [*lines, *self._lengths]
        self.places: dict[str, Array] = {line.name: np.ones(line.nodes) for line in lines}
        self.active = all(field.active for field in self.fields)

    @property
    def shortest(self) -> float:
        """The shortest of all elements [m]."""
        return min(float(line.length.min()) for line in self.lines)

    def blocks(self) -> dict[str, MatrixBlock]:
        of_lines = {line.name: line.element_block() for line in self.lines}
        return of_lines | {body.name: body.element_block() for body in self._lengths}

    def residual(self, state: State, forces: Forces) -> None:
        for field in self.fields:
            field.nodal(forces.force)[...] += self.drag * self._shares(field) * field.nodal(state.u)

    def _shares(self, field: Line | MovingBody) -> Array:
        """Shares of the drag, by node or element and dof of a node [m, m3]."""
        if not isinstance(field, Line):
            turns = np.arange(field.ndof) >= field.dimension
            return np.asarray(self._lengths[field] * np.where(turns, field.lever**2, 1.0)[None])
        length = field.tributary_length
        shares = np.repeat((self.places[field.name] * length)[:, None], field.ndof, axis=1)
        shares[:, field.dimension :] *= length[:, None] ** 2 / 12.0
        return shares

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        for line in self.lines:
            for end, nodes in ((0, slice(None, -1)), (line.ndof, slice(1, None))):
                dofs = np.arange(end, end + line.ndof)
                share = (0.5 * line.length / line.tributary_length[nodes])[:, None]
                whole = self.drag * self._shares(line)[nodes]
                values[line.name][:, dofs, dofs] += weights.force * share * whole
        for body in self._lengths:
            values[body.name][0] += weights.force * self.drag * np.diag(self._shares(body)[0])

    def energy(self, state: State) -> Energy:
        return Energy()

    def work(self, before: State, after: State) -> Work:
        return Work()

    def commit(self, state: State) -> None:
        """Drag has no history."""


@dataclass
class RelaxationResult:
    """Result of dynamic relaxation or settling: Newton iterations, unstable equilibria left on the way, and how far the
    riser sank into clay [m] in steps of the soil.
    """

    iterations: int = 0
    branch_switches: int = 0
    sunk: float = 0.0


def relax(
    comm: Communicator, model: Model, weight: float, settings: NewtonSettings, clock: Timer, t: float,
    loads: Mapping[MovingBody, float] | None = None,
) -> RelaxationResult:
    """Bring lines and bodies to a stable equilibrium at the load factor t and commit it.

    weight: typical force per length of the lines [N/m]; loads: typical force on each body [N]. Raises SolveError when
    no equilibrium is found.
    """
    lines = [field for field in model.lines if isinstance(field, Line)]
    part = Relaxation(lines, 1.0, {body: load / weight for body, load in (loads or {}).items()})
    part.drag = weight / (FREE_FALL * part.shortest)
    system = System(comm, replace(model, parts=[*model.parts, part]), clock)
    newton = Newton(system, replace(settings, least_iterations=1))  # a slow move's forces may pass for balance
    with destroyed_together(comm, newton.destroy, system.destroy):
        return _descend(system, newton, part, t)


@dataclass
class EquilibriumAttempts:
    """Attempts at an equilibrium without drag. After n failures for want of stability the next comes n steps later, and
    after an unstable equilibrium was left not before the tangent is stable.

    unstable: places (nn, 3) [m] of all nodes in the unstable equilibrium that is being left.
    """

    failures: int = 0
    wait: int = 0
    unstable: Array | None = None

    @property
    def leaving(self) -> bool:
        return self.unstable is not None

    def due(self) -> bool:
        self.wait -= 1
        return self.wait <= 0

    def count(self, failure: NotConvergedError) -> None:
        self.failures += 1
        self.wait = self.failures if isinstance(failure, UnstableError) else 0
        if self.failures == MOST_ATTEMPTS:
            raise SolveError(f"dynamic relaxation ends in no stable equilibrium: {failure}") from failure


def _descend(system: System, newton: Newton, part: Relaxation, t: float) -> RelaxationResult:
    stiffest, result, moved, attempts = part.drag * STIFFEST, RelaxationResult(), np.inf, EquilibriumAttempts()
    for _ in range(MOST_STEPS):
        slow = moved < NEARLY_THERE * part.shortest
        if slow and attempts.due() and not _still_leaving(newton, part, t, attempts):
            equilibrium = _without_drag(system, newton, part, t, attempts)
            result.branch_switches += attempts.leaving
            if equilibrium is not None:
                result.iterations += equilibrium.iterations
                return result
        if attempts.leaving:
            _stabilise(newton, part, t)
        try:
            solution = _step(system, newton, part, t, part.drag)
        except NotConvergedError as failure:
            part.drag *= 8.0
            if part.drag > stiffest:
                raise SolveError(f"dynamic relaxation fails even in tiny pseudo-time steps: {failure}") from failure
            continue
        result.iterations += solution.iterations
        moved = _largest_increment(part, solution)
        part.drag *= 0.4 if solution.iterations <= QUICK else 1.0
    raise SolveError(f"dynamic relaxation finds no equilibrium in {MOST_STEPS} pseudo-time steps")


def _without_drag(
    system: System, newton: Newton, part: Relaxation, t: float, attempts: EquilibriumAttempts
) -> Solution | None:
    """An equilibrium where there is a stable one; one that is not is left where it is near."""
    try:
        return _step(system, newton, part, t, drag=0.0)
    except NotConvergedError as failure:
        attempts.count(failure)
        if isinstance(failure, UnstableError) and _is_near(part, failure.solution):
            attempts.unstable, attempts.wait = _leave(system, newton, part, failure.solution), 0
    return None


def _still_leaving(newton: Newton, part: Relaxation, t: float, attempts: EquilibriumAttempts) -> bool:
    """Whether the tangent is unstable where the riser is since it left an unstable equilibrium. Near that one, to which
    an attempt would return, it counts as unstable where round-off may make it stable.
    """
    if attempts.unstable is not None:
        near = float(np.abs(_places(part) - attempts.unstable).max()) < NEAR * part.shortest
        if _stable(newton, part, t, 0.0, surely=near):
            attempts.unstable = None
    return attempts.leaving


def _stable(newton: Newton, part: Relaxation, t: float, drag: float, surely: bool = False) -> bool:
    """Whether the tangent at the accepted state is stable with a drag; surely: round-off doesn't make it so."""
    usual, part.drag = part.drag, drag
    try:
        return newton.unstable_modes(at_rest(newton.system, t), doubtful=surely) == 0
    finally:
        part.drag = usual


def _stabilise(newton: Newton, part: Relaxation, t: float, least: bool = False) -> None:
    """Raise the drag, if need be, to where a step surely grows in the mode and does not turn to its other side.

    least: lower it, too, to the least such drag.
    """
    if least or not _stable(newton, part, t, part.drag, surely=True):
        part.drag = stabilising_drag(part.drag, lambda drag: _stable(newton, part, t, drag, surely=True))


def at_rest(system: System, t: float) -> State:
    """The accepted state at a load factor."""
    return State.at_rest(t, system.numbering.size)


def _step(system: System, newton: Newton, part: Relaxation, t: float, drag: float) -> Solution:
    """A pseudo-time step with the given drag to a stable equilibrium, committed; with drag, histories don't change."""
    solution = step_against(system, newton, part, t, drag)
    if drag > 0.0:
        _pass_through(system, solution.state)
    else:
        system.commit(solution.state)
    return solution


def step_against(system: System, newton: Newton, part: Relaxation, t: float, drag: float) -> Solution:
    """A pseudo-time step with the given drag from the accepted state.

    It must end in an equilibrium that is stable, with the drag where there is one: a longer step would not follow a
    riser that falls away from an unstable one, but return to it.
    """
    usual, part.drag = part.drag, drag
    step = Step.static(at_rest(system, t))
    try:
        solution = newton.solve(step)
        newton.require_stable(solution)
    finally:
        part.drag = usual
    return solution


def _pass_through(system: System, state: State) -> None:
    """Commit a state that is none of the stage's, so that its forces leave no trace."""
    keeping = [part for part in with_role(system.model.parts, Stateful) if part.traits.path_dependent]
    states = [part.state() for part in keeping]
    system.commit(state)
    for part, saved in zip(keeping, states, strict=True):
        part.restore(saved)


def _is_near(part: Relaxation, solution: Solution) -> bool:
    return _largest_increment(part, solution) < NEAR * part.shortest


def _places(part: Relaxation) -> Array:
    """Places of all nodes (nn, d) [m]."""
    return np.concatenate([field.x for field in part.fields])


def _leave(system: System, newton: Newton, part: Relaxation, unstable: Solution) -> Array:
    """Commit an unstable equilibrium, and a small move from there in the mode in which it is left fastest; the nodes'
    places in that equilibrium.
    """
    _pass_through(system, unstable.state)
    t, places = unstable.state.t, _places(part)
    _stabilise(newton, part, t, least=True)
    mode = buckling_mode(system, part, part.fields, at_rest(system, t), Weights.of_statics())
    moved = at_rest(system, t)
    moved.u[:] = NUDGE * part.shortest * mode
    _pass_through(system, moved)
    return places


def _largest_increment(part: Relaxation, solution: Solution) -> float:
    """Longest translation [m] of the step, the same on all ranks, as every rank holds the lines."""
    return max(float(np.abs(solution.state.u[field.translation_dofs]).max()) for field in part.fields)
