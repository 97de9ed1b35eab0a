"""Largest strains along a riser, compiled."""

from __future__ import annotations

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit


@njit
def largest_strains(
    tension: Array, EA: Array, curvature: Array, radius: Array, moment: Array
) -> tuple[float, int, float, int, float]:
    """Of the nodes (nn,): the largest size of tension over EA and its node, the largest curvature times radius and its
    node, the largest moment; of equal ones the first.
    """
    axial, bending, largest = -1.0, -1.0, 0.0
    at = bent_at = 0
    for n in range(tension.size):
        stretch, bend = abs(tension[n]) / EA[n], radius[n] * curvature[n]
        if stretch > axial:
            axial, at = stretch, n
        if bend > bending:
            bending, bent_at = bend, n
        if moment[n] > largest:
            largest = moment[n]
    return axial, at, bending, bent_at, largest
