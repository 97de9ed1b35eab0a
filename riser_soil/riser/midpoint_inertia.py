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

from collections.abc import Sequence

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import fixed
from riser_soil.core.part import Energy, Forces, MatrixBlock, Part, State, Traits, Weights
from riser_soil.core.roles import MomentumCorrecting
from riser_soil.core.saved_state import Saved, Stateful, gathered, restore_all
from riser_soil.riser import hermite
from riser_soil.riser.inertia import Inertia, RotaryInertia
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart
from riser_soil.riser.midpoint_directors import DirectorMotion, Secant, directors


class MidpointInertia(LinePart):
    """The line's mass in steps of the midpoint rule (group I).

    instant: the same mass at an instant, as evaluated at accepted states.
    """

    line: Line

    name, traits = "inertia", Traits("I", symmetric=False, roles=(MomentumCorrecting, Stateful))

    def __init__(self, instant: Inertia) -> None:
        super().__init__(instant.line)
        self.instant = instant
        self._tangents = DirectorMotion(directors(self.line.frames, 0))

    def begin(self, state: State) -> None:
        """Start from an accepted state."""
        self._tangents.begin(state.t, _turning(self.line, state.v))

    def blocks(self) -> dict[str, MatrixBlock]:
        return self.instant.blocks()

    def q_rate(self, state: State) -> Array:
        """q' (ne, 4, d) at the end of a step, as the midpoint rule has it."""
        rate = self._tangents.rate(state.t, _turning(self.line, state.u))
        return self._interleave(state.v, rate)

    def _interleave(self, nodal: Array, at_ends: Array) -> Array:
        q: Array = hermite.interleave(self.line.nodal(nodal), at_ends, fixed(self.line.dimension))
        return q

    def _step(self, state: State) -> tuple[Secant, Array]:
        """The tangents through the step, and the residual conjugate to the means of q (ne, 4, d)."""
        secant, acceleration = self._tangents.accelerate(state.t, _turning(self.line, state.u))
        return secant, hermite.weigh(self.instant.M, self._interleave(state.a, acceleration))

    def residual(self, state: State, forces: Forces) -> None:
        if not self._tangents.within_step(state.t):
            self.instant.residual(state, forces)
        else:
            secant, F = self.line.trial(state).once((self, "step"), lambda trial: self._step(trial.state))
            self.line.scatter(hermite.pull_back(F, secant.P), forces.inertia)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        if not self._tangents.within_step(state.t):
            self.instant.tangent(state, weights, values)
        else:
            secant, F = self.line.trial(state).once((self, "step"), lambda trial: self._step(trial.state))
            K, shift = values[self.line.name], weights.shift_a
            G = self._tangents.geometric(secant, _turning(self.line, state.u), F[:, 1::2])
            hermite.add_geometric(K, weights.inertia, G, self.line.dimension)
            hermite.add_mass(K, weights.inertia, secant.P, 0.5 * shift * secant.by_end, shift, self.instant.M)

    def add_momentum_correction(self, state: State, out: Array) -> None:
        """Add P^T M (q' - q'(v)) at an accepted state to a local array [N s, N m s]."""
        if self.line.active:
            trial = self.line.trial(state)
            excess = hermite.weigh(self.instant.M, self.q_rate(state) - trial.q_rate)
            self.line.scatter(trial.pull_back(excess), out)

    def element_forces(self, state: State) -> Array | None:
        """Element residual (ne, 2 ndof) at an accepted state."""
        return self.instant.element_forces(state)

    def nodal_forces(self, state: State) -> Array | None:
        """Residual (nn, ndof) of what sits at the line's ends, if anything, at an accepted state."""
        return self.instant.nodal_forces(state)

    def energy(self, state: State) -> Energy:
        """Kinetic energy at the start or the end of a step."""
        rate = self.q_rate(state)
        return Energy(kinetic=0.5 * float(np.sum(rate * hermite.weigh(self.instant.M, rate))))

    def commit(self, state: State) -> None:
        self._tangents.commit(state.t, _turning(self.line, state.u))

    def state(self) -> Saved:
        return self._tangents.state()

    def restore(self, saved: Saved) -> None:
        self._tangents.restore(saved)


class MidpointRotaryInertia(LinePart):
    """The sections' rotary inertia in steps of the midpoint rule (group I): mass that sits on their directors.

    instant: the same inertia at an instant, as evaluated at accepted states. masses: of element ends
    on each of the directors [kg m2], (ne, 1, 1).
    """

    line: Line

    name, traits = "rotary inertia", Traits("I", symmetric=False, roles=(MomentumCorrecting, Stateful))

    def __init__(self, instant: RotaryInertia) -> None:
        super().__init__(instant.line)
        self.instant = instant
        on = instant.on_directors()
        self.masses = [mass[:, None, None] for mass in on.values()]
        self._directors = [DirectorMotion(directors(self.line.frames, k)) for k in on]

    def begin(self, state: State) -> None:
        """Start from an accepted state."""
        for director in self._directors:
            director.begin(state.t, _turning(self.line, state.v))

    def blocks(self) -> dict[str, MatrixBlock]:
        return self.instant.blocks()

    def rates(self, state: State) -> Sequence[Array]:
        """Rates of the directors, each (ne, 2, d), at the end of a step of the midpoint rule."""
        return [director.rate(state.t, _turning(self.line, state.u)) for director in self._directors]

    def _step(self, state: State) -> list[tuple[Secant, Array]]:
        """The directors through the step, each with its force on their means (ne, 2, d)."""
        middle = _turning(self.line, state.u)
        steps = [director.accelerate(state.t, middle) for director in self._directors]
        return [(secant, mass * a) for (secant, a), mass in zip(steps, self.masses, strict=True)]

    def residual(self, state: State, forces: Forces) -> None:
        if not self._directors[0].within_step(state.t):
            self.instant.residual(state, forces)
        else:
            steps = self.line.trial(state).once((self, "step"), lambda trial: self._step(trial.state))
            self._scatter([secant.moments(F) for secant, F in steps], forces.inertia)

    def _scatter(self, moments: list[Array], out: Array) -> None:
        """Add moments on element ends, each (ne, 2, r), to a local array."""
        element = np.zeros((len(self.line.length), 2, self.line.ndof))
        element[:, :, self.line.dimension :] = np.sum(moments, axis=0)
        self.line.scatter(element.reshape(len(element), -1), out)

    def add_momentum_correction(self, state: State, out: Array) -> None:
        """Add P^T M (d' - d'(v)) at an accepted state to a local array [N m s]."""
        if self.line.active:
            v = _turning(self.line, state.v)
            excesses = zip(self._directors, self.masses, strict=True)
            self._scatter([director.excess(v, mass) for director, mass in excesses], out)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        if not self._directors[0].within_step(state.t):
            self.instant.tangent(state, weights, values)
        else:
            middle, half = _turning(self.line, state.u), 0.5 * weights.shift_a
            steps = self.line.trial(state).once((self, "step"), lambda trial: self._step(trial.state))
            for director, mass, (secant, F) in zip(self._directors, self.masses, steps, strict=True):
                block = np.swapaxes(secant.P, 2, 3) @ (half * mass[..., None] * secant.by_end)
                block += director.geometric(secant, middle, F)
                hermite.add_geometric(values[self.line.name], weights.inertia, block, self.line.dimension)

    def element_forces(self, state: State) -> Array | None:
        """Element residual (ne, 2 ndof) at an accepted state."""
        return self.instant.element_forces(state)

    def energy(self, state: State) -> Energy:
        """Kinetic energy at the start or the end of a step."""
        squares = (mass * rate**2 for mass, rate in zip(self.masses, self.rates(state), strict=True))
        return Energy(kinetic=0.5 * sum(float(np.sum(square)) for square in squares))

    def commit(self, state: State) -> None:
        for director in self._directors:
            director.commit(state.t, _turning(self.line, state.u))

    def state(self) -> Saved:
        return gathered(self._by_number)

    def restore(self, saved: Saved) -> None:
        restore_all(self._by_number, saved)

    @property
    def _by_number(self) -> dict[str, DirectorMotion]:
        return {str(k): director for k, director in enumerate(self._directors)}


def over_steps(instant: Part) -> Part:
    """Inertia of an instant as the midpoint rule has it over steps."""
    if isinstance(instant, Inertia):
        return MidpointInertia(instant)
    assert isinstance(instant, RotaryInertia)
    return MidpointRotaryInertia(instant)


def _turning(line: Line, values: Array) -> Array:
    """Rotation dofs of the nodes (nn, r)."""
    return line.nodal(values)[:, line.dimension :]
