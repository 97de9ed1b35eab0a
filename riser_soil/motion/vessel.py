"""An end that belongs to a vessel in waves."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from riser_soil.arrays import Array
from riser_soil.motion.ramped import ramped
from riser_soil.riser.ends import Kinematics


@dataclass(frozen=True, eq=False)
class Response:
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
class Berth:
    """Where a stage finds an end on its vessel.

    origin: (3,) the end's position at the stage's beginning [m]. reference: (3,) the point that the response belongs
    to, where the vessel is at rest [m]. clock: what the waves' clock shows then [s]. since: how long the vessel has
    been moving then [s].
    """

    origin: Array
    reference: Array
    clock: float
    since: float


@dataclass(frozen=True, eq=False)
class Vessel:
    """Displacement from the stage's beginning and rotation vector (6,) of an end on a vessel, and their derivatives.

    Linear, as RAOs are: the displacement is s + theta x arm, the arm being that of the vessel at rest. The response
    grows with a smooth step of ramp [s].
    """

    response: Response
    berth: Berth
    ramp: float

    def __call__(self, t: float) -> Kinematics:
        x, v, a = self._moved(t)
        return np.concatenate([x[:3] - self._first[:3], x[3:]]), v, a

    @cached_property
    def _first(self) -> Array:
        """The end's displacement and rotation as the stage begins."""
        return self._moved(0.0)[0]

    def _moved(self, t: float) -> Kinematics:
        x, v, a = (_carried(values, self._arm) for values in self._at_reference(t))
        return x, v, a

    def _at_reference(self, t: float) -> Kinematics:
        x, v, a = self.response(self.berth.clock + t)
        return ramped(self.berth.since + t, self.ramp, x, v, a)

    @cached_property
    def _arm(self) -> Array:
        """From the reference to the end, the vessel at rest: origin - reference = arm + s + theta x arm."""
        first = self._at_reference(0.0)[0]
        spin = np.cross(np.eye(3), first[3:])  # spin @ arm is theta x arm
        return np.linalg.solve(np.eye(3) + spin, self.berth.origin - self.berth.reference - first[:3])


def _carried(values: Array, arm: Array) -> Array:
    """The six of a point at an arm from those of the reference."""
    return np.concatenate([values[:3] + np.cross(values[3:], arm), values[3:]])
