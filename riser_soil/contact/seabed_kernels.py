"""Kernels of the contact with a seabed, see `part_kernels`: what touches, and what the ground answers.

Vectors are in the line's axes, the third component 0 in the plane.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from riser_soil.contact.along_step import OverStep, keep_history, lift, over_step
from riser_soil.contact.contact import ContactResults, write_results
from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.bound import call_each
from riser_soil.core.compiled import fixed, njit
from riser_soil.core.part import Weights
from riser_soil.core.rows import add_pulled_back, add_weighed, as_tuple
from riser_soil.riser import stations
from riser_soil.riser.configuration import Configuration, Maps
from riser_soil.riser.hermite import Size
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
from riser_soil.seabed.grounds import Ground
from riser_soil.seabed.law import NormalLaw
from riser_soil.seabed.points import SeabedPoints, find_penetrations, seabed_points


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


class SeabedData(NamedTuple):
    """A `SeabedContact`: its stations and their share of arc length (ne, ng), radius (ne,), the nodes; the gap at which
    the law's force starts [m]; shares (2,) of the law that act where a step starts and where it ends.

    As found last: which elements touch (ne,); positions of the stations (ne ng, d) and what the seabed does there, with
    forces by their share of the law; the same where the step began, by the whole law; the nodes beside the seabed;
    the law over the step. Workspace for an element, and for the force and its derivative at a station.
    """

    at: stations.Stations
    share: Array
    radius: Array
    over_nodes: OverNodes
    frame: LineFrame
    start: float
    acting: Array
    touches: BoolArray
    position: Array
    began_at: Array
    here: SeabedPoints
    began: SeabedPoints
    nodes: SeabedPoints
    over_step: OverStep
    element: Array
    f: Array
    by: Array


def seabed_data(
    line: Line,
    at: stations.Stations,
    share: Array,
    radius: Array,
    memory: Array,
    nodes: OverNodes,
    ground: Ground,
    law: NormalLaw,
    cover: Any,
) -> SeabedData:
    """With the workspace that they need; memory (ne, ng, nh): the law's history; cover: kernel data of what lies on the
    ground in places, None for nothing.
    """
    (ne, ng, nh), d, radii = memory.shape, line.dimension, np.repeat(radius, share.shape[1])
    here, began = (seabed_points(radii, ground, law, memory.reshape(ne * ng, nh), cover) for _ in range(2))
    beside = seabed_points(nodes.radius, ground, law, law.initial_history(nodes.radius.shape), cover)
    places = np.zeros(ne, dtype=np.bool_), np.zeros((ne * ng, d)), np.zeros((ne * ng, d))
    element = stations.element_workspace(2 * line.ndof, fixed(d))
    return SeabedData(
        *(at, share, radius, nodes, frame_of(line), float(law.start), np.ones(2), *places),
        *(here, began, beside, over_step(law, here, began), element, np.zeros(d), np.zeros((d, d))),
    )


def frame_of(line: Line) -> LineFrame:
    """The frame of a line's coordinates."""
    axes = np.zeros((3, 3))
    axes[: line.dimension] = line.basis.T
    return LineFrame(vector(line.origin), matrix(axes))


@njit
def global_place(frame: LineFrame, x: Vec) -> Vec:
    """A place in global axes [m]."""
    return add(frame.origin, vecmat(x, frame.axes))


@njit
def normal_at(part: SeabedData, p: int) -> Vec:
    """Gradient of the distance of a station from the ground, in the line's axes as its position is."""
    normal: Vec = matvec(part.frame.axes, vector(part.here.at.gradient[p]))
    return normal


@njit
def bend_at(part: SeabedData, p: int) -> Mat:
    """Hessian of the distance [1/m] there, in the line's axes."""
    if part.here.write_hessians.rows.size == 0:
        return ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    axes = part.frame.axes
    return matmul(matmul(axes, matrix(part.here.at.hessian[p])), transpose(axes))


@njit
def by_position(force: float, slope: float, normal: Vec, bend: Mat) -> Mat:
    """Derivative by the position of minus the force per length on the riser; bend: derivative of the normal."""
    return matadd(matscale(slope, outer(normal, normal)), matscale(-force, bend))


@njit
def _place(part: SeabedData, q: Array, D: Size, position: Array, points: SeabedPoints) -> None:
    """Write the positions of the stations, and the same in global axes."""
    ng = part.share.shape[1]
    for p in range(len(position)):
        x = stations.value_at(part.at.N, p, q, p // ng, D)
        for i in range(len(D)):
            position[p, i] = x[i]
        write(global_place(part.frame, padded(position[p])), points.at.place[p])


@njit
def land(part: SeabedData, x: Array, moved: Array) -> None:
    """Raise the increments (nn, ndof) of nodes at x (nn, d) that would sink, see `along_step`; not of those that come
    down on something else.
    """
    d, start, penetration = x.shape[1], part.start, part.nodes.law.penetration
    _find_at_nodes(part, x)
    present = -penetration - start
    _find_at_nodes(part, x + moved[:, :d])
    for n in range(x.shape[0]):
        moved[n, d - 1] += lift(present[n], -penetration[n] - start, start)


@njit
def _find_at_nodes(part: SeabedData, x: Array) -> None:
    """Find the penetrations of nodes at x (nn, d)."""
    for n in range(x.shape[0]):
        write(global_place(part.frame, padded(x[n])), part.nodes.at.place[n])
    find_penetrations(part.nodes)


@add_forces.of(SeabedData)
def _contact_forces(part: SeabedData, at: Configuration, out: LineForces) -> None:
    """By the share of the law that acts."""
    here, law, ng = part.here, part.here.law, part.share.shape[1]
    _place(part, at.q, at.D, part.position, here)
    find_penetrations(here)
    call_each(here.answer)
    part.touches[:] = False
    for p in range(len(part.position)):
        if law.acts[p]:
            part.touches[p // ng] = True
            law.force[p] *= part.acting[1]
            law.slope[p] *= part.acting[1]
            law.stored[p] *= part.acting[1]
            write(scale(-law.force[p], normal_at(part, p)), part.f)
            stations.add_integrand_at(part.at.weighted, p, as_tuple(part.f, at.D), out.end_q, p // ng, at.D)


@add_tangent.of(SeabedData)
def _contact_tangent(part: SeabedData, at: Configuration, maps: Maps, weights: Weights, K: Array) -> None:
    law, workspace, ng = part.here.law, part.element, part.share.shape[1]
    call_each(part.here.write_hessians)
    for e in range(part.radius.size):
        if not part.touches[e]:
            continue
        workspace[:] = 0.0
        for g in range(ng):
            p = e * ng + g
            if law.acts[p]:
                stiffness = by_position(law.force[p], law.slope[p], normal_at(part, p), bend_at(part, p))
                write_matrix(stiffness, part.by)
                pressed = part.at.N[e, g], part.by, maps.place_rows[e]
                add_weighed(workspace, part.at.weighted[e, g], (pressed,), at.D, at.R)
        add_pulled_back(K[e], at.P[e], workspace, at.D, at.R)


@add_energy.of(SeabedData)
def _contact_energy(part: SeabedData, at: Configuration, energy: Array) -> None:
    ng = part.share.shape[1]
    for p in range(len(part.position)):
        energy[2] += part.share[p // ng, p % ng] * part.here.law.stored[p]


@add_work.of(SeabedData)
def _contact_work(part: SeabedData, first: Configuration, last: Configuration, work: Array) -> None:
    """Dissipated is the work of the force at the end of the step less the change of the energy stored.

    Never negative on a plane, where the stored energy is convex in the penetration. What that force takes beyond the
    work of the law along the step is the time scheme's; on ground without a history it is all. The last configuration
    is that of the forces found last.
    """
    here, began, ng = part.here.law, part.began.law, part.share.shape[1]
    extracted, gained, by_law = 0.0, 0.0, 0.0
    _place(part, first.q, last.D, part.began_at, part.began)
    find_penetrations(part.began)
    call_each(part.began.answer)
    call_each(part.over_step.write_work)
    for p in range(len(part.position)):
        share = part.share[p // ng, p % ng]
        gained += share * (here.stored[p] - part.acting[0] * began.stored[p])
        by_law += share * part.over_step.work[p]
        if here.acts[p]:
            way = sub(padded(part.position[p]), padded(part.began_at[p]))
            extracted -= share * here.force[p] * dot(normal_at(part, p), way)
    work[0] += extracted - gained
    work[3] += extracted - (by_law if part.over_step.write_work.rows.size > 0 else gained)


@keep.of(SeabedData)
def _keep_history(part: SeabedData, at: Configuration) -> None:
    """The law's history after the step."""
    keep_history(part.over_step, part.here)


@write_results.of(SeabedData)
def _contact_results(part: SeabedData, at: Configuration, out: ContactResults) -> None:
    law, over, nodes, total = part.here.law, part.over_nodes, part.nodes, (0.0, 0.0, 0.0)
    ng = part.share.shape[1]
    out.force_per_length[:], out.deepest[0] = 0.0, 0.0
    call_each(part.here.set_all_aside)
    for p in range(len(part.position)):
        e, g, force = p // ng, p % ng, law.force[p]
        out.clearance[p] = -law.penetration[p] - part.start
        out.force[p] = force
        out.deepest[0] = max(out.deepest[0], law.penetration[p])
        for side in range(2):
            out.force_per_length[e + side] += over.linear[side, g] * (part.share[e, g] * force)
        total = add(total, scale(part.share[e, g] * force, normal_at(part, p)))
    write(vecmat(total, part.frame.axes), out.on_riser)
    _find_at_nodes(part, at.x)
    for n in range(over.length.size):
        out.force_per_length[n] /= over.length[n]
        out.penetration[n] = out.depth[n] = max(0.0, nodes.law.penetration[n])


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
