"""Strain energy of a two-node element in space, its gradient and its Hessian by the strains of `strain3d`.

    U = EA L axial^2 / 2 + GJ twist^2 / (2 L) + L/4 (sum of k.D k over both stations) - P^2 L^3 / (24 GJ)

with all strains less those of the unstressed element, D = diag(EIy, EIz), and P = (mean curvature x mean
moment)_x.
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
def energy(D: Stiffness, total: Strain, elastic: Strain) -> float:
    """Strain energy U (J)."""
    U = 0.5 * (D.EA * D.L * elastic.axial**2 + D.GJ / D.L * elastic.twist**2)
    U += 0.25 * D.L * D.EIy * (elastic.first[0] ** 2 + elastic.second[0] ** 2)
    U += 0.25 * D.L * D.EIz * (elastic.first[1] ** 2 + elastic.second[1] ** 2)
    return U - 0.5 * _twist_compliance(D) * _torque_rate(_mean(total), _mean(elastic), D) ** 2


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
    Ky, Kz = _torque_rate_slopes(k, e, D)
    half = 0.5 * _twist_compliance(D) * _torque_rate(k, e, D)
    return _less(linear_stress(D, elastic), (half * Ky, half * Kz))


@njit
def stress_change(D: Stiffness, total: Strain, elastic: Strain, change: Strain) -> Stress:
    """Hessian of U times a change of the strains."""
    k, e, dk = _mean(total), _mean(elastic), _mean(change)
    Ky, Kz = _torque_rate_slopes(k, e, D)
    dKy, dKz = _torque_rate_slopes(dk, dk, D)
    half = 0.5 * _twist_compliance(D) * _torque_rate(k, e, D)
    dhalf = 0.5 * _twist_compliance(D) * (Ky * dk[0] + Kz * dk[1])
    return _less(linear_stress(D, change), (half * dKy + dhalf * Ky, half * dKz + dhalf * Kz))
