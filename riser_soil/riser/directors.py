"""Node orientations (directors): tangents at element ends, in space by `spatial_directors`, in a plane by an angle.

`PlanarFrames` keeps an angle per node, `SpatialFrames` a rotation matrix. Each gives the trial orientation
for a rotation increment as a turn with the same members:

    tangent   unit tangents t at both ends of each element (ne, 2, d)
    P         dt/dTheta (ne, 2, d, r)
    motion    q' and q'' from the rates and accelerations of the dofs; see `hermite`
    geometric derivative of P^T F with respect to Theta at fixed F

R is the identity in the unstressed configuration. With body-axes angular velocity W and acceleration A,
t = R t0, t' = R (W x t0), t'' = R (A x t0 + W x (W x t0)).
"""

import math
from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.core.saved_state import Saved
from riser_soil.riser.spatial_directors import SpatialFrames, SpatialOrientation


class PlanarOrientation:
    """Trial orientation of a plane line. angle (nn,) [rad], initial angle of element ends alpha0 (ne, 2)."""

    def __init__(self, angle: Array, alpha0: Array) -> None:
        self.angle, both = angle, (*alpha0.shape, 2)
        self.end_angle, self.tangent, self.normal = np.empty(alpha0.shape), np.empty(both), np.empty(both)
        write_ends(angle, alpha0, self.end_angle, self.tangent, self.normal)

    def at(self, node: int) -> Array:
        """Orientation of a node: its angle (1,)."""
        return self.angle[node : node + 1]

    @property
    def P(self) -> Array:
        return self.normal[..., None]

    @property
    def turned(self) -> Array:
        """Angles (nn, 1) to which the rotation dofs have turned the nodes."""
        return self.angle[:, None]

    def motion(self, v: Array, a: Array) -> tuple[Array, Array]:
        """q' and q'' (ne, 4, 2) from rates and accelerations of the dofs (nn, 3)."""
        rate, acceleration = (np.empty((len(self.tangent), 4, 2)) for _ in range(2))
        write_motion(self.tangent, self.normal, v, a, rate, acceleration)
        return rate, acceleration

    def moment_maps(self, axes: Array, nodes: Sequence[int] | slice = slice(None)) -> Array:
        """Maps (n, 3, 1) of moments conjugate to angles to those in global axes; axes (3, 1): its normal."""
        return np.tile(axes, (len(self.angle[nodes]), 1, 1))

    def geometric(self, F: Array) -> Array:
        """(ne, 2, 1, 1) from the residual conjugate to the tangents, F (ne, 2, 2)."""
        G = np.empty((len(F), 2, 1, 1))
        write_geometric(self.tangent, F, G)
        return G


class PlanarFrames:
    """Committed node angles of a plane line; angles grow without limit.

    A trial with its rates and their derivatives costs about 0.6 of one of `SpatialFrames`, and with half the dofs a
    Newton iteration as well; a step costs 0.7 (`benchmarks.twins`).

    angle: (nn,) rad from the unstressed configuration. alpha0: unstressed tangent angle at element ends (ne,
    2).
    """

    dofs = 1

    def __init__(self, angle: Array, alpha0: Array) -> None:
        self.angle, self.alpha0 = angle, alpha0

    def turned(self, orientation: Array, rotation: Array) -> Array:
        """An orientation turned by an angle (1,)."""
        return orientation + rotation

    def rotation(self, first: Array, second: Array) -> Array:
        """Angle (1,) from one orientation to another."""
        return second - first

    def increment(self, node: int, orientation: Array) -> Array:
        """Increment (1,) that brings a node to an orientation."""
        return orientation - self.angle[node]

    def in_body_axes(self, orientation: Array, rate: Array) -> Array:
        """An angular rate (1,) as the dofs have it."""
        return rate

    def turn(self, increment: Array) -> PlanarOrientation:
        return self.turning(increment)()

    def turning(self, increment: Array) -> Callable[[], PlanarOrientation]:
        """What makes the orientation after an increment from where the line is now, whenever it is called."""
        return partial(_turned, self.angle, increment, self.alpha0)

    def in_new_axes(self, moment: Array, increment: Array) -> Array:
        """Moments (nn, 1) conjugate to the increment, as the next one has them."""
        return moment

    def commit(self, increment: Array) -> None:
        self.angle = self.angle + increment[:, 0]

    def state(self) -> Saved:
        return {"angle": self.angle}

    def restore(self, saved: Saved) -> None:
        self.angle = saved["angle"]


def _turned(angle: Array, increment: Array, alpha0: Array) -> PlanarOrientation:
    return PlanarOrientation(angle + increment[:, 0], alpha0)


def initial_frames(rotation: Array, T0: Array, basis: Array) -> PlanarFrames | SpatialFrames:
    """Frames of a line with axes basis (3, d), see `Layout`: in a plane by angles from the first axis to the second.

    In space body axes are those of the unstressed line at its start, so that the first rotation dof there is spin about
    the axis.
    """
    if basis.shape[1] == 3:
        axes = T0[0, 0]
        return SpatialFrames(rotation @ axes, axes.T @ T0)
    first, second = np.ascontiguousarray(basis.T)
    turned, tangent = rotation @ first, T0[..., 0]
    return PlanarFrames(*(np.arctan2(along @ second, along @ first) for along in (turned, tangent)))


@njit
def write_ends(angle: Array, alpha0: Array, end_angle: Array, tangent: Array, normal: Array) -> None:
    """Write angle (ne, 2), tangent and normal (ne, 2, 2) of element ends; two at one angle share its sine."""
    last, cosine, sine = math.nan, math.nan, math.nan
    for e in range(alpha0.shape[0]):
        for side in range(2):
            direction = angle[e + side] + alpha0[e, side]
            if direction != last:
                last, cosine, sine = direction, math.cos(direction), math.sin(direction)
            end_angle[e, side] = direction
            tangent[e, side, 0], tangent[e, side, 1] = cosine, sine
            normal[e, side, 0], normal[e, side, 1] = -sine, cosine


@njit
def first_wound(end_angle: Array) -> int:
    """First element whose ends' angles (ne, 2) differ by more than half a turn; ne without any."""
    for e in range(end_angle.shape[0]):
        if abs(end_angle[e, 1] - end_angle[e, 0]) > math.pi:
            return e
    return end_angle.shape[0]


@njit
def write_motion(tangent: Array, normal: Array, v: Array, a: Array, rate: Array, acceleration: Array) -> None:
    """Write q' and q'' (ne, 4, 2) from rates and accelerations of the dofs (nn, 3)."""
    for e in range(tangent.shape[0]):
        for side in range(2):
            w, alpha = v[e + side, 2], a[e + side, 2]
            for i in range(2):
                t, n = tangent[e, side, i], normal[e, side, i]
                rate[e, 2 * side, i], acceleration[e, 2 * side, i] = v[e + side, i], a[e + side, i]
                rate[e, 2 * side + 1, i] = w * n
                acceleration[e, 2 * side + 1, i] = alpha * n - w**2 * t


@njit
def write_maps(
    tangent: Array, normal: Array, v: Array, a: Array, shift_v: float, shift_a: float, first: Array, second: Array
) -> None:
    """Write the derivatives of t' and t'' by the angle, each (ne, 2, 2, 1), from angular rates v and a (nn, 1)."""
    for e in range(tangent.shape[0]):
        for side in range(2):
            w, alpha = v[e + side, 0], a[e + side, 0]
            for i in range(2):
                t, n = tangent[e, side, i], normal[e, side, i]
                first[e, side, i, 0] = shift_v * n - w * t
                second[e, side, i, 0] = (shift_a - w**2) * n - (alpha + 2.0 * shift_v * w) * t


@njit
def write_geometric(tangent: Array, F: Array, G: Array) -> None:
    """Write d(n . F)/dangle (ne, 2, 1, 1) at fixed F (ne, 2, 2): the normal turns against the tangent."""
    for e in range(tangent.shape[0]):
        for side in range(2):
            G[e, side, 0, 0] = -tangent[e, side, 0] * F[e, side, 0] - tangent[e, side, 1] * F[e, side, 1]


Frames = PlanarFrames | SpatialFrames
Orientation = PlanarOrientation | SpatialOrientation
