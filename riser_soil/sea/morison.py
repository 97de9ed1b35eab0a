"""Hydrodynamic loads on the riser by Morison's formula: the part "morison"."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from riser_soil.core.arrays import Array
from riser_soil.core.part import Energy, Forces, State, Traits, Weights, Work
from riser_soil.riser.line_part import LinePart
from riser_soil.riser.trial import Trial
from riser_soil.sea.moving_water_kernels import MovingWaterNumbers
from riser_soil.sea.pipe import Pipe
from riser_soil.sea.still_water import StationLoads
from riser_soil.sea.stream_kernels import bring


class Morison(LinePart):
    """Loads of the water at the pipe's stations, brought to the line: group I is the added mass, F all the rest.

    formed: what becomes of the loads in numbers, where they have kernels of their own.
    """

    name = "morison"
    traits = Traits("IF", symmetric=False, follows=True)

    def __init__(
        self, pipe: Pipe, loads: StationLoads, formed: Callable[[MovingWaterNumbers], tuple[Any, ...]] | None = None
    ) -> None:
        super().__init__(pipe.line)
        self._pipe, self._loads, self._formed = pipe, loads, formed

    def element_forces(self, state: State) -> tuple[Array, Array]:
        """Element residuals (inertia, force), each (ne, 2 ndof)."""
        found: tuple[Array, Array] = self.line.trial(state).once((self, "element forces"), self._element_forces)
        return found

    def residual(self, state: State, forces: Forces) -> None:
        trial = self.line.trial(state)
        inertia, force = self._q_forces(trial)
        self.line.collect(trial, inertia, forces.inertia)
        self.line.collect(trial, force, forces.force)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        trial, K = self.line.trial(state), values[self.line.name]
        self._pipe.add_tangent(K, trial, weights, self._loads.derivatives(trial, weights))
        inertia, force = self._q_forces(trial)
        trial.add_turning(K, 1.0, weights.inertia * inertia + weights.force * force)

    def numbers(self) -> tuple[Any, ...]:
        self._in_loop = self._loads.numbers()
        if self._formed is None:
            return self._in_loop
        assert isinstance(self._in_loop, MovingWaterNumbers)
        return self._formed(self._in_loop)

    def renew_numbers(self, start: float, end: float) -> None:
        if isinstance(self._in_loop, MovingWaterNumbers):
            bring(self._in_loop.seen, start, end)

    def energy(self, state: State) -> Energy:
        """Kinetic energy of the added mass at the pipe's own velocity."""
        trial = self.line.trial(state)
        v = self._pipe.flow(trial).v
        return Energy(kinetic=0.5 * self._pipe.total(v, self._loads.momentum(trial, v)))

    def work(self, before: State, after: State) -> Work:
        """Drag of still water dissipates; all that moving water does is external work, of either sign.

        So a riser at rest in a current neither gains nor loses energy, whatever supports it.
        """
        first, last = self.line.left_at(before), self.line.trial(after)
        resisted = self._pipe.taken(lambda trial: self._q_forces(trial)[1], first, last)
        changed = self._changed(first, last)
        if self._loads.dissipative:
            return Work(dissipated=resisted, external=changed, inertial=changed)
        return Work(external=changed - resisted, inertial=changed)

    def _changed(self, first: Trial, last: Trial) -> float:
        """Change of kinetic energy by a change dm of the added mass, as it turns or gets wet, beyond the work of its
        force.

        That force is m a, so the remainder is 1/2 v.dm v per length. Written in rates alone it does not depend on the
        accelerations, which are of first order only in generalised-alpha.
        """
        v = 0.5 * (self._pipe.flow(first).v + self._pipe.flow(last).v)
        return 0.5 * self._pipe.total(v, self._loads.momentum(last, v) - self._loads.momentum(first, v))

    def _element_forces(self, trial: Trial) -> tuple[Array, Array]:
        inertia, force = self._q_forces(trial)
        return trial.pull_back(inertia), trial.pull_back(force)

    def _q_forces(self, trial: Trial) -> tuple[Array, Array]:
        """Residuals conjugate to q (ne, 4, d): inertia, force."""
        forces: tuple[Array, Array] = trial.once((self, "q forces"), self._integrate)
        return forces

    def _integrate(self, trial: Trial) -> tuple[Array, Array]:
        inertia, force = self._loads.forces(trial)
        return self._pipe.integrate(inertia), self._pipe.integrate(force)
