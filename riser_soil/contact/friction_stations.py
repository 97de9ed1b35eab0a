"""Compiled loops over the stations of a line that slides over a seabed, and what they do at one station.

Vectors are in the line's axes. In the plane their third component is 0, and so are components in the lateral direction,
which stands square to the plane. Arrays (ne, ng, d) hold those of all stations, and (m, ng, d) those of the elements
that touch; directions are (ne, ng, d, r), axial and, in space, lateral.
"""

from __future__ import annotations

import math

import numpy as np

from riser_soil.contact.coulomb import Pair
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit
from riser_soil.riser.vectors import Mat, Vec, add, cross, dot, matadd, norm, outer, padded, put, put_matrix, scale, sub

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


@njit
def read_pair(a: Array) -> Pair:
    """The components that are stored in an array (r,)."""
    return a[0], a[1] if a.size > 1 else 0.0


@njit
def directions(tau: Array, normal: Array) -> Array:
    """`directions_at` all stations (ne, ng, d, r)."""
    ne, ng, d = tau.shape
    out = np.empty((ne, ng, d, d - 1))
    for e in range(ne):
        for g in range(ng):
            put_along(directions_at(padded(tau[e, g]), padded(normal[e, g])), out[e, g])
    return out


@njit
def elastic_guesses(elements: IntArray, start_state: tuple[Array, Array, Array], k: Array, position: Array) -> Array:
    """`elastic_guess` (m, ng, r) of some elements; start_state: a `FrictionState`, k (ne,)."""
    before, along, traction = start_state
    m, ng, r = elements.size, along.shape[1], along.shape[3]
    out = np.empty((m, ng, r))
    for i in range(m):
        e = elements[i]
        for g in range(ng):
            moved = sub(padded(position[e, g]), padded(before[e, g]))
            guess = elastic_guess(read_along(along[e, g]), padded(traction[e, g]), k[e], moved)
            out[i, g, 0] = guess[0]
            if r > 1:
                out[i, g, 1] = guess[1]
    return out


@njit
def resistances(
    elements: IntArray, along: Array, k: Array, found: tuple[Array, Array, Array], normal: Array
) -> tuple[Array, Array]:
    """Minus the tractions (m, ng, d) of some elements, and their derivative by the position (m, ng, d, d).

    found: what `coulomb.traction` tells; normal (m, ng, d): of the ground.
    """
    t, by_elastic, by_penetration = found
    m, ng, d = normal.shape
    resistance, by_position = np.empty((m, ng, d)), np.empty((m, ng, d, d))
    for i in range(m):
        e = elements[i]
        for g in range(ng):
            ways = read_along(along[e, g])
            put(scale(-1.0, vector_of(ways, read_pair(t[i, g]))), resistance[i, g])
            by_guess = read_pair(by_elastic[i, g, 0]), read_pair(by_elastic[i, g, -1])
            by = resistance_by_position(ways, k[e], by_guess, read_pair(by_penetration[i, g]), padded(normal[i, g]))
            put_matrix(by, by_position[i, g])
    return resistance, by_position


@njit
def slips(
    elements: IntArray,
    start_state: tuple[Array, Array, Array],
    k: Array,
    position: Array,
    resistance: Array,
    force: Array,
) -> Array:
    """`slip_at` all stations (ne, ng), 0 where they do not press; arguments as above."""
    before, along, traction = start_state
    out = np.zeros(along.shape[:2])
    for i in range(elements.size):
        e = elements[i]
        for g in range(force.shape[1]):
            if force[i, g] > 0.0:
                moved = sub(padded(position[e, g]), padded(before[e, g]))
                taken = add(padded(traction[e, g]), padded(resistance[i, g]))
                out[e, g] = slip_at(read_along(along[e, g]), taken, k[e], moved)
    return out


@njit
def stored(share: Array, elements: IntArray, k: Array, traction: Array) -> float:
    """Energy that the ground stores elastically under tractions (m, ng, d) of some elements; share (ne, ng) [m]."""
    total = 0.0
    for i in range(elements.size):
        e = elements[i]
        for g in range(share.shape[1]):
            t = padded(traction[i, g])
            total += 0.5 * share[e, g] / k[e] * dot(t, t)
    return total
