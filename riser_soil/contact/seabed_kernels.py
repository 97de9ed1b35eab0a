"""Kernels of the contact with a seabed, see `part_kernels`: what touches, and the ground's forces.

Vectors are in the line's axes, the third component 0 in the plane.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from riser_soil.contact.along_step import Shares, lift, seabed_step
from riser_soil.contact.contact import ContactResults, write_results
from riser_soil.core.arrays import Array, BoolArray, as_list
from riser_soil.core.bound import Span, call_span, spans
from riser_soil.core.compiled import fixed, njit
from riser_soil.core.entries import Calls
from riser_soil.core.part import Weights
from riser_soil.core.rows import add_pulled_back, add_weighed, as_tuple
from riser_soil.riser import stations
from riser_soil.riser.configuration import Configuration, Maps
from riser_soil.riser.hermite import Size
from riser_soil.riser.line import Line
from riser_soil.riser.part_kernels import LineForces, add_energy, add_forces, add_tangent, add_work, keep
from riser_soil.riser.sections import larger_beside
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
from riser_soil.seabed.grounds import Ground
from riser_soil.seabed.law import NormalLaw
from riser_soil.seabed.points import seabed_points


class LineFrame(NamedTuple):
    """Origin [m] and axes of a line, global; the rows of `axes` are unit vectors, the third 0 in the plane."""

    origin: Vec
    axes: Mat


class TouchingStations(NamedTuple):
    """Stations of a line's elements and their share of arc length (ne, ng); in the line's frame. As evaluated last:
    which elements touch (ne,); of the stations (n,), n = ne ng, position (n, d), penetration, gradient (n, 3) of the
    distance from the ground in global axes, whether the law acts, force and slope. Workspace for an element, and for a
    vector and a matrix of a station.
    """

    at: stations.Stations
    share: Array
    frame: LineFrame
    touches: BoolArray
    position: Array
    penetration: Array
    gradient: Array
    acts: BoolArray
    force: Array
    slope: Array
    element: Array
    f: Array
    by: Array


class AtNodes(NamedTuple):
    """Nodes (nn,): line that belongs to each [m]; shares (2, ng) that stations of an element have in its first and its
    second node; places (nn, 3) in global axes and penetrations, as evaluated last.
    """

    length: Array
    linear: Array
    place: Array
    penetration: Array


class SeabedData(NamedTuple):
    """A `SeabedContact`: the stations that touch; the nodes; the gap at which the law's force starts [m]; whether the
    ground is flat.

    Places of the stations (n, 3) in global axes, hessians of the distance (n, 3, 3) and energy stored (n,); places and
    energy where the step began; work (n,) of a law with a history in the step, (0,) of others. Kernels, see
    `SeabedPoints`, and which of them find what the stations do at the end of the step and where it began, and so on.
    """

    touching: TouchingStations
    nodes: AtNodes
    start: float
    flat: bool
    place: Array
    hessian: Array
    stored: Array
    began_at: Array
    stored_before: Array
    work: Array
    kernels: Calls
    find: Span
    find_before: Span
    find_at_nodes: Span
    write_hessians: Span
    set_all_aside: Span
    keep: Span


def seabed_data(
    line: Line,
    at: stations.Stations,
    share: Array,
    radius: Array,
    memory: Array,
    linear: Array,
    ground: Ground,
    law: NormalLaw,
    cover: Any,
    shares: Shares | None,
) -> SeabedData:
    """Kernel data of a contact at the stations `at` of a line, with the workspace that they need.

    radius (ne,) [m]; memory (ne, ng, nh): the law's history; cover: kernel data of what lies on the ground in places,
    None for nothing; shares: of the law that act, None for all of it.
    """
    (ne, ng, nh), d, n = memory.shape, line.dimension, share.size
    step = seabed_step(np.repeat(radius, ng), ground, law, memory.reshape(n, nh), cover, shares)
    here, began = step.here, step.began
    at_nodes = seabed_points(larger_beside(radius), ground, law, law.initial_history((ne + 1,)), cover)
    kernels, (find, before, nodal, hessians, aside, keeping) = spans(
        here.find, step.find_before, at_nodes.write_penetrations, here.write_hessians, here.set_all_aside, here.keep
    )
    touching = TouchingStations(
        at,
        share,
        frame_of(line),
        touches=np.zeros(ne, dtype=np.bool_),
        position=np.zeros((n, d)),
        penetration=here.ground.penetration,
        gradient=here.ground.gradient,
        acts=here.law.acts,
        force=here.law.force,
        slope=here.law.slope,
        element=stations.element_workspace(2 * line.ndof, fixed(d)),
        f=np.zeros(d),
        by=np.zeros((d, d)),
    )
    nodes = AtNodes(line.tributary_length, linear, at_nodes.ground.place, at_nodes.ground.penetration)
    arrays = here.ground.place, here.ground.hessian, here.law.stored, began.ground.place, began.law.stored, step.work
    called = kernels, find, before, nodal, hessians, aside, keeping
    return SeabedData._make((touching, nodes, float(law.start), ground.flat, *arrays, *called))


def frame_of(line: Line) -> LineFrame:
    """The frame of a line's coordinates."""
    axes = np.zeros((3, 3))
    axes[: line.dimension] = line.basis.T
    origin, rows = as_list(line.origin), as_list(axes)
    return LineFrame((origin[0], origin[1], origin[2]), (tuple(rows[0]), tuple(rows[1]), tuple(rows[2])))


@njit
def global_place(frame: LineFrame, x: Vec) -> Vec:
    """A place in global axes [m]."""
    return add(frame.origin, vecmat(x, frame.axes))


@njit
def normal_at(touching: TouchingStations, p: int) -> Vec:
    """Gradient of the distance of a station from the ground, in the line's axes as its position is."""
    normal: Vec = matvec(touching.frame.axes, vector(touching.gradient[p]))
    return normal


@njit
def _bend_at(part: SeabedData, p: int) -> Mat:
    """Hessian of the distance of a station [1/m] in the line's axes."""
    axes = part.touching.frame.axes
    bend: Mat = matmul(matmul(axes, matrix(part.hessian[p])), transpose(axes))
    return bend


@njit
def by_position(force: float, slope: float, normal: Vec, bend: Mat) -> Mat:
    """Derivative by the position of minus the force per length on the riser; bend: derivative of the normal."""
    return matadd(matscale(slope, outer(normal, normal)), matscale(-force, bend))


@njit
def _by_position_at(part: SeabedData, p: int) -> Mat:
    """`by_position` of a station, in the line's axes; on flat ground the normal does not turn."""
    normal, force, slope = normal_at(part.touching, p), part.touching.force[p], part.touching.slope[p]
    if part.flat:
        return matscale(slope, outer(normal, normal))
    return by_position(force, slope, normal, _bend_at(part, p))


@njit
def _position(touching: TouchingStations, p: int, q: Array, e: int, D: Size) -> Vec:
    """Position of station p of all, which lies in element e, in the line's axes."""
    x = stations.value_at(touching.at.N, p, q, e, D)
    for i in range(len(D)):
        touching.f[i] = x[i]
    position: Vec = padded(touching.f)
    return position


@njit
def land(part: SeabedData, x: Array, moved: Array) -> None:
    """Raise the increments (nn, ndof) of nodes at x (nn, d) that would sink, see `along_step`; not of those that come
    down on something else.
    """
    nn, d, penetration = x.shape[0], x.shape[1], part.nodes.penetration
    present, then = np.empty(nn), np.empty((nn, d))
    _find_at_nodes(part, x)
    for n in range(nn):
        present[n] = -penetration[n] - part.start
        for i in range(d):
            then[n, i] = x[n, i] + moved[n, i]
    _find_at_nodes(part, then)
    for n in range(nn):
        moved[n, d - 1] += lift(present[n], -penetration[n] - part.start, part.start)


@njit
def _find_at_nodes(part: SeabedData, x: Array) -> None:
    """Write the penetrations of nodes at x (nn, d)."""
    for n in range(x.shape[0]):
        write(global_place(part.touching.frame, padded(x[n])), part.nodes.place[n])
    call_span(part.kernels, part.find_at_nodes)


@add_forces.of(SeabedData)
def _contact_forces(part: SeabedData, at: Configuration, out: LineForces) -> None:
    touching, (ne, ng) = part.touching, part.touching.share.shape
    for e in range(ne):
        for p in range(e * ng, (e + 1) * ng):
            x = _position(touching, p, at.q, e, at.D)
            write(x, touching.position[p])
            write(global_place(touching.frame, x), part.place[p])
    call_span(part.kernels, part.find)
    for e in range(ne):
        touching.touches[e] = False
        for p in range(e * ng, (e + 1) * ng):
            if touching.acts[p]:
                touching.touches[e] = True
                write(scale(-touching.force[p], normal_at(touching, p)), touching.f)
                stations.add_integrand_at(touching.at.weighted, p, as_tuple(touching.f, at.D), out.end_q, e, at.D)


@add_tangent.of(SeabedData)
def _contact_tangent(part: SeabedData, at: Configuration, maps: Maps, weights: Weights, K: Array) -> None:
    touching, ng = part.touching, part.touching.share.shape[1]
    call_span(part.kernels, part.write_hessians)
    for e in range(touching.touches.size):
        if not touching.touches[e]:
            continue
        touching.element[:] = 0.0
        for g in range(ng):
            p = e * ng + g
            if touching.acts[p]:
                write_matrix(_by_position_at(part, p), touching.by)
                pressed = touching.at.N[e, g], touching.by, maps.place_rows[e]
                add_weighed(touching.element, touching.at.weighted[e, g], (pressed,), at.D, at.R)
        add_pulled_back(K[e], at.P[e], touching.element, at.D, at.R)


@add_energy.of(SeabedData)
def _contact_energy(part: SeabedData, at: Configuration, energy: Array) -> None:
    share, stored = part.touching.share.reshape(part.stored.size), 0.0
    for p in range(part.stored.size):
        stored += share[p] * part.stored[p]
    energy[2] += stored


@add_work.of(SeabedData)
def _contact_work(part: SeabedData, first: Configuration, last: Configuration, work: Array) -> None:
    """Dissipated is the work of the force at the end of the step less the change of the energy stored.

    Never negative on a plane, where the stored energy is convex in the penetration. What that force extracts beyond
    the work of the law along the step is the time scheme's; on ground without a history it is all. The last
    configuration is that of the forces evaluated last.
    """
    touching, (ne, ng) = part.touching, part.touching.share.shape
    share, extracted, gained, by_law = touching.share.reshape(ne * ng), 0.0, 0.0, 0.0
    for e in range(ne):
        for p in range(e * ng, (e + 1) * ng):
            write(global_place(touching.frame, _position(touching, p, first.q, e, last.D)), part.began_at[p])
    call_span(part.kernels, part.find_before)
    for p in range(ne * ng):
        way = sub(vector(part.place[p]), vector(part.began_at[p]))
        extracted -= share[p] * touching.force[p] * dot(vector(touching.gradient[p]), way)
        gained += share[p] * (part.stored[p] - part.stored_before[p])
        if part.work.size > 0:
            by_law += share[p] * part.work[p]
    work[0] += extracted - gained
    work[3] += extracted - (by_law if part.work.size > 0 else gained)


@keep.of(SeabedData)
def _keep_history(part: SeabedData, at: Configuration) -> None:
    """Keep the law's history after the step."""
    call_span(part.kernels, part.keep)


@write_results.of(SeabedData)
def _contact_results(part: SeabedData, at: Configuration, out: ContactResults) -> None:
    touching, nodes, total = part.touching, part.nodes, (0.0, 0.0, 0.0)
    ne, ng = touching.share.shape
    out.force_per_length[:], out.deepest[0] = 0.0, 0.0
    call_span(part.kernels, part.set_all_aside)
    for e in range(ne):
        for g in range(ng):
            p = e * ng + g
            force = touching.share[e, g] * touching.force[p]
            out.clearance[p], out.force[p] = -touching.penetration[p] - part.start, touching.force[p]
            out.deepest[0] = max(out.deepest[0], touching.penetration[p])
            for side in range(2):
                out.force_per_length[e + side] += nodes.linear[side, g] * force
            total = add(total, scale(force, normal_at(touching, p)))
    write(vecmat(total, touching.frame.axes), out.on_riser)
    _find_at_nodes(part, at.x)
    for n in range(nodes.length.size):
        out.force_per_length[n] /= nodes.length[n]
        out.penetration[n] = out.depth[n] = max(0.0, nodes.penetration[n])


@njit
def write_at_nodes(nodes: AtNodes, share: Array, values: Array, out: Array) -> None:
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
