"""What a line that slides over a seabed does at one of its stations.

Vectors are in the line's axes. In the plane their third component is 0, and so are components in the lateral direction,
which stands square to the plane. Directions are stored in arrays (d, r), axial and, in space, lateral.
"""

from __future__ import annotations

import math

from riser_soil.contact.coulomb import Pair
from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.riser.vectors import Mat, Vec, add, cross, dot, matadd, norm, outer, padded, put, scale, sub

UPRIGHT = 1e-6  # sine of the angle to the ground's normal below which a riser has no axial direction along the ground
Along = tuple[Vec, Vec]  # directions along the ground, axial and lateral


@njit
def directions_at(tau: Vec, normal: Vec) -> Along:
    """Unit vectors along the ground from the riser's tangent and the ground's normal, zero where it stands upright."""
    n = scale(1.0 / norm(normal), normal)
    axial = sub(tau, scale(dot(tau, n), n))
    length = norm(axial)
    axial = scale(1.0 / length if length > UPRIGHT else 0.0, axial)
    return axial, cross(n, axial)


@njit
def components(along: Along, v: Vec) -> Pair:
    """Of a vector by both directions."""
    return dot(along[0], v), dot(along[1], v)


@njit
def vector_of(along: Along, v: Pair) -> Vec:
    """The vector that has these components."""
    return add(scale(v[0], along[0]), scale(v[1], along[1]))


@njit
def elastic_guess(along: Along, traction: Vec, k: float, moved: Vec) -> Pair:
    """t* of `coulomb`, from the traction at the start of a step and the movement in it."""
    return components(along, sub(traction, scale(k, moved)))


@njit
def resistance_by_position(
    along: Along, k: float, by_elastic: tuple[Pair, Pair], by_penetration: Pair, normal: Vec
) -> Mat:
    """Derivative by the position of minus the traction, from its derivatives by t* and by the penetration."""
    stuck = outer(scale(k, along[0]), vector_of(along, by_elastic[0]))
    stuck = matadd(stuck, outer(scale(k, along[1]), vector_of(along, by_elastic[1])))
    return matadd(stuck, outer(vector_of(along, by_penetration), normal))


@njit
def slip_at(along: Along, taken: Vec, k: float, moved: Vec) -> float:
    """Plastic slip in a step in which the ground takes up a traction elastically [m]."""
    a, b = components(along, sub(moved, scale(1.0 / k, taken)))
    return math.sqrt(a * a + b * b)


@njit
def read_along(along: Array) -> Along:
    """The directions that are stored in an array (d, r)."""
    return padded(along[:, 0]), padded(along[:, 1]) if along.shape[1] > 1 else (0.0, 0.0, 0.0)


@njit
def put_along(along: Along, out: Array) -> None:
    """Store the directions in an array (d, r)."""
    put(along[0], out[:, 0])
    if out.shape[1] > 1:
        put(along[1], out[:, 1])
