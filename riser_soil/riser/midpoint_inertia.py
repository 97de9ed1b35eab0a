"""Momentum-conserving inertia of the midpoint rule: the parts "inertia" and "rotary inertia".

The kinetic energy is 1/2 q' M q' with a constant mass M, q being positions and directors fixed in the sections. From
q'(n+1) = 2 (q(n+1) - q(n))/dt - q'(n) the inertia force of a step is F = M (q'(n+1) - q'(n))/dt. It acts on the means
of q over the step, so that

    sum of mean(q) x F dt  =  change of the angular momentum  sum of q x M q',

exactly, as the elements' own forces have no moment on the line as a whole, in the middle as anywhere. Its work is the
change of the kinetic energy, so that energy errs only by what the strain energy's change differs from the work of the
stresses in the middle, which is of second order and does not pile up.

The rates q'(n+1) of directors are not quite at right angles to them. Each step starts from the angular velocities of
the same momentum, P^T M q'(v) = P^T M q'(n+1) with P = dq/d(dofs): a rigid motion is one of the dofs', so that both
momenta stay, and the part of q' at odds with it takes its energy along, a loss of third order. Steps may then change
in size. Compare Simo, Tarnow & Doblare, Int. J. Numer. Meth. Engng 38 (1995), and Betsch & Steinmann, Int. J. Numer.
Meth. Engng 54 (2002), who keep the rates as they are.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import fixed, njit
from riser_soil.core.part import Part, State, Traits, Weights
from riser_soil.core.roles import MomentumCorrecting
from riser_soil.core.saved_state import Saved, Stateful
from riser_soil.riser import hermite
from riser_soil.riser.configuration import Configuration, Maps
from riser_soil.riser.inertia import (
    Inertia,
    Mass,
    PlanarRotaryMass,
    RotaryInertia,
    SpatialRotaryMass,
    add_forces_at_ends,
    add_kinetic,
    add_tangent_at_ends,
)
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import CompiledPart
from riser_soil.riser.midpoint_directors import (
    DirectorMotion,
    DirectorsInStep,
    write_accelerations,
    write_rates_at_end,
    write_secant,
    write_turning_of,
)
from riser_soil.riser.part_kernels import LineForces, add_energy, add_forces, add_tangent


class MidpointMass(NamedTuple):
    """The mass at an instant, and its tangents in a step. Workspace: their accelerations or rates, and forces on them,
    at_ends (ne, 2, d); q (ne, 4, d) and F (ne, 4, d), conjugate to it; rows (ne, d, n), see `hermite.write_rows`.
    """

    mass: Mass
    tangents: DirectorsInStep
    at_ends: Array
    q: Array
    F: Array
    rows: Array


class MidpointRotaryMass(NamedTuple):
    """The rotary inertia at an instant, and masses (m, ne) [kg m2] on directors in a step. at_ends (ne, 2, d):
    workspace for accelerations or rates of one of these, and forces on it.
    """

    instant: PlanarRotaryMass | SpatialRotaryMass
    masses: Array
    directors: DirectorsInStep
    at_ends: Array


class MidpointPart(CompiledPart):
    """Inertia in steps of the midpoint rule (group I), and between them that of an instant.

    instant: the same at an instant. columns: of the directors that it sits on, see `midpoint_directors`.
    """

    line: Line

    traits = Traits("I", symmetric=False, roles=(MomentumCorrecting, Stateful))

    def __init__(self, instant: Inertia | RotaryInertia, columns: Iterable[int]) -> None:
        super().__init__(instant.line)
        self._motion = DirectorMotion(self.line, columns)

    def begin(self, state: State) -> None:
        """Start from an accepted state."""
        self._motion.begin(state.t, self._turning(state.v))

    def renew_kernel_data(self, start: float, end: float) -> None:
        self._motion.go_to(end)

    def rates(self, state: State) -> list[Array]:
        """Rates of the directors, each (ne, 2, d), at the end of a step by the midpoint rule."""
        return self._motion.rates(state.t, self._turning(state.u))

    def commit(self, state: State) -> None:
        self._motion.commit(state.t, self._turning(state.u))

    def state(self) -> Saved:
        return self._motion.state()

    def restore(self, saved: Saved) -> None:
        self._motion.restore(saved)

    def _turning(self, values: Array) -> Array:
        """Rotation dofs of the nodes (nn, r)."""
        return self.line.nodal(values)[:, self.line.dimension :]


class MidpointInertia(MidpointPart):
    """The line's mass."""

    name = "inertia"

    def __init__(self, instant: Inertia) -> None:
        super().__init__(instant, [0])
        self.instant = instant

    def make_kernel_data(self) -> MidpointMass:
        ne, d = self.line.length.size, self.line.dimension
        q, F, rows = np.empty((ne, 4, d)), np.empty((ne, 4, d)), np.empty((ne, d, 2 * self.line.ndof))
        return MidpointMass(self.instant.make_kernel_data(), self._motion.data, np.empty((ne, 2, d)), q, F, rows)

    def q_rate(self, state: State) -> Array:
        """q' (ne, 4, d) at the end of a step, as the midpoint rule has it."""
        (rate,) = self.rates(state)
        q: Array = hermite.interleave(self.line.nodal(state.v), rate, fixed(self.line.dimension))
        return q

    def add_momentum_correction(self, state: State, out: Array) -> None:
        """Add P^T M (q' - q'(v)) at an accepted state to a local array [N s, N m s]."""
        if self.line.active:
            ((P, excess),) = self._motion.spins(self._turning(state.v))
            still = np.zeros((self.line.nodes, self.line.dimension))
            beyond = hermite.interleave(still, excess, fixed(self.line.dimension))
            self.line.scatter(hermite.pull_back(hermite.weigh(self.instant.M, beyond), P), out)

    def nodal_forces(self, state: State) -> Array | None:
        """Residual (nn, ndof) of what sits at the line's ends, if anything, at an accepted state."""
        return self.instant.nodal_forces(state)


@add_forces.of(MidpointMass)
def _add_forces(part: MidpointMass, at: Configuration, out: LineForces) -> None:
    if part.tangents.elapsed[0] == 0.0:
        add_forces(part.mass, at, out)
    else:
        _go_through_step(part, at)
        hermite.collect_nodal(part.F, part.tangents.secant.P, out.inertia, at.D, at.R)
        add_forces_at_ends(part.mass, at, out)


@njit
def _go_through_step(part: MidpointMass, at: Configuration) -> None:
    """Write the tangents in a step whose middle this is, and the residual F conjugate to the means of q."""
    write_secant(at, part.tangents, 0, 1.0)
    write_accelerations(part.tangents, 0, part.at_ends)
    hermite.write_interleaved(at.a, part.at_ends, part.q, at.D)
    part.F[:] = 0.0
    hermite.add_weighed(part.mass.M, part.q, part.F, at.D)


@add_tangent.of(MidpointMass)
def _add_tangent(part: MidpointMass, at: Configuration, maps: Maps, weights: Weights, K: Array) -> None:
    if part.tangents.elapsed[0] == 0.0:
        add_tangent(part.mass, at, maps, weights, K)
    else:
        _go_through_step(part, at)
        secant, F, follows = part.tangents.secant, part.F, 0.5 * weights.shift_a
        for e in range(F.shape[0]):
            for side in range(2):
                for i in range(len(at.D)):
                    part.at_ends[e, side, i] = F[e, 2 * side + 1, i]
        write_turning_of(at, part.tangents, part.at_ends)
        for e in range(F.shape[0]):
            for side in range(2):
                for i in range(len(at.D)):
                    for k in range(len(at.R)):
                        secant.by_end[e, side, i, k] *= follows
        hermite.write_all_rows(secant.by_end, weights.shift_a, part.rows, at.D, at.R)
        hermite.add_mass_to(K, weights.inertia, secant.P, part.rows, part.mass.M, at.D, at.R)
        hermite.add_geometric(K, weights.inertia, part.tangents.turning, len(at.D))
        add_tangent_at_ends(part.mass, at, maps, weights, K)


@add_energy.of(MidpointMass)
def _add_energy(part: MidpointMass, at: Configuration, energy: Array) -> None:
    """Add the kinetic energy where a step begins or ends."""
    write_rates_at_end(at, part.tangents, 0, part.at_ends)
    hermite.write_interleaved(at.v, part.at_ends, part.q, at.D)
    add_kinetic(part.mass, at, part.q, energy)


class MidpointRotaryInertia(MidpointPart):
    """The sections' rotary inertia: mass that sits on their directors. masses (m, ne) [kg m2]: of element ends."""

    name = "rotary inertia"

    def __init__(self, instant: RotaryInertia) -> None:
        on = instant.on_directors()
        super().__init__(instant, on)
        self.instant, self.masses = instant, np.stack([*on.values()])

    def make_kernel_data(self) -> MidpointRotaryMass:
        at_ends = np.empty((self.line.length.size, 2, self.line.dimension))
        return MidpointRotaryMass(self.instant.make_kernel_data(), self.masses, self._motion.data, at_ends)

    def add_momentum_correction(self, state: State, out: Array) -> None:
        """Add P^T M (d' - d'(v)) at an accepted state to a local array [N m s]."""
        if self.line.active:
            element = np.zeros((len(self.line.length), 2, self.line.ndof))
            for mass, (P, excess) in zip(self.masses, self._motion.spins(self._turning(state.v)), strict=True):
                element[:, :, self.line.dimension :] += np.einsum("e,esik,esi->esk", mass, P, excess)
            self.line.scatter(element.reshape(len(element), -1), out)


@add_forces.of(MidpointRotaryMass)
def _add_rotary_forces(part: MidpointRotaryMass, at: Configuration, out: LineForces) -> None:
    if part.directors.elapsed[0] == 0.0:
        add_forces(part.instant, at, out)
    else:
        P, F, n, d = part.directors.secant.P, part.at_ends, at.v.shape[1], len(at.D)
        for m in range(part.masses.shape[0]):
            _move_director(part, at, m)
            for e in range(F.shape[0]):
                for side in range(2):
                    for j in range(len(at.R)):
                        for i in range(d):
                            out.inertia_e[e, side * n + d + j] += P[e, side, i, j] * F[e, side, i]


@njit
def _move_director(part: MidpointRotaryMass, at: Configuration, m: int) -> None:
    """Write a director in a step whose middle this is, and the force on its mean."""
    write_secant(at, part.directors, m, 1.0)
    write_accelerations(part.directors, m, part.at_ends)
    for e in range(part.at_ends.shape[0]):
        for side in range(2):
            for i in range(len(at.D)):
                part.at_ends[e, side, i] *= part.masses[m, e]


@add_tangent.of(MidpointRotaryMass)
def _add_rotary_tangent(
    part: MidpointRotaryMass, at: Configuration, maps: Maps, weights: Weights, K: Array
) -> None:
    if part.directors.elapsed[0] == 0.0:
        add_tangent(part.instant, at, maps, weights, K)
    else:
        secant, block = part.directors.secant, part.directors.turning
        for m in range(part.masses.shape[0]):
            _move_director(part, at, m)
            write_turning_of(at, part.directors, part.at_ends)
            for e in range(block.shape[0]):
                follows = 0.5 * weights.shift_a * part.masses[m, e]
                for side in range(2):
                    for j in range(len(at.R)):
                        for c in range(len(at.R)):
                            for i in range(len(at.D)):
                                by_end = secant.by_end[e, side, i, c]
                                block[e, side, j, c] += follows * secant.P[e, side, i, j] * by_end
            hermite.add_geometric(K, weights.inertia, block, len(at.D))


@add_energy.of(MidpointRotaryMass)
def _add_rotary_energy(part: MidpointRotaryMass, at: Configuration, energy: Array) -> None:
    """Add the kinetic energy where a step begins or ends."""
    for m in range(part.masses.shape[0]):
        write_rates_at_end(at, part.directors, m, part.at_ends)
        for e in range(part.at_ends.shape[0]):
            for side in range(2):
                for i in range(len(at.D)):
                    energy[0] += 0.5 * part.masses[m, e] * part.at_ends[e, side, i] ** 2


def over_steps(instant: Part) -> Part:
    """Inertia of an instant as the midpoint rule has it over steps."""
    if isinstance(instant, Inertia):
        return MidpointInertia(instant)
    assert isinstance(instant, RotaryInertia)
    return MidpointRotaryInertia(instant)
