"""Newton's method for one step, by PETSc's SNES."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, field

import numpy as np
from mpi4py import MPI
from petsc4py import PETSc

from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, State, local
from riser_soil.core.system import System
from riser_soil.solve.line_search import step_length
from riser_soil.solve.linear_solver import PREFIX, complaint, defaults, factorise_directly
from riser_soil.solve.stability import prescribe_free_turns, unstable_modes
from riser_soil.solve.time_scheme import Scheme, Static

CONVERGED = PETSc.SNES.ConvergedReason.CONVERGED_FNORM_RELATIVE
DIVERGED = PETSc.SNES.ConvergedReason.DIVERGED_DTOL
NOT_SOLVED = PETSc.SNES.ConvergedReason.DIVERGED_LINEAR_SOLVE
ITERATING = PETSc.SNES.ConvergedReason.ITERATING
REUSE = 0.1
STATIC = Static().weights(0.0)


class NotConvergedError(Exception):
    """A step that Newton could not solve; its text says why and where the residual sits."""


class UnstableError(NotConvergedError):
    """An unstable equilibrium, from which the riser would buckle or swing away: `solution`."""

    def __init__(self, text: str, solution: Solution) -> None:
        super().__init__(text)
        self.solution = solution


@dataclass(frozen=True)
class NewtonSettings:
    """tolerance: of the residual's norm, relative to the norm of the forces in play, moments over the
    system's lever.

    floor [N]: the norm that counts as zero, for round-off of a scene whose forces all vanish.
    reuse: an iteration that leaves less than this share of the residual leaves its factorised tangent to the next of
    the same step (Shamanskii's method), as long as each leaves less than this share: two or three such iterations cost
    less than one with its own tangent. Only in time steps without contact, which start near their end: contact has
    corners, and an equilibrium may be far away. least_iterations: before a residual counts as small.
    line_search: shorten steps that lead far beyond the least energy, see `line_search`.
    """

    tolerance: float
    max_iterations: int
    floor: float
    reuse: float = REUSE
    least_iterations: int = 0
    line_search: bool = False


@dataclass(frozen=True, eq=False)
class Step:
    """One step to solve: from the accepted state `before` to time t."""

    scheme: Scheme
    before: State
    t: float
    dt: float
    start: Forces | None
    guess: Array


@dataclass(frozen=True, eq=False)
class Solution:
    """A converged step: the state at its end, the forces in balance by group, the residual norms [N]."""

    state: State
    forces: Forces
    norms: list[float] = field(default_factory=list)

    @property
    def iterations(self) -> int:
        return len(self.norms) - 1


class Newton:
    """Solver of a system's steps. Create once a stage; the symbolic factorisation is reused throughout.

    iterations: of all its steps, those that failed included.
    """

    def __init__(self, system: System, settings: NewtonSettings) -> None:
        self.system, self.settings = system, settings
        self.iterations = 0
        self._x = system.numbering.vector.duplicate()
        self._f = system.numbering.vector.duplicate()
        self._levers = system.numbering.vector.duplicate()
        system.numbering.to_global(system.levers, self._levers)
        self._snes = self._create()

    def _create(self) -> PETSc.SNES:
        snes = PETSc.SNES().create(self.system.comm)
        snes.setType(PETSc.SNES.Type.NEWTONLS)
        snes.setFunction(self._function, self._f)
        snes.setJacobian(self._jacobian, self.system.matrix.mat)
        snes.setConvergenceTest(self._test)
        snes.setTolerances(max_it=self.settings.max_iterations)
        if self.settings.line_search:
            snes.setLineSearchPreCheck(self._shorten)
        snes.getKSP().setType(PETSc.KSP.Type.PREONLY)
        factorise_directly(snes.getKSP().getPC(), self.system)
        snes.setOptionsPrefix(PREFIX)
        with defaults({"snes_linesearch_type": "basic"}):
            snes.setFromOptions()
        return snes

    def solve(self, step: Step) -> Solution:
        """Solve a step or raise NotConvergedError; collective."""
        self._begin(step)
        if failure := self._run():
            raise NotConvergedError(failure)
        state = self._trial(self._x)
        self.require_admissible(state)
        return Solution(state, self._forces, self._norms)

    def _run(self) -> str:
        """Iterate; "" where that converges, else why not. No factors outlive a failed factorisation: MUMPS would refuse
        all that comes after it.
        """
        began, counted, complained = time.perf_counter(), self.system.clock.total, ""
        try:
            self._snes.solve(None, self._x)
        except PETSc.Error as err:
            complained = complaint(err)
            if not complained:
                raise
        self.iterations += self._taken
        self.system.clock.add("linear_solve", began + self.system.clock.total - counted)
        reason = self._snes.getConvergedReason()
        failure = self._reason(complained) if complained or reason <= 0 else ""
        if complained or reason == NOT_SOLVED:
            self._snes.destroy()
            self._snes = self._create()
        return failure

    @property
    def _taken(self) -> int:
        """Iterations of the step so far; a residual that is not finite at its start is none."""
        return max(len(self._norms) - 1, 0)

    def require_admissible(self, state: State) -> None:
        """Raise NotConvergedError where a state in balance is none of the line."""
        for line in self.system.model.lines:
            if reason := line.inadmissible(state):
                raise NotConvergedError(reason)

    def require_stable(self, solution: Solution) -> None:
        """Raise UnstableError where a static solution is an unstable equilibrium, such as an unbuckled strut.

        Stable means that the tangent there has no negative pivot, see `stability`. Parts that follow the line are left
        out of it; where others lack symmetry too, such as moments in space, nothing is judged. Collective.
        """
        negative = self.unstable_modes(solution.state, solution.forces)
        if negative > 0:
            raise UnstableError(
                f"the equilibrium found is unstable (its tangent has {negative} negative pivot(s)): the riser would "
                "buckle or swing away from it; start from a shape nearer to the one that it takes",
                solution,
            )

    def unstable_modes(self, state: State, forces: Forces | None = None, doubtful: bool = False) -> int:
        """Negative pivots at a static state; its forces may be known. doubtful: with those that may be. Collective."""
        found = self.system.forces(state) if forces is None else forces
        return unstable_modes(self.system, state, STATIC, self._scale(found), doubtful)

    def renew(self) -> None:
        """Take over a new matrix after the system's pattern has changed."""
        self._snes.destroy()
        self.system.renew_pattern()
        self._snes = self._create()

    def _begin(self, step: Step) -> None:
        self._step, self._norms = step, list[float]()
        self._weights, self._past = step.scheme.weights(step.dt), step.scheme.past(step.start)
        self._still = step.scheme.trial(step.before, step.t, step.dt, np.zeros_like(step.guess))
        prescribed = State(step.t, *(x.copy() for x in (step.guess, self._still.v, self._still.a)))
        self.system.prescribe(prescribed)
        self._prescribed = [x[self.system.prescribed_dofs] for x in (prescribed.u, prescribed.v, prescribed.a)]
        self._state: State | None = None
        self.system.numbering.to_global(step.guess, self._x)

    def _trial(self, x: PETSc.Vec) -> State:
        """State of the unknowns x; the same object while x stays the same, so that parts need not look twice."""
        u = np.zeros(self.system.numbering.size)
        self.system.numbering.to_local(x, u)
        u[self.system.prescribed_dofs] = self._prescribed[0]
        if self._state is None or (u != self._state.u).any():
            self._state = self._follow(u)
            self._balanced = self._step.scheme.balanced_at(self._step.before, self._state, self._step.dt)
        return self._state

    def _follow(self, u: Array) -> State:
        """State of the increments u: rates follow them by the scheme's shifts, but for the prescribed ones."""
        v = self._still.v + self._weights.shift_v * u
        a = self._still.a + self._weights.shift_a * u
        v[self.system.prescribed_dofs], a[self.system.prescribed_dofs] = self._prescribed[1:]
        return State(self._step.t, u, v, a)

    def _function(self, snes: PETSc.SNES, x: PETSc.Vec, f: PETSc.Vec) -> None:
        self._trial(x)
        self._forces = self.system.forces(self._balanced)
        residual = self._step.scheme.combine(self._forces, self._past)
        self.system.numbering.add_to_global(residual, f)

    def _shorten(self, x: PETSc.Vec, y: PETSc.Vec) -> bool:
        """Scale the step -y from x to the length that the line search finds; whether that changed it."""
        tried, found = x.duplicate(), x.duplicate()

        def slope(part: float) -> float:
            x.copy(tried)
            tried.axpy(-part, y)
            self._function(self._snes, tried, found)
            return -float(found.dot(y))

        part = step_length(-float(self._f.dot(y)), slope)
        y.scale(part)
        for vector in (tried, found):
            vector.destroy()
        return part != 1.0

    def _jacobian(self, snes: PETSc.SNES, x: PETSc.Vec, jacobian: PETSc.Mat, p: PETSc.Mat) -> None:
        """A matrix left as it is keeps its factors."""
        if not self._reusable():
            self._trial(x)
            self.system.assemble(self._balanced, self._weights)
            if self._weights.inertia == 0.0:
                prescribe_free_turns(self.system, self._balanced, self.settings.tolerance * self._scale(self._forces))

    def _reusable(self) -> bool:
        """Whether the tangent of the previous iteration can be reused."""
        if not self._starts_near or len(self._norms) < 2:
            return False
        return self._norms[-1] < self.settings.reuse * self._norms[-2]

    @property
    def _least_iterations(self) -> int:
        """A motion that continues by its first guess alone would keep its errors."""
        return max(self.settings.least_iterations, int(self._starts_near))

    @property
    def _starts_near(self) -> bool:
        """Whether the guess continues a smooth motion: time steps without contact."""
        return self.system.smooth and self._weights.inertia > 0.0

    def _test(self, snes: PETSc.SNES, iteration: int, norms: tuple[float, float, float]) -> int:
        norm = math.sqrt(self.system.sum([float(np.sum(self._weighed() ** 2))])[0])
        self._norms.append(norm)
        if not np.isfinite(norm):
            return PETSc.SNES.ConvergedReason.DIVERGED_FNORM_NAN
        if iteration < self._least_iterations:
            return ITERATING
        if norm <= max(self.settings.tolerance * self._scale(self._forces), self.settings.floor):
            return CONVERGED
        if iteration >= 4 and norm > 1e6 * self._norms[0]:
            return DIVERGED
        return ITERATING

    def _scale(self, forces: Forces) -> float:
        """Norm of the forces in play: reactions, inertia, contact on the lines."""
        system = self.system
        reactions = system.reactions(forces) / system.levers[system.prescribed_dofs]
        inertia = forces.inertia / system.levers
        contact = np.concatenate([(forces.end / system.levers)[local(line)] for line in system.model.lines])
        mine = [float(f @ f) for f in (reactions, inertia, contact)]
        return math.sqrt(max(system.sum(mine)))

    def _reason(self, complained: str) -> str:
        norms = ", ".join(f"{n:.3g}" for n in self._norms[-3:])
        return (
            f"{complained or self._reason_name()} after {self._taken} iterations (last residual norms {norms} N); "
            f"{self._where()}"
        )

    def _reason_name(self) -> str:
        reason = self._snes.getConvergedReason()
        names = (n for n, v in vars(PETSc.SNES.ConvergedReason).items() if v == reason and n.startswith("DIV"))
        return next(names, str(reason)).lower()

    def _weighed(self) -> Array:
        """This rank's residual [N], moments over the lever."""
        return np.asarray(self._f.array_r / self._levers.array_r)

    def _where(self) -> str:
        """The row with the largest residual, in words."""
        values = np.abs(self._weighed())
        if not self.system.comm.allreduce(bool(np.isfinite(values).all()), MPI.LAND):
            return "the residual is not finite"
        first = self._f.getOwnershipRange()[0]
        k = int(np.argmax(values)) if len(values) else -1
        mine = (float(values[k]), first + k) if k >= 0 else (-1.0, -1)
        worst, row = max(self.system.comm.allgather(mine))
        return f"the largest residual, {worst:.3g} N, sits at the {self.system.describe(row)}"

    def destroy(self) -> None:
        for thing in (self._snes, self._x, self._f, self._levers):
            thing.destroy()
