"""Prescribed motion of an end on a rigid body, as on a vessel, and by a displacement with a rotation vector."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.riser import rotations
from riser_soil.riser.line_ends import Kinematics, SupportRotation
from riser_soil.riser.vectors import matrix, vector

SixDegreeMotion = Callable[[float], Kinematics]


class Attitude(NamedTuple):
    """How a body is turned: R (3, 3) from its rest, angular velocity [rad/s] and acceleration [rad/s2] (3,)."""

    R: Array
    w: Array
    dw: Array


@dataclass(frozen=True, eq=False)
class RigidBody:
    """A body's displacement and attitude in global axes.

    six: seconds since the stage began -> surge, sway, heave [m], roll, pitch, yaw [rad], and their first two
    derivatives. axes: (3, 3), columns: forward, to port and up, the body at rest. The rotation is yaw about the body's
    upward axis, then pitch about the axis to port that yaw has turned, then roll about the forward axis that both have:
    R = Rz(yaw) Ry(pitch) Rx(roll), right-handed. Displacements are along the axes at rest.
    """

    six: Callable[[float], Kinematics]
    axes: Array

    def displacement(self, t: float) -> Kinematics:
        """Displacement (3,) [m] of the reference point, its velocity [m/s] and acceleration [m/s2]."""
        x, v, a = (self.axes @ values[:3] for values in self.six(t))
        return x, v, a

    def attitude(self, t: float) -> Attitude:
        """Attitude with spins e1 yaw', e2 pitch', e3 roll' about axes that turn: e2' = w1 x e2, e3' = (w1 + w2) x e3.
        """
        angles, rates, accelerations = (values[3:] for values in self.six(t))
        forward, port, up = self.axes.T
        yawed = _turn(up, angles[2])
        pitched = _turn(yawed @ port, angles[1]) @ yawed
        port, forward = yawed @ port, pitched @ forward
        yawing, pitching, rolling = rates[2] * up, rates[1] * port, rates[0] * forward
        turned = accelerations[2] * up + accelerations[1] * port + accelerations[0] * forward
        turned = turned + np.cross(yawing, pitching) + np.cross(yawing + pitching, rolling)
        return Attitude(_turn(forward, angles[0]) @ pitched, yawing + pitching + rolling, turned)


def _turn(axis: Array, angle: float) -> Array:
    """Rotation matrix (3, 3) about a unit vector."""
    x, y, z = (float(value) for value in angle * axis)
    return np.array(rotations.exp((x, y, z)))


@dataclass(frozen=True, eq=False)
class CarriedPoint:
    """A point of a body, where the body is at rest at `origin` (3,), its reference then at `reference` (3,) [m]."""

    body: RigidBody
    origin: Array
    reference: Array

    def __call__(self, t: float) -> Kinematics:
        """Position, velocity and acceleration: x = reference + d + R r, x'' = d'' + w' x R r + w x (w x R r)."""
        (x, v, a), (R, w, dw) = self.body.displacement(t), self.body.attitude(t)
        arm = R @ (self.origin - self.reference)
        spun: Array = np.cross(w, arm)
        hurled: Array = np.cross(dw, arm) + np.cross(w, spun)
        return self.reference + x + arm, v + spun, a + hurled


@dataclass(frozen=True, eq=False)
class CarriedFrame:
    """A support that turns with a body."""

    body: RigidBody

    def __call__(self, t: float) -> SupportRotation:
        """Turning at t [s]."""
        R, w, dw = self.body.attitude(t)
        return SupportRotation(np.array(rotations.log(matrix(R))), w, dw)


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
