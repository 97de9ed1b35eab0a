"""Contact of a body with the seabed: the part "body contact".

A body touches with spheres of radius r about points fixed to it. A point at x sinks in by r - d(x), where d is the
distance from the ground, and presses as a pipe of a length L does: with the seabed law's force per length f it gets
the force L f n, n the gradient of d, which passes through the sphere's centre. All of it derives from the potential
L psi(r - d(x)) of the law, so the tangent is its Hessian.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from riser_soil.bodies.body import MovingBody, add_tangent_at, add_to_dofs, posture, way_by_increments
from riser_soil.contact.along_step import work_at
from riser_soil.contact.seabed_kernels import by_position
from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.part import State, Traits, Weights
from riser_soil.core.saved_state import Saved, Stateful
from riser_soil.riser.configuration import Maps, SpatialConfiguration
from riser_soil.riser.line_part import CompiledPart
from riser_soil.riser.part_kernels import LineForces, add_energy, add_forces, add_tangent, add_work, keep
from riser_soil.riser.vectors import add, cross, dot, matrix, matscale, matvec, scale, vecmat, vector, write
from riser_soil.seabed.compiled_law import answer, may_act
from riser_soil.seabed.grounds import Ground, distance_at
from riser_soil.seabed.law import NormalLaw


class FoundAtPoints(NamedTuple):
    """What was found last at the points: whether each touches (n,); arm from the body's origin and place [m], normal
    (n, 3); penetration, force per length, its slope and energy stored (n,); the law's history after the step (n, nh).
    """

    touches: BoolArray
    arm: Array
    place: Array
    normal: Array
    penetration: Array
    force: Array
    slope: Array
    stored: Array
    after: Array


class BodyContactData(NamedTuple):
    """A `BodyContact`: points (n, 3) in body axes, radius and length that each stands for [m], memory (n, nh), the
    kernel data of ground and law, and the law's reach; workspace (nh,) for a history.
    """

    points: Array
    radius: float
    length: float
    memory: Array
    ground: Any
    law: Any
    reach: float
    found: FoundAtPoints
    after: Array


@add_forces.of(BodyContactData)
def _press(part: BodyContactData, at: SpatialConfiguration, out: LineForces) -> None:
    here, found = posture(at), part.found
    for p in range(part.points.shape[0]):
        arm = matvec(here.R, vector(part.points[p]))
        place = add(here.x, arm)
        value, normal, _ = distance_at(part.ground, place)
        write(arm, found.arm[p])
        write(place, found.place[p])
        write(normal, found.normal[p])
        found.penetration[p] = part.radius - value
        found.touches[p] = may_act(part.law, found.penetration[p], part.memory[p])
        found.force[p], found.slope[p], found.stored[p] = 0.0, 0.0, 0.0
        if found.touches[p]:
            found.force[p], found.slope[p], found.stored[p] = answer(
                part.law, found.penetration[p], part.memory[p], found.after[p]
            )
            force = scale(-part.length * found.force[p], normal)
            add_to_dofs(out.end[0], force, vecmat(cross(arm, force), here.H))


@add_tangent.of(BodyContactData)
def _add_tangent_of_contact(
    part: BodyContactData, at: SpatialConfiguration, maps: Maps, weights: Weights, K: Array
) -> None:
    here, found = posture(at), part.found
    Rn, Theta = matrix(at.Rn[0]), vector(at.Theta[0])
    for p in range(part.points.shape[0]):
        if found.touches[p]:
            _, normal, bend = distance_at(part.ground, vector(found.place[p]))
            by_place = matscale(part.length, by_position(found.force[p], found.slope[p], normal, bend))
            force = scale(-part.length * found.force[p], normal)
            add_tangent_at(K[0], 1.0, here, Rn, Theta, vector(found.arm[p]), force, by_place)


@add_energy.of(BodyContactData)
def _add_stored(part: BodyContactData, at: SpatialConfiguration, energy: Array) -> None:
    for p in range(part.points.shape[0]):
        energy[2] += part.length * part.found.stored[p]


@add_work.of(BodyContactData)
def _add_lost(part: BodyContactData, first: SpatialConfiguration, last: SpatialConfiguration, work: Array) -> None:
    """Dissipated is the work of the force at the end of the step less the change of the energy stored, as of
    `SeabedContact`; what that force takes beyond the work of the law along the step is the time scheme's. Its work is
    that of the increments, as in the equations of motion.
    """
    began, found = posture(first), part.found
    for p in range(part.points.shape[0]):
        place = add(began.x, matvec(began.R, vector(part.points[p])))
        value, _, _ = distance_at(part.ground, place)
        before = part.radius - value
        touched = may_act(part.law, before, part.memory[p])
        if not (touched or found.touches[p]):
            continue
        stored = answer(part.law, before, part.memory[p], part.after)[2] if touched else 0.0
        way = way_by_increments(first, last, vector(found.arm[p]))
        taken, gained = -found.force[p] * dot(vector(found.normal[p]), way), found.stored[p] - stored
        by_law = gained
        if part.memory.shape[1] > 0:
            by_law = work_at(part.law, part.reach, before, found.penetration[p], part.memory[p], part.after)
        work[0] += part.length * (taken - gained)
        work[3] += part.length * (taken - by_law)


@keep.of(BodyContactData)
def _keep_memory(part: BodyContactData, at: SpatialConfiguration) -> None:
    """The law's history after the step."""
    found, memory = part.found, part.memory
    for p in range(memory.shape[0] if memory.shape[1] > 0 else 0):
        if not found.touches[p]:
            answer(part.law, found.penetration[p], memory[p], found.after[p])
        for k in range(memory.shape[1]):
            memory[p, k] = found.after[p, k]


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
        n, memory = len(self.points), self.memory
        arm, place, normal = (np.zeros((n, 3)) for _ in range(3))
        penetration, force, slope, stored = (np.zeros(n) for _ in range(4))
        answered = penetration, force, slope, stored, np.zeros(memory.shape)
        found = FoundAtPoints(np.zeros(n, dtype=np.bool_), arm, place, normal, *answered)
        sizes = float(self.radius), float(self.length_of_point)
        known = self.ground.kernel_data, self.law.kernel_data, float(self.law.reach)
        return BodyContactData(self.points, *sizes, memory, *known, found, np.zeros(memory.shape[1]))

    def kernel_data(self) -> BodyContactData:
        found: BodyContactData = self._data
        return found

    def force_on_body(self, state: State) -> Array:
        """Sum of the forces on the body (3,) [N], global axes; zero on a rank that does not evaluate it."""
        return -self.find(state).end[0, :3] if self.active else np.zeros(3)

    def penetration(self, state: State) -> float:
        """The deepest point's penetration [m], 0 above the ground."""
        if not self.active:
            return 0.0
        self.find(state)
        return max(0.0, float(self._data.found.penetration.max()))

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
