"""Newton's method for a time step of a riser alone, as one compiled loop over its parts.

The same equations, weights and tests as in `newton`, which solves whatever has more than a riser. `part_kernels` says
what the loop asks of the parts.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.compiled import inlined, njit
from riser_soil.core.held import Held
from riser_soil.riser.configuration import (
    Base,
    Configuration,
    Maps,
    place,
    put_magnitudes,
    put_maps,
    put_turning,
)
from riser_soil.riser.hermite import Size, add_geometric, collect_nodal
from riser_soil.riser.part_kernels import (
    LineForces,
    LineWeights,
    add_energy_of_each,
    add_forces_of_each,
    add_tangent_of_each,
    add_work_of_each,
)
from riser_soil.solve import banded
from riser_soil.solve.round_off import ROUND_OFF, STALLED

CONVERGED, NOT_FINITE, SINGULAR, DIVERGED, TOO_MANY = range(5)
DIVERGES = 1e6  # times the first norm


class TangentRoom(NamedTuple):
    """Room for the tangent: maps; element matrices K (ne, n, n); what is conjugate to the tangents (ne, 2, d), and its
    turning (ne, 2, r, r); the matrix as in `banded`, its pivots and its band. nothing (nn, ndof): zero.
    """

    maps: Maps
    K: Array
    conjugate: Array
    turning: Array
    ab: Array
    pivots: IntArray
    band: Size
    nothing: Array


class HeldRiser(NamedTuple):
    """A riser alone, held for a stage: the numbers of its parts, and of those that turn over energy; room for trial
    states and for the tangent.

    at: configuration evaluated last; first: where a step begins. Arrays (nn, ndof): fixed and free dofs; levers;
    residual [N] of the last trial; sizes of the coordinates, and of the terms [N] that the residual is made of.
    """

    parts: tuple
    turning: tuple
    at: Configuration
    first: Configuration
    forces: LineForces
    room: TangentRoom
    fixed: BoolArray
    free: BoolArray
    levers: Array
    residual: Array
    sizes: Array
    terms: Array


class StepNumbers(NamedTuple):
    """A step to solve; arrays (nn, ndof). u: the first guess, then the solution, and v and a its rates. These follow u
    from v0 and a0 by the shifts, but for what is fixed, whose rates are in v0 and a0. past: see `time_scheme`.
    """

    inertia: float
    force: float
    shift_v: float
    shift_a: float
    u: Array
    v0: Array
    a0: Array
    v: Array
    a: Array
    past: Array


class StopLimits(NamedTuple):
    """When to stop, see `NewtonSettings` and `Newton`."""

    tolerance: float
    floor: float
    reuse: float
    most: int
    least: int
    answers_load: bool


@inlined
def _evaluate(riser: HeldRiser, base: Base, step: StepNumbers) -> None:
    """Forces and residual of the trial increments."""
    _follow(step.u, step.v0, step.shift_v, riser.fixed, step.v)
    _follow(step.u, step.a0, step.shift_a, riser.fixed, step.a)
    put_forces(riser, base, step.u, step.v, step.a)
    weights = LineWeights(step.inertia, step.force)
    _combine(riser.forces.inertia, riser.forces.force, riser.forces.end, step.past, weights, riser.residual)


@njit
def _follow(u: Array, first: Array, shift: float, fixed: BoolArray, out: Array) -> None:
    """Write rates that follow the increments by a shift, but for those of fixed dofs."""
    for n in range(u.shape[0]):
        for i in range(u.shape[1]):
            out[n, i] = first[n, i] + (0.0 if fixed[n, i] else shift * u[n, i])


@njit
def _combine(inertia: Array, force: Array, end: Array, past: Array, weights: LineWeights, residual: Array) -> None:
    """Write the residual of the weighted groups."""
    for n in range(residual.shape[0]):
        for i in range(residual.shape[1]):
            bulk = weights.inertia * inertia[n, i] + weights.force * force[n, i]
            residual[n, i] = bulk + end[n, i] + past[n, i]


@inlined
def put_forces(riser: HeldRiser, base: Base, u: Array, v: Array, a: Array) -> None:
    """Write the line's configuration and forces after increments u, with rates v and a (nn, ndof)."""
    at, forces = riser.at, riser.forces
    place(at, base, u, v, a)
    _clear(forces)
    add_forces_of_each(riser.parts, at, forces)
    collect_nodal(forces.inertia_q, at.P, forces.inertia, at.D, at.R)
    collect_nodal(forces.force_q, at.P, forces.force, at.D, at.R)
    collect_nodal(forces.end_q, at.P, forces.end, at.D, at.R)


@njit
def _clear(forces: LineForces) -> None:
    for conjugate in (forces.inertia_q, forces.force_q, forces.end_q):
        conjugate[:] = 0.0
    for nodal in (forces.inertia, forces.force, forces.end):
        nodal[:] = 0.0


@inlined
def put_tangent(riser: HeldRiser, step: StepNumbers) -> None:
    """The tangent at the configuration that was evaluated last, into the banded matrix."""
    at, forces, room = riser.at, riser.forces, riser.room
    K = room.K
    weights = LineWeights(step.inertia, step.force)
    maps = Maps(room.maps.rate, room.maps.acceleration, step.shift_v, step.shift_a)
    K[:] = 0.0
    put_maps(at, maps)
    add_tangent_of_each(riser.parts, at, maps, weights, K)
    _weigh(forces, weights, room.conjugate)
    put_turning(at, room.conjugate, room.turning)
    add_geometric(K, 1.0, room.turning, len(at.D))
    _fill(K, riser.fixed, room.ab)


@njit
def _weigh(forces: LineForces, weights: LineWeights, conjugate: Array) -> None:
    """Write what is conjugate to the tangents of the elements' ends (ne, 2, d), groups weighted."""
    for e in range(conjugate.shape[0]):
        for side in range(2):
            k = 2 * side + 1
            for i in range(conjugate.shape[2]):
                bulk = weights.inertia * forces.inertia_q[e, k, i] + weights.force * forces.force_q[e, k, i]
                conjugate[e, side, i] = bulk + forces.end_q[e, k, i]


@njit
def _fill(K: Array, fixed: BoolArray, ab: Array) -> None:
    """Sum element matrices into a banded one, with ones on the diagonal for what is fixed."""
    ndof = fixed.shape[1]
    b = 2 * ndof - 1
    ab[:] = 0.0
    for e in range(K.shape[0]):
        for i in range(2 * ndof):
            row = ab[e * ndof + i, b - i : b - i + 2 * ndof]
            for j in range(2 * ndof):
                row[j] += K[e, i, j]
    for k, held in enumerate(fixed.ravel()):
        if held:
            ab[k] = 0.0
            for i in range(max(0, k - b), min(fixed.size, k + b + 1)):
                ab[i, k - i + b] = 0.0
            ab[k, b] = 1.0


@njit
def _norm(values: Array, counted: BoolArray, levers: Array) -> float:
    """Norm [N] of those of the forces (nn, ndof) that are counted, moments over the lever."""
    square = 0.0
    for n in range(values.shape[0]):
        for i in range(values.shape[1]):
            if counted[n, i]:
                square += (values[n, i] / levers[n, i]) ** 2
    return math.sqrt(square)


@njit
def _scale(inertia: Array, force: Array, end: Array, fixed: BoolArray, levers: Array) -> float:
    """Norm of the forces in play: reactions, inertia, contact."""
    reactions, moving, contact = 0.0, 0.0, 0.0
    for n in range(fixed.shape[0]):
        for i in range(fixed.shape[1]):
            lever = levers[n, i]
            moving += (inertia[n, i] / lever) ** 2
            contact += (end[n, i] / lever) ** 2
            if fixed[n, i]:
                reactions += ((inertia[n, i] + force[n, i] + end[n, i]) / lever) ** 2
    return math.sqrt(max(reactions, moving, contact))


@njit
def _stays(norms: Array, taken: int) -> bool:
    """See `round_off.stays`."""
    if taken < 2:
        return False
    return norms[taken] > STALLED * norms[taken - 1] and norms[taken - 1] > STALLED * norms[taken - 2]


@inlined
def _at_round_off(riser: HeldRiser, step: StepNumbers) -> bool:
    """Whether nothing in the residual can be told from its round-off, see `round_off`. Leaves another matrix behind."""
    held_rates = StepNumbers(
        step.inertia, step.force, 0.0, 0.0, step.u, step.v0, step.a0, step.v, step.a, step.past
    )
    put_tangent(riser, held_rates)
    put_magnitudes(riser.at, riser.sizes)
    _sum_terms(riser.room.K, riser.sizes, riser.terms)
    return not _exceeds(riser.residual, riser.terms, riser.free)


@njit
def _sum_terms(K: Array, sizes: Array, terms: Array) -> None:
    """Write the sums of |K| times sizes of the coordinates, both (nn, ndof), over the elements."""
    ndof = sizes.shape[1]
    terms[:] = 0.0
    for e in range(K.shape[0]):
        for i in range(2 * ndof):
            for j in range(2 * ndof):
                terms[e + i // ndof, i % ndof] += abs(K[e, i, j]) * sizes[e + j // ndof, j % ndof]


@njit
def _exceeds(residual: Array, terms: Array, free: BoolArray) -> bool:
    """Whether the residual of any free dof is more than the round-off of its terms."""
    for n in range(free.shape[0]):
        for i in range(free.shape[1]):
            if free[n, i] and abs(residual[n, i]) > ROUND_OFF * terms[n, i]:
                return True
    return False


@njit
def solve_step(held: Held, base: Base, step: StepNumbers, limits: StopLimits, norms: Array) -> tuple[int, int]:
    """Solve a step: outcome and number of iterations; norms (most + 1,): of the residuals [N]."""
    riser: HeldRiser = held.value
    forces = riser.forces
    taken, first, ndof = 0, 0.0, step.u.shape[1]
    while True:
        _evaluate(riser, base, step)
        norm = _norm(riser.residual, riser.free, riser.levers)
        norms[taken] = norm
        if taken == 0:
            first = norm
        if not math.isfinite(norm):
            return NOT_FINITE, taken
        if taken >= limits.least:
            scale = _scale(forces.inertia, forces.force, forces.end, riser.fixed, riser.levers)
            if norm <= limits.tolerance * scale:
                return CONVERGED, taken
            if norm <= limits.floor and (taken > 0 or limits.answers_load):
                return CONVERGED, taken
            if _stays(norms, taken) and _at_round_off(riser, step):
                return CONVERGED, taken
            if taken >= 4 and norm > DIVERGES * first:
                return DIVERGED, taken
        if taken >= limits.most:
            return TOO_MANY, taken
        if taken == 0 or not norm < limits.reuse * norms[taken - 1]:
            put_tangent(riser, step)
            if not banded.factorise(riser.room.ab, riser.room.pivots, riser.room.band):
                return SINGULAR, taken
        for n in range(riser.fixed.shape[0]):
            for i in range(ndof):
                if riser.fixed[n, i]:
                    riser.residual[n, i] = 0.0
        change = riser.residual.reshape(riser.residual.size)
        banded.solve(riser.room.ab, riser.room.pivots, change, riser.room.band)
        for n in range(riser.fixed.shape[0]):
            for i in range(ndof):
                if not riser.fixed[n, i]:
                    step.u[n, i] -= riser.residual[n, i]
        taken += 1


@njit
def account(held: Held, base: Base, v: Array, a: Array, energy: Array, work: Array) -> None:
    """Write the energy (3,) of the configuration evaluated last, and the work (parts, 4) of those that turn over some.

    v, a (nn, ndof): rates and accelerations where the step begins.
    """
    riser: HeldRiser = held.value
    place(riser.first, base, riser.room.nothing, v, a)
    energy[:] = 0.0
    work[:] = 0.0
    add_energy_of_each(riser.parts, riser.at, energy)
    add_work_of_each(riser.turning, riser.first, riser.at, work)
