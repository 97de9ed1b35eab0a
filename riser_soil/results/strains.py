"""Largest strains along a riser, compiled."""

from __future__ import annotations

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit


@njit
def largest_strains(
    tension: Array, EA: Array, curvature: Array, radius: Array, moment: Array
) -> tuple[float, int, float, int, float]:
    """Of the nodes at many instants (nt, nn): the largest size of tension over EA and its place, the largest curvature
    times radius and its place, the largest moment; of equal ones the first. Places are counted along all instants; EA
    and radius (nn,).
    """
    axial, bending, largest = -1.0, -1.0, 0.0
    at = bent_at = 0
    nodes = EA.size
    for k in range(tension.shape[0]):
        for n in range(nodes):
            stretch, bend = abs(tension[k, n]) / EA[n], radius[n] * curvature[k, n]
            if stretch > axial:
                axial, at = stretch, k * nodes + n
            if bend > bending:
                bending, bent_at = bend, k * nodes + n
            if moment[k, n] > largest:
                largest = moment[k, n]
    return axial, at, bending, bent_at, largest
