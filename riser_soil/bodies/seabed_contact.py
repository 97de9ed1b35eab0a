"""Contact of a body with the seabed: the part "body contact".

A body touches with spheres of radius r about points fixed to it. A point at x sinks in by r - d(x), where d is the
distance from the ground, and presses as a pipe of a length L does: with the seabed law's force per length f it gets
the force L f n, n the gradient of d, which passes through the sphere's centre. All of it derives from the potential
L psi(r - d(x)) of the law, so the tangent is its Hessian.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.bodies.body import MovingBody, Posture, add_tangent_at, add_to_dofs, posture, way_by_increments
from riser_soil.contact.along_step import seabed_step
from riser_soil.contact.seabed_kernels import by_position
from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.bound import Span, call_span, spans
from riser_soil.core.compiled import njit
from riser_soil.core.entries import Calls
from riser_soil.core.part import State, Traits, Weights
from riser_soil.core.saved_state import Saved, Stateful
from riser_soil.riser.configuration import Maps, SpatialConfiguration
from riser_soil.riser.line_part import CompiledPart
from riser_soil.riser.part_kernels import LineForces, add_energy, add_forces, add_tangent, add_work, keep
from riser_soil.riser.vectors import add, cross, dot, matrix, matscale, matvec, scale, vecmat, vector, write
from riser_soil.seabed.grounds import Ground
from riser_soil.seabed.law import NormalLaw


class BodyContactData(NamedTuple):
    """A `BodyContact`: points (n, 3) in body axes and length of pipe that each represents [m].

    As evaluated last: arms of the points from the body's origin and places [m], gradients of the distance from the
    ground, each (n, 3), and its hessians (n, 3, 3); penetration, whether the law acts, force per length, slope and
    energy stored (n,); places and energy where the step began; work (n,) of a law with a history in the step, (0,) of
    others. Kernels, and which of them do what, as in `SeabedData`.
    """

    points: Array
    length: float
    arm: Array
    place: Array
    gradient: Array
    hessian: Array
    penetration: Array
    acts: BoolArray
    force: Array
    slope: Array
    stored: Array
    began_at: Array
    stored_before: Array
    work: Array
    kernels: Calls
    find: Span
    find_before: Span
    write_hessians: Span
    keep: Span


@njit
def _place(points: Array, at: Posture, arm: Array, place: Array) -> None:
    """Write arms and places of points (n, 3) in a posture of the body."""
    for p in range(len(points)):
        way = matvec(at.R, vector(points[p]))
        write(way, arm[p])
        write(add(at.x, way), place[p])


@add_forces.of(BodyContactData)
def _press(part: BodyContactData, at: SpatialConfiguration, out: LineForces) -> None:
    here = posture(at)
    _place(part.points, here, part.arm, part.place)
    call_span(part.kernels, part.find)
    for p in range(len(part.points)):
        if part.acts[p]:
            force = scale(-part.length * part.force[p], vector(part.gradient[p]))
            add_to_dofs(out.end[0], force, vecmat(cross(vector(part.arm[p]), force), here.H))


@add_tangent.of(BodyContactData)
def _add_tangent_of_contact(
    part: BodyContactData, at: SpatialConfiguration, maps: Maps, weights: Weights, K: Array
) -> None:
    here, Rn, Theta = posture(at), matrix(at.Rn[0]), vector(at.Theta[0])
    call_span(part.kernels, part.write_hessians)
    for p in range(len(part.points)):
        if part.acts[p]:
            normal, bend = vector(part.gradient[p]), matrix(part.hessian[p])
            by_place = matscale(part.length, by_position(part.force[p], part.slope[p], normal, bend))
            force = scale(-part.length * part.force[p], normal)
            add_tangent_at(K[0], 1.0, here, Rn, Theta, vector(part.arm[p]), force, by_place)


@add_energy.of(BodyContactData)
def _add_stored(part: BodyContactData, at: SpatialConfiguration, energy: Array) -> None:
    for stored in part.stored:
        energy[2] += part.length * stored


@add_work.of(BodyContactData)
def _add_lost(part: BodyContactData, first: SpatialConfiguration, last: SpatialConfiguration, work: Array) -> None:
    """Dissipated is the work of the force at the end of the step less the change of the energy stored, as for
    `SeabedContact`; what that force extracts beyond the work of the law along the step is the time scheme's. Its work
    is that of the increments, as in the equations of motion.
    """
    _place(part.points, posture(first), np.empty(part.arm.shape), part.began_at)
    call_span(part.kernels, part.find_before)
    for p in range(len(part.points)):
        way = way_by_increments(first, last, vector(part.arm[p]))
        extracted = -part.force[p] * dot(vector(part.gradient[p]), way)
        gained = part.stored[p] - part.stored_before[p]
        work[0] += part.length * (extracted - gained)
        work[3] += part.length * (extracted - (part.work[p] if part.work.size > 0 else gained))


@keep.of(BodyContactData)
def _keep_history(part: BodyContactData, at: SpatialConfiguration) -> None:
    """Keep the law's history after the step."""
    call_span(part.kernels, part.keep)


class BodyContact(CompiledPart):
    """Contact of a body with the seabed (group E), see the module's text.

    points (n, 3): in body axes [m]. radius [m]: of the spheres about them. length [m]: of pipe, as which all of them
    together press. memory (n, nh): the law's history.
    """

    name = "body contact"
    after_forces = True

    def __init__(
        self, body: MovingBody, points: Array, radius: float, length: float, ground: Ground, law: NormalLaw
    ) -> None:
        super().__init__(body)
        self.points, self.radius, self.length = points, radius, length
        self.ground, self.law = ground, law
        self.memory = law.initial_history((len(points),))
        self.traits = Traits("E", symmetric=True, path_dependent=True, gradual=law.gradual, roles=(Stateful,))

    @property
    def length_of_point(self) -> float:
        """Length of pipe as which each point presses [m]."""
        return self.length / len(self.points)

    def make_kernel_data(self) -> BodyContactData:
        radius = np.full(len(self.points), self.radius)
        here, began, work, find_before = seabed_step(radius, self.ground, self.law, self.memory)
        ground, law = here.ground, here.law
        kernels, (find, before, hessians, keeping) = spans(here.find, find_before, here.write_hessians, here.keep)
        near = ground.place, ground.gradient, ground.hessian, ground.penetration
        answer = law.acts, law.force, law.slope, law.stored
        step = began.ground.place, began.law.stored, work, kernels, find, before, hessians, keeping
        arm, length = np.zeros(self.points.shape), float(self.length_of_point)
        return BodyContactData._make((self.points, length, arm, *near, *answer, *step))

    def kernel_data(self) -> BodyContactData:
        data: BodyContactData = self._data
        return data

    def force_on_body(self, state: State) -> Array:
        """Sum of the forces on the body (3,) [N], global axes; zero on a rank that does not evaluate it."""
        return -self.find(state).end[0, :3] if self.active else np.zeros(3)

    def penetration(self, state: State) -> float:
        """The deepest point's penetration [m], 0 above the ground."""
        if not self.active:
            return 0.0
        self.find(state)
        return max(0.0, float(self._data.penetration.max()))

    def sunk_by(self, force: float) -> float:
        """How deep [m] a force [N] presses all points into ground that has never been touched, ten lengths at most."""
        depth = self.length * np.geomspace(1e-6, 10.0, 400)
        borne = self.length * self.law.update(depth, self.law.initial_history(depth.shape)).force
        return float(np.interp(force, np.maximum.accumulate(borne), depth, left=0.0))

    def state(self) -> Saved:
        return {"memory": self.memory.copy()}

    def restore(self, saved: Saved) -> None:
        self.memory[...] = saved["memory"]
        self._trials.forget()
