"""Kernels of the contact with a seabed, see `part_kernels`: what touches, and what the ground answers.

Vectors are in the line's axes, the third component 0 in the plane.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from riser_soil.contact.along_step import lift, work_at
from riser_soil.contact.contact import ContactResults, write_results
from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.by_type import by_type
from riser_soil.core.compiled import fixed, njit
from riser_soil.core.part import Weights
from riser_soil.core.rows import add_pulled_back, add_weighed, as_tuple
from riser_soil.riser import stations
from riser_soil.riser.configuration import Configuration, Maps
from riser_soil.riser.line import Line
from riser_soil.riser.part_kernels import LineForces, add_energy, add_forces, add_tangent, add_work, keep
from riser_soil.riser.vectors import (
    Mat,
    Vec,
    add,
    dot,
    matadd,
    matmul,
    matrix,
    matscale,
    matvec,
    outer,
    padded,
    scale,
    sub,
    transpose,
    vecmat,
    vector,
    write,
    write_matrix,
)
from riser_soil.seabed.compiled_law import answer, may_act
from riser_soil.seabed.grounds import distance_at
from riser_soil.seabed.law import NormalLaw

UNKNOWN = -1  # number of what lies on the ground below a place


class LineFrame(NamedTuple):
    """Origin [m] and axes of a line, global; the rows of `axes` are unit vectors, the third 0 in the plane."""

    origin: Vec
    axes: Mat


class OverNodes(NamedTuple):
    """What stations (ne, ng) share with the nodes: radius and length of the line that belongs to a node (nn,) [m];
    linear (2, ng): shares of a station at the first and the second node of its element.
    """

    radius: Array
    length: Array
    linear: Array


class Found(NamedTuple):
    """What was found last at the stations: which elements touch (ne,); position and normal (ne, ng, d); penetration,
    force, its slope and energy stored (ne, ng); what covers the ground below (ne, ng), see `covered_by`; the law's
    history after the step (ne, ng, nh), of elements that touch.
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
    nodes, and the kernel data of its ground and law; the law's start and reach; shares (2,) of the law that act where a
    step starts and where it ends; what covers the ground in places; workspace for an element, for the force and its
    derivative at a station, and for a history (nh,).
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
    acting: Array
    cover: Any
    found: Found
    element: Array
    f: Array
    by: Array
    after: Array


def seabed_data(
    line: Line,
    at: stations.Stations,
    share: Array,
    radius: Array,
    memory: Array,
    nodes: OverNodes,
    ground: Any,
    law: NormalLaw,
    cover: Any,
) -> SeabedData:
    """With the workspace that they need; ground: its kernel data; cover: what lies on it in places, None for nothing.
    """
    (ne, ng), d = share.shape, line.dimension
    position, normal = np.zeros((ne, ng, d)), np.zeros((ne, ng, d))
    penetration, force, slope, stored = (np.zeros((ne, ng)) for _ in range(4))
    touches, below = np.zeros(ne, dtype=np.bool_), np.full((ne, ng), UNKNOWN)
    found = Found(touches, position, normal, penetration, force, slope, stored, below, np.zeros(memory.shape))
    element = stations.element_workspace(2 * line.ndof, fixed(d))
    workspace = element, np.zeros(d), np.zeros((d, d)), np.zeros(memory.shape[2])
    law_data = law.kernel_data, float(law.start), float(law.reach), np.ones(2)
    given = at, share, radius, memory, nodes, frame_of(line), ground, *law_data
    return SeabedData(*given, Bare(-1) if cover is None else cover, found, *workspace)


def frame_of(line: Line) -> LineFrame:
    """The frame of a line's coordinates."""
    axes = np.zeros((3, 3))
    axes[: line.dimension] = line.basis.T
    return LineFrame(vector(line.origin), matrix(axes))


@njit
def distance_in(frame: LineFrame, ground: Any, x: Vec) -> tuple[float, Vec, Mat]:
    """Distance of a point from the ground [m], its gradient and hessian [1/m], in the line's axes as x is."""
    value, gradient, hessian = distance_at(ground, global_place(frame, x))
    return value, matvec(frame.axes, gradient), matmul(matmul(frame.axes, hessian), transpose(frame.axes))


@njit
def global_place(frame: LineFrame, x: Vec) -> Vec:
    """A place in global axes [m]."""
    return add(frame.origin, vecmat(x, frame.axes))


@njit
def by_position(force: float, slope: float, normal: Vec, bend: Mat) -> Mat:
    """Derivative by the position of minus the force per length on the riser; bend: derivative of the normal."""
    return matadd(matscale(slope, outer(normal, normal)), matscale(-force, bend))


@by_type
def covered_by(cover: Any, x: Vec, known: int) -> Any:
    """What lies on the ground below a place x, in global axes: its number, < 0 for nothing. known: what was found there
    last, UNKNOWN at first.
    """


@covered_by.of(Bare)
def _never(cover: Bare, x: Vec, known: int) -> int:
    return cover.nothing


@njit
def _is_covered(part: SeabedData, place: Array, e: int, g: int) -> bool:
    """Whether something else lies on the ground below a station."""
    below = part.found.below
    below[e, g] = covered_by(part.cover, global_place(part.frame, padded(place)), below[e, g])
    return bool(below[e, g] >= 0)


@njit
def land(part: SeabedData, x: Array, moved: Array) -> None:
    """Raise the increments (nn, ndof) of nodes at x (nn, d) that would sink, see `along_step`."""
    d, start = x.shape[1], part.start
    for n in range(x.shape[0]):
        now = padded(x[n])
        then = add(now, padded(moved[n, :d]))
        present, _, _ = distance_in(part.frame, part.ground, now)
        guessed, _, _ = distance_in(part.frame, part.ground, then)
        present, guessed = present - part.nodes.radius[n] - start, guessed - part.nodes.radius[n] - start
        if lift(np.inf, guessed, start) > 0.0 and not _lies_beside(part, then):
            moved[n, d - 1] += lift(np.inf if _lies_beside(part, now) else present, guessed, start)


@njit
def _lies_beside(part: SeabedData, x: Vec) -> bool:
    """Whether something else lies on the ground below a place."""
    return bool(covered_by(part.cover, global_place(part.frame, x), UNKNOWN) >= 0)


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
            write(normal, found.normal[e, g])
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
        acting = part.acting[1]
        found.force[e, g], found.slope[e, g], found.stored[e, g] = acting * force, acting * slope, acting * stored
        write(scale(-acting * force, padded(found.normal[e, g])), part.f)
        p = e * part.share.shape[1] + g
        stations.add_integrand_at(part.at.weighted, p, as_tuple(part.f, at.D), out.end_q, e, at.D)


@add_tangent.of(SeabedData)
def _contact_tangent(part: SeabedData, at: Configuration, maps: Maps, weights: Weights, K: Array) -> None:
    found, workspace = part.found, part.element
    for e in range(part.radius.size):
        if not found.touches[e]:
            continue
        workspace[:] = 0.0
        for g in range(part.share.shape[1]):
            _, _, bend = distance_in(part.frame, part.ground, padded(found.position[e, g]))
            write_matrix(by_position(found.force[e, g], found.slope[e, g], padded(found.normal[e, g]), bend), part.by)
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
    """Dissipated is the work of the force at the end of the step less the change of the energy stored.

    Never negative on a plane, where the stored energy is convex in the penetration. What that force takes beyond the
    work of the law along the step is the time scheme's; on ground without a history it is all. The last configuration
    is that of the forces found last.
    """
    found, ng = part.found, part.share.shape[1]
    taken, gained, by_law = 0.0, 0.0, 0.0
    before, began = np.zeros(ng), np.zeros((ng, part.f.size))
    for e in range(part.radius.size):
        touched = False
        for g in range(ng):
            x = stations.value_at(part.at.N, e * ng + g, first.q, e, last.D)
            for i in range(len(last.D)):
                began[g, i] = x[i]
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
                stored = answer(part.law, before[g], part.memory[e, g], part.after)[2]
                gained -= share * part.acting[0] * stored
            if part.memory.shape[2] > 0 and (touched or found.touches[e]):
                after = found.penetration[e, g]
                by_law += share * work_at(part.law, part.reach, before[g], after, part.memory[e, g], part.after)
    work[0] += taken - gained
    work[3] += taken - by_law if part.memory.shape[2] > 0 else taken - gained


@keep.of(SeabedData)
def _keep_memory(part: SeabedData, at: Configuration) -> None:
    """The law's history after the step."""
    found, memory = part.found, part.memory
    for e in range(memory.shape[0] if memory.shape[2] > 0 else 0):
        for g in range(memory.shape[1]):
            if not found.touches[e]:
                answer(part.law, found.penetration[e, g], memory[e, g], found.after[e, g])
            for k in range(memory.shape[2]):
                memory[e, g, k] = found.after[e, g, k]


@write_results.of(SeabedData)
def _contact_results(part: SeabedData, at: Configuration, out: ContactResults) -> None:
    found, nodes, total = part.found, part.nodes, (0.0, 0.0, 0.0)
    ng = part.share.shape[1]
    out.force_per_length[:], out.deepest[0] = 0.0, 0.0
    for e in range(part.radius.size):
        for g in range(ng):
            pressing, k = found.force[e, g] if found.touches[e] else 0.0, e * ng + g
            covered = _is_covered(part, found.position[e, g], e, g)
            out.clearance[k] = np.inf if covered else -found.penetration[e, g] - part.start
            out.force[k] = pressing
            out.deepest[0] = max(out.deepest[0], found.penetration[e, g])
            for side in range(2):
                out.force_per_length[e + side] += nodes.linear[side, g] * (part.share[e, g] * pressing)
            total = add(total, scale(part.share[e, g] * pressing, padded(found.normal[e, g])))
    write(vecmat(total, part.frame.axes), out.on_riser)
    for n in range(nodes.length.size):
        value, _, _ = distance_in(part.frame, part.ground, padded(at.x[n]))
        inside = max(0.0, nodes.radius[n] - value)
        out.force_per_length[n] /= nodes.length[n]
        if inside > 0.0 and _lies_beside(part, padded(at.x[n])):
            inside = 0.0
        out.penetration[n] = out.depth[n] = inside


@njit
def write_at_nodes(nodes: OverNodes, share: Array, values: Array, out: Array) -> None:
    """Write means at the nodes (nn,) of values at the stations (ne, ng), which count with their share (ne, ng) of arc
    length.
    """
    out[:] = 0.0
    for e in range(values.shape[0]):
        for g in range(values.shape[1]):
            for side in range(2):
                out[e + side] += nodes.linear[side, g] * share[e, g] * values[e, g]
    for n in range(out.size):
        out[n] /= nodes.length[n]
