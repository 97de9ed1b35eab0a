"""Base classes of the parts that act on a line: of all, and of those whose formulas are kernels, see `part_kernels`.

What a system asks of a part of kernels at a trial state, they find in a configuration of the line that all of its parts
share. Nothing is kept between two calls but where the line is and what its parts have found there last.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterable
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from riser_soil.core.arrays import Array, as_list
from riser_soil.core.bound import Bound, Packed, bound, in_turn
from riser_soil.core.part import Energy, Forces, MatrixBlock, Part, State, Traits, Weights, Work
from riser_soil.riser.configuration import maps_for, write_maps, write_turning
from riser_soil.riser.moving_nodes import MovingNodes
from riser_soil.riser.part_kernels import (
    LineWeights,
    add_energy,
    add_forces,
    add_tangent,
    add_work,
    clear,
    collect,
    find_water,
    forces_at,
    keep,
    turn,
    weigh,
    write_residual,
)
from riser_soil.riser.placed_line import LineBase, PlacedTrial


class LinePart:
    """Base of the parts that act on a line; called only on the rank that evaluates it."""

    def __init__(self, line: MovingNodes) -> None:
        self.line = line

    @property
    def active(self) -> bool:
        return self.line.active

    def blocks(self) -> dict[str, MatrixBlock]:
        """All dofs of each element."""
        return {self.line.name: self.line.element_block()}

    def kernel_data(self) -> tuple[Any, ...] | None:
        """The part's kernel data, for the line solver, see `part_kernels`; None without.

        Asked for once a stage, so that what changes is an array that is written to, see `renew_kernel_data`.
        """
        return None

    def renew_kernel_data(self, start: float, end: float) -> None:
        """Write what depends on the time alone into the kernel data that was asked for last, for a step between two
        times [s].
        """

    def energy(self, state: State) -> Energy:
        return Energy()

    def work(self, before: State, after: State) -> Work:
        return Work()

    def commit(self, state: State) -> None:
        """Nothing is kept."""

    def element_forces(self, state: State) -> Array | None:
        """Element residual (ne, 2 ndof) of all groups, of what acts within the elements; None for nothing."""
        return None

    def viscous_forces(self, state: State) -> Array | None:
        """The share of `element_forces` (ne, 2 ndof) that follows from strain rates; None for nothing."""
        return None

    def nodal_forces(self, state: State) -> Array | None:
        """Residual (nn, ndof) of what acts on nodes without holding them; None for nothing."""
        return None


def acting_on(line: MovingNodes, parts: Iterable[Part]) -> list[LinePart]:
    """Those of the parts that act on this line and say where."""
    return [part for part in parts if isinstance(part, LinePart) and part.line is line]


def overrides(part: LinePart, method: str) -> bool:
    """Whether a part has a method of its own in the place of the base's, which does nothing."""
    return getattr(type(part), method) is not getattr(LinePart, method)


class LineTrials:
    """A line at a trial state, `now`, and where a step begins, `then`: what its parts share.

    maps, weights: of the tangent asked for last. conjugate (ne, 2, d), turning (ne, 2, r, r): workspace for what is
    conjugate to the tangents of the elements' ends, and its turning.
    """

    def __init__(self, line: MovingNodes) -> None:
        base, (ne, d, r) = LineBase(line), (line.length.size, line.dimension, line.frames.dofs)
        self.now, self.then = PlacedTrial(line, base), PlacedTrial(line, base)
        self.maps, self.weights = Packed(maps_for(line)), Packed(LineWeights(0.0, 0.0))
        self.conjugate, self.turning = Packed(np.empty((ne, 2, d))), Packed(np.empty((ne, 2, r, r)))
        self._write_maps = bound(write_maps, self.now.at, self.maps)
        self._mapped = -1  # the count of `now` for which they hold
        self._start = self._end = math.nan

    def differentiate(self, weights: Weights) -> None:
        """Find the maps at the trial state."""
        if (weights.inertia, weights.force) != self.weights.value:
            self.weights.renew(LineWeights(float(weights.inertia), float(weights.force)))
        kept, shifts = self.maps.value, (float(weights.shift_v), float(weights.shift_a))
        if self._mapped != self.now.count or (kept.shift_v, kept.shift_a) != shifts:
            self.maps.renew(kept._replace(shift_v=shifts[0], shift_a=shifts[1]))
            self._write_maps()
            self._mapped = self.now.count

    def step_to(self, t: float) -> tuple[float, float]:
        """Times of the step that ends at t: it starts at the time that was asked for before."""
        if t != self._end:
            self._start, self._end = (t if math.isnan(self._end) else self._end), t
        return self._start, self._end

    def step(self, start: float, end: float) -> tuple[float, float]:
        """Times of a step that is known."""
        self._start, self._end = start, end
        return start, end

    def forget(self) -> None:
        """What has been found does not hold any more: the parts' kernel data have changed, or others have used them."""
        self.now.forget()


class BoundPart:
    """Kernels of a part, bound to its kernel data and to the trials of its line, and what they have found last.

    found: the count of the trial at which the forces were found.
    """

    def __init__(self, line: MovingNodes, data: tuple[Any, ...], trials: LineTrials) -> None:
        self._data, self._trials, self.found = data, trials, -1
        n, self.forces = 2 * line.ndof, forces_at(trials.now.at)
        self.energy, self.turned_over = np.zeros(3), np.zeros(4)
        self.residual = np.zeros((line.length.size, n))
        self.K = Packed(line.element_block().zeros())
        self._now, self._forces = Packed(trials.now.at), Packed(self.forces)
        self.find = in_turn(Bound(clear, self._forces), bound(add_forces, data, self._now, self._forces))
        self.collect = Bound(collect, self._now, self._forces)

    @cached_property
    def write_residual(self) -> Bound:
        """Writes the residual of the elements in the forces found last."""
        return Bound(write_residual, self._now, self._forces, Packed(self.residual))

    @cached_property
    def _find_water(self) -> list[Bound]:
        """At the trial state, as another one may have been asked for since."""
        return [bound(find_water, self._data, self._now)] if type(self._data) in find_water.kernels else []

    @cached_property
    def add_tangent(self) -> Bound:
        """Adds to K what the forces found last change by."""
        trials = self._trials
        return in_turn(
            *self._find_water,
            bound(add_tangent, self._data, self._now, trials.maps, trials.weights, self.K),
            Bound(weigh, self._forces, trials.weights, trials.conjugate),
            bound(write_turning, trials.now.at, trials.conjugate, trials.turning),
            Bound(turn, self._now, trials.turning, self.K),
        )

    @cached_property
    def add_energy(self) -> Bound:
        return in_turn(*self._find_water, bound(add_energy, self._data, self._now, Packed(self.energy)))

    @cached_property
    def add_work(self) -> Bound | None:
        """None where the part has no kernel for it."""
        if type(self._data) not in add_work.kernels:
            return None
        given = Packed(self._trials.then.at), self._now, Packed(self.turned_over)
        return in_turn(*self._find_water, bound(add_work, self._data, *given))

    @cached_property
    def keep(self) -> Bound:
        return bound(keep, self._data, self._now)


class CompiledPart(LinePart, ABC):
    """Base of the parts whose formulas are kernels; a part has kernel data, and history if any.

    after_forces: whether its kernels of energy and work read what that of its forces has found at the trial.
    """

    traits: Traits
    after_forces: ClassVar[bool] = False

    @abstractmethod
    def make_kernel_data(self) -> tuple[Any, ...]:
        """The part's kernel data, made once; what changes is an array that is written to, see `renew_kernel_data`."""

    @cached_property
    def _data(self) -> Any:
        return self.make_kernel_data()

    def kernel_data(self) -> tuple[Any, ...]:
        found: tuple[Any, ...] = self._data
        return found

    @cached_property
    def _trials(self) -> LineTrials:
        return self.line.once(LineTrials)

    @cached_property
    def _bound(self) -> BoundPart:
        return BoundPart(self.line, self.kernel_data(), self._trials)

    def _go_to(self, state: State) -> BoundPart:
        """Update line and kernel data to a trial state."""
        found = self._bound
        self._trials.now.move(state)
        self.renew_kernel_data(*self._trials.step_to(state.t))
        return found

    def _find(self, state: State) -> BoundPart:
        """Find the forces at a trial state."""
        found = self._go_to(state)
        found.find()
        found.found = self._trials.now.count
        return found

    def _found(self, state: State) -> BoundPart:
        """The forces at a trial state, on the elements alone."""
        found = self._go_to(state)
        return found if found.found == self._trials.now.count else self._find(state)

    def _placed(self, state: State) -> BoundPart:
        """Ready for energy and work at a trial state."""
        return self._found(state) if self.after_forces else self._go_to(state)

    def residual(self, state: State, forces: Forces) -> None:
        found = self._find(state)
        found.collect()
        if "I" in self.traits.groups:
            forces.inertia[self.line.part] += found.forces.inertia.ravel()
        if "F" in self.traits.groups:
            forces.force[self.line.part] += found.forces.force.ravel()
        if "E" in self.traits.groups:
            forces.end[self.line.part] += found.forces.end.ravel()

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        found, K = self._found(state), values[self.line.name]
        self._trials.differentiate(weights)
        if found.K.value is not K:
            found.K.renew(K)
        found.add_tangent()

    def energy(self, state: State) -> Energy:
        found = self._placed(state)
        found.energy[:] = 0.0
        found.add_energy()
        return Energy(*as_list(found.energy))

    def work(self, before: State, after: State) -> Work:
        found, trials = self._bound, self._trials
        if found.add_work is None:
            return Work()
        trials.then.move(before)
        trials.step(before.t, after.t)
        self._placed(after)
        found.turned_over[:] = 0.0
        found.add_work()
        return Work(*as_list(found.turned_over))

    def commit(self, state: State) -> None:
        """Keep the history."""
        if type(self.kernel_data()) in keep.kernels:
            self._found(state).keep()

    def work_against(self, before: State, after: State) -> float:
        """Work [J] against the mean of the forces at the ends of a step, over its increments."""
        forces, part = Forces.zeros(after.u.size), self.line.part
        for state in (before, after):
            self.residual(state, forces)
        mean = 0.5 * (forces.inertia + forces.force)
        return float(mean[part] @ (after.u - before.u)[part])

    def element_forces(self, state: State) -> Array:
        found = self._found(state)
        found.write_residual()
        return found.residual.copy()

    def forces_on_nodes(self, state: State) -> Array:
        """Residual (nn, ndof) of what acts on nodes themselves."""
        forces = self._find(state).forces
        return forces.inertia + forces.force
