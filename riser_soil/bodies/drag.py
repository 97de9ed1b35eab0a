"""Drag on a body, and what moving water adds to its buoyancy and added mass.

Drag meets the velocity w through the water at the centre of buoyancy: rho/2 CdA_i |w_i| w_i by body axis, of a point
rho/2 CdA |w| w. Where the water moves, its acceleration u' there adds the force (rho V + added mass) u' of Morison's
formula. All act on the wet share, see `body.wet`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from riser_soil.bodies.body import (
    NONE,
    BodyProperties,
    Changes,
    MovingBody,
    Posture,
    add_changes,
    add_in_body_axes,
    by_axes,
    posture,
    scaled_rows,
    wet,
)
from riser_soil.core.arrays import Array
from riser_soil.core.bound import Calls, call_each, calls
from riser_soil.core.compiled import njit
from riser_soil.core.part import State, Traits, Weights, Work
from riser_soil.riser.configuration import Maps, SpatialConfiguration
from riser_soil.riser.line_part import CompiledPart
from riser_soil.riser.part_kernels import LineForces, add_energy, add_forces, add_tangent
from riser_soil.riser.vectors import (
    Mat,
    Vec,
    add,
    cross,
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


@njit
def _resistance(c: Vec, v: Vec) -> tuple[Vec, Vec]:
    """c |v| v by axis, and its slopes by v."""
    speeds = (abs(v[0]), abs(v[1]), abs(v[2]))
    return by_axes(by_axes(c, speeds), v), by_axes(scale(2.0, c), speeds)


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
    by immersion; drag and its derivative, force of the water's acceleration, moment of drag
    and its slopes, in body axes; force of the moving surface upward, and its slopes by the wet share of the moving and
    of calm water.
    """

    arm: Vec
    share: float
    slope: float
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
        return force, scaled_rows(slopes, isotropic(1.0))
    speed = norm(w)
    along = matscale(1.0 / speed, outer(w, w)) if speed > 0.0 else isotropic(0.0)
    return scale(c[0] * speed, w), matscale(c[0], matadd(isotropic(speed), along))


@njit
def _pushed(part: DragData, at: Posture) -> WaterOnBody:
    """What the water does to a body, where that is; the water's motion there is evaluated."""
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
    push = scale(-1.0, by_axes(vector(part.pushed), vecmat(p, at.R)))
    twist, twist_by = _resistance(vector(part.spin_drag), at.W)
    heave, calm_slope = 0.0, 0.0
    if part.buoyancy != 0.0:
        calm, calm_slope = wet(part.level - centre[2], part.radius)
        heave = -part.buoyancy * (share - calm)
    return WaterOnBody(arm, share, slope, drag, drag_by, push, twist, twist_by, heave, calm_slope)


@njit
def _on_body(part: DragData, at: Posture, water: WaterOnBody) -> tuple[Vec, Vec]:
    """Force and moment about the origin in body axes."""
    force = add(scale(water.share, add(water.drag, water.push)), scale(water.heave, at.R[2]))
    return force, add(cross(vector(part.centre), force), scale(water.share, water.twist))


@add_forces.of(DragData)
def _add_drag(part: DragData, at: SpatialConfiguration, out: LineForces) -> None:
    here = posture(at)
    force, moment = _on_body(part, here, _pushed(part, here))
    add_in_body_axes(here, force, moment, out.force[0])


@add_tangent.of(DragData)
def _add_tangent_of_drag(
    part: DragData, at: SpatialConfiguration, maps: Maps, weights: Weights, K: Array
) -> None:
    here = posture(at)
    water, lever = _pushed(part, here), skew(vector(part.centre))
    force, moment = _on_body(part, here, water)
    moved = matscale(-1.0, matmul(skew(water.arm), here.H))  # the centre, by the rotation dofs
    by_place = _force_by(part, here, water, isotropic(1.0), NONE)
    by_turn = _force_by(part, here, water, moved, here.T)
    resists = matscale(weights.shift_v * water.share, water.drag_by)
    by_place = matadd(by_place, matmul(resists, transpose(here.R)))
    by_turn = matadd(by_turn, matscale(-1.0, matmul(resists, lever)))
    rise = scale(water.slope, vector(part.motion.immersion_gradient[0]))
    spun = scaled_rows(scale(weights.shift_v * water.share, water.twist_by), isotropic(1.0))
    twist_by_turn = matadd(outer(water.twist, vecmat(rise, moved)), spun)
    by = Changes(
        by_place,
        by_turn,
        matadd(matmul(lever, by_place), outer(water.twist, rise)),
        matadd(matmul(lever, by_turn), twist_by_turn),
    )
    add_changes(K[0], weights.force, here, vector(at.Theta[0]), force, moment, by)


@njit
def _force_by(part: DragData, at: Posture, water: WaterOnBody, moved: Mat, turned: Mat) -> Mat:
    """Derivative of the force in body axes, at constant rates, by dofs that move the centre and turn the body so."""
    motion, inverse, up = part.motion, transpose(at.R), at.R[2]
    more = scale(water.slope, vecmat(vector(motion.immersion_gradient[0]), moved))
    drift = sub(at.v, vector(motion.velocity[0]))
    by_stream = matmul(inverse, matmul(matrix(motion.velocity_gradient[0]), moved))
    through = matadd(matmul(skew(vecmat(drift, at.R)), turned), matscale(-1.0, by_stream))
    pushed = matmul(inverse, matmul(matrix(motion.acceleration_gradient[0]), moved))
    pushed = matadd(pushed, matmul(skew(vecmat(vector(motion.acceleration[0]), at.R)), turned))
    carried = scaled_rows(scale(-1.0, vector(part.pushed)), pushed)
    out = matscale(water.share, matadd(matmul(water.drag_by, through), carried))
    out = matadd(out, outer(add(water.drag, water.push), more))
    rising = scale(-part.buoyancy, add(more, scale(water.calm_slope, moved[2])))
    return matadd(out, matadd(outer(up, rising), matscale(water.heave, matmul(skew(up), turned))))


@add_energy.of(DragData)
def _no_energy(part: DragData, at: SpatialConfiguration, energy: Array) -> None:
    """Nothing is stored."""


class BodyDrag(CompiledPart):
    """Drag, and what moving water adds to buoyancy and added mass (group F), see the module's text.

    sea: the water. rho [kg/m3]. buoyancy: of the whole volume [N], where the surface moves, else 0. level: of calm
    water [m]. still: whether all work is lost.
    """

    name = "body drag"
    traits = Traits("F", symmetric=False, follows=True)

    def __init__(
        self,
        body: MovingBody,
        properties: BodyProperties,
        sea: Sea,
        rho: float,
        buoyancy: float,
        level: float,
        still: bool,
    ) -> None:
        super().__init__(body)
        self._properties, self._sea, self._rho, self._turns = properties, sea, rho, body.turns
        self._buoyancy, self._level, self._still = buoyancy, level, still

    def make_kernel_data(self) -> DragData:
        properties, rho = self._properties, self._rho
        motion, t, x = motion_workspace(1, 3), np.zeros(1), np.zeros((1, 3))
        return DragData(
            drag=0.5 * rho * properties.drag,
            spin_drag=0.5 * rho * properties.spin_drag,
            pushed=rho * properties.volume + properties.added_mass,
            centre=properties.buoyancy_centre,
            buoyancy=float(self._buoyancy),
            level=float(self._level),
            radius=properties.radius,
            turns=self._turns,
            find=calls(*motion_of(self._sea, motion, t, x)),
            t=t,
            x=x,
            motion=motion,
        )

    def renew_kernel_data(self, start: float, end: float) -> None:
        self._data.t[0] = end

    def work(self, before: State, after: State) -> Work:
        work = self.work_against(before, after)
        return Work(dissipated=work) if self._still else Work(external=-work)
