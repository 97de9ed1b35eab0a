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
from riser_soil.core.part import Part, State, Traits
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
    Motion,
    Secant,
    accelerations_within,
    rates_within,
    secant_within,
    turning_within,
)
from riser_soil.riser.part_kernels import LineForces, LineWeights, add_energy, add_forces, add_tangent


class MidpointMass(NamedTuple):
    """The mass at an instant, and its tangents in a step."""

    mass: Mass
    tangents: Motion


class MidpointRotaryMass(NamedTuple):
    """The rotary inertia at an instant, and masses (m, ne) [kg m2] on directors in a step."""

    instant: PlanarRotaryMass | SpatialRotaryMass
    masses: Array
    directors: Motion


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
        """Of the directors, each (ne, 2, d), at the end of a step, as the midpoint rule has them."""
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
        return MidpointMass(self.instant.make_kernel_data(), self._motion.data)

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
        secant, F = _through_step(part, at)
        pulled = np.empty(out.inertia_e.shape)
        hermite.write_pulled_back(F, secant.P, pulled, at.D, at.R)
        for e in range(pulled.shape[0]):
            for i in range(pulled.shape[1]):
                out.inertia_e[e, i] += pulled[e, i]
        add_forces_at_ends(part.mass, at, out)


@njit
def _through_step(part: MidpointMass, at: Configuration) -> tuple[Secant, Array]:
    """The tangents in a step whose middle this is, and the residual conjugate to the means of q (ne, 4, d)."""
    secant = secant_within(at, part.tangents.fixed[0], 1.0)
    acceleration = accelerations_within(part.tangents, 0, secant.change)
    F = np.zeros(at.q.shape)
    hermite.add_weighed(part.mass.M, hermite.interleave(at.a, acceleration, at.D), F, at.D)
    return secant, F


@add_tangent.of(MidpointMass)
def _add_tangent(part: MidpointMass, at: Configuration, maps: Maps, weights: LineWeights, K: Array) -> None:
    if part.tangents.elapsed[0] == 0.0:
        add_tangent(part.mass, at, maps, weights, K)
    else:
        secant, F = _through_step(part, at)
        rows = np.empty((K.shape[0], len(at.D), K.shape[2]))
        hermite.write_all_rows(0.5 * maps.shift_a * secant.by_end, maps.shift_a, rows, at.D, at.R)
        hermite.add_mass_to(K, weights.inertia, secant.P, rows, part.mass.M, at.D, at.R)
        turning = turning_within(at, secant, np.ascontiguousarray(F[:, 1::2]))
        hermite.add_geometric(K, weights.inertia, turning, len(at.D))
        add_tangent_at_ends(part.mass, at, maps, weights, K)


@add_energy.of(MidpointMass)
def _add_energy(part: MidpointMass, at: Configuration, energy: Array) -> None:
    """Where a step begins or ends."""
    rate = part.tangents.rate[0]
    if part.tangents.elapsed[0] > 0.0:
        rate = rates_within(part.tangents, 0, secant_within(at, part.tangents.fixed[0], 0.5).change)
    add_kinetic(part.mass, at, hermite.interleave(at.v, rate, at.D), energy)


class MidpointRotaryInertia(MidpointPart):
    """The sections' rotary inertia: mass that sits on their directors. masses (m, ne) [kg m2]: of element ends."""

    name = "rotary inertia"

    def __init__(self, instant: RotaryInertia) -> None:
        on = instant.on_directors()
        super().__init__(instant, on)
        self.instant, self.masses = instant, np.stack([*on.values()])

    def make_kernel_data(self) -> MidpointRotaryMass:
        return MidpointRotaryMass(self.instant.make_kernel_data(), self.masses, self._motion.data)

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
        n, d = at.v.shape[1], len(at.D)
        for k in range(part.masses.shape[0]):
            secant, F = _director_through_step(part, at, k)
            for e in range(F.shape[0]):
                for side in range(2):
                    for j in range(len(at.R)):
                        for i in range(d):
                            out.inertia_e[e, side * n + d + j] += secant.P[e, side, i, j] * F[e, side, i]


@njit
def _director_through_step(part: MidpointRotaryMass, at: Configuration, k: int) -> tuple[Secant, Array]:
    """A director in a step whose middle this is, and the force on its mean (ne, 2, d)."""
    secant = secant_within(at, part.directors.fixed[k], 1.0)
    F = accelerations_within(part.directors, k, secant.change)
    for e in range(F.shape[0]):
        F[e] *= part.masses[k, e]
    return secant, F


@add_tangent.of(MidpointRotaryMass)
def _add_rotary_tangent(
    part: MidpointRotaryMass, at: Configuration, maps: Maps, weights: LineWeights, K: Array
) -> None:
    if part.directors.elapsed[0] == 0.0:
        add_tangent(part.instant, at, maps, weights, K)
    else:
        for k in range(part.masses.shape[0]):
            secant, F = _director_through_step(part, at, k)
            block, P, by_end = turning_within(at, secant, F), secant.P, secant.by_end
            for e in range(F.shape[0]):
                follows = 0.5 * maps.shift_a * part.masses[k, e]
                for side in range(2):
                    for j in range(len(at.R)):
                        for c in range(len(at.R)):
                            for i in range(len(at.D)):
                                block[e, side, j, c] += follows * P[e, side, i, j] * by_end[e, side, i, c]
            hermite.add_geometric(K, weights.inertia, block, len(at.D))


@add_energy.of(MidpointRotaryMass)
def _add_rotary_energy(part: MidpointRotaryMass, at: Configuration, energy: Array) -> None:
    """Where a step begins or ends."""
    for k in range(part.masses.shape[0]):
        rate = part.directors.rate[k]
        if part.directors.elapsed[0] > 0.0:
            rate = rates_within(part.directors, k, secant_within(at, part.directors.fixed[k], 0.5).change)
        for e in range(rate.shape[0]):
            energy[0] += 0.5 * part.masses[k, e] * np.sum(rate[e] ** 2)


def over_steps(instant: Part) -> Part:
    """Inertia of an instant as the midpoint rule has it over steps."""
    if isinstance(instant, Inertia):
        return MidpointInertia(instant)
    assert isinstance(instant, RotaryInertia)
    return MidpointRotaryInertia(instant)
