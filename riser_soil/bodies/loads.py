"""What acts on a body: inertia with added mass, weight and buoyancy, and the water's motion.

The origin of the body's axes is at x, its frame is R, its spin H dTheta, v and W its rates. In body axes the origin has
the velocity b = R^T v, and with the mass matrix M (6, 6) of b and W, added mass included, the momenta are
(P, L) = M (b, W). Kirchhoff's equations give the force and moment

    f = P' + W x P,    m = L' + W x L + b x P,    b' = R^T a - W x b,

so that no energy is made, however different the added masses are (Lamb, Hydrodynamics, 1932, art. 124). Conjugate to
the dofs are R f and T_L(Theta) m. Where the water moves, its acceleration u' at the centre of buoyancy adds the force
(rho V + added mass) u' of Morison's formula; the added mass itself meets the body's own velocity.
Drag meets the velocity w through the water there: rho/2 CdA_i |w_i| w_i by body axis, of a point rho/2 CdA |w| w.
Drag, buoyancy and the water's acceleration act on the wet share, see `body.wet`; the added mass is that of all.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from riser_soil.bodies.body import MovingBody, radius_of, wet, wet_height
from riser_soil.core.arrays import Array
from riser_soil.core.part import Energy, Forces, MatrixBlock, State, Traits, Weights, Work
from riser_soil.riser import rotations
from riser_soil.riser.rotations import moment_stiffness
from riser_soil.riser.spatial_directors import SpatialOrientation
from riser_soil.riser.vectors import matrix, scale, skew, vector
from riser_soil.sea.flows import Sea, SeaAtPoints

STIFFER, LEAST = 10.0, 1e-6  # times the moment, of what holds a body as it is let go; its least force [N]


@dataclass(frozen=True, eq=False)
class BodyProperties:
    """mass [kg]; inertia (3,) about the centre of gravity [kg.m2]; gravity_centre, buoyancy_centre (3,) [m]; volume
    [m3]; drag (3,): CdA [m2]; spin_drag (3,) [m5]; added_mass (3,) [kg]; added_inertia (3,) about the centre of
    buoyancy [kg.m2]; by body axes. Of a point what turns is zero.
    """

    mass: float
    inertia: Array
    gravity_centre: Array
    volume: float
    buoyancy_centre: Array
    drag: Array
    spin_drag: Array
    added_mass: Array
    added_inertia: Array

    @property
    def radius(self) -> float:
        return radius_of(self.volume)

    def mass_matrix(self) -> Array:
        """M (6, 6) about the origin of the body's axes."""
        own = _about_origin(self.mass * np.eye(3), np.diag(self.inertia), self.gravity_centre)
        return own + _about_origin(np.diag(self.added_mass), np.diag(self.added_inertia), self.buoyancy_centre)


def _about_origin(mass: Array, inertia: Array, centre: Array) -> Array:
    """Of a mass matrix (3, 3) at a centre that moves with b + W x c, and an inertia about it."""
    lever = -_skew(centre)
    return np.block([[mass, mass @ lever], [lever.T @ mass, inertia + lever.T @ mass @ lever]])


def _skew(v: Array) -> Array:
    return np.array(skew(vector(v)))


class Posture(NamedTuple):
    """A body at a state: x, Theta, v, a, W, A (3,); R, H, Rn (3, 3); T: T_R(Theta), which gives its spin in its own
    axes.
    """

    x: Array
    Theta: Array
    v: Array
    a: Array
    W: Array
    A: Array
    R: Array
    H: Array
    Rn: Array
    T: Array


def posture(body: MovingBody, state: State) -> Posture:
    trial = body.trial(state)
    turn, v, a = trial.turn, body.nodal(state.v)[0], body.nodal(state.a)[0]
    assert isinstance(turn, SpatialOrientation)
    Theta, R, H = turn.Theta[0], turn.R[0], turn.H[0]
    W, A = (values[3:] if body.turns else np.zeros(3) for values in (v, a))
    return Posture(trial.x[0], Theta, v[:3], a[:3], W, A, R, H, turn.Rn[0], R.T @ H)


class BodyPart:
    """Base of a body's parts: wrenches conjugate to its dofs (6,) and their derivatives (6, 6), of which a point has
    the first three.
    """

    name: str
    group: str
    traits: Traits

    def __init__(self, body: MovingBody) -> None:
        self.body, self.active = body, body.active

    def blocks(self) -> dict[str, MatrixBlock]:
        return {self.body.name: self.body.block()}

    def wrench(self, state: State) -> Array:
        raise NotImplementedError

    def derivative(self, state: State, weights: Weights) -> Array:
        raise NotImplementedError

    def residual(self, state: State, forces: Forces) -> None:
        out = forces.inertia if self.group == "I" else forces.force
        out[self.body.part] += self.wrench(state)[: self.body.size]

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        weight, n = weights.inertia if self.group == "I" else weights.force, self.body.size
        if weight:
            values[self.body.name][0] += weight * self.derivative(state, weights)[:n, :n]

    def energy(self, state: State) -> Energy:
        return Energy()

    def work(self, before: State, after: State) -> Work:
        return Work()

    def commit(self, state: State) -> None:
        """Nothing is kept."""


def _on_dofs(at: Posture, force: Array, moment: Array) -> Array:
    """R f and T_L m of a force and a moment about the origin, both in body axes."""
    return np.concatenate([at.R @ force, at.T.T @ moment])


def _derivative_on_dofs(at: Posture, force: Array, moment: Array, changes: Array) -> Array:
    """Of `_on_dofs` (6, 6), with the changes (6, 6) of force and moment by the dofs."""
    out = np.concatenate([at.R @ changes[:3], at.T.T @ changes[3:]])
    out[:3, 3:] -= _skew(at.R @ force) @ at.H
    turned = rotations.right_tangent_derivative(scale(-1.0, vector(at.Theta)), vector(moment))
    out[3:, 3:] -= np.array(turned)  # T_L(x) = T_R(-x)
    return out


class BodyInertia(BodyPart):
    """Mass, inertia and added mass (group I), see the module's text. M: of `BodyProperties`."""

    name, group = "body inertia", "I"
    traits = Traits("I", symmetric=False)

    def __init__(self, body: MovingBody, M: Array) -> None:
        super().__init__(body)
        self.M = M

    def _momenta(self, at: Posture) -> tuple[Array, Array, Array, Array, Array]:
        """b, P, L, and the force and moment in body axes."""
        b, M = at.R.T @ at.v, self.M
        (P, L) = (M @ np.concatenate([b, at.W])).reshape(2, 3)
        rates = M @ np.concatenate([at.R.T @ at.a - np.cross(at.W, b), at.A])
        return b, P, L, rates[:3] + np.cross(at.W, P), rates[3:] + np.cross(at.W, L) + np.cross(b, P)

    def wrench(self, state: State) -> Array:
        at = posture(self.body, state)
        *_, force, moment = self._momenta(at)
        return _on_dofs(at, force, moment)

    def derivative(self, state: State, weights: Weights) -> Array:
        at = posture(self.body, state)
        b, P, L, force, moment = self._momenta(at)
        db, dW, dA = np.zeros((3, 6)), np.zeros((3, 6)), np.zeros((3, 6))
        db[:, :3], db[:, 3:] = weights.shift_v * at.R.T, _skew(b) @ at.T
        dW[:, 3:], dA[:, 3:] = weights.shift_v * np.eye(3), weights.shift_a * np.eye(3)
        rate = np.zeros((3, 6))
        rate[:, :3], rate[:, 3:] = weights.shift_a * at.R.T, _skew(at.R.T @ at.a) @ at.T
        rate += _skew(b) @ dW - _skew(at.W) @ db
        momenta, rates = self.M @ np.concatenate([db, dW]), self.M @ np.concatenate([rate, dA])
        spin = _skew(at.W)
        changes = rates + np.concatenate([spin @ momenta[:3] - _skew(P) @ dW, spin @ momenta[3:] - _skew(L) @ dW])
        changes[3:] += _skew(b) @ momenta[:3] - _skew(P) @ db
        return _derivative_on_dofs(at, force, moment, changes)

    def energy(self, state: State) -> Energy:
        at = posture(self.body, state)
        rates = np.concatenate([at.R.T @ at.v, at.W])
        return Energy(kinetic=0.5 * float(rates @ self.M @ rates))


class BodyWeight(BodyPart):
    """Weight, and buoyancy under calm water (group F), with a potential that is zero at z = 0, buoyancy's in the air.

    weight [N]; buoyancy: of the whole volume [N]. level: of the water [m], inf without a surface.
    """

    name, group = "body weight", "F"
    traits = Traits("F", symmetric=True)

    def __init__(self, body: MovingBody, given: BodyProperties, weight: float, buoyancy: float, level: float) -> None:
        super().__init__(body)
        self._given, self._weight, self._buoyancy, self._level = given, weight, buoyancy, level

    @property
    def load(self) -> float:
        """The larger of weight and buoyancy [N]."""
        return max(self._weight, self._buoyancy)

    def _wet(self, z: float) -> tuple[float, float]:
        return (1.0, 0.0) if np.isinf(self._level) else wet(self._level - z, self._given.radius)

    def _acting(self, at: Posture) -> list[tuple[Array, float, float]]:
        """Arms (3,) in global axes, upward residuals [N] and their slopes by height [N/m]."""
        low, high = at.R @ self._given.gravity_centre, at.R @ self._given.buoyancy_centre
        share, slope = self._wet(float(at.x[2] + high[2]))
        return [(low, self._weight, 0.0), (high, -self._buoyancy * share, self._buoyancy * slope)]

    def wrench(self, state: State) -> Array:
        at = posture(self.body, state)
        out = np.zeros(6)
        for arm, force, _ in self._acting(at):
            out[2] += force
            out[3:] += at.H.T @ np.cross(arm, [0.0, 0.0, force])
        return out

    def derivative(self, state: State, weights: Weights) -> Array:
        at, out = posture(self.body, state), np.zeros((6, 6))
        for arm, force, slope in self._acting(at):
            upward = np.array([0.0, 0.0, force])
            risen = np.concatenate([[0.0, 0.0, 1.0], (-_skew(arm) @ at.H)[2]])
            lever = moment_stiffness(matrix(at.Rn), vector(at.Theta), vector(np.cross(arm, upward)))
            out += slope * np.outer(risen, risen)
            out[3:, 3:] += at.H.T @ _skew(upward) @ _skew(arm) @ at.H + np.array(lever)
        return out

    def energy(self, state: State) -> Energy:
        at, given = posture(self.body, state), self._given
        low, high = (float(at.x[2] + (at.R @ c)[2]) for c in (given.gravity_centre, given.buoyancy_centre))
        lifted = -high if np.isinf(self._level) else wet_height(self._level - high, given.radius)
        return Energy(potential=self._weight * low + self._buoyancy * lifted)


class BodyDrag(BodyPart):
    """Drag, and what moving water adds to buoyancy and added mass (group F), see the module's text.

    sea: the water. rho [kg/m3]. buoyancy: of the whole volume [N], where the surface moves, else 0. level: of calm
    water [m]. still: whether all work is lost.
    """

    name, group = "body drag", "F"
    traits = Traits("F", symmetric=False, follows=True)

    def __init__(
        self, body: MovingBody, given: BodyProperties, sea: Sea, rho: float, buoyancy: float, level: float, still: bool
    ) -> None:
        super().__init__(body)
        self._given, self._water, self._rho, self._buoyancy = given, SeaAtPoints(sea, 1), rho, buoyancy
        self._level, self._still = level, still
        self._pushed = rho * given.volume + given.added_mass

    def _found(self, state: State) -> tuple[Posture, Array, Array, Array, Array, Array]:
        """Posture; force at the centre of buoyancy and moment in body axes, and their changes (3, 6) with the dofs, but
        for those of rates (3, 3) by w and by W.
        """
        given, at = self._given, posture(self.body, state)
        c = given.buoyancy_centre
        arm = at.R @ c
        water = self._water(state.t, (at.x + arm)[None])
        moved = np.concatenate([np.eye(3), -_skew(arm) @ at.H], axis=1)  # of the centre, by the dofs
        share, slope = wet(float(water.immersion[0]), given.radius) if np.isfinite(water.immersion[0]) else (1.0, 0.0)
        more = slope * water.immersion_gradient[0] @ moved
        turned = np.concatenate([np.zeros((3, 3)), at.T], axis=1)
        u, du = water.velocity[0], water.velocity_gradient[0] @ moved
        p, dp = water.acceleration[0], water.acceleration_gradient[0] @ moved
        w = at.R.T @ (at.v - u) + np.cross(at.W, c)
        dw = _skew(at.R.T @ (at.v - u)) @ turned - at.R.T @ du
        drag, by_w = self._drag(w)
        push, dpush = at.R.T @ p, at.R.T @ dp + _skew(at.R.T @ p) @ turned
        force = drag - self._pushed * push
        up, dup = self._heave(at, arm, moved, share, more)
        twist, by_W = self._twist(at.W)
        changes = share * (by_w @ dw - self._pushed[:, None] * dpush) + np.outer(force, more) + dup
        spins = np.outer(twist, more)
        return at, share * force + up, share * twist, np.concatenate([changes, spins]), share * by_w, share * by_W

    def _heave(self, at: Posture, arm: Array, moved: Array, share: float, more: Array) -> tuple[Array, Array]:
        """Less the buoyancy that the moving surface has beyond the calm one's, in body axes, and its change."""
        if self._buoyancy == 0.0:
            return np.zeros(3), np.zeros((3, 6))
        calm, slope = wet(self._level - float((at.x + arm)[2]), self._given.radius)
        force = -self._buoyancy * (share - calm)
        up, turned = at.R[2], np.concatenate([np.zeros((3, 3)), at.T], axis=1)
        return force * up, force * _skew(up) @ turned - self._buoyancy * np.outer(up, more + slope * moved[2])

    def _drag(self, w: Array) -> tuple[Array, Array]:
        c = 0.5 * self._rho * self._given.drag
        if self.body.turns:
            return c * np.abs(w) * w, np.diag(2.0 * c * np.abs(w))
        speed = float(np.linalg.norm(w))
        along = np.outer(w, w) / speed if speed > 0.0 else np.zeros((3, 3))
        return c * speed * w, c[0] * (speed * np.eye(3) + along)

    def _twist(self, W: Array) -> tuple[Array, Array]:
        c = 0.5 * self._rho * self._given.spin_drag
        return c * np.abs(W) * W, np.diag(2.0 * c * np.abs(W))

    def wrench(self, state: State) -> Array:
        at, force, twist, *_ = self._found(state)
        return _on_dofs(at, force, np.cross(self._given.buoyancy_centre, force) + twist)

    def derivative(self, state: State, weights: Weights) -> Array:
        at, force, twist, changes, by_w, by_W = self._found(state)
        lever = _skew(self._given.buoyancy_centre)
        changes[:3, :3] += weights.shift_v * by_w @ at.R.T
        changes[:3, 3:] -= weights.shift_v * by_w @ lever
        changes[3:, 3:] += weights.shift_v * by_W
        changes[3:] += lever @ changes[:3]
        return _derivative_on_dofs(at, force, lever @ force + twist, changes)

    def work(self, before: State, after: State) -> Work:
        mean, n = 0.5 * (self.wrench(before) + self.wrench(after)), self.body.size
        taken = float(mean[:n] @ (after.u - before.u)[self.body.part])
        return Work(dissipated=taken) if self._still else Work(external=-taken)


class Release(BodyPart):
    """What has held a body, in the stage in which it is let go: a spring to where it is, and to how it stands, that has
    the reaction at first and gets as soft as the load factor grows (group F).

    reaction (6,): conjugate to its dofs as it was held [N, N.m]. With a potential, so that it can't tip the body over.
    """

    name, group = "release", "F"
    traits = Traits("F", symmetric=True)

    def __init__(self, body: MovingBody, reaction: Array) -> None:
        super().__init__(body)
        whole = np.zeros(6)
        whole[: body.size] = reaction
        force, moment = float(np.linalg.norm(whole[:3])), float(np.linalg.norm(whole[3:]))
        self.k = max(force, LEAST) / body.lever
        self.kr = STIFFER * (moment + max(force, LEAST) * body.lever)
        turned = body.frames.R[0] @ whole[3:] / self.kr
        self._x = body.x[0] + whole[:3] / self.k
        self._R = np.array(rotations.exp(vector(turned))) @ body.frames.R[0]

    def _turn(self, at: Posture) -> Array:
        return np.array(rotations.log(matrix(at.R @ self._R.T)))

    def wrench(self, state: State) -> Array:
        at = posture(self.body, state)
        moment = self.kr * at.H.T @ self._turn(at)
        return (1.0 - state.t) * np.concatenate([self.k * (at.x - self._x), moment])

    def derivative(self, state: State, weights: Weights) -> Array:
        at, out = posture(self.body, state), np.zeros((6, 6))
        turn = self._turn(at)
        out[:3, :3] = self.k * np.eye(3)
        spin = np.array(rotations.left_tangent_inverse(vector(turn)))
        lever = moment_stiffness(matrix(at.Rn), vector(at.Theta), vector(self.kr * turn))
        out[3:, 3:] = self.kr * at.H.T @ spin @ at.H + np.array(lever)
        return (1.0 - state.t) * out
