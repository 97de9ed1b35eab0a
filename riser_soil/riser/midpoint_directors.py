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
from riser_soil.riser.rotations import exp_coefficients, left_tangent, moment_stiffness
from riser_soil.riser.spatial_directors import SpatialFrames
from riser_soil.riser.vectors import (
    Mat,
    Vec,
    add,
    cross,
    dot,
    matmul,
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


class DirectorsInStep(NamedTuple):
    """m directors at element ends in a step.

    fixed: as in the sections, (m, ne, 2, 3) in space, in a plane (m, 1) how far ahead of the tangent they turn [rad];
    rate (m, ne, 2, d): where the step begins; elapsed (1,): since then [s]. secant, turning (ne, 2, r, r): workspace
    for one of them.
    """

    fixed: Array
    rate: Array
    elapsed: Array
    secant: Secant
    turning: Array


class PlanarDirectors:
    """Tangents (column 0) or normals (column 1) of a line in its plane."""

    def __init__(self, frames: PlanarFrames, column: int) -> None:
        self._frames, self.fixed = frames, np.array([0.5 * math.pi * column])

    def secant(self, middle: Array) -> Secant:
        """For the rotation increments to the middle (nn, 1)."""
        workspace = secant_workspace(len(middle) - 1, 2, 1)
        _write_planar(self._frames.turn(middle).end_angle, self.fixed[0], middle, 1.0, 0.0, workspace)
        return workspace

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
        workspace = secant_workspace(len(middle) - 1, 3, 3)
        _write_spatial(self._frames.R, np.ascontiguousarray(middle), self.fixed[None], 0, 1.0, workspace)
        return workspace

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
        ne, d, r = line.length.size, line.dimension, line.frames.dofs
        workspace = secant_workspace(ne, d, r), np.empty((ne, 2, r, r))
        self.data, self._t = DirectorsInStep(fixed, np.zeros((len(fixed), ne, 2, d)), np.zeros(1), *workspace), math.inf

    def begin(self, t: float, v: Array) -> None:
        """Start from the accepted configuration with angular velocities v (nn, r)."""
        self._start(t, [each.rates(v) for each in self._moving])

    def _start(self, t: float, rates: Iterable[Array]) -> None:
        self._t, self.data.elapsed[0] = t, 0.0
        for stored, rate in zip(self.data.rate, rates, strict=True):
            stored[...] = rate

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
        """For each director once accepted: P (ne, 2, d, r), and its rate beyond that of angular velocities v."""
        pairs = zip(self._moving, self.data.rate, strict=True)
        return [(each.secant(np.zeros_like(v)).P, rate - each.rates(v)) for each, rate in pairs]

    def commit(self, t: float, end: Array) -> None:
        """Accept a step; to be called before the line's frames do."""
        self._start(t, self.rates(t, end))

    def state(self) -> Saved:
        return {"t": np.array(self._t), "rate": self.data.rate.copy()}

    def restore(self, saved: Saved) -> None:
        self._start(float(saved["t"]), [*saved["rate"]])


def secant_workspace(ne: int, d: int, r: int) -> Secant:
    return Secant(np.empty((ne, 2, d)), np.empty((ne, 2, d)), np.empty((ne, 2, d, r)), np.empty((ne, 2, d, r)))


@by_type
def write_secant(at: Configuration, motion: DirectorsInStep, k: int, share: float) -> None:
    """Write that of a director over a step whose middle is at a share of a configuration's rotation increments."""


@by_type
def write_turning_of(at: Configuration, motion: DirectorsInStep, F: Array) -> None:
    """Write the derivative of P^T F at fixed F (ne, 2, d) by the rotation increments of the middle, where `at` is, of
    the secant written last.
    """


@write_secant.of(PlanarConfiguration)
def _write_secant_in_plane(at: PlanarConfiguration, motion: DirectorsInStep, k: int, share: float) -> None:
    _write_planar(at.end_angle, motion.fixed[k, 0], at.Theta, share, 1.0 - share, motion.secant)


@write_secant.of(SpatialConfiguration)
def _write_secant_in_space(at: SpatialConfiguration, motion: DirectorsInStep, k: int, share: float) -> None:
    _write_spatial(at.Rn, at.Theta, motion.fixed, k, share, motion.secant)


@write_turning_of.of(PlanarConfiguration)
def _write_turning_in_plane(at: PlanarConfiguration, motion: DirectorsInStep, F: Array) -> None:
    """The directors' ends turn on by a right angle from `by_end`."""
    G, by_end = motion.turning, motion.secant.by_end
    for e in range(F.shape[0]):
        for side in range(2):
            G[e, side, 0, 0] = 0.5 * (by_end[e, side, 0, 0] * F[e, side, 1] - by_end[e, side, 1, 0] * F[e, side, 0])


@write_turning_of.of(SpatialConfiguration)
def _write_turning_in_space(at: SpatialConfiguration, motion: DirectorsInStep, F: Array) -> None:
    G, secant = motion.turning, motion.secant
    for e in range(F.shape[0]):
        for side in range(2):
            n, force = e + side, vector(F[e, side])
            spins, changes = transpose(matrix(at.H[n])), transpose(matrix(secant.by_end[e, side]))
            lever = moment_stiffness(
                matrix(at.Rn[n]), vector(at.Theta[n]), cross(vector(secant.mean[e, side]), force)
            )
            for k in range(3):
                for j in range(3):
                    G[e, side, k, j] = 0.5 * dot(spins[k], cross(changes[j], force)) + lever[k][j]


@njit
def write_accelerations(motion: DirectorsInStep, k: int, out: Array) -> None:
    """Write mean accelerations (ne, 2, d) of a director over a step, by the secant of its middle."""
    dt, change, rate = 2.0 * motion.elapsed[0], motion.secant.change, motion.rate
    for e in range(out.shape[0]):
        for side in range(2):
            for i in range(out.shape[2]):
                out[e, side, i] = 2.0 / dt * (change[e, side, i] / dt - rate[k, e, side, i])


@njit
def write_rates_at_end(at: Configuration, motion: DirectorsInStep, k: int, out: Array) -> None:
    """Write rates (ne, 2, d) of a director where a step begins, or where it ends in this configuration."""
    elapsed, change, rate = motion.elapsed[0], motion.secant.change, motion.rate
    if elapsed > 0.0:
        write_secant(at, motion, k, 0.5)
    for e in range(out.shape[0]):
        for side in range(2):
            for i in range(out.shape[2]):
                before = rate[k, e, side, i]
                out[e, side, i] = 2.0 / elapsed * change[e, side, i] - before if elapsed > 0.0 else before


@njit
def _write_planar(end_angle: Array, ahead: float, Theta: Array, share: float, beyond: float, out: Secant) -> None:
    """end_angle (ne, 2): of the tangents, at `beyond` of the increments Theta (nn, 1) past the middle at a share."""
    for e in range(end_angle.shape[0]):
        for side in range(2):
            half = share * Theta[e + side, 0]
            angle = end_angle[e, side] + ahead - beyond * Theta[e + side, 0]
            cosine, sine = math.cos(angle), math.sin(angle)
            near, far = math.cos(half), 2.0 * math.sin(half)
            p, z = near * cosine, near * sine
            way_p, way_z = -far * sine, far * cosine
            out.mean[e, side, 0], out.mean[e, side, 1] = p, z
            out.change[e, side, 0], out.change[e, side, 1] = way_p, way_z
            out.P[e, side, 0, 0], out.P[e, side, 1, 0] = -z, p
            out.by_end[e, side, 0, 0], out.by_end[e, side, 1, 0] = -2.0 * (z + 0.5 * way_z), 2.0 * (p + 0.5 * way_p)


@njit
def _change(rotation: Vec, d: Vec) -> Vec:
    """(exp[rotation] - I) d, exact to round-off of the small difference itself."""
    a, b, _ = exp_coefficients(dot(rotation, rotation))
    once = cross(rotation, d)
    return add(scale(a, once), scale(b, cross(rotation, once)))


@njit
def _write_spatial(Rn: Array, Theta: Array, fixed: Array, director: int, share: float, out: Secant) -> None:
    mean, change, P, by_end = out
    for e in range(mean.shape[0]):
        for side in range(2):
            n, d = e + side, vector(fixed[director, e, side])
            R, half = matrix(Rn[n]), scale(share, vector(Theta[n]))
            start, way = matvec(R, d), matvec(R, _change(scale(2.0, half), d))
            middle, end = add(start, scale(0.5, way)), add(start, way)
            mean[e, side, 0], mean[e, side, 1], mean[e, side, 2] = middle
            change[e, side, 0], change[e, side, 1], change[e, side, 2] = way
            spins, end_spins = transpose(_spins(R, half)), transpose(_spins(R, scale(2.0, half)))
            for k in range(3):
                P[e, side, 0, k], P[e, side, 1, k], P[e, side, 2, k] = cross(spins[k], middle)
                turned = scale(2.0, cross(end_spins[k], end))
                by_end[e, side, 0, k], by_end[e, side, 1, k], by_end[e, side, 2, k] = turned


@njit
def _spins(R: Mat, rotation: Vec) -> Mat:
    """H: the spin in global axes that increments of a rotation vector give, of a frame that was R before it."""
    return matmul(R, left_tangent(rotation))


@njit
def _rates(R: Array, v: Array, fixed: Array) -> Array:
    rates = np.empty(fixed.shape)
    for e in range(fixed.shape[0]):
        for side in range(2):
            turning = cross(vector(v[e + side]), vector(fixed[e, side]))
            rates[e, side, 0], rates[e, side, 1], rates[e, side, 2] = matvec(matrix(R[e + side]), turning)
    return rates
