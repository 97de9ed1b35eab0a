"""Mandel notation: symmetric tensors as vectors of six, xx, yy, zz, √2 xy, √2 xz, √2 yz.

Double contractions are dot products of the vectors. Tension positive. Arrays have the components last; elastic
constants broadcast against the leading axes.
"""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.seabed.bearing import Number

UNIT: Array = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
VOLUME: Array = np.outer(UNIT, UNIT)
DEVIATOR: Array = np.eye(6) - VOLUME / 3.0  # projector on the deviatoric part


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
    """Add values (...,) in place to each normal component of tensors (..., 6); returns the tensors."""
    for i in range(3):
        a[..., i] += values
    return a


def deviator(a: Array) -> Array:
    """Deviatoric part (..., 6)."""
    return plus_mean(a.copy(), -mean(a))


def modulus(
    bulk: Number,
    shear: Number,
    volume: Number,
    deviator: Number,
    along: Number | float = 0.0,
    n: Number | float = 0.0,
    m: Number | float = 0.0,
) -> Number:
    """K 1⊗1 + 2G P - along n⊗n [Pa] of entries of VOLUME, DEVIATOR and n; numbers or arrays, as this is compiled, too.
    """
    return bulk * volume + 2.0 * shear * deviator - along * n * m


def stiffness(bulk: Array, shear: Array) -> Array:
    """Isotropic elastic moduli (n, 6, 6) [Pa] of bulk (n,) and shear modulus (n,)."""
    return modulus(bulk[:, None, None], shear[:, None, None], VOLUME, DEVIATOR)


def stretched(volume: Number, shape: Number, a: tuple[Number, ...]) -> tuple[Number, ...]:
    """Six components of a tensor whose mean is multiplied by one factor, its deviator by another; numbers or arrays
    (n,), as this is compiled, too.
    """
    xx, yy, zz, xy, xz, yz = a
    mean = (xx + yy + zz) / 3.0
    beside = volume * mean
    return (
        shape * (xx - mean) + beside,
        shape * (yy - mean) + beside,
        shape * (zz - mean) + beside,
        shape * xy,
        shape * xz,
        shape * yz,
    )


def elastic_stress(bulk: Array, shear: Array, strain: Array) -> Array:
    """Stress (n, 6) [Pa] of an elastic strain (n, 6)."""
    return np.stack(stretched(3.0 * bulk, 2.0 * shear, tuple(strain.T)), axis=1)


def elastic_strain(bulk: Array, shear: Array, stress: Array) -> Array:
    """Elastic strain (n, 6) of a stress (n, 6) [Pa]."""
    return np.stack(stretched(1.0 / (3.0 * bulk), 1.0 / (2.0 * shear), tuple(stress.T)), axis=1)


def components(a: Array) -> Array:
    """Components (..., 9) of tensors (..., 6), row by row: xx, xy, xz, yx, ..."""
    result: Array = (a * np.array([1.0, 1.0, 1.0, *[np.sqrt(0.5)] * 3]))[..., [0, 3, 4, 3, 1, 5, 4, 5, 2]]
    return result


def product(a: Array, b: Array) -> Array:
    """a:b (n,) of two tensors (n, 6)."""
    result: Array = np.einsum("ni,ni->n", a, b)
    return result


def von_mises(stress: Array) -> Array:
    """Equivalent stress q = √(3/2 s:s) [Pa] (...,); |σ| in uniaxial tension, √3|τ| in simple shear."""
    s = deviator(stress)
    return np.sqrt(1.5 * np.einsum("...i,...i->...", s, s))
