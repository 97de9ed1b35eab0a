"""Rigid-body motions of the line that its supports leave free, such as a turn about the chord between its ends.

They take no energy where the loads do not depend on the direction.
"""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.riser.directors import Orientation
from riser_soil.riser.spatial_directors import SpatialOrientation

STILL = 1e-9  # of the line's length, or a radian: what moves less does not move


def free_turns(x: Array, turn: Orientation, prescribed: BoolArray, length: float) -> Array:
    """Increments (k, nn, d + r) of independent rigid motions that move no prescribed dof; in space sections may spin.

    x (nn, d): positions; prescribed (nn, d + r). length: the line's [m]; also the largest displacement of each motion.
    """
    motions = _rigid_motions(x, turn, length)
    units = unit_lengths(x.shape, motions.shape[2], length)
    motions /= units
    none = np.zeros((len(motions), 1))
    _, sizes, combined = np.linalg.svd(np.hstack([motions[:, prescribed], none]).T)
    free = _independent(combined[np.count_nonzero(sizes > STILL) :] @ motions.reshape(len(motions), -1))
    free = free.reshape(-1, *units.shape)
    largest = np.abs(free[..., : x.shape[1]]).max(axis=(1, 2), initial=0.0)
    moving = largest > STILL
    return np.asarray(free[moving] / largest[moving][:, None, None] * units)


def _independent(motions: Array) -> Array:
    """Orthonormal motions (k, n) that make up the same ones: a straight line spins as it turns about itself."""
    _, sizes, basis = np.linalg.svd(motions, full_matrices=False)
    return np.asarray(basis[sizes > STILL])


def unit_lengths(shape: tuple[int, ...], dofs: int, length: float) -> Array:
    """Units that make translations [m] and rotations comparable (nn, d + r): the line's length, and one."""
    nodes, d = shape
    units = np.ones((nodes, dofs))
    units[:, :d] = length
    return units


def _rigid_motions(x: Array, turn: Orientation, length: float) -> Array:
    """Shifts by the length and turns by a radian about the first node; in space also a spin about the tangents."""
    nodes, d = x.shape
    arm, shifts = x - x[0], [np.tile(length * axis, (nodes, 1)) for axis in np.eye(d)]
    if not isinstance(turn, SpatialOrientation):
        turned, still = np.stack([-arm[:, 1], arm[:, 0]], axis=1), np.zeros((nodes, 1))
        return np.stack([np.hstack([moved, still]) for moved in shifts] + [np.hstack([turned, still + 1.0])])
    still = np.zeros((nodes, 3))
    tangents = np.concatenate([turn.tangent[:, 0], turn.tangent[-1:, 1]])
    spins = [still + axis for axis in np.eye(3)]
    moves = [*((moved, still) for moved in shifts), *((np.cross(spin, arm), spin) for spin in spins), (still, tangents)]
    return np.stack([np.hstack([moved, np.linalg.solve(turn.H, spin[..., None])[..., 0]]) for moved, spin in moves])
