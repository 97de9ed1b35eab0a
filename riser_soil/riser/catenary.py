"""The elastic catenary between two points in space as the first shape of a line; `cable` finds its balance."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from riser_soil.arrays import Array, IntArray
from riser_soil.errors import SceneError
from riser_soil.riser.cable import Balance, Chain, fit
from riser_soil.riser.shapes import UP, Curve, X, from_nodes

BARS = 2000  # error of H some 5e-8 of it
SOFTNESS = 1e-7  # of the length: about what the line sinks into the seabed
LEAST_H = 2.0  # of the heaviest bar: what a kink at H = 0 is rounded to


@dataclass(frozen=True, eq=False)
class Catenary:
    """Curve of the line, tensions at its nodes (nn,) N, and horizontal tension H (N).

    beyond [m]: how far the end lies beyond its place, horizontally away from the start; 0 unless the line is slack.
    """

    curve: Curve
    tension: Array
    H: float
    beyond: float = 0.0


def catenary(
    arc: Array,
    start: Array,
    end: Array,
    weight: Array | float,
    EA: Array | float,
    level: float = -np.inf,
    *,
    points: Array | None = None,
    least_H: float = 0.0,
    bars: int = BARS,
) -> Catenary:
    """Shape and tension of a line of length arc[-1] between two points, which carries its own weight.

    arc: (nn,) unstressed arc length of the nodes. weight: N/m, negative where the line floats, and EA: N; each for the
    whole line or by element (ne,). level: height [m] at which the line rests on the seabed; by default there is none.
    points: (np, 2) arc lengths [m] of point weights [N]. bars: about how many the line is cut into; the error is of second order in their
    length.
    least_H [N]: where the line is so slack that its H would be less, it is laid with this one and ends `beyond` its
    place; at H = 0 a cable has kinks, and any shape on the seabed. Raises SceneError where there is no such line.
    """
    length, rests = np.diff(arc), bool(np.isfinite(level))
    across = np.array([end[0] - start[0], end[1] - start[1], 0.0])
    h = float(np.linalg.norm(across))
    _above(level, float(start[2]), float(end[2]), float(arc[-1]))
    pieces = np.maximum(1, np.ceil(length * (bars / arc[-1]) - 1e-9)).astype(int)
    floor = level if rests else float(start[2])
    joints = np.append(0, np.cumsum(pieces))
    w, stiffness = (np.repeat(np.broadcast_to(value, length.shape), pieces) for value in (weight, EA))
    chain = _chain(np.repeat(length / pieces, pieces), stiffness, w, start[2] - floor, end[2] - floor, rests)
    if points is not None:
        _hang_on(chain, points)
    if not chain.load > 0.0:
        raise SceneError("riser.initial: catenary: needs a submerged weight; give initial points, or straight")
    floor_H = max(least_H, LEAST_H * float(np.abs(w).max() * (length / pieces).max()))
    found = fit(chain, h, floor_H)
    shape = _in_space(found, joints, start, across / h if h > 0.0 else X)
    return replace(shape, beyond=max(0.0, found.reach - h) if found.H <= floor_H else 0.0)


def _above(level: float, start: float, end: float, L: float) -> None:
    low = min(start, end)
    if low < level - 1e-9 * L:
        raise SceneError(
            f"riser: an end at z = {low:.6g} m lies below the level {level:.6g} m at which the riser rests"
        )


def _chain(l0: Array, EA: Array, w: Array, z0: float, z1: float, rests: bool) -> Chain:
    W = 0.5 * (np.append(w * l0, 0.0) + np.append(0.0, w * l0))
    softness = SOFTNESS * float(l0.sum()) if rests else None
    return Chain(l0, EA, W, z0, z1, float(np.abs(W).max()), softness)


def _hang_on(chain: Chain, points: Array) -> None:
    """Add point weights to the joints around them; what hangs on a held end is no matter of the line."""
    along = np.append(0.0, np.cumsum(chain.l0))
    bar = np.clip(np.searchsorted(along, points[:, 0], side="right") - 1, 0, chain.l0.size - 1)
    share = (points[:, 0] - along[bar]) / chain.l0[bar]
    inner = np.zeros_like(chain.W)
    np.add.at(inner, bar, (1.0 - share) * points[:, 1])
    np.add.at(inner, bar + 1, share * points[:, 1])
    chain.W[1:-1] += inner[1:-1]


def _in_space(found: Balance, joints: IntArray, start: Array, direction: Array) -> Catenary:
    x, z, V = found.x[joints, None], found.z[joints, None] - found.chain.z0, found.V_at_joints[joints, None]
    force = found.H * direction + V * UP
    tension = np.linalg.norm(force, axis=1)
    curve = from_nodes(start + x * direction + z * UP, force / tension[:, None])
    return Catenary(curve, tension, found.H)
