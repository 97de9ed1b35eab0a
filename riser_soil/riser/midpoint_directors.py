"""Directors of the sections at element ends over a step of the midpoint rule.

The midpoint rule needs of a director d its mean (d0 + d1)/2, its change d1 - d0, and how both follow the rotation
increment Theta to the middle of the step; the end lies at twice that increment. A spin w of the middle turns the mean
by w x mean: this pulls inertia forces back so that a rigid turn of the whole line does no work that the angular
momentum doesn't show.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.by_type import by_type
from riser_soil.core.compiled import njit
from riser_soil.core.saved_state import Saved
from riser_soil.riser.configuration import Configuration, PlanarConfiguration, SpatialConfiguration
from riser_soil.riser.directors import Frames, PlanarFrames
from riser_soil.riser.line import Line
from riser_soil.riser.rotations import exp_coefficients, moment_stiffness
from riser_soil.riser.spatial_directors import SpatialFrames, node_frames
from riser_soil.riser.vectors import (
    Vec,
    add,
    cross,
    dot,
    matrix,
    matvec,
    scale,
    transpose,
    vector,
)


class Secant(NamedTuple):
    """A director at element ends over a step: mean and change (ne, 2, d).

    P (ne, 2, d, r): change of the mean by the spin of the middle that each rotation dof there gives. by_end (ne, 2, d,
    r): derivative by these dofs of the change, and of twice the mean.
    """

    mean: Array
    change: Array
    P: Array
    by_end: Array


class Motion(NamedTuple):
    """Of m directors at element ends in a step. fixed: as in the sections, (m, ne, 2, 3) in space, in a plane (m, 1)
    how far ahead of the tangent they turn [rad]; rate (m, ne, 2, d): where the step begins; elapsed (1,): since then
    [s].
    """

    fixed: Array
    rate: Array
    elapsed: Array


class PlanarDirectors:
    """Tangents (column 0) or normals (column 1) of a line in its plane."""

    def __init__(self, frames: PlanarFrames, column: int) -> None:
        self._frames, self.fixed = frames, np.array([0.5 * math.pi * column])

    def secant(self, middle: Array) -> Secant:
        """For the rotation increments to the middle (nn, 1)."""
        return Secant(*_planar_secant(self._frames.turn(middle).end_angle + self.fixed[0], middle))

    def rates(self, v: Array) -> Array:
        """(ne, 2, 2) at the accepted configuration, from angular velocities (nn, 1)."""
        angle = self._frames.turn(np.zeros_like(v)).end_angle + self.fixed[0]
        turned = np.stack([-np.sin(angle), np.cos(angle)], axis=-1)
        return np.asarray(np.stack([v[:-1], v[1:]], axis=1) * turned)


class SpatialDirectors:
    """Tangents (column 0) or normals (columns 1 and 2) of a line in space."""

    def __init__(self, frames: SpatialFrames, column: int) -> None:
        self._frames, self.fixed = frames, np.ascontiguousarray(frames.T0[..., column])

    def secant(self, middle: Array) -> Secant:
        """For the rotation increments to the middle (nn, 3)."""
        return Secant(*_secant(self._frames.R, np.ascontiguousarray(middle), self.fixed))

    def rates(self, v: Array) -> Array:
        """(ne, 2, 3) at the accepted configuration, from body-axes angular velocities (nn, 3)."""
        return np.asarray(_rates(self._frames.R, np.ascontiguousarray(v), self.fixed))


Directors = PlanarDirectors | SpatialDirectors


def directors(frames: Frames, column: int) -> Directors:
    """The directors that suit the line's dimension."""
    if isinstance(frames, PlanarFrames):
        return PlanarDirectors(frames, column)
    return SpatialDirectors(frames, column)


class DirectorMotion:
    """Directors of a line and their rates over a step; data: what kernels know of them.

    The rates (ne, 2, d) at its end are those of the midpoint rule, whose mean over the step is change/dt. They need not
    be at right angles to the directors.
    """

    def __init__(self, line: Line, columns: Iterable[int]) -> None:
        self._moving = [directors(line.frames, column) for column in columns]
        fixed = np.stack([each.fixed for each in self._moving])
        rate = np.zeros((len(fixed), line.length.size, 2, line.dimension))
        self.data, self._t = Motion(fixed, rate, np.zeros(1)), math.inf

    def begin(self, t: float, v: Array) -> None:
        """Start from the accepted configuration with angular velocities v (nn, r)."""
        self._start(t, [each.rates(v) for each in self._moving])

    def _start(self, t: float, rates: Iterable[Array]) -> None:
        self._t, self.data.elapsed[0] = t, 0.0
        for kept, rate in zip(self.data.rate, rates, strict=True):
            kept[...] = rate

    def go_to(self, t: float) -> None:
        """To a time of the step, or to its start."""
        self.data.elapsed[0] = max(t - self._t, 0.0)

    def rates(self, t: float, end: Array) -> list[Array]:
        """Rates, each (ne, 2, d), at the end of a step, reached by the increments `end` (nn, r); or at its start."""
        if t <= self._t:
            return [rate.copy() for rate in self.data.rate]
        by = 2.0 / (t - self._t)
        pairs = zip(self._moving, self.data.rate, strict=True)
        return [by * each.secant(0.5 * end).change - rate for each, rate in pairs]

    def spins(self, v: Array) -> list[tuple[Array, Array]]:
        """Of each director once accepted: P (ne, 2, d, r), and its rate beyond that of angular velocities v."""
        pairs = zip(self._moving, self.data.rate, strict=True)
        return [(each.secant(np.zeros_like(v)).P, rate - each.rates(v)) for each, rate in pairs]

    def commit(self, t: float, end: Array) -> None:
        """Accept a step; to be called before the line's frames do."""
        self._start(t, self.rates(t, end))

    def state(self) -> Saved:
        return {"t": np.array(self._t), "rate": self.data.rate.copy()}

    def restore(self, saved: Saved) -> None:
        self._start(float(saved["t"]), [*saved["rate"]])


@by_type
def secant_within(at: Configuration, fixed: Array, share: float) -> Secant:
    """Of a director over a step, its middle at a share of the rotation increments of a configuration."""
    raise NotImplementedError


@by_type
def turning_within(at: Configuration, secant: Secant, F: Array) -> Array:
    """(ne, 2, r, r): derivative of P^T F at fixed F (ne, 2, d) by the rotation increments of the middle."""
    raise NotImplementedError


@secant_within.of(PlanarConfiguration)
def _secant_in_plane(at: PlanarConfiguration, fixed: Array, share: float) -> Secant:
    angle = at.end_angle + fixed[0]
    for e in range(angle.shape[0]):
        for side in range(2):
            angle[e, side] -= (1.0 - share) * at.Theta[e + side, 0]
    mean, change, P, by_end = _planar_secant(angle, share * at.Theta)
    return Secant(mean, change, P, by_end)


@secant_within.of(SpatialConfiguration)
def _secant_in_space(at: SpatialConfiguration, fixed: Array, share: float) -> Secant:
    mean, change, P, by_end = _secant(at.Rn, share * at.Theta, fixed)
    return Secant(mean, change, P, by_end)


@turning_within.of(PlanarConfiguration)
def _turning_in_plane(at: PlanarConfiguration, secant: Secant, F: Array) -> Array:
    return _planar_geometric(secant.by_end, F)


@turning_within.of(SpatialConfiguration)
def _turning_in_space(at: SpatialConfiguration, secant: Secant, F: Array) -> Array:
    return _geometric(at.Rn, at.Theta, secant.mean, secant.by_end, F)


@njit
def accelerations_within(motion: Motion, k: int, change: Array) -> Array:
    """Mean accelerations (ne, 2, d) of a director over a step in whose middle it is."""
    dt = 2.0 * motion.elapsed[0]
    return 2.0 / dt * (change / dt - motion.rate[k])


@njit
def rates_within(motion: Motion, k: int, change: Array) -> Array:
    """Rates (ne, 2, d) of a director at the end of a step."""
    return 2.0 / motion.elapsed[0] * change - motion.rate[k]


@njit
def _planar_secant(angle: Array, middle: Array) -> tuple[Array, Array, Array, Array]:
    """angle (ne, 2): of the directors at the rotation increments to the middle (nn, 1)."""
    ne = angle.shape[0]
    mean, change = np.empty((ne, 2, 2)), np.empty((ne, 2, 2))
    P, by_end = np.empty((ne, 2, 2, 1)), np.empty((ne, 2, 2, 1))
    for e in range(ne):
        for side in range(2):
            cosine, sine = math.cos(angle[e, side]), math.sin(angle[e, side])
            near, far = math.cos(middle[e + side, 0]), 2.0 * math.sin(middle[e + side, 0])
            p, z = near * cosine, near * sine
            way_p, way_z = -far * sine, far * cosine
            mean[e, side, 0], mean[e, side, 1] = p, z
            change[e, side, 0], change[e, side, 1] = way_p, way_z
            P[e, side, 0, 0], P[e, side, 1, 0] = -z, p
            by_end[e, side, 0, 0], by_end[e, side, 1, 0] = -2.0 * (z + 0.5 * way_z), 2.0 * (p + 0.5 * way_p)
    return mean, change, P, by_end


@njit
def _planar_geometric(by_end: Array, F: Array) -> Array:
    """The directors' ends turn on by a right angle from `by_end`."""
    G = np.empty((F.shape[0], 2, 1, 1))
    for e in range(F.shape[0]):
        for side in range(2):
            G[e, side, 0, 0] = 0.5 * (by_end[e, side, 0, 0] * F[e, side, 1] - by_end[e, side, 1, 0] * F[e, side, 0])
    return G


@njit
def _change(rotation: Vec, d: Vec) -> Vec:
    """(exp[rotation] - I) d, exact to round-off of the small difference itself."""
    a, b, _ = exp_coefficients(dot(rotation, rotation))
    once = cross(rotation, d)
    return add(scale(a, once), scale(b, cross(rotation, once)))


@njit
def _secant(Rn: Array, Theta: Array, fixed: Array) -> tuple[Array, Array, Array, Array]:
    ne = fixed.shape[0]
    mean, change = np.empty((ne, 2, 3)), np.empty((ne, 2, 3))
    P, by_end = np.empty((ne, 2, 3, 3)), np.empty((ne, 2, 3, 3))
    _, H = node_frames(Rn, Theta)
    _, H1 = node_frames(Rn, 2.0 * Theta)
    for e in range(ne):
        for side in range(2):
            n, d = e + side, vector(fixed[e, side])
            start = matvec(matrix(Rn[n]), d)
            way = matvec(matrix(Rn[n]), _change(scale(2.0, vector(Theta[n])), d))
            middle, end = add(start, scale(0.5, way)), add(start, way)
            mean[e, side, 0], mean[e, side, 1], mean[e, side, 2] = middle
            change[e, side, 0], change[e, side, 1], change[e, side, 2] = way
            spins, end_spins = transpose(matrix(H[n])), transpose(matrix(H1[n]))
            for k in range(3):
                P[e, side, 0, k], P[e, side, 1, k], P[e, side, 2, k] = cross(spins[k], middle)
                turned = scale(2.0, cross(end_spins[k], end))
                by_end[e, side, 0, k], by_end[e, side, 1, k], by_end[e, side, 2, k] = turned
    return mean, change, P, by_end


@njit
def _rates(R: Array, v: Array, fixed: Array) -> Array:
    rates = np.empty(fixed.shape)
    for e in range(fixed.shape[0]):
        for side in range(2):
            turning = cross(vector(v[e + side]), vector(fixed[e, side]))
            rates[e, side, 0], rates[e, side, 1], rates[e, side, 2] = matvec(matrix(R[e + side]), turning)
    return rates


@njit
def _geometric(Rn: Array, Theta: Array, mean: Array, by_end: Array, F: Array) -> Array:
    G = np.empty(by_end.shape)
    _, H = node_frames(Rn, Theta)
    for e in range(F.shape[0]):
        for side in range(2):
            n, force = e + side, vector(F[e, side])
            spins, changes = transpose(matrix(H[n])), transpose(matrix(by_end[e, side]))
            lever = moment_stiffness(matrix(Rn[n]), vector(Theta[n]), cross(vector(mean[e, side]), force))
            for k in range(3):
                for j in range(3):
                    G[e, side, k, j] = 0.5 * dot(spins[k], cross(changes[j], force)) + lever[k][j]
    return G
