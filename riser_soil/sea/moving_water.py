"""Morison loads in moving water, per length: drag on the relative velocity, Froude-Krylov force and added mass.

The pipe's velocity v and acceleration a meet those of the undisturbed water at its axis, u and u'. With the cross-
section A = pi D^2/4 and the added mass m of `morison_law`,

    force = drag of (v - u) - m a + m u' + rho A u'.

The last term, that of Froude and Krylov, is what the pressure of the undisturbed water does to a piece of the pipe of
length ds closed at both ends: minus its gradient rho u' times the volume A ds, in all directions. A piece within the
line is open; the dynamic pressure on its ends is part of the effective tension, as the static one is (Sparks, Journal
of Energy Resources Technology 106, 1984, on closed pressure fields; DNV-RP-C205, 6.2, for the whole formula). All terms
with u' are known from where the pipe is; as external forces they belong to group F, so that the time scheme stays of
second order, while m a is inertia.
Source: Morison et al., Petroleum Transactions 189 (1950), in its relative form.
"""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Weights
from riser_soil.riser.stations import Derivatives
from riser_soil.riser.trial import Trial
from riser_soil.sea import morison_law as law
from riser_soil.sea.flows import motion_room, put_in_plane
from riser_soil.sea.moving_water_kernels import MovingWaterNumbers
from riser_soil.sea.pipe import Pipe, StationFlow
from riser_soil.sea.sea import Sea
from riser_soil.sea.still_water import StationLoads, StillWater
from riser_soil.sea.stream_kernels import WaterInLoop, water_in_loop
from riser_soil.sea.water import Water, WaterMotion


class _Seen(NamedTuple):
    """The motion at a time and places x (ne, ng, d)."""

    t: float
    x: Array
    motion: WaterMotion

    def at(self, t: float, x: Array) -> bool:
        return self.t == t and np.array_equal(self.x, x)


class FlowAtStations:
    """Moving water around the pipe, evaluated once for trials that differ in rates alone: the last motion seen at the
    latest time and the last one at the time before, where the step begins, are kept.
    """

    def __init__(self, pipe: Pipe, water: Water) -> None:
        self.pipe, self._water = pipe, water
        self._latest: _Seen | None = None
        self._before: _Seen | None = None

    def at(self, trial: Trial) -> WaterMotion:
        """The water's motion at the stations: arrays (ne, ng, ...) in the line's axes."""
        motion: WaterMotion = trial.once((self, "motion"), self._find)
        return motion

    @cached_property
    def in_loop(self) -> WaterInLoop:
        """The same in the compiled loop over a riser alone; for a `Sea`."""
        assert isinstance(self._water, Sea)
        return water_in_loop(self.pipe, self._water.numbers)

    def immersion(self, trial: Trial) -> tuple[Array, Array]:
        """Height of the surface above the stations (ne, ng) [m] and its gradient (ne, ng, d)."""
        motion = self.at(trial)
        return motion.immersion, motion.immersion_gradient

    def through(self, trial: Trial) -> StationFlow:
        """The pipe's motion through the water: its velocity is the relative one."""
        flow: StationFlow = trial.once((self, "through"), self._relative)
        return flow

    def _relative(self, trial: Trial) -> StationFlow:
        flow = self.pipe.flow(trial)
        return flow._replace(v=flow.v - self.at(trial).velocity)

    def _find(self, trial: Trial) -> WaterMotion:
        t, x = trial.state.t, self.pipe.position(trial)
        for seen in (self._latest, self._before):
            if seen is not None and seen.at(t, x):
                return seen.motion
        if self._latest is not None and self._latest.t != t:
            self._before = self._latest
        self._latest = _Seen(t, x, self._evaluate(t, x))
        return self._latest.motion

    def _evaluate(self, t: float, x: Array) -> WaterMotion:
        *at, d = x.shape
        found = self._water(t, self.pipe.line.to_global(x.reshape(-1, d)))
        seen = found if d == 3 else self._in_plane(found)
        return WaterMotion(*(part.reshape(*at, *part.shape[1:]) for part in seen))

    def _in_plane(self, found: WaterMotion) -> WaterMotion:
        seen = motion_room(found.immersion.size, 2)
        put_in_plane(found, np.ascontiguousarray(self.pipe.line.basis), seen)
        return seen


class RelativeDrag:
    """Still water's loads, with drag on the velocity through the water."""

    dissipative = False

    def __init__(self, still: StillWater, stream: FlowAtStations) -> None:
        self._still, self._stream = still, stream

    def forces(self, trial: Trial) -> tuple[Array, Array]:
        return self._still.resist(self._stream.through(trial))

    def derivatives(self, trial: Trial, weights: Weights) -> Derivatives:
        by = self._still.linearise(self._stream.through(trial), weights)
        return by._replace(position=-by.rate @ self._stream.at(trial).velocity_gradient)

    def numbers(self) -> MovingWaterNumbers:
        return self.seen_in(self._stream.in_loop)

    def seen_in(self, water: WaterInLoop) -> MovingWaterNumbers:
        return self._still.seen_in(water)._replace(dissipative=False)

    def momentum(self, trial: Trial, v: Array) -> Array:
        return self._still.momentum(trial, v)


class AcceleratedWater:
    """Froude-Krylov force and added mass by the water's acceleration, added to other loads: rho A u' and m u'.

    mass: (ne, 2) as in `StillWater`. displaced: rho A (ne,) [kg/m].
    """

    dissipative = False

    def __init__(self, loads: StationLoads, stream: FlowAtStations, mass: Array, displaced: Array) -> None:
        self._loads, self._stream, self._pipe = loads, stream, stream.pipe
        self._mass = mass + displaced[:, None]  # rho A is the same across and along the pipe

    def forces(self, trial: Trial) -> tuple[Array, Array]:
        inertia, force = self._loads.forces(trial)
        acceleration, tau = self._stream.at(trial).acceleration, self._pipe.flow(trial).tau
        return inertia, force - law.added(acceleration, tau, self._mass)

    def derivatives(self, trial: Trial, weights: Weights) -> Derivatives:
        by, flow, water = self._loads.derivatives(trial, weights), self._pipe.flow(trial), self._stream.at(trial)
        mass = -weights.force * self._mass
        by_a, by_slope = law.added_derivatives(water.acceleration, flow.tau, flow.stretch, mass)
        return by._replace(
            position=by.position + by_a @ water.acceleration_gradient,
            slope=by.slope + by_slope,
        )

    def numbers(self) -> MovingWaterNumbers:
        return self.seen_in(self._stream.in_loop)

    def seen_in(self, water: WaterInLoop) -> MovingWaterNumbers:
        return self._loads.seen_in(water)._replace(dissipative=False, pushed=self._mass)

    def momentum(self, trial: Trial, v: Array) -> Array:
        return self._loads.momentum(trial, v)
