"""Strains and strain energy of a two-node element in space, with gradient and Hessian.

The ends of the element have turned from its frame by twists tau_i and swings (y_i, z_i), see
`corotation`. Between them the swing is the quadratic whose mean vanishes, since the frame follows the
chord, and the twist is linear:

    axial strain  l/L + bow(y) + bow(z), the mean over the element (see `beam2d`);
    twist         tau_2 - tau_1 + (y_1 z_2 - z_1 y_2)/2, as the plane of bending turns along the element;
    curvatures    (y', z') in the section's axes, which tau turns, at the two Gauss stations.

Where curvature and moment point different ways (unequal stiffnesses, curved unstressed shape), the
torque varies along the element by P = (curvature x moment)_x per length. The deviation of the twist from
the line between the ends that this causes is condensed, see below. All these terms
together make the element fourth-order accurate; without any of them it is second-order.

The strains do not change when the frame turns about the chord.

The strain energy is

    U = EA L axial^2 / 2 + GJ twist^2 / (2 L) + L/4 (sum of k.D k over both stations) - h P^2 L^3 / (24 GJ)

with all strains less those of the unstressed element, D = diag(EI_y, EI_z), and P = (mean curvature x mean
moment)_x, the torque rate. Without bending stiffness the first term is that of `tension_only`. The last one is what the
twist sets free that deviates from the line between the ends by
a (1 - 4 x^2/L^2), x from the middle. It is stiffened by GJ and, as it turns the curvature k, by k'.D k' with k' normal
to k; of both the least energy by a has

    h = 1 / (1 + (EI_z ky^2 + EI_y kz^2) L^2 / (10 GJ)).

As P^2 <= (k'.D k') (k.D k), k elastic, U stays positive: an element bent about its soft axis that is long for its
stiffness ratio would otherwise gain energy without end by bending about the stiff one.
"""

import math
from typing import NamedTuple

from riser_soil.core.compiled import njit
from riser_soil.riser.beam2d import bow, bow_slopes
from riser_soil.riser.stiffness import ElementStiffness, with_EA
from riser_soil.riser.tension_only import (
    pulled,
    stored,
    with_fold,
    with_fold_change,
    with_fold_energy,
)
from riser_soil.riser.vectors import Vec, add, dot, scale

ROOT3 = math.sqrt(3.0)
Pair = tuple[float, float]  # components along the second and third section axis


class Station(NamedTuple):
    """Section axes and curvature at a Gauss station."""

    cosine: float  # of the twist
    sine: float
    curvature: Pair


class Strain(NamedTuple):
    """Strains, or their change, of one element."""

    axial: float
    twist: float  # over the whole element, rad
    first: Pair  # curvature at the first Gauss station, 1/m
    second: Pair  # at the second
    bow: float  # part of the axial strain, in every configuration


class Stress(NamedTuple):
    """Derivatives of the strain energy by chord over length, twist, curvatures and bow."""

    axial: float
    twist: float
    first: Pair
    second: Pair
    bow: float


@njit
def _at_station(side: float, L: float, a: Vec, b: Vec) -> Vec:
    """(tau, y', z') at the first (side = -1) or second (+1) station; linear in the ends' angles a and b."""
    first, second = (side * ROOT3 - 1.0) / L, (side * ROOT3 + 1.0) / L
    tau = 0.5 * (a[0] + b[0]) + side / (2.0 * ROOT3) * (b[0] - a[0])
    return (tau, first * a[1] + second * b[1], first * a[2] + second * b[2])


@njit
def _to_ends(side: float, L: float, v: Vec) -> tuple[Vec, Vec]:
    """Transpose of `_at_station`."""
    first, second = (side * ROOT3 - 1.0) / L, (side * ROOT3 + 1.0) / L
    share = side / (2.0 * ROOT3)
    return (
        ((0.5 - share) * v[0], first * v[1], first * v[2]),
        ((0.5 + share) * v[0], second * v[1], second * v[2]),
    )


@njit
def _station(side: float, L: float, a: Vec, b: Vec) -> Station:
    tau, y, z = _at_station(side, L, a, b)
    c, s = math.cos(tau), math.sin(tau)
    return Station(c, s, (y * c + z * s, z * c - y * s))


@njit
def _curvature_change(at: Station, side: float, L: float, da: Vec, db: Vec) -> Pair:
    dtau, dy, dz = _at_station(side, L, da, db)
    ky, kz = at.curvature
    return dy * at.cosine + dz * at.sine + dtau * kz, dz * at.cosine - dy * at.sine - dtau * ky


@njit
def _station_force(at: Station, M: Pair) -> Vec:
    """Generalised force on (tau, y', z') of the moment pair M conjugate to the curvature."""
    ky, kz = at.curvature
    return (M[0] * kz - M[1] * ky, M[0] * at.cosine - M[1] * at.sine, M[0] * at.sine + M[1] * at.cosine)


@njit
def _station_force_change(at: Station, M: Pair, dtau: float, dk: Pair) -> Vec:
    """Change of `_station_force` at fixed M."""
    _, y, z = _station_force(at, M)
    return (M[0] * dk[1] - M[1] * dk[0], -dtau * z, dtau * y)


@njit
def stations(L: float, a: Vec, b: Vec) -> tuple[Station, Station]:
    """Both Gauss stations for the angles a and b of the ends."""
    return _station(-1.0, L, a, b), _station(1.0, L, a, b)


@njit
def strain(L: float, length: float, a: Vec, b: Vec, at: tuple[Station, Station]) -> Strain:
    """Strains for a chord of `length` and the ends' angles a and b; the axial one starts at 1."""
    bowed = bow(a[1], b[1]) + bow(a[2], b[2])
    twist = b[0] - a[0] + 0.5 * (a[1] * b[2] - a[2] * b[1])
    return Strain(length / L + bowed, twist, at[0].curvature, at[1].curvature, bowed)


@njit
def _gradients(a: Vec, b: Vec) -> tuple[Vec, Vec, Vec, Vec]:
    """Gradients by a and b of the axial strain and of the twist's quadratic part; all linear in (a, b)."""
    y1, y2 = bow_slopes(a[1], b[1])
    z1, z2 = bow_slopes(a[2], b[2])
    twist1, twist2 = (0.0, 0.5 * b[2], -0.5 * b[1]), (0.0, -0.5 * a[2], 0.5 * a[1])
    return (0.0, y1, z1), (0.0, y2, z2), twist1, twist2


@njit
def strain_change(L: float, a: Vec, b: Vec, at: tuple[Station, Station], stretch: float, da: Vec, db: Vec) -> Strain:
    """Change of `strain` when the chord lengthens by `stretch` and the angles change by da and db."""
    axial1, axial2, twist1, twist2 = _gradients(a, b)
    bowed = dot(axial1, da) + dot(axial2, db)
    twist = db[0] - da[0] + dot(twist1, da) + dot(twist2, db)
    first, second = _curvature_change(at[0], -1.0, L, da, db), _curvature_change(at[1], 1.0, L, da, db)
    return Strain(stretch / L + bowed, twist, first, second, bowed)


@njit
def _curvature_change_variation(at: Station, side: float, L: float, da: Vec, db: Vec, ea: Vec, eb: Vec) -> Pair:
    dtau, dy, dz = _at_station(side, L, da, db)
    etau = _at_station(side, L, ea, eb)[0]
    ky, kz = _curvature_change(at, side, L, ea, eb)
    return etau * (dz * at.cosine - dy * at.sine) + dtau * kz, -etau * (dy * at.cosine + dz * at.sine) - dtau * ky


@njit
def strain_change_variation(L: float, at: tuple[Station, Station], da: Vec, db: Vec, ea: Vec, eb: Vec) -> Strain:
    """Change of `strain_change` for da and db, kept fixed, when the angles change by ea and eb."""
    axial1, axial2, twist1, twist2 = _gradients(ea, eb)
    first = _curvature_change_variation(at[0], -1.0, L, da, db, ea, eb)
    second = _curvature_change_variation(at[1], 1.0, L, da, db, ea, eb)
    bowed = dot(axial1, da) + dot(axial2, db)
    return Strain(bowed, dot(twist1, da) + dot(twist2, db), first, second, bowed)


@njit
def conjugate(L: float, a: Vec, b: Vec, at: tuple[Station, Station], s: Stress) -> tuple[Vec, Vec]:
    """Generalised moments mu_1, mu_2 conjugate to the angles a and b, for the stresses s."""
    axial1, axial2, twist1, twist2 = _gradients(a, b)
    first1, first2 = _to_ends(-1.0, L, _station_force(at[0], s.first))
    second1, second2 = _to_ends(1.0, L, _station_force(at[1], s.second))
    end1 = add(scale(s.bow, axial1), scale(s.twist, add(twist1, (-1.0, 0.0, 0.0))))
    end2 = add(scale(s.bow, axial2), scale(s.twist, add(twist2, (1.0, 0.0, 0.0))))
    return add(end1, add(first1, second1)), add(end2, add(first2, second2))


@njit
def conjugate_change(
    L: float, at: tuple[Station, Station], s: Stress, change: Strain, da: Vec, db: Vec
) -> tuple[Vec, Vec]:
    """Change of `conjugate` at fixed stresses, for the change of the strains that da and db bring about."""
    axial1, axial2, twist1, twist2 = _gradients(da, db)
    dtau1, dtau2 = _at_station(-1.0, L, da, db)[0], _at_station(1.0, L, da, db)[0]
    first1, first2 = _to_ends(-1.0, L, _station_force_change(at[0], s.first, dtau1, change.first))
    second1, second2 = _to_ends(1.0, L, _station_force_change(at[1], s.second, dtau2, change.second))
    end1 = add(scale(s.bow, axial1), scale(s.twist, twist1))
    end2 = add(scale(s.bow, axial2), scale(s.twist, twist2))
    return add(end1, add(first1, second1)), add(end2, add(first2, second2))


@njit
def total(a: Strain, b: Strain) -> Strain:
    """a + b."""
    first = (a.first[0] + b.first[0], a.first[1] + b.first[1])
    second = (a.second[0] + b.second[0], a.second[1] + b.second[1])
    return Strain(a.axial + b.axial, a.twist + b.twist, first, second, a.bow + b.bow)


@njit
def difference(a: Strain, b: Strain) -> Strain:
    """a - b."""
    first = (a.first[0] - b.first[0], a.first[1] - b.first[1])
    second = (a.second[0] - b.second[0], a.second[1] - b.second[1])
    return Strain(a.axial - b.axial, a.twist - b.twist, first, second, a.bow - b.bow)


@njit
def _mean(s: Strain) -> Pair:
    return 0.5 * (s.first[0] + s.second[0]), 0.5 * (s.first[1] + s.second[1])


@njit
def _torque_rate(k: Pair, elastic: Pair, D: ElementStiffness) -> float:
    """P for the mean curvature k and its elastic part."""
    return k[0] * D.EI_z * elastic[1] - k[1] * D.EI_y * elastic[0]


@njit
def _torque_rate_slopes(k: Pair, elastic: Pair, D: ElementStiffness) -> Pair:
    """Derivatives of P by the mean curvature; linear in (k, elastic)."""
    return D.EI_z * elastic[1] - D.EI_y * k[1], D.EI_z * k[0] - D.EI_y * elastic[0]


@njit
def _twist_compliance(D: ElementStiffness) -> float:
    return D.L**3 / (12.0 * D.GJ)


@njit
def _share(k: Pair, D: ElementStiffness) -> float:
    """h for the mean curvature k."""
    return 1.0 / (1.0 + 0.1 * D.L**2 / D.GJ * (D.EI_z * k[0] ** 2 + D.EI_y * k[1] ** 2))


@njit
def _share_slopes(k: Pair, D: ElementStiffness, h: float) -> Pair:
    """Derivatives of h by the mean curvature."""
    by = -0.2 * D.L**2 / D.GJ * h**2
    return by * D.EI_z * k[0], by * D.EI_y * k[1]


@njit
def energy(D: ElementStiffness, total: Strain, elastic: Strain) -> float:
    """Strain energy U (J)."""
    U = D.L * with_fold_energy(D.law, D.EA * stored(D.law, elastic.axial), total.bow)
    U += 0.5 * D.GJ / D.L * elastic.twist**2
    U += 0.25 * D.L * D.EI_y * (elastic.first[0] ** 2 + elastic.second[0] ** 2)
    U += 0.25 * D.L * D.EI_z * (elastic.first[1] ** 2 + elastic.second[1] ** 2)
    k = _mean(total)
    return U - 0.5 * _twist_compliance(D) * _share(k, D) * _torque_rate(k, _mean(elastic), D) ** 2


@njit
def pulled_strain(D: ElementStiffness, elastic: Strain) -> tuple[Strain, ElementStiffness]:
    """The strains with N/EA for the axial one, and the stiffnesses for a change of them: `tension_only`."""
    axial, stiffness = pulled(D.law, elastic.axial)
    return Strain(axial, elastic.twist, elastic.first, elastic.second, elastic.bow), with_EA(D, stiffness * D.EA)


@njit
def linear_stress(D: ElementStiffness, elastic: Strain) -> Stress:
    """Stresses but for those of the torque rate."""
    y, z = 0.5 * D.L * D.EI_y, 0.5 * D.L * D.EI_z
    first, second = (
        (y * elastic.first[0], z * elastic.first[1]),
        (y * elastic.second[0], z * elastic.second[1]),
    )
    axial = D.EA * D.L * elastic.axial
    return Stress(axial, D.GJ / D.L * elastic.twist, first, second, axial)


@njit
def _less(s: Stress, moment: Pair, bow: float) -> Stress:
    """s with the moment taken off both stations, and another one that takes the bow out."""
    first = (s.first[0] - moment[0], s.first[1] - moment[1])
    second = (s.second[0] - moment[0], s.second[1] - moment[1])
    return Stress(s.axial, s.twist, first, second, bow)


@njit
def stress(D: ElementStiffness, total: Strain, elastic: Strain) -> Stress:
    """Gradient of U by the strains `total`, of which `elastic` exceeds the unstressed ones, the axial one N/EA."""
    k, e = _mean(total), _mean(elastic)
    linear = linear_stress(D, elastic)
    bow = D.L * with_fold(D.law, D.EA * elastic.axial, total.bow)
    return _less(linear, _twisting_moment(D, k, e), bow)


@njit
def _twisting_moment(D: ElementStiffness, k: Pair, e: Pair) -> Pair:
    """Share of the torque's rate P in the moment of each station, with the other sign."""
    P, h, half = _torque_rate(k, e, D), _share(k, D), 0.5 * _twist_compliance(D)
    (Py, Pz), (hy, hz) = _torque_rate_slopes(k, e, D), _share_slopes(k, D, h)
    return half * P * (h * Py + 0.5 * P * hy), half * P * (h * Pz + 0.5 * P * hz)


@njit
def stress_change(D: ElementStiffness, total: Strain, elastic: Strain, change: Strain) -> Stress:
    """Hessian of U times a change of the strains; D: stiffnesses for a change of them."""
    k, e, dk = _mean(total), _mean(elastic), _mean(change)
    P, h, half = _torque_rate(k, e, D), _share(k, D), 0.5 * _twist_compliance(D)
    (Py, Pz), (hy, hz) = _torque_rate_slopes(k, e, D), _share_slopes(k, D, h)
    dPy, dPz = _torque_rate_slopes(dk, dk, D)
    dP, dh = Py * dk[0] + Pz * dk[1], hy * dk[0] + hz * dk[1]
    bent = _share_slopes(dk, D, h)
    dhy, dhz = 2.0 * dh / h * hy + bent[0], 2.0 * dh / h * hz + bent[1]
    first = half * (dP * (h * Py + P * hy) + P * (dh * Py + h * dPy + 0.5 * P * dhy))
    second = half * (dP * (h * Pz + P * hz) + P * (dh * Pz + h * dPz + 0.5 * P * dhz))
    linear = linear_stress(D, change)
    return _less(linear, (first, second), with_fold_change(D.law, linear.bow, D.L, total.bow, change.bow))
