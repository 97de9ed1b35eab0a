"""Parts that act on a line: the base of all, and those whose formulas are kernels, one by one or together.

Parts with kernels are evaluated in a trial configuration of the line, which all of its parts share (`placed_line`).
Between two calls nothing is cached but that configuration and the forces that were evaluated in it last.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from functools import cached_property
from typing import Any, ClassVar, TypeVar

import numpy as np

from riser_soil.core.arrays import Array, as_list
from riser_soil.core.bound import Bound, Packed, in_turn
from riser_soil.core.part import Energy, Forces, MatrixBlock, Part, State, Traits, Weights, Work
from riser_soil.riser.bound_parts import BoundParts, KernelData, has_history, has_work
from riser_soil.riser.moving_nodes import MovingNodes
from riser_soil.riser.part_kernels import LineForces
from riser_soil.riser.placed_line import LineTrials

Other = TypeVar("Other")


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

    def energy(self, state: State) -> Energy:
        return Energy()

    def work(self, before: State, after: State) -> Work:
        return Work()

    def commit(self, state: State) -> None:
        """By default a part has no history."""

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
    """Parts that act on this line and say where."""
    return [part for part in parts if isinstance(part, LinePart) and part.line is line]


def overrides(part: LinePart, method: str) -> bool:
    """Whether a part has a method of its own in the place of that of `LinePart`, which does nothing."""
    return getattr(type(part), method) is not getattr(LinePart, method)


class CompiledPart(LinePart, ABC):
    """Base of the parts whose formulas are kernels; a part has kernel data, and history if any.

    after_forces: whether its kernels of energy and work read what the kernel of its forces has written.
    """

    name: str
    traits: Traits
    after_forces: ClassVar[bool] = False

    @abstractmethod
    def make_kernel_data(self) -> KernelData:
        """The part's kernel data, made once; what changes is an array that is written to, see `renew_kernel_data`."""

    @cached_property
    def _data(self) -> Any:
        return self.make_kernel_data()

    def kernel_data(self) -> KernelData:
        """Arrays and constants that the part's kernels read and write; their type selects the kernels."""
        data: KernelData = self._data
        return data

    def renew_kernel_data(self, start: float, end: float) -> None:
        """Write what depends on the time alone into the kernel data, for a step between two times [s]."""

    def bind(self) -> None:
        """Bind kernels of its own beside those of all parts, see `LineParts.bind`."""

    @property
    def reads(self) -> Sequence[CompiledPart]:
        """Parts of the line whose results its kernels read, so that these are evaluated first."""
        return ()

    @cached_property
    def _trials(self) -> LineTrials:
        return self.line.once(LineTrials)

    @cached_property
    def _alone(self) -> LineParts:
        return LineParts(self.line, [self])

    def find(self, state: State) -> LineForces:
        """Its residuals at a trial state, for all that reads what it finds there; on the elements alone."""
        return self._alone.find(state)

    def residual(self, state: State, forces: Forces) -> None:
        self._alone.residual(state, forces)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        self._alone.tangent(state, weights, values)

    def energy(self, state: State) -> Energy:
        return self._alone.energy(state)

    def work(self, before: State, after: State) -> Work:
        if not has_work(self.kernel_data()):
            return Work()
        return Work(*self._alone.work_rows(before, after)[0])

    def commit(self, state: State) -> None:
        """Keep the history."""
        if has_history(self.kernel_data()):
            self._alone.keep(state)

    def work_against(self, before: State, after: State) -> float:
        """Work [J] against the mean of the forces at the ends of a step, over its increments."""
        forces, part = Forces.zeros(after.u.size), self.line.part
        for state in (before, after):
            self.residual(state, forces)
        mean = 0.5 * (forces.inertia + forces.force)
        return float(mean[part] @ (after.u - before.u)[part])

    def element_forces(self, state: State) -> Array:
        return self._alone.element_forces(state)

    def forces_on_nodes(self, state: State) -> Array:
        """Residual (nn, ndof) of what acts on nodes themselves."""
        return self._alone.forces_on_nodes(state)


class LineParts:
    """Parts of one line that have kernels, evaluated together: a single one, or all that act on it.

    name: the line's; parts: in the order in which they are evaluated; data: their kernel data. forces: their residuals
    as evaluated last, in the configuration of count `evaluated_at`. accepted: whether the states are accepted ones, at
    which the line is placed once for all; but for work, which needs the one where the step begins.
    """

    def __init__(self, line: MovingNodes, parts: Sequence[CompiledPart], accepted: bool = False) -> None:
        self.line, self.name, self.parts = line, line.name, parts
        self.data = [part.kernel_data() for part in parts]
        self._trials = line.once(LineTrials)
        self._placed = self._trials.then if accepted else self._trials.now
        self._kernels = BoundParts(self._placed.at, self.data)
        self.forces, self.evaluated_at = self._kernels.forces, -1
        self._renewed = [part for part in parts if type(part).renew_kernel_data is not CompiledPart.renew_kernel_data]
        self._first = [each for part in parts for each in part.reads if each not in parts]
        self._after_forces = any(part.after_forces for part in parts)
        self._groups = {group for part in parts for group in part.traits.groups}
        self._write_forces, self._collect = in_turn(*self._kernels.find_forces()), self._kernels.collect()

    def bind(self) -> None:
        """Bind all kernels: those that are missing are compiled together, on all cores, as soon as one is called."""
        _ = self._tangent, self._energy, self._work, self._keep, self._element_forces
        for part in self.parts:
            part.bind()

    def renew(self, start: float, end: float) -> None:
        """Write what depends on time into the kernel data, for a step between two times [s] by another solver."""
        self._trials.start, self._trials.end = start, end
        self._trials.forget()
        self._renew()

    def _renew(self) -> None:
        for part in self._renewed:
            part.renew_kernel_data(self._trials.start, self._trials.end)

    def go_to(self, state: State, velocities_alone: bool = False) -> None:
        """Bring line and kernel data to a trial state, whose accelerations may not matter."""
        self._trials.step_to(state.t)
        self._renew()
        for part in self._first:
            part.find(state)
        self._placed.move(state, velocities_alone)

    def find(self, state: State) -> LineForces:
        """Residuals at a trial state, as they act on elements and on nodes."""
        self.go_to(state)
        if self.evaluated_at != self._placed.count:
            self._evaluate()
        return self.forces

    def _evaluate(self) -> None:
        self._write_forces()
        self.evaluated_at = self._placed.count

    def residual(self, state: State, forces: Forces) -> None:
        """Add the parts' residuals at a trial state."""
        self.go_to(state)
        self._evaluate()
        self._collect()
        at, out = self.line.part, self.forces
        if "I" in self._groups:
            forces.inertia[at] += out.inertia.ravel()
        if "F" in self._groups:
            forces.force[at] += out.force.ravel()
        if "E" in self._groups:
            forces.end[at] += out.end.ravel()

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        """Add the parts' tangent at a trial state to the line's element matrices (ne, n, n)."""
        self.find(state)
        self._add_to(values[self.line.name], weights, self._tangent)

    def mass(self, state: State, K: Array) -> None:
        """Add the parts' mass at an accepted state, without rates, to the element matrices K (ne, n, n)."""
        self.go_to(state)
        self._add_to(K, MASS_ALONE, self._mass)

    def _add_to(self, K: Array, weights: Weights, add: Bound) -> None:
        self._placed.differentiate(weights)
        if self._K.value is not K:
            self._K.renew(K)
        add()

    @cached_property
    def _K(self) -> Packed:
        return Packed(self.line.element_block().zeros())

    @cached_property
    def _mass(self) -> Bound:
        maps, weights = self._placed.trial.maps, self._placed.trial.weights
        return in_turn(*self._kernels.find_water(), *self._kernels.tangent(self.data, maps, weights, self._K))

    @cached_property
    def _tangent(self) -> Bound:
        return in_turn(self._mass, *self._kernels.turning(self._placed.trial.weights, self._K))

    def energy(self, state: State) -> Energy:
        """The parts' energy at a trial state."""
        self._place(state)
        return Energy(*self._energies())

    def kinetic_energy(self, state: State) -> float:
        """Kinetic energy [J] of parts that have no other, at a trial state."""
        self.go_to(state, velocities_alone=True)
        return float(self._energies()[0])

    def _energies(self) -> list[float]:
        """Kinetic, strain and potential energy [J] in the configuration that the line is placed in."""
        energy, add_energy = self._energy
        energy[:] = 0.0
        add_energy()
        return as_list(energy)

    @cached_property
    def _energy(self) -> tuple[Array, Bound]:
        energy = np.zeros(3)
        return energy, in_turn(*self._kernels.find_water(), *self._kernels.energy(Packed(energy)))

    def work_rows(self, before: State, after: State) -> list[list[float]]:
        """What parts turn over in a step from an accepted state, (4,) each that has a kernel for it."""
        trials = self._trials
        trials.then.move(before)
        trials.start, trials.end = before.t, after.t
        self._place(after)
        rows, find = self._work
        rows[...] = 0.0
        find()
        return as_list(rows)

    @cached_property
    def _work(self) -> tuple[Array, Bound]:
        rows = np.zeros((sum(map(has_work, self.data)), 4))
        return rows, in_turn(*self._kernels.find_water(), *self._kernels.work(self._trials.then.at, rows))

    def _place(self, state: State) -> None:
        """Get ready for energy and work at a trial state."""
        if self._after_forces:
            self.find(state)
        else:
            self.go_to(state)

    def keep(self, state: State) -> None:
        """Keep the history of the parts at the end of a step."""
        self.find(state)
        self._keep()

    @cached_property
    def _keep(self) -> Bound:
        return in_turn(*self._kernels.keep())

    def element_forces(self, state: State) -> Array:
        """Residual (ne, 2 ndof) of all groups within the elements."""
        self.find(state)
        residual, write = self._element_forces
        write()
        return residual.copy()

    @cached_property
    def _element_forces(self) -> tuple[Array, Bound]:
        residual = np.zeros((self.line.length.size, 2 * self.line.ndof))
        return residual, self._kernels.write_residual(residual)

    def forces_on_nodes(self, state: State) -> Array:
        """Residual (nn, ndof) of what acts on nodes themselves."""
        self.go_to(state)
        self._evaluate()
        return self.forces.inertia + self.forces.force


MASS_ALONE = Weights(inertia=1.0, force=0.0, shift_v=0.0, shift_a=1.0)


def joined(parts: Iterable[Other], accepted: bool = False) -> list[Other | LineParts]:
    """Parts, those of each line or body that have kernels as one; accepted: see `LineParts`."""
    compiled: dict[MovingNodes, list[CompiledPart]] = {}
    others: list[Other | LineParts] = []
    for part in parts:
        if isinstance(part, CompiledPart):
            compiled.setdefault(part.line, []).append(part)
        else:
            others.append(part)
    return [*(LineParts(line, of_line, accepted) for line, of_line in compiled.items()), *others]
