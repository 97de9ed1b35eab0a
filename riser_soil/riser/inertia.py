"""Inertia of the line in dynamic stages: the parts "inertia", a consistent mass, and "rotary inertia" of its sections.

In space an element's end has the rotary inertia tensor J [kg m2] in its node's body axes, where Euler's equations for
the angular velocity W and acceleration A give the moment

    m = J A + W x J W,

conjugate to the body-axes spin. With the node's frame R = Rn exp[Theta] that spin is T_R(Theta) dTheta, so that
T_L(Theta) m is conjugate to the rotation vector. Arrays of nodes: Theta, W, A (nn, 3); of ends: J (ne, 2, 3, 3).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.core.part import State, Traits, Weights
from riser_soil.riser.attachments import Masses
from riser_soil.riser.configuration import Configuration, Maps, PlanarConfiguration, SpatialConfiguration
from riser_soil.riser.directors import PlanarFrames
from riser_soil.riser.hermite import add_mass_to, add_weighed, consistent_mass
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import CompiledPart
from riser_soil.riser.part_kernels import LineForces, add_energy, add_forces, add_tangent
from riser_soil.riser.rotations import left_tangent, right_tangent_derivative
from riser_soil.riser.vectors import (
    Mat,
    Vec,
    add,
    cross,
    dot,
    matadd,
    matmul,
    matrix,
    matscale,
    matvec,
    scale,
    skew,
    vector,
)


class Mass(NamedTuple):
    """Mass matrices along the elements, M (ne, 4, 4) [kg], as in `hermite.weigh`; masses at the line's ends (2,)."""

    M: Array
    ends: Array


class Inertia(CompiledPart):
    """Consistent mass of the cubic line and of what is attached to it, turning with the tangents (group I).

    line: the riser's field. mass: kg/m per element (ne,), contents included, water excluded. attached: further masses.
    The section's own rotary inertia is left out: it is (diameter/wavelength)^2 of the rest.
    The tangent is not symmetric, as the tangents' accelerations depend on their rates.
    """

    name = "inertia"
    traits = Traits("I", symmetric=False)

    def __init__(self, line: Line, mass: Array, attached: Masses | None = None) -> None:
        super().__init__(line)
        along = consistent_mass(line.length, mass)
        ends: Array = np.zeros(2)
        if attached is not None:
            along, ends = along + attached.along, attached.ends
        self._mass = Mass(along, ends)

    @property
    def M(self) -> Array:
        """Mass matrices of the elements (ne, 4, 4), with what sits at the line's ends."""
        M = self._mass.M.copy()
        M[0, 0, 0] += self._mass.ends[0]
        M[-1, 2, 2] += self._mass.ends[1]
        return M

    def make_kernel_data(self) -> Mass:
        return self._mass

    def nodal_forces(self, state: State) -> Array | None:
        return self.forces_on_nodes(state) if self._mass.ends.any() else None


@add_forces.of(Mass)
def _add_forces(part: Mass, at: Configuration, out: LineForces) -> None:
    add_weighed(part.M, at.acceleration, out.inertia_q, at.D)
    add_forces_at_ends(part, at, out)


@njit
def add_forces_at_ends(part: Mass, at: Configuration, out: LineForces) -> None:
    """Add those of what sits at the line's ends."""
    last = at.a.shape[0] - 1
    for i in range(len(at.D)):
        out.inertia[0, i] += part.ends[0] * at.a[0, i]
        out.inertia[last, i] += part.ends[1] * at.a[last, i]


@add_tangent.of(Mass)
def _add_tangent(part: Mass, at: Configuration, maps: Maps, weights: Weights, K: Array) -> None:
    add_mass_to(K, weights.inertia, at.P, maps.acceleration_rows, part.M, at.D, at.R)
    add_tangent_at_ends(part, at, maps, weights, K)


@njit
def add_tangent_at_ends(part: Mass, at: Configuration, maps: Maps, weights: Weights, K: Array) -> None:
    """Add that of what sits at the line's ends."""
    follows, last, second = weights.inertia * weights.shift_a, K.shape[0] - 1, K.shape[1] // 2
    for i in range(len(at.D)):
        K[0, i, i] += follows * part.ends[0]
        K[last, second + i, second + i] += follows * part.ends[1]


@add_energy.of(Mass)
def _add_energy(part: Mass, at: Configuration, energy: Array) -> None:
    add_kinetic(part, at, at.rate, energy)


@njit
def add_kinetic(part: Mass, at: Configuration, rate: Array, energy: Array) -> None:
    """Add the kinetic energy of rates q' (ne, 4, d)."""
    last = at.v.shape[0] - 1
    for i in range(len(at.D)):
        energy[0] += 0.5 * (part.ends[0] * at.v[0, i] ** 2 + part.ends[1] * at.v[last, i] ** 2)
    for e in range(part.M.shape[0]):
        for i in range(len(at.D)):
            for a in range(4):
                momentum = 0.0
                for b in range(4):
                    momentum += part.M[e, a, b] * rate[e, b, i]
                energy[0] += 0.5 * rate[e, a, i] * momentum


class SpatialRotaryMass(NamedTuple):
    """Inertia tensors J (ne, 2, 3, 3) [kg m2] of element ends in body axes."""

    J: Array


class PlanarRotaryMass(NamedTuple):
    """Inertia (ne,) [kg m2] of each element end in the plane."""

    inertia: Array


class RotaryInertia(CompiledPart):
    """Rotary inertia of the sections, gathered at the nodes (group I).

    line: the riser's field. across: kg m per element (ne,) about an axis across the pipe (rho I of the section).
    polar: about the pipe's own axis, by default twice that, as of a round section; it counts in space only. Half of an
    element's belongs to each of its ends, so that its share in a frequency is second-order accurate.

    In the plane moments and tangent, linear there, cost 0.7 to 0.9 of those in space (`benchmarks.twins`).
    In space a line without polar inertia must not move: nothing but GJ would resist its spin, so that the scheme's
    weighting of moments at both ends of a step, which no inertia slows down, winds a soft pipe up.
    """

    name = "rotary inertia"

    def __init__(self, line: Line, across: Array, polar: Array | None = None) -> None:
        super().__init__(line)
        self.traits = Traits("I", symmetric=line.dimension == 2)
        self.across = 0.5 * line.length * across  # of ends, kg m2
        self.polar = 2.0 * self.across if polar is None else 0.5 * line.length * polar

    def on_directors(self) -> dict[int, Array]:
        """Masses [kg m2] of element ends (ne,) on the tangent (0) and the normals (1, 2) that have the same inertia.

        In space half the polar inertia sits on each normal, and on the tangent what the inertia across is more than
        that: zero for a round section, negative for one with polar inertia only.
        """
        if self.line.dimension == 2:
            return {1: self.across}
        half = 0.5 * self.polar
        masses: dict[int, Array] = {1: half, 2: half}
        on_tangent = self.across - half
        return {0: on_tangent} | masses if on_tangent.any() else masses

    def make_kernel_data(self) -> PlanarRotaryMass | SpatialRotaryMass:
        frames = self.line.frames
        if isinstance(frames, PlanarFrames):
            return PlanarRotaryMass(self.across)
        return _in_space(self.across, self.polar, frames.T0)


def _in_space(across: Array, polar: Array, T0: Array) -> SpatialRotaryMass:
    """Inertia of each element end about an axis across the pipe and about its own; T0: unstressed frames there."""
    about_axes = np.stack([polar, across, across], axis=1)[:, None, None, :]
    return SpatialRotaryMass(np.ascontiguousarray(T0 * about_axes @ np.swapaxes(T0, 2, 3)))


@add_forces.of(SpatialRotaryMass)
def _spatial_forces(part: SpatialRotaryMass, at: SpatialConfiguration, out: LineForces) -> None:
    W, A = at.v[:, 3:], at.a[:, 3:]
    for e in range(part.J.shape[0]):
        for side in range(2):
            moment = _end_moment(part.J, e, side, at.Theta, W, A)
            for i in range(3):
                out.inertia_e[e, 6 * side + 3 + i] += moment[i]


@add_tangent.of(SpatialRotaryMass)
def _spatial_tangent(
    part: SpatialRotaryMass, at: SpatialConfiguration, maps: Maps, weights: Weights, K: Array
) -> None:
    W, A = at.v[:, 3:], at.a[:, 3:]
    _add_moments_tangent(K, weights.inertia, part.J, at.Theta, W, A, weights.shift_v, weights.shift_a)


@add_forces.of(PlanarRotaryMass)
def _planar_forces(part: PlanarRotaryMass, at: PlanarConfiguration, out: LineForces) -> None:
    for e in range(part.inertia.size):
        for side in range(2):
            out.inertia_e[e, 3 * side + 2] += part.inertia[e] * at.a[e + side, 2]


@add_tangent.of(PlanarRotaryMass)
def _planar_tangent(
    part: PlanarRotaryMass, at: PlanarConfiguration, maps: Maps, weights: Weights, K: Array
) -> None:
    for e in range(part.inertia.size):
        for side in range(2):
            K[e, 2 + 3 * side, 2 + 3 * side] += weights.inertia * weights.shift_a * part.inertia[e]


@add_energy.of(SpatialRotaryMass)
def _spatial_energy(part: SpatialRotaryMass, at: SpatialConfiguration, energy: Array) -> None:
    energy[0] += _kinetic_energy(part.J, at.v[:, 3:])


@add_energy.of(PlanarRotaryMass)
def _planar_energy(part: PlanarRotaryMass, at: PlanarConfiguration, energy: Array) -> None:
    for e in range(part.inertia.size):
        energy[0] += 0.5 * part.inertia[e] * (at.v[e, 2] ** 2 + at.v[e + 1, 2] ** 2)


@njit
def _moment(J: Mat, W: Vec, A: Vec) -> Vec:
    return add(matvec(J, A), cross(W, matvec(J, W)))


@njit
def _moment_derivative(J: Mat, W: Vec, shift_v: float, shift_a: float) -> Mat:
    """dm/dTheta, the rates following by the shifts."""
    gyroscopic = matadd(matmul(skew(W), J), matscale(-1.0, skew(matvec(J, W))))
    return matadd(matscale(shift_a, J), matscale(shift_v, gyroscopic))


@njit
def _end_moment(J: Array, e: int, side: int, Theta: Array, W: Array, A: Array) -> Vec:
    """Residual conjugate to the rotation vector of an end."""
    n = e + side
    m = _moment(matrix(J[e, side]), vector(W[n]), vector(A[n]))
    return matvec(left_tangent(vector(Theta[n])), m)


@njit
def _add_moments_tangent(
    K: Array, weight: float, J: Array, Theta: Array, W: Array, A: Array, shift_v: float, shift_a: float
) -> None:
    """Add weight times the derivative of the ends' moments to K (ne, 12, 12)."""
    for e in range(J.shape[0]):
        for side in range(2):
            n, at, tensor = e + side, 3 + 6 * side, matrix(J[e, side])
            rotation, spin = vector(Theta[n]), vector(W[n])
            m = _moment(tensor, spin, vector(A[n]))
            turning = matscale(-1.0, right_tangent_derivative(scale(-1.0, rotation), m))  # T_L(x) = T_R(-x)
            rates = matmul(left_tangent(rotation), _moment_derivative(tensor, spin, shift_v, shift_a))
            change = matadd(turning, rates)
            for i in range(3):
                for j in range(3):
                    K[e, at + i, at + j] += weight * change[i][j]


@njit
def _kinetic_energy(J: Array, W: Array) -> float:
    """Kinetic energy [J] of all ends."""
    twice = 0.0
    for e in range(J.shape[0]):
        for side in range(2):
            spin = vector(W[e + side])
            twice += dot(spin, matvec(matrix(J[e, side]), spin))
    return 0.5 * twice
