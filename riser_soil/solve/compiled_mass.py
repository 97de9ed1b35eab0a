"""What the compiled loop tells of accepted configurations: mass, bulk forces, forces of the elements.

With contact they are asked for once a step, at the accepted configuration; see `riser_mass` and `time_scheme`.

What acts within a riser's elements, and its section forces, by the kernels of its parts; see `part_kernels`.

As `riser.section_forces`, which asks the parts' methods one by one. At an accepted state of a riser alone.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.bound import Bound, in_turn
from riser_soil.core.compiled import njit
from riser_soil.core.packed import Packed
from riser_soil.core.part import Forces, State
from riser_soil.core.saved_state import Saved
from riser_soil.riser.configuration import (
    Configuration,
    PlanarConfiguration,
    maps_for,
    put_maps,
    put_moment_maps,
)
from riser_soil.riser.hermite import put_pulled_back
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart, overrides
from riser_soil.riser.part_kernels import (
    LineForces,
    LineWeights,
    add_energy,
    add_forces,
    add_tangent,
    bound,
    clear,
    collect,
    find_water,
    forces_of,
)
from riser_soil.riser.placed_line import PlacedLine
from riser_soil.riser.section_forces import NO_FRAMES, section_input, viscous_residual
from riser_soil.riser.section_kernels import SectionForces, put_section_forces, size_of
from riser_soil.riser.sections import Elements
from riser_soil.solve import riser_loop as loop
from riser_soil.solve.packed_riser import KernelParts, matrix_workspace
from riser_soil.solve.riser_loop import Dofs, MatrixWorkspace, NewtonProgress, StepData
from riser_soil.solve.riser_mass import projectors

KernelData = tuple[Any, ...]


class MassData(NamedTuple):
    """inverse (nn, ndof) [1/m] of the levers of moments; moving (nn, ndof, ndof): see `riser_mass.projectors`; whole
    (nn,): where they change nothing.
    """

    inverse: Array
    moving: Array
    whole: BoolArray


class CompiledMass:
    """A `InverseMass` of one line, by the kernels of its parts; and the bulk forces of an accepted state.

    placed: the line where it is accepted; bulk, inertial: numbers of the parts with forces in groups I and F, and in I;
    prescribed, levers (size,): of the line's dofs; update: writes what depends on the time into the numbers.
    """

    def __init__(
        self,
        line: Line,
        placed: PlacedLine,
        bulk: Sequence[KernelData],
        inertial: Sequence[KernelData],
        prescribed: BoolArray,
        levers: Array,
        update: Callable[[float], None],
    ) -> None:
        self._line, self._update, self._free, self._placed = line, update, ~prescribed, placed
        shape = line.nodes, line.ndof
        self._forces, self._energy, self._known = forces_of(line), np.zeros(3), False
        self._step, self._workspace = StepData(*(np.zeros(shape) for _ in range(6))), matrix_workspace(line)
        self._dofs = Dofs(np.zeros(shape, dtype=bool), np.ones(shape), *(np.zeros(shape) for _ in range(3)))
        moving, whole = np.zeros((*shape, line.ndof)), np.zeros(line.nodes, dtype=bool)
        self._mass = MassData(1.0 / levers.reshape(shape), moving, whole)
        self._bind_state(bulk, inertial)
        self._bind_mass(inertial)

    def _bind_state(self, bulk: Sequence[KernelData], inertial: Sequence[KernelData]) -> None:
        """Bind the kernels of forces and kinetic energy in motion."""
        here, forces, energy = map(Packed, (self._placed.at, self._forces, self._energy))
        each = [bound(add_forces, numbers, here, forces) for numbers in bulk]
        self._find_forces = in_turn(Bound(clear, forces), *each, Bound(collect, here, forces))
        self._find_energy = in_turn(*(bound(add_energy, numbers, here, energy) for numbers in inertial))

    def _bind_mass(self, inertial: Sequence[KernelData]) -> None:
        """Bind the kernels of the mass at rest."""
        at = self._placed.at
        here, workspace, dofs, mass = map(Packed, (at, self._workspace, self._dofs, self._mass))
        K, none = Packed(self._workspace.K), np.zeros(1)
        progress = Packed(NewtonProgress(none, none, np.zeros(2, dtype=np.int64)))
        maps, weights = Packed(maps_for(self._line)._replace(shift_a=1.0)), Packed(LineWeights(1.0, 0.0))
        self._find_matrices = in_turn(
            *(bound(find_water, numbers, here) for numbers in inertial if type(numbers) in find_water.kernels),
            bound(put_maps, at, maps),
            Bound(loop.clear_tangent, K),
            *(bound(add_tangent, numbers, here, maps, weights, K) for numbers in inertial),
            Bound(weigh, workspace, mass),
        )
        self._solve = in_turn(
            Bound(project, workspace, dofs, mass),
            Bound(loop.fill, workspace, dofs),
            Bound(loop.factorise, workspace, progress),
            Bound(loop.improve, workspace, Packed(self._step), dofs),
        )

    def bulk_forces(self, state: State) -> Forces:
        """Forces of groups I and F at an accepted state, those of group E left out."""
        self._update(state.t)
        self._placed.move(state)
        self._find_forces()
        forces = self._forces
        return Forces(*(group.ravel().copy() for group in (forces.inertia, forces.force, forces.end)))

    def kinetic_energy(self, state: State) -> float:
        """Kinetic energy [J] at an accepted state."""
        self._update(state.t)
        self._placed.move(state, velocities_alone=True)
        self._energy[:] = 0.0
        self._find_energy()
        return float(self._energy[0])

    def accelerations(self, t: float, force: Array) -> Array:
        """a with M a = force, in the accepted configuration at time t."""
        self._update(t)
        self._placed.stand()
        self._find_matrices()
        if not self._known:
            self._know(projectors(self._workspace.K, self._free))
        self._step.u[...] = 0.0
        np.negative(force, out=self._dofs.residual.ravel())
        self._solve()
        return self._step.u.ravel() * self._mass.inverse.ravel()

    def state(self) -> Saved:
        """As of `RiserMass`."""
        return {self._line.name: self._mass.moving.copy()} if self._known else {}

    def restore(self, saved: Saved) -> None:
        self._known = False
        if self._line.name in saved:
            self._know(saved[self._line.name])

    def _know(self, moving: Array) -> None:
        self._mass.moving[...], self._known = moving, True
        self._mass.whole[...] = (moving == np.eye(moving.shape[1])).all(axis=(1, 2))


def mass_of(
    line: Line, placed: PlacedLine, parts: KernelParts, prescribed: BoolArray, levers: Array
) -> CompiledMass:
    """Inverse of a line's mass, by its parts; see `CompiledMass`."""
    groups = parts.in_groups("IF"), parts.in_groups("I")
    return CompiledMass(line, placed, *groups, prescribed, levers, parts.update_to)


@njit
def weigh(workspace: MatrixWorkspace, mass: MassData) -> None:
    """Divide element matrices by the levers, so that all masses are in kg."""
    n, inverse = workspace.K.shape[1], mass.inverse.reshape(mass.inverse.size)
    for e in range(workspace.K.shape[0]):
        K, of_ends = workspace.K[e], inverse[e * (n // 2) : e * (n // 2) + n]
        for i in range(n):
            for j in range(n):
                K[i, j] *= of_ends[i] * of_ends[j]


@njit
def project(workspace: MatrixWorkspace, dofs: Dofs, mass: MassData) -> None:
    """Project element matrices and forces over the levers onto what moves; what does not gets the largest mass, which
    is on a diagonal.
    """
    K, ndof, largest = workspace.K, mass.inverse.shape[1], 0.0
    left, own = np.zeros((ndof, ndof)), np.zeros(ndof)
    for e in range(K.shape[0]):
        for i in range(2 * ndof):
            largest = max(largest, K[e, i, i])
        if mass.whole[e] and mass.whole[e + 1]:
            continue
        for row in range(2):
            for column in range(2):
                block = K[e, row * ndof : (row + 1) * ndof, column * ndof : (column + 1) * ndof]
                _multiply(mass.moving[e + row], block, left)
                _multiply(left, mass.moving[e + column], block)
    if largest == 0.0:
        largest = 1.0
    for n in range(dofs.residual.shape[0]):
        e, first = max(n - 1, 0), ndof if n > 0 else 0
        for i in range(ndof):
            own[i] = dofs.residual[n, i] * mass.inverse[n, i]
            dofs.residual[n, i] = own[i]
        if mass.whole[n]:
            continue
        for i in range(ndof):
            dofs.residual[n, i] = 0.0
            for j in range(ndof):
                dofs.residual[n, i] += mass.moving[n, i, j] * own[j]
                K[e, first + i, first + j] += largest * ((1.0 if i == j else 0.0) - mass.moving[n, i, j])


@njit
def _multiply(left: Array, right: Array, out: Array) -> None:
    """Write the product of two matrices, to another place."""
    for i in range(left.shape[0]):
        for j in range(right.shape[1]):
            total = 0.0
            for k in range(left.shape[1]):
                total += left[i, k] * right[k, j]
            out[i, j] = total


class ElementForces:
    """Residuals of the elements of a line and its section forces, in a configuration where parts have put their forces.

    parts: of the line, for what follows from strain rates.
    """

    def __init__(self, line: Line, at: Configuration, forces: LineForces, parts: Sequence[LinePart]) -> None:
        self._line = line
        self._damped = [part for part in parts if overrides(part, "viscous_forces")]
        self._at, self._residual = at, np.zeros((line.length.size, 2 * line.ndof))
        self._put = Bound(put_residual, Packed(at), Packed(forces), Packed(self._residual))
        self._elements: Elements | None = None

    def residual(self) -> Array:
        """Sum over parts and groups (ne, 2 ndof); the same array each time."""
        self._put()
        return self._residual

    def section_forces(self, elements: Elements, state: State) -> Array:
        """Of the line whose elements these are, see `SectionForces.within`."""
        if self._elements is not elements:
            self._bind_sections(elements)
        self.residual()
        if self._damped:
            self._viscous[...] = viscous_residual(self._line, self._damped, state)
        self._put_sections()
        return self._sections.copy()

    def _bind_sections(self, elements: Elements) -> None:
        line, at, self._elements = self._line, self._at, elements
        maps = np.empty((line.nodes, 3, line.frames.dofs))
        frames = (NO_FRAMES, NO_FRAMES) if isinstance(at, PlanarConfiguration) else (at.frame1, at.frame2)
        viscous = np.zeros_like(self._residual) if self._damped else None
        given = section_input(line, elements, self._residual, viscous, at.x, maps, at.tangent, *frames)
        self._viscous, self._sections = given.viscous, np.empty(size_of(line.nodes))
        self._put_sections = in_turn(
            bound(put_moment_maps, at, Packed(np.ascontiguousarray(line.turning_axes)), Packed(maps)),
            Bound(put_section_forces, Packed(given), Packed(SectionForces.within(self._sections, line.nodes))),
        )


class AcceptedForces:
    """What the parts of a line put within its elements at an accepted state: workspace of its own beside that of the
    loop.

    placed: the line there; parts: with their numbers. whole: whether the loop's forces tell the same, where it has
    solved for the state: in the axes in which that step began, which parts with viscous forces don't know any more.
    forces: as found last.
    """

    def __init__(self, line: Line, placed: PlacedLine, parts: Sequence[tuple[LinePart, tuple[Any, ...]]]) -> None:
        self._placed = placed
        self.whole = not any(overrides(part, "viscous_forces") for part, _ in parts)
        out = forces_of(line)
        here, forces = Packed(placed.at), Packed(out)
        self._find = in_turn(
            Bound(clear, forces),
            *(bound(add_forces, numbers, here, forces) for _, numbers in parts),
        )
        self.forces = ElementForces(line, placed.at, out, [part for part, _ in parts])

    def found(self, state: State) -> ElementForces:
        """At an accepted state, to whose time the numbers have been brought."""
        self._placed.move(state)
        self._find()
        return self.forces


@njit
def put_residual(at: Configuration, forces: LineForces, out: Array) -> None:
    """Write the sum of all groups within the elements."""
    q = forces.inertia_q + forces.force_q + forces.end_q
    put_pulled_back(q, at.P, out, at.D, at.R)
    for e in range(out.shape[0]):
        for i in range(out.shape[1]):
            out[e, i] += forces.inertia_e[e, i] + forces.force_e[e, i]
