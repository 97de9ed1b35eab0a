"""Motions of a whole line, as if it were rigid, that its supports leave free, such as the turn of a riser that is held
at both ends about the line between them. They cost nothing where the loads don't tell one direction from another.
"""

from __future__ import annotations

import numpy as np

from riser_soil.arrays import Array, BoolArray
from riser_soil.riser.directors import SpatialTurn, Turn

HELD = 1e-9  # of the line's length, or a radian: what moves less at a support is held there, and does not move at all


def free_turns(x: Array, turn: Turn, prescribed: BoolArray, length: float) -> Array:
    """Increments (k, nn, d + r) of rigid motions that move no prescribed dof; in space sections may spin along.

    x (nn, d): positions; prescribed (nn, d + r). length: the line's [m]; also the largest displacement of each motion.
    """
    motions = _rigid_motions(x, turn, length)
    at_supports = motions[:, prescribed] / unit_lengths(x.shape, motions.shape[2], length)[prescribed]
    none = np.zeros((len(motions), 1))
    _, sizes, combined = np.linalg.svd(np.hstack([at_supports, none]).T)
    free = np.tensordot(combined[np.count_nonzero(sizes > HELD) :], motions, axes=1)
    largest = np.abs(free[..., : x.shape[1]]).max(axis=(1, 2), initial=0.0)
    moving = largest > HELD * length
    return np.asarray(free[moving] * (length / largest[moving])[:, None, None])


def unit_lengths(shape: tuple[int, ...], dofs: int, length: float) -> Array:
    """What makes translations [m] and rotations comparable (nn, d + r): the line's length, and one."""
    nodes, d = shape
    units = np.ones((nodes, dofs))
    units[:, :d] = length
    return units


def _rigid_motions(x: Array, turn: Turn, length: float) -> Array:
    """Shifts by the length and turns by a radian about the first node; in space also a spin about the tangents."""
    nodes, d = x.shape
    arm, shifts = x - x[0], [np.tile(length * axis, (nodes, 1)) for axis in np.eye(d)]
    if not isinstance(turn, SpatialTurn):
        turned, still = np.stack([-arm[:, 1], arm[:, 0]], axis=1), np.zeros((nodes, 1))
        return np.stack([np.hstack([moved, still]) for moved in shifts] + [np.hstack([turned, still + 1.0])])
    still = np.zeros((nodes, 3))
    tangents = np.concatenate([turn.tangent[:, 0], turn.tangent[-1:, 1]])
    spins = [still + axis for axis in np.eye(3)]
    moves = [*((moved, still) for moved in shifts), *((np.cross(spin, arm), spin) for spin in spins), (still, tangents)]
    return np.stack([np.hstack([moved, np.linalg.solve(turn.H, spin[..., None])[..., 0]]) for moved, spin in moves])
