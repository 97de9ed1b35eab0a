"""Strain energy of a two-node element in space, its gradient and its Hessian by the strains of `strain3d`.

    U = EA L axial^2 / 2 + GJ twist^2 / (2 L) + L/4 (sum of k.D k over both stations) - h P^2 L^3 / (24 GJ)

with all strains less those of the unstressed element, D = diag(EIy, EIz), and P = (mean curvature x mean
moment)_x, the torque rate. The last term is what the twist sets free that deviates from the line between the ends by
a (1 - 4 x^2/L^2), x from the middle. It is stiffened by GJ and, as it turns the curvature k, by k'.D k' with k' normal
to k; of both the least energy by a has

    h = 1 / (1 + (EIz ky^2 + EIy kz^2) L^2 / (10 GJ)).

As P^2 <= (k'.D k') (k.D k), k elastic, U stays positive: an element bent about its soft axis that is long for its
stiffness ratio would otherwise gain energy without end by bending about the stiff one.
"""


from riser_soil.core.compiled import njit
from riser_soil.riser.strain3d import Pair, Stiffness, Strain, Stress


@njit
def _mean(s: Strain) -> Pair:
    return 0.5 * (s.first[0] + s.second[0]), 0.5 * (s.first[1] + s.second[1])


@njit
def _torque_rate(k: Pair, elastic: Pair, D: Stiffness) -> float:
    """P for the mean curvature k and its elastic part."""
    return k[0] * D.EIz * elastic[1] - k[1] * D.EIy * elastic[0]


@njit
def _torque_rate_slopes(k: Pair, elastic: Pair, D: Stiffness) -> Pair:
    """Derivatives of P by the mean curvature; linear in (k, elastic)."""
    return D.EIz * elastic[1] - D.EIy * k[1], D.EIz * k[0] - D.EIy * elastic[0]


@njit
def _twist_compliance(D: Stiffness) -> float:
    return D.L**3 / (12.0 * D.GJ)


@njit
def _share(k: Pair, D: Stiffness) -> float:
    """h for the mean curvature k."""
    return 1.0 / (1.0 + 0.1 * D.L**2 / D.GJ * (D.EIz * k[0] ** 2 + D.EIy * k[1] ** 2))


@njit
def _share_slopes(k: Pair, D: Stiffness, h: float) -> Pair:
    """Derivatives of h by the mean curvature."""
    by = -0.2 * D.L**2 / D.GJ * h**2
    return by * D.EIz * k[0], by * D.EIy * k[1]


@njit
def energy(D: Stiffness, total: Strain, elastic: Strain) -> float:
    """Strain energy U (J)."""
    U = 0.5 * (D.EA * D.L * elastic.axial**2 + D.GJ / D.L * elastic.twist**2)
    U += 0.25 * D.L * D.EIy * (elastic.first[0] ** 2 + elastic.second[0] ** 2)
    U += 0.25 * D.L * D.EIz * (elastic.first[1] ** 2 + elastic.second[1] ** 2)
    k = _mean(total)
    return U - 0.5 * _twist_compliance(D) * _share(k, D) * _torque_rate(k, _mean(elastic), D) ** 2


@njit
def linear_stress(D: Stiffness, elastic: Strain) -> Stress:
    """Stresses but for those of the torque rate."""
    y, z = 0.5 * D.L * D.EIy, 0.5 * D.L * D.EIz
    first, second = (
        (y * elastic.first[0], z * elastic.first[1]),
        (y * elastic.second[0], z * elastic.second[1]),
    )
    return Stress(D.EA * D.L * elastic.axial, D.GJ / D.L * elastic.twist, first, second)


@njit
def _less(s: Stress, moment: Pair) -> Stress:
    """s with the moment taken off both stations."""
    first = (s.first[0] - moment[0], s.first[1] - moment[1])
    second = (s.second[0] - moment[0], s.second[1] - moment[1])
    return Stress(s.axial, s.twist, first, second)


@njit
def stress(D: Stiffness, total: Strain, elastic: Strain) -> Stress:
    """Gradient of U by the strains `total`, of which `elastic` exceeds the unstressed ones."""
    k, e = _mean(total), _mean(elastic)
    return _less(linear_stress(D, elastic), _twisting_moment(D, k, e))


@njit
def _twisting_moment(D: Stiffness, k: Pair, e: Pair) -> Pair:
    """What P takes off the moment of each station."""
    P, h, half = _torque_rate(k, e, D), _share(k, D), 0.5 * _twist_compliance(D)
    (Py, Pz), (hy, hz) = _torque_rate_slopes(k, e, D), _share_slopes(k, D, h)
    return half * P * (h * Py + 0.5 * P * hy), half * P * (h * Pz + 0.5 * P * hz)


@njit
def stress_change(D: Stiffness, total: Strain, elastic: Strain, change: Strain) -> Stress:
    """Hessian of U times a change of the strains."""
    k, e, dk = _mean(total), _mean(elastic), _mean(change)
    P, h, half = _torque_rate(k, e, D), _share(k, D), 0.5 * _twist_compliance(D)
    (Py, Pz), (hy, hz) = _torque_rate_slopes(k, e, D), _share_slopes(k, D, h)
    dPy, dPz = _torque_rate_slopes(dk, dk, D)
    dP, dh = Py * dk[0] + Pz * dk[1], hy * dk[0] + hz * dk[1]
    bent = _share_slopes(dk, D, h)
    dhy, dhz = 2.0 * dh / h * hy + bent[0], 2.0 * dh / h * hz + bent[1]
    first = half * (dP * (h * Py + P * hy) + P * (dh * Py + h * dPy + 0.5 * P * dhy))
    second = half * (dP * (h * Pz + P * hz) + P * (dh * Pz + h * dPz + 0.5 * P * dhz))
    return _less(linear_stress(D, change), (first, second))
