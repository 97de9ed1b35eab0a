"""The elastic catenary between two points, hanging freely or resting on a level, frictionless seabed.

With H the horizontal tension, w the submerged weight per unstressed length, a = H/w and s the unstressed
length from the lowest point, the line hangs as

    x = a asinh(s/a) + H s/EA,    z = sqrt(a^2 + s^2) - a + w s^2/(2 EA),    T = w sqrt(a^2 + s^2).

Where it rests it carries T = H. The inextensible limits are sqrt(L^2 - v^2) = 2 a sinh(h/2a) for spans h and
v, and s^2 = v^2 + 2 a v for the suspended length s of a line that rests. Source: Irvine, Cable Structures
(1981), chapter 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from riser_soil.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.riser.shapes import UP, Curve, X, from_nodes


@dataclass(frozen=True, eq=False)
class Catenary:
    """Curve of the line, tensions (nn,) N, and horizontal tension H (N)."""

    curve: Curve
    tension: Array
    H: float


@dataclass(frozen=True)
class Rope:
    """Unstressed length L [m], submerged weight w [N/m], stiffness EA [N]; spans h and v [m] between its
    ends.
    """

    L: float
    w: float
    EA: float
    h: float
    v: float


def catenary(
    arc: Array, start: Array, end: Array, weight: float, EA: float, level: float = -np.inf
) -> Catenary:
    """Shape and tension of a line of length arc[-1] between two points, as an initial guess that carries its
    own weight.

    arc: (nn,) unstressed arc length of the nodes. weight: N/m, positive, averaged over the line. EA: N.
    level: height [m] at which the line rests on the seabed; by default there is none.
    """
    rope = _rope(arc, start, end, weight, EA, level)
    across = np.array([end[0] - start[0], end[1] - start[1], 0.0])
    direction = across / rope.h if rope.h > 0.0 else X
    profile = _hanging(rope, arc)
    if start[2] + profile.z.min() < level - 1e-9 * rope.L:
        profile = _resting(rope, arc, start[2] - level)
    position = start + profile.x[:, None] * direction + profile.z[:, None] * UP
    force = profile.H * direction + profile.V[:, None] * UP
    tension = np.linalg.norm(force, axis=1)
    return Catenary(from_nodes(position, force / tension[:, None]), tension, profile.H)


@dataclass(frozen=True, eq=False)
class _Profile:
    """x and z from the start (nn,) m; horizontal and vertical (nn,) tension, N."""

    x: Array
    z: Array
    H: float
    V: Array


def _rope(arc: Array, start: Array, end: Array, weight: float, EA: float, level: float) -> Rope:
    h = float(np.hypot(end[0] - start[0], end[1] - start[1]))
    rope = Rope(float(arc[-1]), weight, EA, h, float(end[2] - start[2]))
    distance = float(np.hypot(h, rope.v))
    if weight <= 0.0:
        raise SceneError(
            f"riser.initial: catenary: needs a positive submerged weight, not {weight:.6g} N/m; give points"
        )
    if distance * (1.0 + 1e-9) >= rope.L:
        raise SceneError(
            f"riser: too short for a catenary: its length of {rope.L:.6g} m must exceed "
            f"the {distance:.6g} m between its ends"
        )
    if h < 1e-6 * rope.L:
        raise SceneError(
            f"riser.initial: catenary: the ends are only {h:.3g} m apart horizontally; give initial points"
        )
    if min(start[2], end[2]) < level - 1e-9 * rope.L:
        low = float(min(start[2], end[2]))
        raise SceneError(
            f"riser: an end at z = {low:.6g} m lies below the level {level:.6g} m at which the riser rests"
        )
    return rope


def _bisect(f: Callable[[float], float], low: float, high: float) -> float:
    """Root of an increasing function between low and high, to round-off."""
    for _ in range(200):
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        low, high = (middle, high) if f(middle) < 0.0 else (low, middle)
    return 0.5 * (low + high)


def _drop(a: float, s: Array | float) -> Array:
    """sqrt(a^2 + s^2) - a without cancellation."""
    return np.asarray(np.square(s) / (np.hypot(a, s) + a))


def _hanging(rope: Rope, arc: Array) -> _Profile:
    a, s0 = _stretched(rope, *_inextensible(rope))
    s, per_EA = arc - s0, rope.w / rope.EA
    x = a * (np.arcsinh(s / a) + np.arcsinh(s0 / a)) + a * per_EA * arc
    z = _drop(a, s) - _drop(a, s0) + 0.5 * per_EA * (s**2 - s0**2)
    return _Profile(x, z, rope.w * a, rope.w * s)


def _inextensible(rope: Rope) -> tuple[float, float]:
    """a, and the arc length s0 of the lowest point (it may lie beyond the ends): sinh(y)/y is known for y =
    h/2a.
    """
    ratio = np.sqrt(rope.L**2 - rope.v**2) / rope.h
    log_y = _bisect(lambda log_y: _log_sinhc(np.exp(log_y)) - np.log(ratio), -20.0, 20.0)
    a = 0.5 * rope.h / np.exp(log_y)
    return a, a * np.sinh(0.5 * rope.h / a - np.arctanh(rope.v / rope.L))


def _log_sinhc(y: float) -> float:
    """log(sinh(y)/y), also where sinh would overflow or the quotient is 1."""
    if y < 1e-3:
        return y * y / 6.0
    return float(y + np.log(-np.expm1(-2.0 * y)) - np.log(2.0 * y))


def _stretched(rope: Rope, a: float, s0: float) -> tuple[float, float]:
    """Newton from the inextensible catenary to the elastic one, in log(a) and s0."""
    for _ in range(50):
        misfit, jacobian = _misfit(rope, a, s0)
        if np.linalg.norm(misfit) < 1e-12 * rope.L:
            return float(a), float(s0)
        step = np.linalg.solve(jacobian, -misfit)
        step /= max(1.0, abs(step[0]), abs(step[1]) / rope.L)
        a, s0 = a * np.exp(step[0]), s0 + step[1]
    raise SceneError("riser.initial: catenary: found none between the ends; give initial points")


def _misfit(rope: Rope, a: float, s0: float) -> tuple[Array, Array]:
    """End position minus where it should be, and its derivatives with respect to log(a) and s0."""
    ends, per_EA = np.array([rope.L - s0, -s0]), rope.w / rope.EA
    angle, radius = np.arcsinh(ends / a), np.hypot(a, ends)
    x = a * (angle[0] - angle[1]) + a * per_EA * rope.L - rope.h
    z = _drop(a, ends[0]) - _drop(a, ends[1]) + 0.5 * per_EA * (ends[0] ** 2 - ends[1] ** 2) - rope.v
    x_a = (angle - ends / radius) @ [1.0, -1.0] + per_EA * rope.L
    z_a = (a / radius) @ [1.0, -1.0]
    x_s = -(a / radius) @ [1.0, -1.0]
    z_s = -(ends / radius) @ [1.0, -1.0] - per_EA * rope.L
    return np.array([x, z]), np.array([[a * x_a, x_s], [a * z_a, z_s]])


def _suspended(rope: Rope, a: float, height: float) -> float:
    """Unstressed length that hangs from `height` down to the seabed."""
    top = np.sqrt(height * (height + 2.0 * a))
    return _bisect(
        lambda s: float(_drop(a, s)) + 0.5 * rope.w / rope.EA * s**2 - height, 0.0, float(top) * (1.0 + 1e-15)
    )


def _reach(rope: Rope, a: float, s: float) -> float:
    """Horizontal reach of a hanging length."""
    return float(a * np.arcsinh(s / a) + a * rope.w / rope.EA * s)


def _resting(rope: Rope, arc: Array, height: float) -> _Profile:
    """Ends at `height` and `height` + v above the seabed, the middle resting on it."""
    heights = (height, height + rope.v)

    def overshoot(a: float) -> float:
        hanging = [_suspended(rope, a, z) for z in heights]
        resting = (rope.L - sum(hanging)) * (1.0 + a * rope.w / rope.EA)
        return sum(_reach(rope, a, s) for s in hanging) + resting - rope.h

    least = rope.L - sum(_suspended(rope, 1e-12 * rope.L, z) for z in heights)
    if overshoot(1e-9 * rope.L) > 0.0:
        raise SceneError(
            f"riser: too long: with {least:.6g} m left to rest on the seabed it cannot end "
            f"{rope.h:.6g} m away without slack; shorten it or give initial points"
        )
    a = float(
        np.exp(_bisect(lambda log_a: overshoot(np.exp(log_a)), np.log(1e-9 * rope.L), np.log(1e9 * rope.L)))
    )
    first, last = (_suspended(rope, a, z) for z in heights)
    s = np.where(arc < first, arc - first, np.maximum(arc - (rope.L - last), 0.0))
    ground = np.clip(arc - first, 0.0, rope.L - first - last) * (1.0 + a * rope.w / rope.EA)
    hung = a * np.arcsinh(s / a) + a * rope.w / rope.EA * s
    z = _drop(a, s) + 0.5 * rope.w / rope.EA * s**2 - height
    return _Profile(_reach(rope, a, first) + hung + ground, z, rope.w * a, rope.w * s)
