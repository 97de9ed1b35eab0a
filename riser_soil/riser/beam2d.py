"""Two-node corotational Euler-Bernoulli elements in a vertical plane: forces and tangent from one energy.

They are those of `beam3d` in a plane, at less than half of its cost (`benchmarks.twins`), with in-plane coordinates (p,
z) and angles positive from p to z. An element sees its chord x2 - x1 (m) and the directions of the section tangents at
its ends (rad). The chord's length l and the angles theta_i from the chord to the tangents store

    U = EA L strain^2 / 2 + bending,

with the shallow-arch strain of `bending_energy`. Forces (N) and moments (N m) are ordered p1, z1, moment1, p2,
z2, moment2; they are internal, and the tangent is the symmetric Hessian of U. Nodes may turn without
limit; only theta_i must stay below pi.

In the strain energy the end rotations a and b (rad) are measured from the chord. Bending follows from the cubic
deflection; half its square slope, averaged over the element, is the shallow-arch term of the axial strain

    strain = (l - l0)/L + bow(a, b) - bow(a0, b0),    bow(a, b) = (2 a^2 - a b + 2 b^2)/30,

which makes the two-node element fourth-order accurate on curved lines. Elements without bending stiffness go slack
instead of bearing compression: their axial energy is that of `tension_only`.
Source: Crisfield, Non-linear Finite Element Analysis of Solids and Structures, vol. 1 (1991), chapter 7.

A uniform load w per unstressed length L has an energy, too. As the element bows from its chord by the cubic with
theta_1 and theta_2, the load has, with its component w.n across the chord, the potential

    V = -w.(x1 + x2) L/2 - (theta_1 - theta_2) w.n L^2/12

theta_1 - theta_2 does not change as the chord turns, so V depends on the chord by its direction alone.
"""

import math
from typing import Generic, NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.riser.stiffness import ElementStiffness, LineStiffness, Number, of_element, with_EA
from riser_soil.riser.tension_only import (
    Heaped,
    pulled,
    set_spring_forces,
    set_spring_tangent,
    spring_energy,
    stored,
    with_fold,
    with_fold_change,
    with_fold_energy,
)

Vec2 = tuple[float, float]


class PlanarReference(NamedTuple, Generic[Number]):
    """Unstressed configuration: of all elements of a line, each (ne,), or of one of them."""

    l0: Number  # chord length, m
    theta1: Number  # angles from the chord to the tangents at the ends, rad
    theta2: Number


LineReference = PlanarReference[Array]
ElementReference = PlanarReference[float]


class PlanarCorotated(NamedTuple):
    """Configuration of one element in its own frame."""

    axis: Vec2  # unit vector along the chord
    length: float  # chord, m
    theta1: float
    theta2: float


class PlanarNodalForces(NamedTuple):
    """Force on node 2 (node 1 gets its opposite), along and across the chord, and moments on both nodes."""

    force: Vec2
    moment1: float
    moment2: float


@njit
def _without_turns(angle: float) -> float:
    """An angle less its whole turns, in [-pi, pi)."""
    return angle - 2.0 * math.pi * math.floor(0.5 * angle / math.pi + 0.5)


@njit
def corotate(chord: Array, direction1: float, direction2: float) -> PlanarCorotated:
    """The element in the frame of its chord, by the directions of its ends' tangents."""
    length = math.sqrt(chord[0] * chord[0] + chord[1] * chord[1])
    axis, angle = (chord[0] / length, chord[1] / length), math.atan2(chord[1], chord[0])
    return PlanarCorotated(axis, length, _without_turns(direction1 - angle), _without_turns(direction2 - angle))


@njit
def reference(chord0: Array, direction0_1: Array, direction0_2: Array) -> LineReference:
    """Unstressed configuration from chords (ne, 2) and tangent directions (each (ne,))."""
    ne = len(chord0)
    l0, theta1, theta2 = np.empty(ne), np.empty(ne), np.empty(ne)
    for e in range(ne):
        at = corotate(chord0[e], direction0_1[e], direction0_2[e])
        l0[e], theta1[e], theta2[e] = at.length, at.theta1, at.theta2
    return PlanarReference(l0, theta1, theta2)


@njit
def _unstressed(ref: LineReference, e: int) -> ElementReference:
    """The unstressed configuration of element e."""
    return PlanarReference(ref.l0[e], ref.theta1[e], ref.theta2[e])


@njit
def _strain(D: ElementStiffness, rest: ElementReference, at: PlanarCorotated) -> float:
    return (at.length - rest.l0) / D.L + bow(at.theta1, at.theta2) - bow(rest.theta1, rest.theta2)


@njit
def _stress(
    D: ElementStiffness, rest: ElementReference, at: PlanarCorotated, strain: float
) -> tuple[float, float, float]:
    """Derivatives of U by the chord's length and by theta_1 and theta_2; strain: N/EA."""
    N = D.EA * strain
    m1, m2 = end_moments(D, at.theta1 - rest.theta1, at.theta2 - rest.theta2)
    slope1, slope2 = bow_slopes(at.theta1, at.theta2)
    straightening = D.L * with_fold(D.law, N, bow(at.theta1, at.theta2))
    return N, m1 + straightening * slope1, m2 + straightening * slope2


@njit
def _elastic_variation(
    D: ElementStiffness, at: PlanarCorotated, N: float, stretch: float, dtheta1: float, dtheta2: float
) -> tuple[float, float, float]:
    """Variation of `_stress`, by `stress_variation`."""
    slope1, slope2 = bow_slopes(at.theta1, at.theta2)
    bowed, change = bow(at.theta1, at.theta2), slope1 * dtheta1 + slope2 * dtheta2
    both = with_fold(D.law, N, bowed)
    dN, dm1, dm2 = stress_variation(D, at, both, stretch, dtheta1, dtheta2)
    dm1 = with_fold_change(D.law, dm1, D.L * slope1, bowed, change)
    return dN, dm1, with_fold_change(D.law, dm2, D.L * slope2, bowed, change)


@njit
def stress_variation(
    D: ElementStiffness, at: PlanarCorotated, N: float, stretch: float, dtheta1: float, dtheta2: float
) -> tuple[float, float, float]:
    """Variation of the stresses: the Hessian of U times a variation of the chord's length and of theta_i."""
    slope1, slope2 = bow_slopes(at.theta1, at.theta2)
    dN = D.EA * (stretch / D.L + slope1 * dtheta1 + slope2 * dtheta2)
    dm1, dm2 = end_moments(D, dtheta1, dtheta2)
    dslope1, dslope2 = bow_slopes(dtheta1, dtheta2)
    dm1 += D.L * (dN * slope1 + N * dslope1)
    dm2 += D.L * (dN * slope2 + N * dslope2)
    return dN, dm1, dm2


@njit
def element_energy(e: int, at: PlanarCorotated, ref: LineReference, line: LineStiffness) -> float:
    """Strain energy [J] of element e."""
    D, rest = of_element(line, e), _unstressed(ref, e)
    phi1, phi2 = at.theta1 - rest.theta1, at.theta2 - rest.theta2
    m1, m2 = end_moments(D, phi1, phi2)
    axial = D.EA * stored(D.law, _strain(D, rest, at))
    axial = with_fold_energy(D.law, axial, bow(at.theta1, at.theta2))
    return D.L * axial + 0.5 * (m1 * phi1 + m2 * phi2)


@njit
def nodal_forces(at: PlanarCorotated, N: float, m1: float, m2: float) -> PlanarNodalForces:
    """Nodal forces from the chord force N and the moments m_i conjugate to theta_i."""
    return PlanarNodalForces((N, -(m1 + m2) / at.length), m1, m2)


@njit
def write_forces(axis: Vec2, forces: PlanarNodalForces, out: Array) -> None:
    """Write an element's forces, given along its frame, to `out` (6,) in the plane's axes."""
    along, across = forces.force
    p, z = axis[0] * along - axis[1] * across, axis[1] * along + axis[0] * across
    out[0], out[1], out[2] = -p, -z, forces.moment1
    out[3], out[4], out[5] = p, z, forces.moment2


@njit
def write_element_forces(e: int, at: PlanarCorotated, ref: LineReference, line: LineStiffness, f: Array) -> None:
    """Write internal forces f (6,) of element e."""
    D, rest = of_element(line, e), _unstressed(ref, e)
    strain, _ = pulled(D.law, _strain(D, rest, at))
    N, m1, m2 = _stress(D, rest, at, strain)
    write_forces(at.axis, nodal_forces(at, N, m1, m2), f)


@njit
def configuration_variation(at: PlanarCorotated, force: Vec2, stretch: float, spin: float) -> Vec2:
    """Variation of the force on node 2 at fixed N and m_i: the chord lengthens by `stretch` and spins."""
    return -spin * force[1], spin * force[0] - stretch / at.length * force[1]


@njit
def _vary(
    D: ElementStiffness, at: PlanarCorotated, N: float, force: Vec2, u: Vec2, w1: float, w2: float
) -> PlanarNodalForces:
    """Variation of an element's forces when its nodes move by u = u2 - u1, in its axes, and turn by w_i."""
    stretch, spin = u[0], u[1] / at.length
    dN, dm1, dm2 = _elastic_variation(D, at, N, stretch, w1 - spin, w2 - spin)
    change = nodal_forces(at, dN, dm1, dm2)
    geometric = configuration_variation(at, force, stretch, spin)
    total = (change.force[0] + geometric[0], change.force[1] + geometric[1])
    return PlanarNodalForces(total, change.moment1, change.moment2)


@njit
def _tangent(D: ElementStiffness, at: PlanarCorotated, N: float, force: Vec2, K: Array) -> None:
    """Write the tangent of an element, its stiffnesses for a change of strains, column by column to K (6, 6)."""
    c, s = at.axis
    still = (0.0, 0.0)
    write_forces(at.axis, _vary(D, at, N, force, (c, -s), 0.0, 0.0), K[:, 3])
    write_forces(at.axis, _vary(D, at, N, force, (s, c), 0.0, 0.0), K[:, 4])
    write_forces(at.axis, _vary(D, at, N, force, still, 1.0, 0.0), K[:, 2])
    write_forces(at.axis, _vary(D, at, N, force, still, 0.0, 1.0), K[:, 5])
    for i in range(6):
        K[i, 0], K[i, 1] = -K[i, 3], -K[i, 4]


@njit
def write_element(
    e: int, at: PlanarCorotated, ref: LineReference, line: LineStiffness, f: Array, K: Array
) -> None:
    """Write internal forces f (6,) of element e and their derivative K (6, 6) by displacements and angles."""
    D, rest = of_element(line, e), _unstressed(ref, e)
    strain, stiffness = pulled(D.law, _strain(D, rest, at))
    N, m1, m2 = _stress(D, rest, at, strain)
    response = nodal_forces(at, N, m1, m2)
    write_forces(at.axis, response, f)
    _tangent(with_EA(D, stiffness * D.EA), at, N, response.force, K)


@njit
def bow(a: float, b: float) -> float:
    """Half the mean square slope of the deflection from the chord."""
    return (2.0 * a * a - a * b + 2.0 * b * b) / 30.0


@njit
def bow_slopes(a: float, b: float) -> tuple[float, float]:
    """Derivatives of `bow` by a and b; linear, so they map variations too."""
    return (4.0 * a - b) / 30.0, (4.0 * b - a) / 30.0


@njit
def end_moments(D: ElementStiffness, a: float, b: float) -> tuple[float, float]:
    """Moments (N m) conjugate to the end rotations a and b of a cubic deflection."""
    EI_per_L = D.EI_y / D.L
    return EI_per_L * (4.0 * a + 2.0 * b), EI_per_L * (2.0 * a + 4.0 * b)


@njit
def _load_in_axes(at: PlanarCorotated, w: Array) -> tuple[float, float]:
    """The load along the chord and across it."""
    c, s = at.axis
    return c * w[0] + s * w[1], c * w[1] - s * w[0]


@njit
def load_potential(at: PlanarCorotated, L: float, w: Array, middle_p: float, middle_z: float) -> float:
    """V [J] of one element, its middle (x1 + x2)/2 at (p, z) [m]."""
    _, across = _load_in_axes(at, w)
    return -L * (w[0] * middle_p + w[1] * middle_z) - L * L / 12.0 * (at.theta1 - at.theta2) * across


@njit
def add_load_forces(at: PlanarCorotated, L: float, w: Array, f: Array) -> None:
    """Add the residual of one element to f (6,)."""
    along, across = _load_in_axes(at, w)
    twelfth = L * L / 12.0
    spun = twelfth * (at.theta1 - at.theta2) * along / at.length  # by the chord's turning, over its length
    p, z = -spun * at.axis[1], spun * at.axis[0]
    f[0] -= 0.5 * L * w[0] + p
    f[1] -= 0.5 * L * w[1] + z
    f[2] -= twelfth * across
    f[3] -= 0.5 * L * w[0] - p
    f[4] -= 0.5 * L * w[1] - z
    f[5] += twelfth * across


@njit
def add_load_tangent(at: PlanarCorotated, L: float, w: Array, K: Array) -> None:
    """Add the derivative of the residual of one element to K (6, 6)."""
    along, across = _load_in_axes(at, w)
    c, s = at.axis
    twelfth, spread = L * L / 12.0, at.theta1 - at.theta2
    bend = twelfth * spread / (at.length * at.length)
    even, odd = bend * across, bend * along  # by n n and by (e n + n e) of the chord's unit vector e and its normal n
    pp = even * s * s + 2.0 * odd * c * s
    zz = even * c * c - 2.0 * odd * c * s
    pz = -even * c * s - odd * (c * c - s * s)
    turned = twelfth * along / at.length
    for end in range(2):
        sign = 2 * end - 1.0
        for other in range(2):
            both, i, j = sign * (2 * other - 1.0), 3 * end, 3 * other
            K[i, j] += both * pp
            K[i, j + 1] += both * pz
            K[i + 1, j] += both * pz
            K[i + 1, j + 1] += both * zz
            mixed = -both * turned
            K[i, j + 2] += mixed * -s
            K[i + 1, j + 2] += mixed * c
            K[j + 2, i] += mixed * -s
            K[j + 2, i + 1] += mixed * c


@njit
def heaped_energy(at: Heaped, chord: Array, direction1: float, direction2: float, L: float) -> float:
    """Energy [J] of an element in a heap: `tension_only`."""
    return spring_energy(at, chord) + 0.5 * at.stiffness * L * L * (1.0 - math.cos(direction2 - direction1))


@njit
def heaped_load_potential(direction1: float, direction2: float, L: float, w: Array) -> float:
    """Potential [J] of a load w per length (2,) [N/m] on its bow."""
    p, z = math.cos(direction1) - math.cos(direction2), math.sin(direction1) - math.sin(direction2)
    return -L * L / 12.0 * (w[0] * p + w[1] * z)


@njit
def write_heaped_forces(
    at: Heaped, chord: Array, direction1: float, direction2: float, L: float, w: Array, f: Array
) -> None:
    """Write the forces f (6,) of both, and of the load on the nodes."""
    set_spring_forces(at, chord, L, w, f)
    turn = 0.5 * at.stiffness * L * L * math.sin(direction2 - direction1)
    f[2] = -turn - L * L / 12.0 * (w[1] * math.cos(direction1) - w[0] * math.sin(direction1))
    f[5] = turn + L * L / 12.0 * (w[1] * math.cos(direction2) - w[0] * math.sin(direction2))


@njit
def write_heaped_tangent(at: Heaped, direction1: float, direction2: float, L: float, w: Array, K: Array) -> None:
    """Write their derivative K (6, 6)."""
    set_spring_tangent(at, 2, K)
    turn = 0.5 * at.stiffness * L * L * math.cos(direction2 - direction1)
    K[2, 2] = turn + L * L / 12.0 * (w[0] * math.cos(direction1) + w[1] * math.sin(direction1))
    K[5, 5] = turn - L * L / 12.0 * (w[0] * math.cos(direction2) + w[1] * math.sin(direction2))
    K[2, 5] = K[5, 2] = -turn
