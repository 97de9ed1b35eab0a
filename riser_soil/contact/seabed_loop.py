"""Contact with a seabed and friction on it in the compiled loop over a riser alone, see `part_kernels`."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from riser_soil.contact.along_step import work_at
from riser_soil.contact.contact import ContactResults, put_results
from riser_soil.contact.coulomb import Adhesion, Pair, adhesion_at, limits, return_map
from riser_soil.contact.friction_stations import (
    directions_at,
    elastic_guess,
    put_along,
    read_along,
    resistance_by_position,
    slip_at,
    vector_of,
)
from riser_soil.contact.seabed_stations import (
    LineFrame,
    OverNodes,
    by_position,
    distance_in,
    frame_of,
    global_place,
    put_contact,
)
from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.by_type import by_type
from riser_soil.core.compiled import fixed, njit
from riser_soil.core.rows import add_pulled_back, add_weighed, held
from riser_soil.riser import stations
from riser_soil.riser.configuration import Configuration, Maps
from riser_soil.riser.line import Line
from riser_soil.riser.part_kernels import LineForces, LineWeights, add_energy, add_forces, add_tangent, add_work, keep
from riser_soil.riser.vectors import Vec, add, dot, padded, put, put_matrix, scale, sub
from riser_soil.seabed.compiled_law import answer, may_act
from riser_soil.seabed.law import NormalLaw


class Found(NamedTuple):
    """What was found last at the stations: which elements touch (ne,); position and normal (ne, ng, d); penetration,
    force, its slope and energy stored (ne, ng); what covers the ground below (ne, ng), or -1; the law's history after
    the step (ne, ng, nh), of elements that touch.
    """

    touches: BoolArray
    position: Array
    normal: Array
    penetration: Array
    force: Array
    slope: Array
    stored: Array
    below: IntArray
    after: Array


class Bare(NamedTuple):
    """Ground on which nothing lies anywhere; nothing: -1."""

    nothing: int


class SeabedData(NamedTuple):
    """A `SeabedContact`: its stations and their share of arc length (ne, ng), radius (ne,), memory (ne, ng, nh), the
    nodes, and the numbers of its ground and law; the law's start and reach; what covers the ground in places; workspace
    for an element, for the force and its derivative at a station, and for a history (nh,).
    """

    at: stations.Stations
    share: Array
    radius: Array
    memory: Array
    nodes: OverNodes
    frame: LineFrame
    ground: Any
    law: Any
    start: float
    reach: float
    cover: Any
    found: Found
    element: Array
    f: Array
    by: Array
    after: Array


class FrictionData(NamedTuple):
    """A `CoulombFriction` at the stations of a contact: coefficients, adhesion, stiffness (ne,), its `FrictionState`
    and way slid (ne, ng), and minus the traction found last (ne, ng, d).
    """

    contact: SeabedData
    mu: Pair
    adhesion: Adhesion
    stiffness: Array
    position: Array
    along: Array
    traction: Array
    slid: Array
    resistance: Array


def seabed_data(
    line: Line,
    at: stations.Stations,
    share: Array,
    radius: Array,
    memory: Array,
    nodes: OverNodes,
    ground: Any,
    law: NormalLaw,
    cover: Any = None,
) -> SeabedData:
    """With the workspace that they need; ground: its numbers; cover: what lies on it in places, if anything."""
    (ne, ng), d = share.shape, line.dimension
    position, normal = np.zeros((ne, ng, d)), np.zeros((ne, ng, d))
    penetration, force, slope, stored = (np.zeros((ne, ng)) for _ in range(4))
    touches, below = np.zeros(ne, dtype=np.bool_), np.full((ne, ng), -1)
    found = Found(touches, position, normal, penetration, force, slope, stored, below, np.zeros(memory.shape))
    element = stations.element_workspace(2 * line.ndof, fixed(d))
    workspace = element, np.zeros(d), np.zeros((d, d)), np.zeros(memory.shape[2])
    law_data = law.kernel_data, float(law.start), float(law.reach)
    given = at, share, radius, memory.copy(), nodes, frame_of(line), ground, *law_data
    return SeabedData(*given, Bare(-1) if cover is None else cover, found, *workspace)


@by_type
def covered_by(cover: Any, x: Vec, known: int) -> Any:
    """What lies on the ground below a place x, in global axes: its number, or -1. known: what was found there last."""


@covered_by.of(Bare)
def _never(cover: Bare, x: Vec, known: int) -> int:
    return cover.nothing


@njit
def _is_covered(part: SeabedData, place: Array, e: int, g: int) -> bool:
    """Whether something else lies on the ground below a station."""
    below = part.found.below
    below[e, g] = covered_by(part.cover, global_place(part.frame, padded(place)), below[e, g])
    return bool(below[e, g] >= 0)


@add_forces.of(SeabedData)
def _contact_forces(part: SeabedData, at: Configuration, out: LineForces) -> None:
    found, ng = part.found, part.share.shape[1]
    for e in range(part.radius.size):
        touches = False
        for g in range(ng):
            x = stations.value_at(part.at.N, e * ng + g, at.q, e, at.D)
            for i in range(len(at.D)):
                found.position[e, g, i] = x[i]
            value, normal, _ = distance_in(part.frame, part.ground, padded(found.position[e, g]))
            found.penetration[e, g] = part.radius[e] - value
            put(normal, found.normal[e, g])
            if may_act(part.law, found.penetration[e, g], part.memory[e, g]):
                if _is_covered(part, found.position[e, g], e, g):
                    found.penetration[e, g] = -np.inf
                else:
                    touches = True
        found.touches[e] = touches
        if touches:
            _press(part, at, e, out)


@njit
def _press(part: SeabedData, at: Configuration, e: int, out: LineForces) -> None:
    """Forces on an element that touches."""
    found = part.found
    for g in range(part.share.shape[1]):
        force, slope, stored = answer(part.law, found.penetration[e, g], part.memory[e, g], found.after[e, g])
        found.force[e, g], found.slope[e, g], found.stored[e, g] = force, slope, stored
        put(scale(-force, padded(found.normal[e, g])), part.f)
        p = e * part.share.shape[1] + g
        stations.add_integrand_at(part.at.weighted, p, held(part.f, at.D), out.end_q, e, at.D)


@add_tangent.of(SeabedData)
def _contact_tangent(part: SeabedData, at: Configuration, maps: Maps, weights: LineWeights, K: Array) -> None:
    found, workspace = part.found, part.element
    for e in range(part.radius.size):
        if not found.touches[e]:
            continue
        workspace[:] = 0.0
        for g in range(part.share.shape[1]):
            _, _, bend = distance_in(part.frame, part.ground, padded(found.position[e, g]))
            put_matrix(by_position(found.force[e, g], found.slope[e, g], padded(found.normal[e, g]), bend), part.by)
            pressed = part.at.N[e, g], part.by, maps.place_rows[e]
            add_weighed(workspace, part.at.weighted[e, g], (pressed,), at.D, at.R)
        add_pulled_back(K[e], at.P[e], workspace, at.D, at.R)


@add_energy.of(SeabedData)
def _contact_energy(part: SeabedData, at: Configuration, energy: Array) -> None:
    for e in range(part.radius.size):
        if part.found.touches[e]:
            for g in range(part.share.shape[1]):
                energy[2] += part.share[e, g] * part.found.stored[e, g]


@add_work.of(SeabedData)
def _contact_work(part: SeabedData, first: Configuration, last: Configuration, work: Array) -> None:
    """See `SeabedContact.work`; the last configuration is that of the forces found last."""
    found, ng = part.found, part.share.shape[1]
    taken, gained, by_law = 0.0, 0.0, 0.0
    before, began = np.zeros(ng), np.zeros((ng, part.f.size))
    for e in range(part.radius.size):
        touched = False
        for g in range(ng):
            stations.put_value(part.at.N[e, g], first.q[e], began[g], last.D)
            value, _, _ = distance_in(part.frame, part.ground, padded(began[g]))
            before[g] = part.radius[e] - value
            if may_act(part.law, before[g], part.memory[e, g]):
                if _is_covered(part, began[g], e, g):
                    before[g] = -np.inf
                else:
                    touched = True
        for g in range(ng):
            share = part.share[e, g]
            if found.touches[e]:
                way = sub(padded(found.position[e, g]), padded(began[g]))
                taken -= share * found.force[e, g] * dot(padded(found.normal[e, g]), way)
                gained += share * found.stored[e, g]
            if touched:
                gained -= share * answer(part.law, before[g], part.memory[e, g], part.after)[2]
            if part.memory.shape[2] > 0 and (touched or found.touches[e]):
                after = found.penetration[e, g]
                by_law += share * work_at(part.law, part.reach, before[g], after, part.memory[e, g], part.after)
    work[0] += taken - gained
    work[3] += taken - by_law if part.memory.shape[2] > 0 else taken - gained


@keep.of(SeabedData)
def _keep_memory(part: SeabedData, at: Configuration) -> None:
    """See `SeabedContact.commit`."""
    found, memory = part.found, part.memory
    for e in range(memory.shape[0] if memory.shape[2] > 0 else 0):
        for g in range(memory.shape[1]):
            if not found.touches[e]:
                answer(part.law, found.penetration[e, g], memory[e, g], found.after[e, g])
            for k in range(memory.shape[2]):
                memory[e, g, k] = found.after[e, g, k]


@put_results.of(SeabedData)
def _contact_results(part: SeabedData, at: Configuration, out: ContactResults) -> None:
    """Of ground on which nothing lies anywhere."""
    found = part.found.touches, part.found.penetration, part.found.force, part.found.normal
    put_contact(part.frame, part.ground, part.nodes, part.start, part.share, at.x, found, out)


@njit
def _elastic(part: FrictionData, e: int, g: int) -> Pair:
    """t* of `coulomb` at a station."""
    guess: Pair = elastic_guess(
        read_along(part.along[e, g]), padded(part.traction[e, g]), part.stiffness[e], _moved(part, e, g)
    )
    return guess


@njit
def _moved(part: FrictionData, e: int, g: int) -> Vec:
    """The movement of a station in the step."""
    moved: Vec = sub(padded(part.contact.found.position[e, g]), padded(part.position[e, g]))
    return moved


@njit
def _limits(part: FrictionData, e: int, g: int) -> tuple[Pair, Pair]:
    """L of `coulomb` at a station, and its derivative by the penetration."""
    found = part.contact.found
    most = adhesion_at(part.adhesion, found.penetration[e, g])
    limit: tuple[Pair, Pair] = limits(found.force[e, g], found.slope[e, g], part.mu, most)
    return limit


@add_forces.of(FrictionData)
def _friction_forces(part: FrictionData, at: Configuration, out: LineForces) -> None:
    """After those of the contact that it belongs to."""
    contact = part.contact
    for e in range(part.stiffness.size):
        if not contact.found.touches[e]:
            continue
        for g in range(contact.share.shape[1]):
            limit, rise = _limits(part, e, g)
            t, _, _ = return_map(_elastic(part, e, g), limit, rise)
            put(scale(-1.0, vector_of(read_along(part.along[e, g]), t)), part.resistance[e, g])
            p = e * contact.share.shape[1] + g
            stations.add_integrand_at(contact.at.weighted, p, held(part.resistance[e, g], at.D), out.end_q, e, at.D)


@add_tangent.of(FrictionData)
def _friction_tangent(part: FrictionData, at: Configuration, maps: Maps, weights: LineWeights, K: Array) -> None:
    contact, found, workspace = part.contact, part.contact.found, part.contact.element
    for e in range(part.stiffness.size):
        if not found.touches[e]:
            continue
        workspace[:] = 0.0
        for g in range(contact.share.shape[1]):
            limit, rise = _limits(part, e, g)
            _, by_elastic, by_penetration = return_map(_elastic(part, e, g), limit, rise)
            ways, normal = read_along(part.along[e, g]), padded(found.normal[e, g])
            put_matrix(
                resistance_by_position(ways, part.stiffness[e], by_elastic, by_penetration, normal), contact.by
            )
            dragged = contact.at.N[e, g], contact.by, maps.place_rows[e]
            add_weighed(workspace, contact.at.weighted[e, g], (dragged,), at.D, at.R)
        add_pulled_back(K[e], at.P[e], workspace, at.D, at.R)


@add_energy.of(FrictionData)
def _friction_energy(part: FrictionData, at: Configuration, energy: Array) -> None:
    for e in range(part.stiffness.size):
        if part.contact.found.touches[e]:
            for g in range(part.contact.share.shape[1]):
                t: Vec = padded(part.resistance[e, g])
                energy[2] += 0.5 * part.contact.share[e, g] / part.stiffness[e] * dot(t, t)


@add_work.of(FrictionData)
def _friction_work(part: FrictionData, first: Configuration, last: Configuration, work: Array) -> None:
    """See `CoulombFriction.work`."""
    contact = part.contact
    for e in range(part.stiffness.size):
        for g in range(contact.share.shape[1]):
            share, begun = contact.share[e, g], padded(part.traction[e, g])
            work[0] += 0.5 * share / part.stiffness[e] * dot(begun, begun)
            if contact.found.touches[e]:
                t: Vec = padded(part.resistance[e, g])
                work[0] += share * dot(t, _moved(part, e, g)) - 0.5 * share / part.stiffness[e] * dot(t, t)


@keep.of(FrictionData)
def _keep_traction(part: FrictionData, at: Configuration) -> None:
    """See `CoulombFriction.commit`."""
    found = part.contact.found
    for e in range(part.stiffness.size):
        for g in range(part.slid.shape[1]):
            t, k = padded(part.traction[e, g]), part.stiffness[e]
            if found.touches[e] and found.force[e, g] > 0.0:
                taken = add(t, padded(part.resistance[e, g]))
                part.slid[e, g] += slip_at(read_along(part.along[e, g]), taken, k, _moved(part, e, g))
            stations.put_unit_tangent(part.contact.at.dN[e, g], at.chord[e], at.tangent[e], part.contact.f, at.D)
            put_along(directions_at(padded(part.contact.f), padded(found.normal[e, g])), part.along[e, g])
            for i in range(len(at.D)):
                part.position[e, g, i] = found.position[e, g, i]
                part.traction[e, g, i] = -part.resistance[e, g, i] if found.touches[e] else 0.0
