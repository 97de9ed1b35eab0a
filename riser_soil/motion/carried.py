"""Prescribed end motion by a displacement and a rotation vector given together, as by a table or a vessel."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.riser import rotations
from riser_soil.riser.ends import Kinematics, SupportRotation
from riser_soil.riser.vectors import matrix, vector

SixDegreeMotion = Callable[[float], Kinematics]
"""Seconds since the stage began -> displacement [m] and rotation vector [rad] in global axes (6,), and their first two
derivatives.
"""


@dataclass(frozen=True, eq=False)
class CarriedEnd:
    """`origin` (3,) [m], displaced by the first three of six."""

    origin: Array
    six: SixDegreeMotion

    def __call__(self, t: float) -> Kinematics:
        """Position [m], velocity [m/s] and acceleration [m/s2] at t [s]."""
        x, v, a = self.six(t)
        return self.origin + x[:3], v[:3], a[:3]


@dataclass(frozen=True, eq=False)
class CarriedSupport:
    """A support turned by the last three of six, a rotation vector, from where it is at t = 0."""

    six: SixDegreeMotion

    def __call__(self, t: float) -> SupportRotation:
        """Turning at t [s]."""
        rotation, rate, acceleration = (values[3:] for values in self.six(t))
        return SupportRotation(self._from_first(rotation), *angular_rates(rotation, rate, acceleration))

    def _from_first(self, rotation: Array) -> Array:
        """The rotation vector from where the support is at t = 0."""
        if self._back is None:
            return rotation
        return np.array(rotations.log(matrix(np.array(rotations.exp(vector(rotation))) @ self._back)))

    @cached_property
    def _back(self) -> Array | None:
        """The first rotation undone, (3, 3); None where there is none."""
        first = self.six(0.0)[0][3:]
        return np.array(rotations.exp(vector(-first))) if np.any(first) else None


def angular_rates(rotation: Array, rate: Array, acceleration: Array) -> tuple[Array, Array]:
    """Angular velocity and acceleration (3,) in global axes of exp[rotation] from a rotation vector's derivatives.

    w = T_L(theta) theta', w' = T_L(theta) theta'' + d(T_L(theta) theta')/dtheta theta'.
    """
    tangent = np.array(rotations.left_tangent(vector(rotation)))
    change = -np.array(rotations.right_tangent_derivative(vector(-rotation), vector(rate)))
    return tangent @ rate, tangent @ acceleration + change @ rate
