"""Integration points of contact on the soil's surface: facets divided evenly, as fine as the contact asks for.

Points are fixed to the soil: each keeps its place on its facet and the undeformed area that it stands for. quad4 is cut
into rows and columns, tri6 into n² equal triangles; the points lie in the middles.
"""

from __future__ import annotations

import math

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit

TRI = range(6)  # nodes of tri6
LARGEST = 512  # divisions of a facet's side
ENOUGH = 12  # points along a facet or an element, whichever is shorter: they leave 1e-4 of the force, of a cubic gap


def divisions(
    points: Array, facets: IntArray, along: Array, spacing: tuple[float, float], element: float = 0.0
) -> IntArray:
    """Into how many parts (nf, 2) facets are cut in xi and eta: their points lie no farther apart than the spacing.

    points (np, 3): undeformed [m]. facets (nf, 4, 6 or 8). along (2,): horizontal unit vector of the riser. spacing: of
    points along and across it [m]. element: length of the riser's elements [m], over which the gap is smooth; along the
    riser points are spread wider than asked for where that is enough for it and for the facet.
    """
    at = points[facets]
    if facets.shape[1] != len(TRI):
        a, b, c, d = at[:, 0], at[:, 1], at[:, 2], at[:, 3]
        counted = _parts(0.5 * np.stack([b + c - a - d, c + d - a - b], axis=1), along, spacing, element)
    else:
        sides = np.stack([at[:, 1] - at[:, 0], at[:, 2] - at[:, 1], at[:, 0] - at[:, 2]], axis=1)
        counted = np.repeat(_parts(sides, along, spacing, element).max(axis=1)[:, None], 2, axis=1)
    return np.clip(counted, 1, LARGEST)


def _parts(sides: Array, along: Array, spacing: tuple[float, float], element: float) -> IntArray:
    """Parts (nf, k) of sides (nf, k, 3) [m]; what they rise counts as across."""
    lengthwise, across = np.abs(sides[..., :2] @ along), sides[..., :2] @ np.array([-along[1], along[0]])
    apart = np.maximum(spacing[0], np.minimum(lengthwise, element) / ENOUGH)
    wanted = np.maximum(lengthwise / apart, np.hypot(across, sides[..., 2]) / spacing[1])
    parts: IntArray = np.ceil(wanted - 1e-9).astype(np.int64)
    return parts


@njit
def place(nodes: int, parts: IntArray, k: int) -> tuple[float, float, float]:
    """(xi, eta) of the k-th point of a facet, and the area in (xi, eta) that it stands for."""
    n, m = parts[0], parts[1]
    if nodes != 6:
        return -1.0 + (2 * (k // m) + 1) / n, -1.0 + (2 * (k % m) + 1) / m, 4.0 / (n * m)
    left = n * n - k  # triangles from this one on: those of m rows fill m²
    m = int(math.sqrt(left))
    m += m * m < left
    row, column = n - m, k - (n * n - m * m)
    third = (1 + column % 2) / 3.0
    return (row + third) / n, (column // 2 + third) / n, 0.5 / (n * n)


@njit
def area(points: Array, facet: IntArray, dN: Array) -> float:
    """Area of a facet per area in (xi, eta) [m2], where its shape functions have the derivatives dN (nv, 2)."""
    a1 = a2 = a3 = b1 = b2 = b3 = 0.0
    for v in range(len(facet)):
        x, y, z = points[facet[v], 0], points[facet[v], 1], points[facet[v], 2]
        a1, a2, a3 = a1 + x * dN[v, 0], a2 + y * dN[v, 0], a3 + z * dN[v, 0]
        b1, b2, b3 = b1 + x * dN[v, 1], b2 + y * dN[v, 1], b3 + z * dN[v, 1]
    return math.sqrt((a2 * b3 - a3 * b2) ** 2 + (a3 * b1 - a1 * b3) ** 2 + (a1 * b2 - a2 * b1) ** 2)
