"""Formulas of elements in space, for all elements of a line: `riser.beam3d`, `riser.increments`."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.riser import beam3d, rotations
from riser_soil.riser.stiffness import LineStiffness
from riser_soil.riser.vectors import vector


@njit
def strain_energy(
    chord: Array, frame1: Array, frame2: Array, ref: beam3d.SpatialReference, section: LineStiffness
) -> Array:
    """Strain energy (ne,) in J; arguments as in `forces`."""
    U = np.empty(len(chord))
    for e in range(len(chord)):
        U[e] = beam3d.element_energy(e, beam3d.element_shape(e, chord, frame1, frame2, section), ref, section)
    return U


@njit
def load_potential(
    chord: Array, frame1: Array, frame2: Array, middle: Array, section: LineStiffness, load: Array
) -> Array:
    """Potential (ne,) [J] of a load per length (ne, 3) [N/m] on elements with their middles (ne, 3): `corotation`."""
    V = np.empty(len(chord))
    for e in range(len(chord)):
        at, w = beam3d.element_shape(e, chord, frame1, frame2, section), vector(load[e])
        V[e] = beam3d.element_potential(at, section.L[e], w, vector(middle[e]))
    return V


@njit
def forces(
    chord: Array,
    frame1: Array,
    frame2: Array,
    ref: beam3d.SpatialReference,
    section: LineStiffness,
    load: Array,
) -> Array:
    """Internal forces f (ne, 12) less those of a load per length (ne, 3) [N/m], for chords (ne, 3) and section frames
    (ne, 3, 3) of both ends.
    """
    f = np.empty((len(chord), 12))
    for e in range(len(chord)):
        beam3d.write_element_forces(e, chord, frame1, frame2, ref, section, load, f[e])
    return f


@njit
def forces_and_tangent(
    chord: Array,
    frame1: Array,
    frame2: Array,
    ref: beam3d.SpatialReference,
    section: LineStiffness,
    load: Array,
) -> tuple[Array, Array]:
    """Forces f (ne, 12) as in `forces`, and their derivative K (ne, 12, 12) by displacements and spatial spins."""
    f, K, workspace = np.empty((len(chord), 12)), np.empty((len(chord), 12, 12)), beam3d.tangent_workspace()
    for e in range(len(chord)):
        beam3d.write_element(e, chord, frame1, frame2, ref, section, load, workspace, f[e], K[e])
    return f, K


@njit
def forces_to_increments(f: Array, H: Array) -> None:
    """Turn the moments in f (ne, 12), conjugate to spins, into those of rotation vectors; H is (nn, 3, 3)."""
    for e in range(len(f)):
        rotations.element_to_increments(e, f[e], H)


@njit
def to_increments(f: Array, K: Array, H: Array, Rn: Array, Theta: Array) -> None:
    """Turn forces f (ne, 12) and tangents K (ne, 12, 12) by spins into those by rotation vectors.

    H, Rn (nn, 3, 3) and Theta (nn, 3) belong to the nodes. K becomes the Hessian of the strain energy.
    """
    for e in range(len(f)):
        rotations.tangent_to_increments(e, f[e], K[e], H, Rn, Theta)
    forces_to_increments(f, H)
