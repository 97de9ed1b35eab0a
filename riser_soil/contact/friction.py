"""Friction of the riser on the seabed, integrated along its elements: the part "friction", and a line at one station.

Vectors are in the line's axes. In the plane their third component is 0, and so are components in the lateral direction,
which is normal to the plane. Directions are stored in arrays (d, r), axial and, in space, lateral.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from riser_soil.contact.coulomb import Adhesion, Pair, adhesion_at, limits, return_map
from riser_soil.contact.seabed_contact import SeabedContact
from riser_soil.contact.seabed_kernels import TouchingStations, normal_at
from riser_soil.core.arrays import Array
from riser_soil.core.bound import Bound, Packed, bound
from riser_soil.core.by_type import by_type
from riser_soil.core.compiled import njit
from riser_soil.core.part import State, Traits, Weights
from riser_soil.core.rows import add_pulled_back, add_weighed, as_tuple
from riser_soil.core.saved_state import Saved, Stateful
from riser_soil.riser import stations
from riser_soil.riser.configuration import Configuration, Maps
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import CompiledPart
from riser_soil.riser.moving_nodes import MovingNodes
from riser_soil.riser.part_kernels import LineForces, add_energy, add_forces, add_tangent, add_work, keep
from riser_soil.riser.vectors import (
    Mat,
    Vec,
    add,
    cross,
    dot,
    matadd,
    norm,
    outer,
    padded,
    scale,
    sub,
    write,
    write_matrix,
)

UPRIGHT = 1e-6  # sine of the angle to the ground's normal below which a riser has no axial direction along the ground
Along = tuple[Vec, Vec]  # directions along the ground, axial and lateral


@njit
def directions_at(tau: Vec, normal: Vec) -> Along:
    """Unit vectors along the ground from the riser's tangent and the ground's normal, zero of an upright riser."""
    n = scale(1.0 / norm(normal), normal)
    axial = sub(tau, scale(dot(tau, n), n))
    length = norm(axial)
    axial = scale(1.0 / length if length > UPRIGHT else 0.0, axial)
    return axial, cross(n, axial)


@njit
def components(along: Along, v: Vec) -> Pair:
    """Components of a vector along both directions."""
    return dot(along[0], v), dot(along[1], v)


@njit
def vector_of(along: Along, v: Pair) -> Vec:
    """The vector that has these components."""
    return add(scale(v[0], along[0]), scale(v[1], along[1]))


@njit
def elastic_guess(along: Along, traction: Vec, k: float, moved: Vec) -> Pair:
    """Elastic guess t* of the traction, see `coulomb`, from that at the start of a step and the movement in it."""
    return components(along, sub(traction, scale(k, moved)))


@njit
def resistance_by_position(
    along: Along, k: float, by_elastic: tuple[Pair, Pair], by_penetration: Pair, normal: Vec
) -> Mat:
    """Derivative by the position of minus the traction, from its derivatives by t* and by the penetration."""
    stuck = resistance_by_movement(along, k, by_elastic)
    return matadd(stuck, outer(vector_of(along, by_penetration), normal))


@njit
def resistance_by_movement(along: Along, k: float, by_elastic: tuple[Pair, Pair]) -> Mat:
    """Derivative by the movement in the step of minus the traction."""
    first = outer(scale(k, along[0]), vector_of(along, by_elastic[0]))
    return matadd(first, outer(scale(k, along[1]), vector_of(along, by_elastic[1])))


@njit
def slip_at(along: Along, decrease: Vec, k: float, moved: Vec) -> float:
    """Plastic slip in a step [m]: the movement less its elastic part, which comes with a decrease of the traction."""
    a, b = components(along, sub(moved, scale(1.0 / k, decrease)))
    return math.sqrt(a * a + b * b)


@njit
def read_along(along: Array) -> Along:
    """The directions that are stored in an array (d, r)."""
    return padded(along[:, 0]), padded(along[:, 1]) if along.shape[1] > 1 else (0.0, 0.0, 0.0)


@njit
def write_along(along: Along, out: Array) -> None:
    """Store the directions in an array (d, r)."""
    write(along[0], out[:, 0])
    if out.shape[1] > 1:
        write(along[1], out[:, 1])


class FrictionData(NamedTuple):
    """A `CoulombFriction` at the stations of a contact: coefficients (2,), infinite where nothing slides; adhesion,
    stiffness (ne,).

    Where a step starts: positions (ne, ng, d); directions along the ground (ne, ng, d, r), axial and, in space,
    lateral; traction (ne, ng, d) on the riser [N/m] and way slid (ne, ng) [m].
    resistance (ne, ng, d): minus the traction as evaluated last, of elements that touch.
    """

    contact: TouchingStations
    mu: Array
    adhesion: Adhesion
    stiffness: Array
    position: Array
    along: Array
    traction: Array
    slid: Array
    resistance: Array


AT_START = "position", "along", "traction"  # of friction's kernel data: what a step starts from


@by_type
def write_start(part: Any, at: Configuration) -> Any:
    """Write the places and directions from which a step starts, after the contact's forces have been evaluated."""


class SeabedFriction(CompiledPart):
    """Base of the parts of friction at the points of a contact with a seabed, whose normal forces they read; group E.

    mu (2,): coefficients; slid: the way that each point has slid [m]. Kernel data have what AT_START names. Directions
    are those of the start of the step; the traction's axes are constant.
    """

    traits = Traits("E", symmetric=False, path_dependent=True, gradual=True, roles=(Stateful,))
    after_forces = True

    def __init__(self, field: MovingNodes, contact: CompiledPart, mu: Array, slid: Array) -> None:
        super().__init__(field)
        self._contact, self._mu, self._slid = contact, mu, slid
        self._begun = False  # whether the data have what a step starts from

    def stick(self) -> None:
        """From now on nothing slides, as in small vibrations about rest."""
        self._mu[:] = np.inf
        self._trials.forget()

    @cached_property
    def _write_start(self) -> Bound:
        return bound(write_start, self._data, Packed(self._trials.now.at))

    def bind(self) -> None:
        _ = self._write_start

    def renew_kernel_data(self, start: float, end: float) -> None:
        if not self._begun:
            self._contact.find(State.at_rest(end, self.line.offset + self.line.size))
            self._write_start()
            self._begun = True

    @property
    def reads(self) -> Sequence[CompiledPart]:
        return (self._contact,)

    def state(self) -> Saved:
        """What the next step starts from, if there was one, and the slip of the points."""
        at_start = {name: getattr(self._data, name).copy() for name in AT_START} if self._begun else {}
        return {"slid": self._slid.copy()} | at_start

    def restore(self, saved: Saved) -> None:
        self._slid[...], self._begun = saved["slid"], "position" in saved
        for name in AT_START if self._begun else ():
            getattr(self._data, name)[...] = saved[name]
        self._trials.forget()


class CoulombFriction(SeabedFriction):
    """Part "friction": friction at the stations of a `SeabedContact`.

    axial, lateral: coefficients, > 0. stiffness (ne,): of the ground along itself, per length [N/m2], see
    `mobilised_within`. adhesion: of clay, which limits friction. The force acts on the axis.
    """

    line: Line

    name = "friction"

    def __init__(
        self, contact: SeabedContact, axial: float, lateral: float, stiffness: Array, adhesion: Adhesion | None = None
    ) -> None:
        mu = np.array([axial, lateral if contact.line.dimension == 3 else axial])
        super().__init__(contact.line, contact, mu, np.zeros(contact.share.shape))
        self.contact = contact
        self._stiffness, self._adhesion = stiffness, adhesion or Adhesion()

    def make_kernel_data(self) -> FrictionData:
        d, shape = self.line.dimension, self.contact.share.shape
        position, traction, resistance = (np.zeros((*shape, d)) for _ in range(3))
        contact, law = self.contact.kernel_data().touching, (self._mu, self._adhesion, self._stiffness)
        return FrictionData(contact, *law, position, np.zeros((*shape, d, d - 1)), traction, self._slid, resistance)

    def kernel_data(self) -> FrictionData:
        data: FrictionData = self._data
        return data

    def slip(self) -> Array:
        """Accumulated slip of the riser over the ground at its nodes (nn,) [m], >= 0."""
        write_slip, slip = self._write_slip
        write_slip()
        return slip.copy()

    def bind(self) -> None:
        super().bind()
        _ = self._write_slip

    @cached_property
    def _write_slip(self) -> tuple[Bound, Array]:
        """The kernel that writes the slip at the nodes, and its target (nn,)."""
        slip = np.empty(self.line.nodes)
        return self.contact.write_at_nodes(self._slid, slip), slip

    def force_on_riser(self, state: State) -> Array:
        """Sum of the friction on the riser (3,) [N], global axes."""
        if not self.line.active:
            return np.zeros(3)
        return np.asarray(-self.line.basis @ self.find(state).end_q[:, ::2].sum(axis=(0, 1)))


def mobilised_within(
    mobilisation: float, axial: float, lateral: float, weight: Array, most: float = np.inf
) -> Array:
    """Stiffness (ne,) [N/m2] at which the larger coefficient is mobilised after so long a slide [m] under the weight
    (ne,) [N/m], or an adhesion that is less [N/m].
    """
    return np.asarray(np.minimum(max(axial, lateral) * weight, most) / mobilisation)


@njit
def _elastic(part: FrictionData, e: int, g: int) -> Pair:
    """Elastic guess t* of the traction at a station, see `coulomb`."""
    guess: Pair = elastic_guess(
        read_along(part.along[e, g]), padded(part.traction[e, g]), part.stiffness[e], _moved(part, e, g)
    )
    return guess


@njit
def _moved(part: FrictionData, e: int, g: int) -> Vec:
    """The movement of a station in the step."""
    moved: Vec = sub(padded(part.contact.position[e * part.slid.shape[1] + g]), padded(part.position[e, g]))
    return moved


@njit
def _limits(part: FrictionData, e: int, g: int) -> tuple[Pair, Pair]:
    """Limits L of the traction at a station, see `coulomb`, and their derivative by the penetration."""
    contact, mu, p = part.contact, (part.mu[0], part.mu[1]), e * part.slid.shape[1] + g
    most = adhesion_at(part.adhesion, contact.penetration[p]) if mu[0] < math.inf else (math.inf, 0.0)
    limit: tuple[Pair, Pair] = limits(contact.force[p], contact.slope[p], mu, most)
    return limit


@add_forces.of(FrictionData)
def _friction_forces(part: FrictionData, at: Configuration, out: LineForces) -> None:
    """Add friction; called after the forces of its contact."""
    contact = part.contact
    for e in range(part.stiffness.size):
        if not contact.touches[e]:
            continue
        for g in range(contact.share.shape[1]):
            limit, rise = _limits(part, e, g)
            t, _, _ = return_map(_elastic(part, e, g), limit, rise)
            write(scale(-1.0, vector_of(read_along(part.along[e, g]), t)), part.resistance[e, g])
            p = e * contact.share.shape[1] + g
            stations.add_integrand_at(contact.at.weighted, p, as_tuple(part.resistance[e, g], at.D), out.end_q, e, at.D)


@add_tangent.of(FrictionData)
def _friction_tangent(part: FrictionData, at: Configuration, maps: Maps, weights: Weights, K: Array) -> None:
    contact, workspace = part.contact, part.contact.element
    for e in range(part.stiffness.size):
        if not contact.touches[e]:
            continue
        workspace[:] = 0.0
        for g in range(contact.share.shape[1]):
            limit, rise = _limits(part, e, g)
            _, by_elastic, by_penetration = return_map(_elastic(part, e, g), limit, rise)
            p = e * contact.share.shape[1] + g
            ways, normal = read_along(part.along[e, g]), normal_at(contact, p)
            write_matrix(
                resistance_by_position(ways, part.stiffness[e], by_elastic, by_penetration, normal), contact.by
            )
            dragged = contact.at.N[e, g], contact.by, maps.place_rows[e]
            add_weighed(workspace, contact.at.weighted[e, g], (dragged,), at.D, at.R)
        add_pulled_back(K[e], at.P[e], workspace, at.D, at.R)


@add_energy.of(FrictionData)
def _friction_energy(part: FrictionData, at: Configuration, energy: Array) -> None:
    for e in range(part.stiffness.size):
        if part.contact.touches[e]:
            for g in range(part.contact.share.shape[1]):
                t: Vec = padded(part.resistance[e, g])
                energy[2] += 0.5 * part.contact.share[e, g] / part.stiffness[e] * dot(t, t)


@add_work.of(FrictionData)
def _friction_work(part: FrictionData, first: Configuration, last: Configuration, work: Array) -> None:
    """Dissipated is the work of friction less the change of the energy stored; never negative."""
    contact = part.contact
    for e in range(part.stiffness.size):
        for g in range(contact.share.shape[1]):
            share, before = contact.share[e, g], padded(part.traction[e, g])
            work[0] += 0.5 * share / part.stiffness[e] * dot(before, before)
            if contact.touches[e]:
                t: Vec = padded(part.resistance[e, g])
                work[0] += share * dot(t, _moved(part, e, g)) - 0.5 * share / part.stiffness[e] * dot(t, t)


@keep.of(FrictionData)
def _keep_traction(part: FrictionData, at: Configuration) -> None:
    """Keep the traction, the way slid beyond the elastic mobilisation, and what the next step starts from."""
    contact = part.contact
    for e in range(part.stiffness.size):
        for g in range(part.slid.shape[1]):
            t, k = padded(part.traction[e, g]), part.stiffness[e]
            if contact.force[e * part.slid.shape[1] + g] > 0.0:
                decrease = add(t, padded(part.resistance[e, g]))
                part.slid[e, g] += slip_at(read_along(part.along[e, g]), decrease, k, _moved(part, e, g))
            for i in range(len(at.D)):
                part.traction[e, g, i] = -part.resistance[e, g, i] if contact.touches[e] else 0.0
    write_start(part, at)


@write_start.of(FrictionData)
def _write_start(part: FrictionData, at: Configuration) -> None:
    contact = part.contact
    for e in range(part.stiffness.size):
        for g in range(part.slid.shape[1]):
            p = e * part.slid.shape[1] + g
            tau, _ = stations.unit_tangent_at(contact.at.dN, p, at.chord, at.tangent, e, at.D)
            for i in range(len(at.D)):
                contact.f[i], part.position[e, g, i] = tau[i], contact.position[p, i]
            write_along(directions_at(padded(contact.f), normal_at(contact, p)), part.along[e, g])
