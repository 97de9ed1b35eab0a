"""Two-node corotational Euler-Bernoulli elements in space: forces and tangent from one energy.

An element sees its chord x2 - x1 (m) and the section frames T1, T2 at its ends (columns: tangent, second
and third section axis). In the frame of `corotation` the chord's length and the rotations of the ends
store the strain energy of `strain3d`. Forces (N) and moments (N m) are ordered force1, moment1, force2,
moment2, in global axes; they are internal and conjugate to displacements and spatial spins, by which the
tangent differentiates them. `rotations` turns both into those of rotation vectors, where the tangent is
the symmetric Hessian of the energy. Nodes may turn without limit; within one element the tangents of the
ends must stay less than half a turn from its chord, and the twist less than half a turn.
"""

from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.riser.corotation import (
    BowLoad,
    SpatialCorotated,
    SpatialNodalForces,
    SwingTwist,
    bow_load,
    bow_potential,
    chord_force,
    corotate,
    end_moment,
    frame_spin,
    lengthen,
    moment,
    moment_variation,
    nodal_forces,
    plus,
    rate,
    split,
    turn,
    turned,
)
from riser_soil.riser.stiffness import ElementStiffness, LineStiffness, of_element
from riser_soil.riser.strain3d import (
    Station,
    Strain,
    Stress,
    conjugate,
    conjugate_change,
    difference,
    energy,
    pulled_strain,
    stations,
    strain,
    strain_change,
    stress,
    stress_change,
)
from riser_soil.riser.tension_only import (
    Heaped,
    set_spring_forces,
    set_spring_tangent,
    spring_energy,
)
from riser_soil.riser.vectors import Mat, Vec, add, dot, matrix, scale, sub, vecmat, vector

STILL = (0.0, 0.0, 0.0)


class SpatialReference(NamedTuple):
    """Unstressed configuration of the elements."""

    axial: Array  # (ne,) strain measures of `strain3d` in the unstressed shape
    twist: Array  # (ne,)
    curvature: Array  # (ne, 2, 2) station, section axis


class Shape(NamedTuple):
    """Configuration of one element in its own frame, and its strains."""

    frame: SpatialCorotated
    end1: SwingTwist
    end2: SwingTwist
    stations: tuple[Station, Station]
    strain: Strain


class SpatialChange(NamedTuple):
    """A change of an element's configuration, or its rate, in the element's frame."""

    stretch: float  # of the chord
    spin: Vec  # of the frame
    spin1: Vec  # of the ends, relative to the frame
    spin2: Vec
    da: Vec  # change of the ends' angles
    db: Vec


class SpatialResponse(NamedTuple):
    """Stresses and forces of an element in its own frame, as the variation of its forces needs them."""

    elastic: Strain  # what the stress comes from
    stress: Stress
    mu1: Vec  # generalised moments of the ends
    mu2: Vec
    forces: SpatialNodalForces
    load: BowLoad


@njit
def shape(L: float, chord: Vec, T1: Mat, T2: Mat) -> Shape:
    """Configuration of an element of arc length L with section frames T1 and T2 at its ends."""
    frame = corotate(chord, T1, T2)
    end1, end2 = split(frame.A1), split(frame.A2)
    both = stations(L, end1.angles, end2.angles)
    return Shape(frame, end1, end2, both, strain(L, frame.length, end1.angles, end2.angles, both))


@njit
def reference(chord0: Array, T0_1: Array, T0_2: Array, L: Array) -> SpatialReference:
    """Unstressed configuration from chords (ne, 3), end frames (ne, 3, 3) and arc lengths (ne,)."""
    ne = len(L)
    axial, twist, curvature = np.empty(ne), np.empty(ne), np.empty((ne, 2, 2))
    for e in range(ne):
        at = shape(L[e], vector(chord0[e]), matrix(T0_1[e]), matrix(T0_2[e])).strain
        axial[e], twist[e] = at.axial, at.twist
        curvature[e, 0, 0], curvature[e, 0, 1] = at.first
        curvature[e, 1, 0], curvature[e, 1, 1] = at.second
    return SpatialReference(axial, twist, curvature)


@njit
def _unstressed(ref: SpatialReference, e: int) -> Strain:
    k = ref.curvature[e]
    return Strain(ref.axial[e], ref.twist[e], (k[0, 0], k[0, 1]), (k[1, 0], k[1, 1]), 0.0)


@njit
def element_shape(e: int, chord: Array, frame1: Array, frame2: Array, line: LineStiffness) -> Shape:
    """Configuration of element e, for chords (ne, 3) and section frames (ne, 3, 3) of both ends."""
    at: Shape = shape(line.L[e], vector(chord[e]), matrix(frame1[e]), matrix(frame2[e]))
    return at


@njit
def element_energy(e: int, at: Shape, ref: SpatialReference, line: LineStiffness) -> float:
    """Strain energy of element e."""
    return energy(of_element(line, e), at.strain, difference(at.strain, _unstressed(ref, e)))


@njit
def element_potential(at: Shape, L: float, w: Vec, middle: Vec) -> float:
    """Potential [J] of a load w per length [N/m] on an element with this middle: `corotation`."""
    potential: float = bow_potential(bow_load(at.frame.axes, L, w), at.end1.angles, at.end2.angles)
    return potential - L * dot(w, middle)


@njit
def respond(L: float, at: Shape, elastic: Strain, s: Stress, load: BowLoad) -> SpatialResponse:
    """Forces of the stress s, which comes from the strains `elastic`, and of a load."""
    by_stress1, by_stress2 = conjugate(L, at.end1.angles, at.end2.angles, at.stations, s)
    by_load = end_moment(load)
    mu1, mu2 = add(by_stress1, by_load), sub(by_stress2, by_load)
    return SpatialResponse(elastic, s, mu1, mu2, _all_forces(at, s.axial / L, mu1, mu2, load), load)


@njit
def _all_forces(at: Shape, N: float, mu1: Vec, mu2: Vec, load: BowLoad) -> SpatialNodalForces:
    """Forces of the chord force N, of generalised moments of the ends, and of a load as the frame turns under it."""
    by_turning = chord_force(load, at.frame.length, at.end1.angles, at.end2.angles)
    forces = nodal_forces(at.frame.length, N, moment(at.end1, mu1), moment(at.end2, mu2))
    return plus(forces, SpatialNodalForces(by_turning, STILL, STILL))


@njit
def _respond(D: ElementStiffness, unstressed: Strain, at: Shape, w: Vec) -> tuple[SpatialResponse, ElementStiffness]:
    """Forces of an element under a load, and its stiffnesses for a change of the strains."""
    elastic, tangent = pulled_strain(D, difference(at.strain, unstressed))
    return respond(D.L, at, elastic, stress(D, at.strain, elastic), bow_load(at.frame.axes, D.L, w)), tangent


@njit
def write_forces(axes: Mat, forces: SpatialNodalForces, out: Array) -> None:
    """Write an element's forces, given along its frame, to `out` (12,) in global axes."""
    force = vecmat(forces.force, axes)
    moment1 = vecmat(forces.moment1, axes)
    moment2 = vecmat(forces.moment2, axes)
    for i in range(3):
        out[i] = -force[i]
        out[3 + i] = moment1[i]
        out[6 + i] = force[i]
        out[9 + i] = moment2[i]


@njit
def write_element_forces(
    e: int,
    chord: Array,
    frame1: Array,
    frame2: Array,
    ref: SpatialReference,
    line: LineStiffness,
    load: Array,
    f: Array,
) -> None:
    """Write internal forces f (12,) of element e, less those of a load per length (ne, 3) [N/m], for chords (ne, 3) and
    section frames (ne, 3, 3) of both ends.
    """
    at, w = element_shape(e, chord, frame1, frame2, line), vector(load[e])
    response, _ = _respond(of_element(line, e), _unstressed(ref, e), at, w)
    _write_loaded_forces(line.L[e], at, response, w, f)


@njit
def _write_loaded_forces(L: float, at: Shape, response: SpatialResponse, w: Vec, f: Array) -> None:
    """Write an element's forces, those of the load on its nodes among them."""
    write_forces(at.frame.axes, response.forces, f)
    for i in range(3):
        f[i] -= 0.5 * L * w[i]
        f[6 + i] -= 0.5 * L * w[i]


@njit
def move(at: Shape, u: Vec, w1: Vec, w2: Vec) -> SpatialChange:
    """First-order change of the configuration when the nodes move by u = u2 - u1 and spin by w1, w2."""
    spin = frame_spin(at.frame.length, u)
    spin1, spin2 = sub(w1, spin), sub(w2, spin)
    return SpatialChange(u[0], spin, spin1, spin2, rate(at.end1, spin1), rate(at.end2, spin2))


@njit
def strain_of(L: float, at: Shape, m: SpatialChange) -> Strain:
    """Change of the strains in a move, or their rates."""
    return strain_change(L, at.end1.angles, at.end2.angles, at.stations, m.stretch, m.da, m.db)


@njit
def forces_change(
    L: float, at: Shape, response: SpatialResponse, m: SpatialChange, change: Strain, ds: Stress
) -> SpatialNodalForces:
    """Change of an element's forces when it moves, its strains change and its stresses change by ds."""
    elastic1, elastic2 = conjugate(L, at.end1.angles, at.end2.angles, at.stations, ds)
    geometric1, geometric2 = conjugate_change(L, at.stations, response.stress, change, m.da, m.db)
    load, length = turned(response.load, m.spin), at.frame.length
    by_load = end_moment(load)
    dmu1, dmu2 = add(add(elastic1, geometric1), by_load), sub(add(elastic2, geometric2), by_load)
    dm1 = add(moment(at.end1, dmu1), moment_variation(at.end1, response.mu1, m.spin1))
    dm2 = add(moment(at.end2, dmu2), moment_variation(at.end2, response.mu2, m.spin2))
    stressed = nodal_forces(length, ds.axial / L, dm1, dm2)
    pulled = add(
        chord_force(load, length, at.end1.angles, at.end2.angles), chord_force(response.load, length, m.da, m.db)
    )
    geometric = SpatialNodalForces(add(pulled, lengthen(length, response.forces, m.stretch)), STILL, STILL)
    return plus(plus(stressed, geometric), turn(response.forces, m.spin))


@njit
def _vary(D: ElementStiffness, at: Shape, response: SpatialResponse, u: Vec, w1: Vec, w2: Vec) -> SpatialNodalForces:
    """Variation of an element's forces when its nodes move by u = u2 - u1 and spin by w1, w2."""
    m = move(at, u, w1, w2)
    change = strain_of(D.L, at, m)
    return forces_change(D.L, at, response, m, change, stress_change(D, at.strain, response.elastic, change))


@njit
def tangent_workspace() -> Array:
    """Workspace (2, 9, 16) for moves of an element, zero but for the blocks on the diagonal, and for what they change;
    nine columns are used. Where rows are whole vectors of eight, compilers see that none of a move's is another's.
    """
    return np.zeros((2, 9, 16))


@njit
def _tangent(D: ElementStiffness, at: Shape, response: SpatialResponse, workspace: Array, K: Array) -> None:
    """Write the element's tangent to K (12, 12): the changes, columns of workspace[1], by the moves, columns of
    workspace[0].
    """
    axes, moves, changes = at.frame.axes, workspace[0], workspace[1]
    for i in range(3):
        for k in range(3):
            moves[i, k] = moves[3 + i, 3 + k] = moves[6 + i, 6 + k] = axes[i][k]
    for k in range(8):
        _write_change(D, at, response, moves, changes, k)
    _write_last_change(at, response, changes)
    _spread(changes, K)


@njit
def _write_last_change(at: Shape, response: SpatialResponse, changes: Array) -> None:
    """Write how the forces change as node 2 spins about the third axis: as the whole element turns about it, they turn
    with it, and the load on them changes. So eight moves remain to be computed, which fill vectors.
    """
    axes, length = at.frame.axes, at.frame.length
    spin = (axes[0][2], axes[1][2], axes[2][2])
    load = turned(response.load, spin)
    by_load = end_moment(load)
    whole = plus(turn(response.forces, spin), _all_forces(at, 0.0, by_load, scale(-1.0, by_load), load))
    x, y = length * axes[0][0], length * axes[0][1]
    for row, local in ((0, whole.force), (3, whole.moment1), (6, whole.moment2)):
        change = vecmat(local, axes)
        for i in range(3):
            by_chord = x * changes[row + i, 1] - y * changes[row + i, 0]
            changes[row + i, 8] = change[i] - changes[row + i, 5] - by_chord


@njit
def _write_change(
    D: ElementStiffness, at: Shape, response: SpatialResponse, moves: Array, changes: Array, k: int
) -> None:
    """Write how the forces change in move k; by itself so that the loop over all of them is done on vectors."""
    u, w1, w2 = _three(moves, 0, k), _three(moves, 3, k), _three(moves, 6, k)
    change, axes = _vary(D, at, response, u, w1, w2), at.frame.axes
    force, moment1, moment2 = vecmat(change.force, axes), vecmat(change.moment1, axes), vecmat(change.moment2, axes)
    for i in range(3):
        changes[i, k], changes[3 + i, k], changes[6 + i, k] = force[i], moment1[i], moment2[i]


@njit
def _three(rows: Array, first: int, k: int) -> Vec:
    return rows[first, k], rows[first + 1, k], rows[first + 2, k]


@njit
def _spread(changes: Array, K: Array) -> None:
    """Write K (12, 12) from changes (9, 16) of the force on node 2 and of both moments by u and both spins."""
    for i in range(3):
        for k in range(3):
            for row, of in ((6, 0), (3, 3), (9, 6)):
                by_u = changes[of + i, k]
                K[row + i, k], K[row + i, 6 + k] = -by_u, by_u
                K[row + i, 3 + k], K[row + i, 9 + k] = changes[of + i, 3 + k], changes[of + i, 6 + k]
        for k in range(12):
            K[i, k] = -K[6 + i, k]


@njit
def write_element(
    e: int,
    chord: Array,
    frame1: Array,
    frame2: Array,
    ref: SpatialReference,
    line: LineStiffness,
    load: Array,
    workspace: Array,
    f: Array,
    K: Array,
) -> None:
    """Write forces f (12,) of element e as `write_element_forces`, and their derivative K (12, 12) by displacements and
    spatial spins; workspace: `tangent_workspace`.
    """
    D, w = of_element(line, e), vector(load[e])
    at = element_shape(e, chord, frame1, frame2, line)
    response, tangent = _respond(D, _unstressed(ref, e), at, w)
    _write_loaded_forces(D.L, at, response, w, f)
    _tangent(tangent, at, response, workspace, K)


@njit
def heaped_energy(at: Heaped, chord: Array, frame1: Array, frame2: Array, L: float) -> float:
    """Energy [J] of an element in a heap: `tension_only`. 1 + 2 cos of the angle between its ends is the trace of the
    rotation from one to the other.
    """
    return spring_energy(at, chord) + 0.25 * at.stiffness * L * L * (3.0 - _trace(frame1, frame2))


@njit
def _trace(frame1: Array, frame2: Array) -> float:
    """Sum of the products of the frames' axes."""
    total = 0.0
    for i in range(3):
        for k in range(3):
            total += frame1[i, k] * frame2[i, k]
    return total


@njit
def heaped_load_potential(frame1: Array, frame2: Array, L: float, w: Array) -> float:
    """Potential [J] of a load w per length (3,) [N/m] on its bow."""
    along = 0.0
    for i in range(3):
        along += w[i] * (frame1[i, 0] - frame2[i, 0])
    return -L * L / 12.0 * along


@njit
def write_heaped_forces(at: Heaped, chord: Array, frame1: Array, frame2: Array, L: float, w: Array, f: Array) -> None:
    """Write the forces f (12,) of both, and of the load on the nodes."""
    set_spring_forces(at, chord, L, w, f)
    stiffness, twelfth = 0.25 * at.stiffness * L * L, L * L / 12.0
    for i in range(3):
        j, m = (i + 1) % 3, (i + 2) % 3
        turn = 0.0
        for k in range(3):
            turn += stiffness * (frame1[j, k] * frame2[m, k] - frame1[m, k] * frame2[j, k])
        f[3 + i] = -turn - twelfth * (frame1[j, 0] * w[m] - frame1[m, 0] * w[j])
        f[9 + i] = turn + twelfth * (frame2[j, 0] * w[m] - frame2[m, 0] * w[j])


@njit
def write_heaped_tangent(at: Heaped, frame1: Array, frame2: Array, L: float, w: Array, K: Array) -> None:
    """Write their derivative K (12, 12) by displacements and spatial spins."""
    set_spring_tangent(at, 3, K)
    stiffness, twelfth, trace = 0.25 * at.stiffness * L * L, L * L / 12.0, _trace(frame1, frame2)
    along1, along2 = 0.0, 0.0
    for i in range(3):
        along1 += frame1[i, 0] * w[i]
        along2 += frame2[i, 0] * w[i]
    for i in range(3):
        for j in range(3):
            same = 1.0 if i == j else 0.0
            turn, back = trace * same, trace * same
            for k in range(3):
                turn -= frame2[i, k] * frame1[j, k]
                back -= frame1[i, k] * frame2[j, k]
            K[3 + i, 3 + j] = stiffness * back - twelfth * (frame1[i, 0] * w[j] - same * along1)
            K[9 + i, 9 + j] = stiffness * turn + twelfth * (frame2[i, 0] * w[j] - same * along2)
            K[3 + i, 9 + j] = -stiffness * turn
            K[9 + i, 3 + j] = -stiffness * back
