"""Prescribed motion of an end on a vessel in waves, by response amplitude operators (RAOs)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.motion.prescribed import ramped
from riser_soil.riser.line_ends import Kinematics

TURN = 2.0 * np.pi


@dataclass(frozen=True, eq=False)
class VesselResponse:
    """A vessel's motion at its reference point, the sum of Re(amplitude exp(i w t)); t: the waves' clock [s].

    frequency: w (n,) [rad/s]. amplitude: (n, 6), displacement [m] and rotation [rad] along and about global axes.
    """

    frequency: Array
    amplitude: Array

    def __call__(self, t: float) -> Kinematics:
        """Displacement and rotation (6,) at t, and their derivatives."""
        turning = np.exp(1j * self.frequency * t)
        x, v, a = (np.real(turning * (1j * self.frequency) ** order @ self.amplitude) for order in range(3))
        return x, v, a


@dataclass(frozen=True, eq=False)
class VesselAttachment:
    """Position of an end on its vessel: its mean, and where it was found as the vessel began to move it.

    mean: (3,) the end while the vessel is at rest [m]. reference: (3,) the point that the response belongs to, then
    [m]. offset: (6,) the end's displacement from there [m] and rotation vector [rad] as the vessel began to move: not
    zero where the vessel moves again after a rest.
    """

    mean: Array
    reference: Array
    offset: Array


@dataclass(frozen=True, eq=False)
class VesselMotion:
    """Displacement from the mean and rotation vector (6,) of an end on a vessel, and their derivatives.

    r response + (1 - r) offset, r being a smooth step of ramp [s]. Linear, as RAOs are: the response of the end is
    s + theta x arm, the arm being that of the vessel at rest. clock: what the waves' clock shows as the stage begins
    [s]. since: how long the vessel has been moving then [s].
    """

    response: VesselResponse
    attachment: VesselAttachment
    ramp: float
    clock: float
    since: float

    def __call__(self, t: float) -> Kinematics:
        response = self.response(self.clock + t)
        x, v, a = (_carried(values, self.attachment.mean - self.attachment.reference) for values in response)
        x, v, a = ramped(self.since + t, self.ramp, x - self.attachment.offset, v, a)
        return x + self.attachment.offset, v, a


def _carried(values: Array, arm: Array) -> Array:
    """The six of a point at an arm from those of the reference."""
    return np.concatenate([values[:3] + np.cross(values[3:], arm), values[3:]])


@dataclass(frozen=True, eq=False)
class RaoTable:
    """Complex responses to unit waves, amplitude times exp(-i lag).

    frequency: (nf,) increasing [rad/s]. direction: (nd,) increasing from 0 to below 2 pi [rad]. response: (nd, nf, m).
    """

    frequency: Array
    direction: Array
    response: Array

    def at(self, w: Array, direction: Array) -> Array:
        """Responses (n, m) to waves of frequencies w and directions (n,), linear between the table's, in frequency and,
        periodically, in direction; beyond the table's frequencies those at its ends.
        """
        first, last, share = self._between(direction)
        by_direction = (1.0 - share)[:, None, None] * self.response[first] + share[:, None, None] * self.response[last]
        response = np.empty((w.size, self.response.shape[2]), dtype=complex)
        for n, table in enumerate(by_direction):
            response[n] = [np.interp(w[n], self.frequency, column) for column in table.T]
        return response

    def beyond(self, w: Array) -> tuple[BoolArray, BoolArray]:
        """Which waves lie below and above the table's frequencies, but for round-off (n,)."""
        return w < self.frequency[0] * (1.0 - 1e-9), w > self.frequency[-1] * (1.0 + 1e-9)

    def _between(self, direction: Array) -> tuple[IntArray, IntArray, Array]:
        """Numbers of the directions before and after each direction, and the share of the latter."""
        angle = np.mod(direction, TURN)
        last: IntArray = np.searchsorted(self.direction, angle, side="right") % self.direction.size
        first = last - 1
        width = np.mod(self.direction[last] - self.direction[first], TURN)
        width[width == 0.0] = TURN
        share = np.mod(angle - self.direction[first], TURN) / width
        return first, last, np.where(share > 1.0 - 1e-9, 1.0, np.where(share < 1e-9, 0.0, share))
