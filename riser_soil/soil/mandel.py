"""Mandel notation: symmetric tensors as vectors of six, xx, yy, zz, √2 xy, √2 xz, √2 yz.

Double contractions are dot products of the vectors. Tension positive. Arrays have the components last; elastic
constants broadcast against the leading axes.
"""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit

UNIT: Array = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
DEVIATOR: Array = np.eye(6) - np.outer(UNIT, UNIT) / 3.0  # projector on the deviatoric part


def bulk_modulus(E: Array, nu: float) -> Array:
    """K = E / 3(1 − 2ν) [Pa]."""
    return E / (3.0 * (1.0 - 2.0 * nu))


def shear_modulus(E: Array, nu: float) -> Array:
    """G = E / 2(1 + ν) [Pa]."""
    return E / (2.0 * (1.0 + nu))


def mean(a: Array) -> Array:
    """A third of the trace (...,)."""
    result: Array = (a[..., 0] + a[..., 1] + a[..., 2]) / 3.0
    return result


def plus_mean(a: Array, values: Array) -> Array:
    """The same tensors (..., 6), with values (...,) added in place to each of their normal components."""
    for i in range(3):
        a[..., i] += values
    return a


def deviator(a: Array) -> Array:
    """Deviatoric part (..., 6)."""
    return plus_mean(a.copy(), -mean(a))


def stiffness(bulk: Array, shear: Array) -> Array:
    """Isotropic elastic moduli K 1⊗1 + 2G P (n, 6, 6) [Pa] of bulk (n,) and shear modulus (n,)."""
    result: Array = bulk[:, None, None] * np.outer(UNIT, UNIT) + (2.0 * shear)[:, None, None] * DEVIATOR
    return result


def elastic_stress(bulk: Array, shear: Array, strain: Array) -> Array:
    """Stress (n, 6) [Pa] of an elastic strain (n, 6)."""
    out = np.zeros(strain.shape)
    _add_stresses(bulk, shear, np.ascontiguousarray(strain), out)
    return out


def elastic_strain(bulk: Array, shear: Array, stress: Array) -> Array:
    """Elastic strain (n, 6) of a stress (n, 6) [Pa]."""
    out = np.zeros(stress.shape)
    _add_strains(bulk, shear, np.ascontiguousarray(stress), out)
    return out


@njit
def _add_stresses(bulk: Array, shear: Array, strain: Array, out: Array) -> None:
    for i in range(len(out)):
        add_elastic_stress(bulk[i], shear[i], strain[i], out[i])


@njit
def _add_strains(bulk: Array, shear: Array, stress: Array, out: Array) -> None:
    for i in range(len(out)):
        add_elastic_strain(bulk[i], shear[i], stress[i], out[i])


@njit
def add_elastic_stress(bulk: float, shear: float, strain: Array, out: Array) -> None:
    """Add the stress (6,) of an elastic strain (6,): 3K of its mean and 2G of its deviator."""
    mean = (strain[0] + strain[1] + strain[2]) / 3.0
    for k in range(6):
        out[k] += 3.0 * bulk * mean + 2.0 * shear * (strain[k] - mean) if k < 3 else 2.0 * shear * strain[k]


@njit
def add_elastic_strain(bulk: float, shear: float, stress: Array, out: Array) -> None:
    """Add the elastic strain (6,) of a stress (6,): by the inverse moduli."""
    add_elastic_stress(1.0 / (9.0 * bulk), 1.0 / (4.0 * shear), stress, out)


def product(a: Array, b: Array) -> Array:
    """a:b (n,) of two tensors (n, 6)."""
    result: Array = np.einsum("ni,ni->n", a, b)
    return result


def size(a: Array) -> Array:
    """|a| (n,) of tensors (n, 6)."""
    return np.sqrt(product(a, a))


def von_mises(stress: Array) -> Array:
    """Equivalent stress q = √(3/2 s:s) [Pa] (...,); |σ| in uniaxial tension, √3|τ| in simple shear."""
    s = deviator(stress)
    return np.sqrt(1.5 * np.einsum("...i,...i->...", s, s))
