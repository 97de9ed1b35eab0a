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

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from riser_soil.bodies.body import MovingBody, radius_of, wet, wet_height
from riser_soil.core.arrays import Array
from riser_soil.core.bound import Calls, call_each, calls
from riser_soil.core.compiled import njit
from riser_soil.core.part import State, Traits, Work
from riser_soil.riser import rotations
from riser_soil.riser.configuration import Maps, SpatialConfiguration
from riser_soil.riser.line_part import CompiledPart
from riser_soil.riser.part_kernels import LineForces, LineWeights, add_energy, add_forces, add_tangent
from riser_soil.riser.rotations import moment_stiffness
from riser_soil.riser.vectors import (
    Mat,
    Vec,
    add,
    cross,
    dot,
    isotropic,
    matadd,
    matmul,
    matrix,
    matscale,
    matvec,
    norm,
    outer,
    scale,
    skew,
    sub,
    transpose,
    vecmat,
    vector,
)
from riser_soil.sea.flows import Sea, WaterMotion, motion_of, motion_workspace

STIFFER, LEAST = 10.0, 1e-6  # times the moment, of what holds a body as it is let go; its least force [N]
NONE: Mat = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


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
    """A body in a configuration: place, rates and accelerations of translation and rotation; frame R and spin H, and T,
    which gives the spin in the body's own axes.
    """

    x: Vec
    v: Vec
    a: Vec
    W: Vec
    A: Vec
    R: Mat
    H: Mat
    T: Mat


@njit
def posture(at: SpatialConfiguration) -> Posture:
    R, H = matrix(at.frames[0]), matrix(at.H[0])
    rates = vector(at.v[0, :3]), vector(at.a[0, :3]), vector(at.v[0, 3:]), vector(at.a[0, 3:])
    return Posture(vector(at.x[0]), *rates, R, H, matmul(transpose(R), H))


class Changes(NamedTuple):
    """Derivatives of a force and a moment in body axes by the place and by the rotation dofs."""

    force_by_place: Mat
    force_by_turn: Mat
    moment_by_place: Mat
    moment_by_turn: Mat


@njit
def _add_in_body_axes(at: Posture, force: Vec, moment: Vec, out: Array) -> None:
    """Add R f and T_L m of a force and a moment about the origin, both in body axes, to the dofs' (6,)."""
    _add_to(out, matvec(at.R, force), vecmat(moment, at.T))


@njit
def _add_to(out: Array, force: Vec, moment: Vec) -> None:
    for i in range(3):
        out[i] += force[i]
        out[3 + i] += moment[i]


@njit
def _add_changes(K: Array, weight: float, at: Posture, Theta: Vec, force: Vec, moment: Vec, by: Changes) -> None:
    """Add weight times the derivative of what `_add_in_body_axes` adds to K (6, 6)."""
    T = transpose(at.T)
    force_by_turn = matadd(matmul(at.R, by.force_by_turn), matscale(-1.0, matmul(skew(matvec(at.R, force)), at.H)))
    turned = rotations.right_tangent_derivative(scale(-1.0, Theta), moment)  # T_L(x) = T_R(-x)
    moment_by_turn = matadd(matmul(T, by.moment_by_turn), matscale(-1.0, turned))
    by_place = matmul(at.R, by.force_by_place), matmul(T, by.moment_by_place)
    _add_blocks(K, weight, by_place[0], force_by_turn, by_place[1], moment_by_turn)


@njit
def _add_blocks(K: Array, weight: float, xx: Mat, xt: Mat, tx: Mat, tt: Mat) -> None:
    """Add weight times a matrix (6, 6) by its blocks."""
    for i in range(3):
        for j in range(3):
            K[i, j] += weight * xx[i][j]
            K[i, 3 + j] += weight * xt[i][j]
            K[3 + i, j] += weight * tx[i][j]
            K[3 + i, 3 + j] += weight * tt[i][j]


@njit
def _by_axes(a: Vec, b: Vec) -> Vec:
    return (a[0] * b[0], a[1] * b[1], a[2] * b[2])


@njit
def _scaled_rows(a: Vec, A: Mat) -> Mat:
    return (scale(a[0], A[0]), scale(a[1], A[1]), scale(a[2], A[2]))


@njit
def _resistance(c: Vec, v: Vec) -> tuple[Vec, Vec]:
    """c |v| v by axis, and its slopes by v."""
    speeds = (abs(v[0]), abs(v[1]), abs(v[2]))
    return _by_axes(_by_axes(c, speeds), v), _by_axes(scale(2.0, c), speeds)


class InertiaData(NamedTuple):
    """M (6, 6), of `BodyProperties`."""

    M: Array


@njit
def _momenta(part: InertiaData, b: Vec, W: Vec) -> tuple[Vec, Vec]:
    """M times the rates of translation and rotation, or their accelerations."""
    M = part.M
    linear = add(matvec(matrix(M[:3, :3]), b), matvec(matrix(M[:3, 3:]), W))
    return linear, add(matvec(matrix(M[3:, :3]), b), matvec(matrix(M[3:, 3:]), W))


@njit
def _momenta_by(part: InertiaData, b: Mat, W: Mat) -> tuple[Mat, Mat]:
    """The same of their derivatives."""
    M = part.M
    linear = matadd(matmul(matrix(M[:3, :3]), b), matmul(matrix(M[:3, 3:]), W))
    return linear, matadd(matmul(matrix(M[3:, :3]), b), matmul(matrix(M[3:, 3:]), W))


@njit
def _inertial(part: InertiaData, at: Posture) -> tuple[Vec, Vec, Vec, Vec, Vec]:
    """b, P, L, and the force and moment in body axes."""
    b = vecmat(at.v, at.R)
    P, L = _momenta(part, b, at.W)
    force, moment = _momenta(part, sub(vecmat(at.a, at.R), cross(at.W, b)), at.A)
    return b, P, L, add(force, cross(at.W, P)), add(moment, add(cross(at.W, L), cross(b, P)))


@add_forces.of(InertiaData)
def _add_inertia(part: InertiaData, at: SpatialConfiguration, out: LineForces) -> None:
    here = posture(at)
    _, _, _, force, moment = _inertial(part, here)
    _add_in_body_axes(here, force, moment, out.inertia[0])


@add_tangent.of(InertiaData)
def _add_tangent_of_inertia(
    part: InertiaData, at: SpatialConfiguration, maps: Maps, weights: LineWeights, K: Array
) -> None:
    here, shift_v, shift_a = posture(at), maps.shift_v, maps.shift_a
    b, P, L, force, moment = _inertial(part, here)
    inverse, spin, drift = transpose(here.R), skew(here.W), skew(b)
    b_by_place, b_by_turn = matscale(shift_v, inverse), matmul(drift, here.T)
    rate_by_place = matadd(matscale(shift_a, inverse), matscale(-1.0, matmul(spin, b_by_place)))
    rate_by_turn = matmul(skew(vecmat(here.a, here.R)), here.T)
    rate_by_turn = matadd(rate_by_turn, matadd(matscale(shift_v, drift), matscale(-1.0, matmul(spin, b_by_turn))))
    P_by_place, L_by_place = _momenta_by(part, b_by_place, NONE)
    P_by_turn, L_by_turn = _momenta_by(part, b_by_turn, isotropic(shift_v))
    force_by_place, moment_by_place = _momenta_by(part, rate_by_place, NONE)
    force_by_turn, moment_by_turn = _momenta_by(part, rate_by_turn, isotropic(shift_a))
    by_spin_P, by_spin_L, turned = matscale(-shift_v, skew(P)), matscale(-shift_v, skew(L)), matscale(-1.0, skew(P))
    by = Changes(
        matadd(force_by_place, matmul(spin, P_by_place)),
        matadd(force_by_turn, matadd(matmul(spin, P_by_turn), by_spin_P)),
        matadd(
            matadd(moment_by_place, matmul(spin, L_by_place)),
            matadd(matmul(drift, P_by_place), matmul(turned, b_by_place)),
        ),
        matadd(
            matadd(moment_by_turn, matadd(matmul(spin, L_by_turn), by_spin_L)),
            matadd(matmul(drift, P_by_turn), matmul(turned, b_by_turn)),
        ),
    )
    _add_changes(K[0], weights.inertia, here, vector(at.Theta[0]), force, moment, by)


@add_energy.of(InertiaData)
def _add_kinetic(part: InertiaData, at: SpatialConfiguration, energy: Array) -> None:
    here = posture(at)
    b = vecmat(here.v, here.R)
    P, L = _momenta(part, b, here.W)
    energy[0] += 0.5 * (dot(b, P) + dot(here.W, L))


class BodyInertia(CompiledPart):
    """Mass, inertia and added mass (group I), see the module's text. M: of `BodyProperties`."""

    name = "body inertia"
    traits = Traits("I", symmetric=False)

    def __init__(self, body: MovingBody, M: Array) -> None:
        super().__init__(body)
        self.M = M

    def make_kernel_data(self) -> InertiaData:
        return InertiaData(self.M)


class WeightData(NamedTuple):
    """weight and whole buoyancy [N]; level of the water, inf without a surface, and radius [m]; the centres (3,)."""

    weight: float
    buoyancy: float
    level: float
    radius: float
    gravity_centre: Array
    buoyancy_centre: Array


@njit
def _lifts(part: WeightData, at: Posture) -> tuple[tuple[Vec, float, float], tuple[Vec, float, float]]:
    """Arms in global axes, upward residuals [N] and their slopes by height [N/m], of weight and buoyancy."""
    low, high = matvec(at.R, vector(part.gravity_centre)), matvec(at.R, vector(part.buoyancy_centre))
    share, slope = 1.0, 0.0
    if part.level < math.inf:
        share, slope = wet(part.level - at.x[2] - high[2], part.radius)
    return (low, part.weight, 0.0), (high, -part.buoyancy * share, part.buoyancy * slope)


@add_forces.of(WeightData)
def _add_weight(part: WeightData, at: SpatialConfiguration, out: LineForces) -> None:
    here = posture(at)
    for arm, force, _ in _lifts(part, here):
        upward = (0.0, 0.0, force)
        _add_to(out.force[0], upward, vecmat(cross(arm, upward), here.H))


@add_tangent.of(WeightData)
def _add_tangent_of_weight(
    part: WeightData, at: SpatialConfiguration, maps: Maps, weights: LineWeights, K: Array
) -> None:
    here = posture(at)
    for arm, force, slope in _lifts(part, here):
        upward, height = (0.0, 0.0, force), (0.0, 0.0, 1.0)
        risen = scale(-1.0, matmul(skew(arm), here.H)[2])
        own = matmul(transpose(here.H), matmul(matmul(skew(upward), skew(arm)), here.H))
        lever = moment_stiffness(matrix(at.Rn[0]), vector(at.Theta[0]), cross(arm, upward))
        turning = matadd(matscale(slope, outer(risen, risen)), matadd(own, lever))
        across = matscale(slope, outer(height, risen))
        _add_blocks(K[0], weights.force, matscale(slope, outer(height, height)), across, transpose(across), turning)


@add_energy.of(WeightData)
def _add_potential(part: WeightData, at: SpatialConfiguration, energy: Array) -> None:
    here = posture(at)
    (low, _, _), (high, _, _) = _lifts(part, here)
    height = here.x[2] + high[2]
    lifted = wet_height(part.level - height, part.radius) if part.level < math.inf else -height
    energy[2] += part.weight * (here.x[2] + low[2]) + part.buoyancy * lifted


class BodyWeight(CompiledPart):
    """Weight, and buoyancy under calm water (group F), with a potential that is zero at z = 0, buoyancy's in the air.

    weight [N]; buoyancy: of the whole volume [N]. level: of the water [m], inf without a surface.
    """

    name = "body weight"
    traits = Traits("F", symmetric=True)

    def __init__(self, body: MovingBody, given: BodyProperties, weight: float, buoyancy: float, level: float) -> None:
        super().__init__(body)
        self._given, self._weight, self._buoyancy, self._level = given, weight, buoyancy, level

    @property
    def load(self) -> float:
        """The larger of weight and buoyancy [N]."""
        return max(self._weight, self._buoyancy)

    def make_kernel_data(self) -> WeightData:
        given, forces = self._given, (float(self._weight), float(self._buoyancy))
        return WeightData(*forces, float(self._level), given.radius, given.gravity_centre, given.buoyancy_centre)


class DragData(NamedTuple):
    """drag and spin_drag (3,): rho CdA/2; pushed (3,): mass on which the water's acceleration acts [kg]; centre (3,) of
    buoyancy; buoyancy [N], level and radius [m]: see `BodyDrag`; turns: whether axes resist by themselves. find: writes
    the water's motion at time t (1,) and the centre's place x (1, 3).
    """

    drag: Array
    spin_drag: Array
    pushed: Array
    centre: Array
    buoyancy: float
    level: float
    radius: float
    turns: bool
    find: Calls
    t: Array
    x: Array
    motion: WaterMotion


class WaterOnBody(NamedTuple):
    """What the water does to a body where it is: arm of the centre of buoyancy in global axes; wet share, and its slope
    by immersion; velocity through the water, drag and its derivative, force of the water's acceleration, moment of drag
    and its slopes, in body axes; force of the moving surface upward, and its slopes by the wet share of the moving and
    of calm water.
    """

    arm: Vec
    share: float
    slope: float
    through: Vec
    drag: Vec
    drag_by: Mat
    push: Vec
    twist: Vec
    twist_by: Vec
    heave: float
    calm_slope: float


@njit
def _drag(part: DragData, w: Vec) -> tuple[Vec, Mat]:
    """The force at a velocity through the water, and its derivative."""
    c = vector(part.drag)
    if part.turns:
        force, slopes = _resistance(c, w)
        return force, _scaled_rows(slopes, isotropic(1.0))
    speed = norm(w)
    along = matscale(1.0 / speed, outer(w, w)) if speed > 0.0 else isotropic(0.0)
    return scale(c[0] * speed, w), matscale(c[0], matadd(isotropic(speed), along))


@njit
def _pushed(part: DragData, at: Posture) -> WaterOnBody:
    """What the water does to a body, where that is; the water's motion there is found."""
    c, arm = vector(part.centre), matvec(at.R, vector(part.centre))
    centre = add(at.x, arm)
    for i in range(3):
        part.x[0, i] = centre[i]
    call_each(part.find)
    share, slope, immersion = 1.0, 0.0, part.motion.immersion[0]
    if immersion < math.inf:
        share, slope = wet(immersion, part.radius)
    u, p = vector(part.motion.velocity[0]), vector(part.motion.acceleration[0])
    through = add(vecmat(sub(at.v, u), at.R), cross(at.W, c))
    drag, drag_by = _drag(part, through)
    push = scale(-1.0, _by_axes(vector(part.pushed), vecmat(p, at.R)))
    twist, twist_by = _resistance(vector(part.spin_drag), at.W)
    heave, calm_slope = 0.0, 0.0
    if part.buoyancy != 0.0:
        calm, calm_slope = wet(part.level - centre[2], part.radius)
        heave = -part.buoyancy * (share - calm)
    return WaterOnBody(arm, share, slope, through, drag, drag_by, push, twist, twist_by, heave, calm_slope)


@njit
def _on_body(part: DragData, at: Posture, found: WaterOnBody) -> tuple[Vec, Vec]:
    """Force and moment about the origin in body axes."""
    force = add(scale(found.share, add(found.drag, found.push)), scale(found.heave, at.R[2]))
    return force, add(cross(vector(part.centre), force), scale(found.share, found.twist))


@add_forces.of(DragData)
def _add_drag(part: DragData, at: SpatialConfiguration, out: LineForces) -> None:
    here = posture(at)
    force, moment = _on_body(part, here, _pushed(part, here))
    _add_in_body_axes(here, force, moment, out.force[0])


@add_tangent.of(DragData)
def _add_tangent_of_drag(
    part: DragData, at: SpatialConfiguration, maps: Maps, weights: LineWeights, K: Array
) -> None:
    here = posture(at)
    found, lever = _pushed(part, here), skew(vector(part.centre))
    force, moment = _on_body(part, here, found)
    moved = matscale(-1.0, matmul(skew(found.arm), here.H))  # the centre, by the rotation dofs
    by_place = _force_by(part, here, found, isotropic(1.0), NONE)
    by_turn = _force_by(part, here, found, moved, here.T)
    resists = matscale(maps.shift_v * found.share, found.drag_by)
    by_place = matadd(by_place, matmul(resists, transpose(here.R)))
    by_turn = matadd(by_turn, matscale(-1.0, matmul(resists, lever)))
    rise = scale(found.slope, vector(part.motion.immersion_gradient[0]))
    spun = _scaled_rows(scale(maps.shift_v * found.share, found.twist_by), isotropic(1.0))
    twist_by_turn = matadd(outer(found.twist, vecmat(rise, moved)), spun)
    by = Changes(
        by_place,
        by_turn,
        matadd(matmul(lever, by_place), outer(found.twist, rise)),
        matadd(matmul(lever, by_turn), twist_by_turn),
    )
    _add_changes(K[0], weights.force, here, vector(at.Theta[0]), force, moment, by)


@njit
def _force_by(part: DragData, at: Posture, found: WaterOnBody, moved: Mat, turned: Mat) -> Mat:
    """Derivative of the force in body axes, rates held: by dofs that move the centre and turn the body like that."""
    motion, inverse, up = part.motion, transpose(at.R), at.R[2]
    more = scale(found.slope, vecmat(vector(motion.immersion_gradient[0]), moved))
    drift = sub(at.v, vector(motion.velocity[0]))
    by_stream = matmul(inverse, matmul(matrix(motion.velocity_gradient[0]), moved))
    through = matadd(matmul(skew(vecmat(drift, at.R)), turned), matscale(-1.0, by_stream))
    pushed = matmul(inverse, matmul(matrix(motion.acceleration_gradient[0]), moved))
    pushed = matadd(pushed, matmul(skew(vecmat(vector(motion.acceleration[0]), at.R)), turned))
    carried = _scaled_rows(scale(-1.0, vector(part.pushed)), pushed)
    out = matscale(found.share, matadd(matmul(found.drag_by, through), carried))
    out = matadd(out, outer(add(found.drag, found.push), more))
    rising = scale(-part.buoyancy, add(more, scale(found.calm_slope, moved[2])))
    return matadd(out, matadd(outer(up, rising), matscale(found.heave, matmul(skew(up), turned))))


class BodyDrag(CompiledPart):
    """Drag, and what moving water adds to buoyancy and added mass (group F), see the module's text.

    sea: the water. rho [kg/m3]. buoyancy: of the whole volume [N], where the surface moves, else 0. level: of calm
    water [m]. still: whether all work is lost.
    """

    name = "body drag"
    traits = Traits("F", symmetric=False, follows=True)

    def __init__(
        self, body: MovingBody, given: BodyProperties, sea: Sea, rho: float, buoyancy: float, level: float, still: bool
    ) -> None:
        super().__init__(body)
        self._given, self._sea, self._rho, self._turns = given, sea, rho, body.turns
        self._buoyancy, self._level, self._still = buoyancy, level, still

    def make_kernel_data(self) -> DragData:
        given, rho, motion, t, x = self._given, self._rho, motion_workspace(1, 3), np.zeros(1), np.zeros((1, 3))
        return DragData(
            drag=0.5 * rho * given.drag,
            spin_drag=0.5 * rho * given.spin_drag,
            pushed=rho * given.volume + given.added_mass,
            centre=given.buoyancy_centre,
            buoyancy=float(self._buoyancy),
            level=float(self._level),
            radius=given.radius,
            turns=self._turns,
            find=calls(*motion_of(self._sea.kernel_data, motion, t, x)),
            t=t,
            x=x,
            motion=motion,
        )

    def renew_kernel_data(self, start: float, end: float) -> None:
        self._data.t[0] = end

    def work(self, before: State, after: State) -> Work:
        taken = self.taken(before, after)
        return Work(dissipated=taken) if self._still else Work(external=-taken)


class ReleaseData(NamedTuple):
    """Springs k [N/m] and kr [N.m/rad] to a place x (3,) and an orientation R (3, 3); left (1,): the share there is."""

    k: float
    kr: float
    x: Array
    R: Array
    left: Array


@njit
def _turned(part: ReleaseData, at: Posture) -> Vec:
    """Rotation vector from the orientation that the spring holds it to."""
    turn: Vec = rotations.log(matmul(at.R, transpose(matrix(part.R))))
    return turn


@add_forces.of(ReleaseData)
def _add_release(part: ReleaseData, at: SpatialConfiguration, out: LineForces) -> None:
    here, left = posture(at), part.left[0]
    force = scale(left * part.k, sub(here.x, vector(part.x)))
    _add_to(out.force[0], force, vecmat(scale(left * part.kr, _turned(part, here)), here.H))


@add_tangent.of(ReleaseData)
def _add_tangent_of_release(
    part: ReleaseData, at: SpatialConfiguration, maps: Maps, weights: LineWeights, K: Array
) -> None:
    here, left = posture(at), part.left[0]
    turn = _turned(part, here)
    spin = matmul(transpose(here.H), matmul(rotations.left_tangent_inverse(turn), here.H))
    lever = moment_stiffness(matrix(at.Rn[0]), vector(at.Theta[0]), scale(part.kr, turn))
    turning = matadd(matscale(part.kr, spin), lever)
    _add_blocks(K[0], weights.force * left, isotropic(part.k), NONE, NONE, turning)


@add_energy.of(DragData)
@add_energy.of(ReleaseData)
def _no_energy(part: DragData | ReleaseData, at: SpatialConfiguration, energy: Array) -> None:
    """Of drag nothing is stored; of a release nothing is told, as a static stage has no account."""


class Release(CompiledPart):
    """What has held a body, in the stage in which it is let go: a spring to where it is, and to how it stands, that has
    the reaction at first and gets as soft as the load factor grows (group F).

    reaction (6,): conjugate to its dofs as it was held [N, N.m]. With a potential, so that it can't tip the body over.
    """

    name = "release"
    traits = Traits("F", symmetric=True)

    def __init__(self, body: MovingBody, reaction: Array) -> None:
        super().__init__(body)
        force, moment = float(np.linalg.norm(reaction[:3])), float(np.linalg.norm(reaction[3:]))
        k, kr = max(force, LEAST) / body.lever, STIFFER * (moment + max(force, LEAST) * body.lever)
        R = body.frames.R[0]
        turned = np.array(rotations.exp(vector(R @ reaction[3:] / kr))) @ R
        self._springs = ReleaseData(k, kr, body.x[0] + reaction[:3] / k, turned, np.ones(1))

    def make_kernel_data(self) -> ReleaseData:
        return self._springs

    def renew_kernel_data(self, start: float, end: float) -> None:
        self._springs.left[0] = 1.0 - end
