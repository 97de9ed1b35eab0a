"""Friction of a body on the seabed: the part "body friction", by the law of `contact.coulomb`.

It acts at the points by which the body touches, with one coefficient in all directions along the ground.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.bodies.body import add_tangent_at, add_to_dofs, posture, way_by_increments
from riser_soil.bodies.seabed_contact import BodyContact, BodyContactData
from riser_soil.contact.coulomb import Adhesion, Pair, adhesion_at, limits, return_map
from riser_soil.contact.friction import (
    SeabedFriction,
    directions_at,
    elastic_guess,
    read_along,
    resistance_by_position,
    slip_at,
    vector_of,
    write_along,
    write_start,
)
from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.core.part import State, Weights
from riser_soil.riser.configuration import Maps, SpatialConfiguration
from riser_soil.riser.part_kernels import LineForces, add_energy, add_forces, add_tangent, add_work, keep
from riser_soil.riser.vectors import Vec, add, cross, dot, matrix, matscale, scale, sub, vecmat, vector, write

ALONG_X = (1.0, 0.0, 0.0)  # no seabed is so steep that it is square to it


class BodyFrictionData(NamedTuple):
    """A `BodyFriction` at the points of a contact: coefficients (2,), both the same; adhesion; stiffness per length
    [N/m2].

    Where a step starts: places (n, 3) and directions along the ground (n, 3, 2); traction (n, 3) on the body per
    length [N/m] and way slid (n,) [m]. resistance (n, 3): minus the traction as evaluated last, of points that touch.
    """

    contact: BodyContactData
    mu: Array
    adhesion: Adhesion
    stiffness: float
    position: Array
    along: Array
    traction: Array
    slid: Array
    resistance: Array


@njit
def _moved(part: BodyFrictionData, p: int) -> Vec:
    """The movement of a point in the step."""
    moved: Vec = sub(vector(part.contact.place[p]), vector(part.position[p]))
    return moved


@njit
def _mapped(part: BodyFrictionData, p: int) -> tuple[Pair, tuple[Pair, Pair], Pair]:
    """Traction per length at a point and its derivatives, as of `coulomb.return_map`."""
    contact, mu = part.contact, (part.mu[0], part.mu[1])
    most = adhesion_at(part.adhesion, contact.penetration[p]) if mu[0] < np.inf else (np.inf, 0.0)
    limit, rise = limits(contact.force[p], contact.slope[p], mu, most)
    guess = elastic_guess(read_along(part.along[p]), vector(part.traction[p]), part.stiffness, _moved(part, p))
    mapped: tuple[Pair, tuple[Pair, Pair], Pair] = return_map(guess, limit, rise)
    return mapped


@add_forces.of(BodyFrictionData)
def _resist(part: BodyFrictionData, at: SpatialConfiguration, out: LineForces) -> None:
    """Add friction; called after the forces of its contact."""
    here, contact = posture(at), part.contact
    for p in range(part.slid.size):
        if contact.acts[p]:
            t, _, _ = _mapped(part, p)
            write(scale(-1.0, vector_of(read_along(part.along[p]), t)), part.resistance[p])
            force = scale(contact.length, vector(part.resistance[p]))
            add_to_dofs(out.end[0], force, vecmat(cross(vector(contact.arm[p]), force), here.H))


@add_tangent.of(BodyFrictionData)
def _add_tangent_of_friction(
    part: BodyFrictionData, at: SpatialConfiguration, maps: Maps, weights: Weights, K: Array
) -> None:
    here, contact, length = posture(at), part.contact, part.contact.length
    Rn, Theta = matrix(at.Rn[0]), vector(at.Theta[0])
    for p in range(part.slid.size):
        if contact.acts[p]:
            _, by_elastic, by_penetration = _mapped(part, p)
            ways, normal = read_along(part.along[p]), vector(contact.gradient[p])
            by_place = resistance_by_position(ways, part.stiffness, by_elastic, by_penetration, normal)
            force = scale(length, vector(part.resistance[p]))
            add_tangent_at(K[0], 1.0, here, Rn, Theta, vector(contact.arm[p]), force, matscale(length, by_place))


@add_energy.of(BodyFrictionData)
def _add_stored(part: BodyFrictionData, at: SpatialConfiguration, energy: Array) -> None:
    for p in range(part.slid.size):
        if part.contact.acts[p]:
            t = vector(part.resistance[p])
            energy[2] += 0.5 * part.contact.length / part.stiffness * dot(t, t)


@add_work.of(BodyFrictionData)
def _add_lost(part: BodyFrictionData, first: SpatialConfiguration, last: SpatialConfiguration, work: Array) -> None:
    """Dissipated is the work of friction less the change of the energy stored."""
    length, softness = part.contact.length, 0.5 / part.stiffness
    for p in range(part.slid.size):
        before = vector(part.traction[p])
        work[0] += length * softness * dot(before, before)
        if part.contact.acts[p]:
            t = vector(part.resistance[p])
            way = way_by_increments(first, last, vector(part.contact.arm[p]))
            work[0] += length * (dot(t, way) - softness * dot(t, t))


@keep.of(BodyFrictionData)
def _keep_traction(part: BodyFrictionData, at: SpatialConfiguration) -> None:
    """Keep the traction, the way slid beyond the elastic mobilisation, and what the next step starts from."""
    contact = part.contact
    for p in range(part.slid.size):
        t, touches = vector(part.resistance[p]), contact.acts[p]
        if contact.force[p] > 0.0:
            decrease = add(vector(part.traction[p]), t)
            part.slid[p] += slip_at(read_along(part.along[p]), decrease, part.stiffness, _moved(part, p))
        write(scale(-1.0 if touches else 0.0, t), part.traction[p])
    write_start(part, at)


@write_start.of(BodyFrictionData)
def _write_start(part: BodyFrictionData, at: SpatialConfiguration) -> None:
    contact = part.contact
    for p in range(part.slid.size):
        write(vector(contact.place[p]), part.position[p])
        write_along(directions_at(ALONG_X, vector(contact.gradient[p])), part.along[p])


class BodyFriction(SeabedFriction):
    """Friction at the points of a `BodyContact`.

    mu: coefficient, > 0. stiffness: of the ground along itself, per length [N/m2], see `contact.mobilised_within`.
    adhesion: of clay, which limits friction.
    """

    name = "body friction"

    def __init__(self, contact: BodyContact, mu: float, stiffness: float, adhesion: Adhesion) -> None:
        super().__init__(contact.line, contact, np.full(2, mu), np.zeros(len(contact.points)))
        self.contact, self._stiffness, self._adhesion = contact, stiffness, adhesion

    @property
    def coefficient(self) -> float:
        """The friction coefficient, infinite where nothing slides."""
        return float(self._mu[0])

    def make_kernel_data(self) -> BodyFrictionData:
        n = len(self.contact.points)
        contact = self.contact.kernel_data()
        law = self._mu, self._adhesion, float(self._stiffness)
        position, traction, resistance = (np.zeros((n, 3)) for _ in range(3))
        return BodyFrictionData(contact, *law, position, np.zeros((n, 3, 2)), traction, self._slid, resistance)

    def force_on_body(self, state: State) -> Array:
        """Sum of the forces on the body (3,) [N], global axes; zero on a rank that does not evaluate it."""
        return -self.find(state).end[0, :3] if self.active else np.zeros(3)
