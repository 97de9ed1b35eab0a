"""Formulas of elements in a plane, for all elements of a line: `riser.beam2d`."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.riser import beam2d
from riser_soil.riser.stiffness import LineStiffness


@njit
def strain_energy(
    chord: Array, direction1: Array, direction2: Array, ref: beam2d.LineReference, section: LineStiffness
) -> Array:
    """Strain energy U (ne,) in J; arguments as in `forces`."""
    U = np.empty(len(chord))
    for e in range(len(chord)):
        U[e] = beam2d.element_energy(e, beam2d.corotate(chord[e], direction1[e], direction2[e]), ref, section)
    return U


@njit
def forces(
    chord: Array, direction1: Array, direction2: Array, ref: beam2d.LineReference, section: LineStiffness
) -> Array:
    """Internal forces f (ne, 6) for chords (ne, 2) and tangent directions (ne,) of both ends, rad."""
    f = np.empty((len(chord), 6))
    for e in range(len(chord)):
        beam2d.write_element_forces(e, beam2d.corotate(chord[e], direction1[e], direction2[e]), ref, section, f[e])
    return f


@njit
def forces_and_tangent(
    chord: Array, direction1: Array, direction2: Array, ref: beam2d.LineReference, section: LineStiffness
) -> tuple[Array, Array]:
    """Internal forces f (ne, 6) and their derivative K (ne, 6, 6) by displacements and angles."""
    f, K = np.empty((len(chord), 6)), np.empty((len(chord), 6, 6))
    for e in range(len(chord)):
        beam2d.write_element(e, beam2d.corotate(chord[e], direction1[e], direction2[e]), ref, section, f[e], K[e])
    return f, K


@njit
def load_potential(chord: Array, direction1: Array, direction2: Array, middle: Array, L: Array, w: Array) -> Array:
    """V (ne,) [J]; chord, middle = (x1 + x2)/2 [m] and w [N/m]: (ne, 2); directions (ne,) as in `forces`."""
    V = np.empty(len(chord))
    for e in range(len(chord)):
        at = beam2d.corotate(chord[e], direction1[e], direction2[e])
        V[e] = beam2d.load_potential(at, L[e], w[e], middle[e, 0], middle[e, 1])
    return V


@njit
def load_forces(chord: Array, direction1: Array, direction2: Array, L: Array, w: Array) -> Array:
    """Residual (ne, 6); arguments as in `load_potential`."""
    f = np.zeros((len(chord), 6))
    for e in range(len(chord)):
        beam2d.add_load_forces(beam2d.corotate(chord[e], direction1[e], direction2[e]), L[e], w[e], f[e])
    return f


@njit
def add_load_tangent(
    out: Array, weight: float, chord: Array, direction1: Array, direction2: Array, L: Array, w: Array
) -> None:
    """Add weight times the derivative of the residual to out (ne, 6, 6); other arguments as in `load_potential`."""
    own = np.empty(2)
    for e in range(len(chord)):
        for i in range(2):
            own[i] = weight * w[e, i]
        beam2d.add_load_tangent(beam2d.corotate(chord[e], direction1[e], direction2[e]), L[e], own, out[e])
