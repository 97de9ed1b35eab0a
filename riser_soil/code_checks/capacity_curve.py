"""Capacity curve of an umbilical or cable (API 17E, ISO 13628-5): tension and curvature that it bears together."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array


def utilisation(tension: Array, curvature: Array, curve: Array) -> Array:
    """The share of the loads in those on the curve, along the ray from the origin through both.

    curve: (n, 2) tension [N] and curvature [1/m] >= 0, tensions growing from 0 or less, which each ray meets once; from
    its ends it falls to curvature 0 at the same tension. Where it begins at tension 0, compression counts as no
    tension. Loads divided by their utilisation lie on the curve.

    Source: API 17E (2010), allowable bend radius at a tension.
    """
    corners = _closed(curve)
    if curve[0, 0] == 0.0:
        tension = np.maximum(tension, 0.0)
    loads = np.stack(np.broadcast_arrays(tension, curvature), axis=-1)
    size = corners.max(axis=0)
    at, angles = _angle(loads, size), _angle(corners, size)
    side = np.clip(np.searchsorted(angles, at, side="right") - 1, 0, len(corners) - 2)
    first, second = corners[side], corners[side + 1]
    return np.asarray(_cross(first - second, loads) / _cross(first, second))


def _closed(curve: Array) -> Array:
    """Corners (m, 2) in order of the angle: from no tension or compression to the largest tension, without curvature
    at both ends.
    """
    corners = np.asarray(curve, dtype=float)
    if corners[0, 1] > 0.0 and corners[0, 0] < 0.0:
        corners = np.vstack([[corners[0, 0], 0.0], corners])
    if corners[-1, 1] > 0.0:
        corners = np.vstack([corners, [corners[-1, 0], 0.0]])
    return corners[::-1]


def _angle(points: Array, size: Array) -> Array:
    """Angle from the axis of tension towards that of curvature [rad], from 0 to pi."""
    return np.asarray(np.arctan2(points[..., 1] / size[1], points[..., 0] / size[0]))


def _cross(a: Array, b: Array) -> Array:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])
