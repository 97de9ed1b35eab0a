"""Two-node corotational Euler-Bernoulli elements in space: forces and tangent from one energy.

An element sees its chord x2 - x1 (m) and the section frames T1, T2 at its ends (columns: tangent, second
and third section axis). In the frame of `corotation` the chord's length l and the rotation vectors
theta_i of the ends store

    U = EA L strain^2 / 2 + bending about the second and the third axis + GJ twist^2 / (2 L),

with the shallow-arch strain of `bending`. Forces (N) and moments (N m) are ordered force1, moment1,
force2, moment2, in global axes; they are internal and conjugate to displacements and spatial spins, by
which the tangent differentiates them. `increments` turns both into those of rotation vectors, where the
tangent is the symmetric Hessian of U. Nodes may turn without limit; only theta_i must stay below pi.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from riser_soil.arrays import Array
from riser_soil.riser.bending import bow, bow_slopes, end_moments
from riser_soil.riser.corotation import (
    Corotated,
    NodalForces,
    axis_variation,
    configuration_variation,
    corotate,
    frame_spin,
    nodal_forces,
    plus,
    turn,
)
from riser_soil.riser.rotations import (
    left_tangent_inverse,
    right_tangent_inverse_derivative,
)
from riser_soil.riser.vectors import (
    Mat,
    Vec,
    add,
    dot,
    matrix,
    matvec,
    scale,
    sub,
    vecmat,
    vector,
)

STILL = (0.0, 0.0, 0.0)


class Section(NamedTuple):
    """Section stiffnesses of the elements, each of shape (ne,)."""

    EA: Array  # N
    EIy: Array  # N m2, bending about the second section axis
    EIz: Array  # N m2, bending about the third section axis
    GJ: Array  # N m2


class Reference(NamedTuple):
    """Unstressed configuration of the elements."""

    L: Array  # (ne,) arc length, m
    l0: Array  # (ne,) chord length, m
    theta1: Array  # (ne, 3) rotation vectors from the element's frame to the section frames of the ends, rad
    theta2: Array  # (ne, 3)


class Element(NamedTuple):
    """Stiffnesses and unstressed configuration of one element."""

    L: float
    EA: float
    EIy_per_L: float
    EIz_per_L: float
    GJ_per_L: float
    l0: float
    theta1: Vec
    theta2: Vec


class Tangents(NamedTuple):
    """Maps at one end: the spin w_i - omega to the variation of theta_i, and that to m_i at fixed mu_i."""

    rate: Mat  # T_L^-1(theta_i)
    geometric: Mat  # d(T_L^-T(theta_i) mu_i)/dtheta_i


class Response(NamedTuple):
    """What the variation of an element's forces needs besides its configuration, in the element's frame."""

    N: float
    twisting: float  # moment of m_1 + m_2 about the chord, N m
    forces: NodalForces
    end1: Tangents
    end2: Tangents


@njit(cache=True)
def reference(chord0: Array, T0_1: Array, T0_2: Array, L: Array) -> Reference:
    """Unstressed configuration from chords (ne, 3), end frames (ne, 3, 3) and arc lengths (ne,)."""
    ne = len(L)
    l0, theta1, theta2 = np.empty(ne), np.empty((ne, 3)), np.empty((ne, 3))
    for e in range(ne):
        at = corotate(vector(chord0[e]), matrix(T0_1[e]), matrix(T0_2[e]))
        l0[e], theta1[e], theta2[e] = at.length, at.theta1, at.theta2
    return Reference(L, l0, theta1, theta2)


@njit(cache=True)
def _element(ref: Reference, section: Section, e: int) -> Element:
    L = ref.L[e]
    return Element(
        L,
        section.EA[e],
        section.EIy[e] / L,
        section.EIz[e] / L,
        section.GJ[e] / L,
        ref.l0[e],
        vector(ref.theta1[e]),
        vector(ref.theta2[e]),
    )


@njit(cache=True)
def _arch(theta1: Vec, theta2: Vec) -> float:
    """Shallow-arch strain of both bending planes."""
    return bow(theta1[1], theta2[1]) + bow(theta1[2], theta2[2])


@njit(cache=True)
def _arch_slopes(theta1: Vec, theta2: Vec) -> tuple[Vec, Vec]:
    """Gradient of `_arch`, which is linear in the rotations."""
    y1, y2 = bow_slopes(theta1[1], theta2[1])
    z1, z2 = bow_slopes(theta1[2], theta2[2])
    return (0.0, y1, z1), (0.0, y2, z2)


@njit(cache=True)
def _strain(element: Element, at: Corotated) -> float:
    stretch = (at.length - element.l0) / element.L
    return stretch + _arch(at.theta1, at.theta2) - _arch(element.theta1, element.theta2)


@njit(cache=True)
def _elastic_moments(element: Element, phi1: Vec, phi2: Vec) -> tuple[Vec, Vec]:
    """Moments of bending and torsion for the rotations phi_i from the unstressed shape; linear."""
    x = element.GJ_per_L * (phi2[0] - phi1[0])
    y1, y2 = end_moments(element.EIy_per_L, phi1[1], phi2[1])
    z1, z2 = end_moments(element.EIz_per_L, phi1[2], phi2[2])
    return (-x, y1, z1), (x, y2, z2)


@njit(cache=True)
def _stress(element: Element, at: Corotated) -> tuple[float, Vec, Vec]:
    """Derivatives of U by the chord's length and by theta_1 and theta_2."""
    N = element.EA * _strain(element, at)
    mu1, mu2 = _elastic_moments(element, sub(at.theta1, element.theta1), sub(at.theta2, element.theta2))
    slopes1, slopes2 = _arch_slopes(at.theta1, at.theta2)
    return N, add(mu1, scale(N * element.L, slopes1)), add(mu2, scale(N * element.L, slopes2))


@njit(cache=True)
def _stress_variation(
    element: Element, at: Corotated, N: float, stretch: float, dtheta1: Vec, dtheta2: Vec
) -> tuple[float, Vec, Vec]:
    """Variation of `_stress`: the Hessian of U times a variation of the chord's length and of theta_i."""
    slopes1, slopes2 = _arch_slopes(at.theta1, at.theta2)
    dN = element.EA * (stretch / element.L + dot(slopes1, dtheta1) + dot(slopes2, dtheta2))
    dmu1, dmu2 = _elastic_moments(element, dtheta1, dtheta2)
    dslopes1, dslopes2 = _arch_slopes(dtheta1, dtheta2)
    arch1 = add(scale(dN * element.L, slopes1), scale(N * element.L, dslopes1))
    arch2 = add(scale(dN * element.L, slopes2), scale(N * element.L, dslopes2))
    return dN, add(dmu1, arch1), add(dmu2, arch2)


@njit(cache=True)
def _configure(chord: Array, frame1: Array, frame2: Array, e: int) -> Corotated:
    return corotate(vector(chord[e]), matrix(frame1[e]), matrix(frame2[e]))


@njit(cache=True)
def strain_energy(chord: Array, frame1: Array, frame2: Array, ref: Reference, section: Section) -> Array:
    """Strain energy U (ne,) in J; arguments as in `forces`."""
    U = np.empty(len(chord))
    for e in range(len(chord)):
        element = _element(ref, section, e)
        at = _configure(chord, frame1, frame2, e)
        phi1, phi2 = sub(at.theta1, element.theta1), sub(at.theta2, element.theta2)
        mu1, mu2 = _elastic_moments(element, phi1, phi2)
        U[e] = 0.5 * (element.EA * element.L * _strain(element, at) ** 2 + dot(mu1, phi1) + dot(mu2, phi2))
    return U


@njit(cache=True)
def _put_forces(axes: Mat, forces: NodalForces, out: Array) -> None:
    """Write an element's forces, given along its frame, to `out` (12,) in global axes."""
    force = vecmat(forces.force, axes)
    moment1 = vecmat(forces.moment1, axes)
    moment2 = vecmat(forces.moment2, axes)
    for i in range(3):
        out[i] = -force[i]
        out[3 + i] = moment1[i]
        out[6 + i] = force[i]
        out[9 + i] = moment2[i]


@njit(cache=True)
def forces(chord: Array, frame1: Array, frame2: Array, ref: Reference, section: Section) -> Array:
    """Internal forces f (ne, 12) for chords (ne, 3) and section frames (ne, 3, 3) of both ends."""
    f = np.empty((len(chord), 12))
    for e in range(len(chord)):
        at = _configure(chord, frame1, frame2, e)
        N, mu1, mu2 = _stress(_element(ref, section, e), at)
        m1 = vecmat(mu1, left_tangent_inverse(at.theta1))
        m2 = vecmat(mu2, left_tangent_inverse(at.theta2))
        _put_forces(at.axes, nodal_forces(at, N, m1, m2), f[e])
    return f


@njit(cache=True)
def _respond(element: Element, at: Corotated) -> Response:
    N, mu1, mu2 = _stress(element, at)
    end1 = Tangents(left_tangent_inverse(at.theta1), right_tangent_inverse_derivative(at.theta1, mu1))
    end2 = Tangents(left_tangent_inverse(at.theta2), right_tangent_inverse_derivative(at.theta2, mu2))
    m1, m2 = vecmat(mu1, end1.rate), vecmat(mu2, end2.rate)
    return Response(N, m1[0] + m2[0], nodal_forces(at, N, m1, m2), end1, end2)


@njit(cache=True)
def _moment_variation(end: Tangents, dmu: Vec, dtheta: Vec) -> Vec:
    """Variation of m_i = T_L^-T(theta_i) mu_i."""
    return add(vecmat(dmu, end.rate), matvec(end.geometric, dtheta))


@njit(cache=True)
def _vary(element: Element, at: Corotated, response: Response, u: Vec, w1: Vec, w2: Vec) -> NodalForces:
    """Variation of an element's forces when its nodes move by u = u2 - u1 and spin by w1, w2."""
    spin = frame_spin(at, u, w1, w2)
    relative1, relative2 = sub(w1, spin), sub(w2, spin)
    dtheta1, dtheta2 = matvec(response.end1.rate, relative1), matvec(response.end2.rate, relative2)
    dN, dmu1, dmu2 = _stress_variation(element, at, response.N, u[0], dtheta1, dtheta2)
    dm1 = _moment_variation(response.end1, dmu1, dtheta1)
    dm2 = _moment_variation(response.end2, dmu2, dtheta2)
    dq1, dq2 = axis_variation(at, relative1, relative2)
    configuration = configuration_variation(at, response.twisting, response.forces.force, u[0], dq1, dq2)
    change = plus(nodal_forces(at, dN, dm1, dm2), configuration)
    return plus(change, turn(response.forces, spin))


@njit(cache=True)
def _tangent(element: Element, at: Corotated, response: Response, K: Array) -> None:
    """Write the element's tangent, column by column, to K (12, 12)."""
    for k in range(3):
        unit = (at.axes[0][k], at.axes[1][k], at.axes[2][k])
        _put_forces(at.axes, _vary(element, at, response, STILL, unit, STILL), K[:, 3 + k])
        _put_forces(at.axes, _vary(element, at, response, STILL, STILL, unit), K[:, 9 + k])
        _put_forces(at.axes, _vary(element, at, response, unit, STILL, STILL), K[:, 6 + k])
        for i in range(12):
            K[i, k] = -K[i, 6 + k]


@njit(cache=True)
def forces_and_tangent(
    chord: Array, frame1: Array, frame2: Array, ref: Reference, section: Section
) -> tuple[Array, Array]:
    """Internal forces f (ne, 12) and their derivative K (ne, 12, 12) by displacements and spatial spins."""
    f, K = np.empty((len(chord), 12)), np.empty((len(chord), 12, 12))
    for e in range(len(chord)):
        element, at = _element(ref, section, e), _configure(chord, frame1, frame2, e)
        response = _respond(element, at)
        _put_forces(at.axes, response.forces, f[e])
        _tangent(element, at, response, K[e])
    return f, K
