"""Vectors along a line by their components: one array a component, for many states at once.

Components come first: (k, ..., nn) at the nodes, (k, 2, ..., ne) at the first and second ends of the elements. In a
plane a vector in it has two components, and a moment or another vector across it one, about the plane's normal, the
first axis times the second. Sums are taken term by term: each number is rounded in one way, wherever it lies.
"""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array


def dot(a: Array, b: Array) -> Array:
    """Scalar product of vectors (k, ...)."""
    total = a[0] * b[0]
    for i in range(1, len(a)):
        total += a[i] * b[i]
    return np.asarray(total)


def cross(a: Array, b: Array) -> Array:
    """Vector product of vectors (d, ...): (1, ...) in a plane, (3, ...) in space."""
    pairs = ((0, 1),) if len(a) == 2 else ((1, 2), (2, 0), (0, 1))
    return np.stack([a[i] * b[j] - a[j] * b[i] for i, j in pairs])


def size(a: Array) -> Array:
    """Magnitude of vectors (k, ...)."""
    return np.abs(a[0]) if len(a) == 1 else np.asarray(np.sqrt(dot(a, a)))


def across(a: Array, unit: Array) -> Array:
    """The share of vectors (r, ...) across unit vectors (d, ...): all of it where they are about the plane's normal."""
    return a if len(a) == 1 else np.asarray(a - dot(a, unit) * unit)


def ends_in_front(values: Array) -> Array:
    """Components (k, 2, ..., ne) of vectors (..., ne, 2, k) at the elements' ends; a copy."""
    return np.ascontiguousarray(np.moveaxis(values, (-1, -2), (0, 1)))


def vectors(components: Array) -> Array:
    """Vectors (..., k) with components (k, ...); a copy."""
    return np.ascontiguousarray(np.moveaxis(components, 0, -1))


def at_ends(values: Array, axis: int = 0) -> Array:
    """Values at the nodes (..., nn) as the elements' ends have them: first and second ends along a new axis."""
    return np.stack([values[..., :-1], values[..., 1:]], axis=axis)


def mean_beside(values: Array) -> Array:
    """Mean at the nodes (..., nn) of what the elements beside have there (2, ..., ne)."""
    first, second = values
    mean = np.empty((*first.shape[:-1], first.shape[-1] + 1))
    mean[..., 0], mean[..., -1] = first[..., 0], second[..., -1]
    np.add(second[..., :-1], first[..., 1:], out=mean[..., 1:-1])
    mean[..., 1:-1] *= 0.5
    return mean
