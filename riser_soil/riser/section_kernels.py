"""Kernels of section forces: all that results tell of the inside of a riser, from the residuals of its elements.

A section's moment M changes along the unstressed arc s as M' = F x t, with the section's force F and the unit tangent
t, so its magnitude as |M|' = M . (F x t)/|M|. Both ends of an element have a value and a slope of their own: the cubic
through them is the moment itself under an even or linear load, whatever jumps at the nodes. In an element far too long
for the bend, whose load is borne by tension, it would tower over its ends: it rises above them by no more than twice
what a parabola with the second differences of the values beside it would.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, views
from riser_soil.core.compiled import njit

NEGLIGIBLE = 1e-9  # of the line's largest moment: one that is none but for round-off
TIE = 1e-9  # of a value, by which another must be larger to count as larger: round-off does not choose


class SectionInput(NamedTuple):
    """What section forces follow from. residual and viscous (ne, 2 ndof): see `section_forces`, viscous is empty where
    nothing is. x (nn, d): of the nodes; maps (nn, 3, r): of what is conjugate to their rotation dofs to moments in
    global axes; tangent (ne, 2, d): of the elements' ends; first and second (ne, 3, 3): frames there, empty in a plane,
    where there is one stiffness. basis (3, d) and origin (3,): the line's axes; arc and bends (nn,): 1, or 0 between
    chains; y, z (ne,): 1/EI.
    """

    residual: Array
    viscous: Array
    x: Array
    maps: Array
    tangent: Array
    first: Array
    second: Array
    basis: Array
    origin: Array
    arc: Array
    bends: Array
    y: Array
    z: Array


class SectionForces(NamedTuple):
    """Section forces and moments at nodes, exerted by the line after a node on the line before it, in global axes: (nn,
    3) or (nn,). Those of many instants have one axis more in front.

    force N, moment N m; about_axes N m: torque and bending moments about the section's own axes; effective_tension N,
    positive in tension; bending_moment N m and curvature 1/m, magnitudes; position (nn, 3) m. Of the elements
    themselves, at their ends (ne, 2): curvature_beside, which differs where stiffnesses meet, the slopes of moment [N]
    and curvature [1/m2], which differ where a force or contact acts on a node, and unit tangents (ne, 2, 3) in the
    direction of growing arc length. Of the line's two ends (2, 3): what is exerted on the elements there. extreme
    (3, 2): least tension, and largest moment and curvature, between nodes too, each with its arc length [m].

    The section's axes: in space the first section's y axis is horizontal before all motion, to the left of the tangent
    (of a vertical one along the global y axis), and z completes the right-handed frame; along the riser frames follow
    without twist. In a plane y is normal to it, to the left of the direction from start to end, and so z points up
    where the riser is level.
    """

    force: Array
    moment: Array
    about_axes: Array
    effective_tension: Array
    bending_moment: Array
    curvature: Array
    curvature_beside: Array
    moment_slope: Array
    curvature_slope: Array
    tangent: Array
    position: Array
    end_force: Array
    end_moment: Array
    extreme: Array

    @classmethod
    def within(cls, vector: Array, nodes: int) -> SectionForces:
        """The section forces of a line as views of one vector of packed numbers (..., n), n from `size_of`."""
        return cls(*views(vector, _shapes(nodes)))


def _shapes(nn: int) -> list[tuple[int, ...]]:
    """Shapes of the arrays of `SectionForces`."""
    ne = nn - 1
    at_nodes: list[tuple[int, ...]] = [(nn, 3), (nn, 3), (nn, 3), (nn,), (nn,), (nn,)]
    return [*at_nodes, (ne, 2), (ne, 2), (ne, 2), (ne, 2, 3), (nn, 3), (2, 3), (2, 3), (3, 2)]


def size_of(nodes: int) -> int:
    """How many numbers the section forces of a line with so many nodes are."""
    return sum(math.prod(shape) for shape in _shapes(nodes))


@njit
def write_section_forces(given: SectionInput, out: SectionForces) -> None:
    """All together."""
    ne, basis = len(given.residual), given.basis
    shape, free = (ne, 2, 3), np.empty((ne + 1, 3))
    on_ends, moments, damping, along = np.empty(shape), np.empty(shape), np.zeros(shape), out.tangent
    write_end_forces(given.residual, basis, given.maps, on_ends, moments)
    if len(given.viscous) > 0:
        write_end_forces(given.viscous, basis, given.maps, np.empty(shape), damping)
    for e in range(ne):
        for end in range(2):
            for i in range(3):
                along[e, end, i] = 0.0
                for j in range(basis.shape[1]):
                    along[e, end, i] += basis[i, j] * given.tangent[e, end, j]
    _write_at_nodes(on_ends, moments, damping, along, given.bends, free, out)
    _write_curvatures(free, given.first, given.second, given.y, given.z, out)
    _write_about_axes(given, out.moment, out.about_axes)
    _write_position(given, out.position)
    for end in range(2):
        e = -end  # the first element, or the last
        for i in range(3):
            out.end_force[end, i], out.end_moment[end, i] = on_ends[e, end, i], moments[e, end, i]
    _write_extremes(given.arc, out)


@njit
def _write_position(given: SectionInput, out: Array) -> None:
    """Places of the nodes (nn, 3) in global axes."""
    for n in range(len(out)):
        for i in range(3):
            out[n, i] = given.origin[i]
            for j in range(given.basis.shape[1]):
                out[n, i] += given.x[n, j] * given.basis[i, j]


@njit
def _write_extremes(arc: Array, out: SectionForces) -> None:
    """Least tension of the nodes, of equal ones the first; largest moment and curvature between nodes, too."""
    least, moments = 0, np.empty(out.curvature_beside.shape)
    for n in range(len(arc)):
        if not out.effective_tension[n] >= out.effective_tension[least]:
            least = n
    for e in range(len(moments)):
        moments[e, 0], moments[e, 1] = out.bending_moment[e], out.bending_moment[e + 1]
    out.extreme[0, 0], out.extreme[0, 1] = out.effective_tension[least], arc[least]
    for row, values, slopes in ((1, moments, out.moment_slope), (2, out.curvature_beside, out.curvature_slope)):
        out.extreme[row, 0], out.extreme[row, 1], _ = largest_between_nodes(arc, values, slopes)


@njit
def _write_at_nodes(
    on_ends: Array, moments: Array, damping: Array, tangent: Array, bends: Array, free: Array, out: SectionForces
) -> None:
    """Forces, moments and the moment's slope; free (nn, 3): the bending moment less the damping's.

    on_ends, moments, damping (ne, 2, 3): on the elements' ends; tangent: there; bends (nn,): 1, or 0 between chains.
    """
    nn = len(free)
    bending, behind = np.empty((nn, 3)), np.empty(on_ends.shape)
    viscous, t = np.empty(3), np.empty(3)
    for n in range(nn):
        force, moment = out.force[n], out.moment[n]
        share = 1.0 if n == 0 or n == nn - 1 else 0.5
        for i in range(3):
            force[i] = moment[i] = viscous[i] = t[i] = 0.0
            for e, end, sign in ((n - 1, 1, share), (n, 0, -share)):
                if 0 <= e < nn - 1:
                    behind[e, end, i] = sign / share * on_ends[e, end, i]
                    force[i] += sign * on_ends[e, end, i]
                    moment[i] += sign * moments[e, end, i]
                    viscous[i] += sign * damping[e, end, i]
                    t[i] += tangent[e, end, i]
        size = math.sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2])
        tension, twist, twist_rate, square = 0.0, 0.0, 0.0, 0.0
        for i in range(3):
            t[i] /= size
            tension += force[i] * t[i]
            twist += moment[i] * t[i]
            twist_rate += viscous[i] * t[i]
        for i in range(3):
            bending[n, i] = (moment[i] - twist * t[i]) * bends[n]
            free[n, i] = bending[n, i] - (viscous[i] - twist_rate * t[i])
            square += bending[n, i] ** 2
        out.effective_tension[n], out.bending_moment[n] = tension, math.sqrt(square)
    moment_slopes(bending, behind, tangent, out.moment_slope)


@njit
def _write_curvatures(free: Array, first: Array, second: Array, y: Array, z: Array, out: SectionForces) -> None:
    """Curvatures: bending moment over stiffness, about the section axes where there are two stiffnesses.

    free (nn, 3): the moment that bends; first, second: see `SectionInput`; y, z (ne,): 1/EI.
    """
    beside, negligible = out.curvature_beside, NEGLIGIBLE * largest_of(out.bending_moment)
    out.curvature[:] = 0.0
    for e in range(len(beside)):
        for end in range(2):
            M = free[e + end]
            if len(first) == 0:
                k = math.sqrt(M[0] * M[0] + M[1] * M[1] + M[2] * M[2]) * y[e]
            else:
                F = first[e] if end == 0 else second[e]
                about_y = F[0, 1] * M[0] + F[1, 1] * M[1] + F[2, 1] * M[2]
                about_z = F[0, 2] * M[0] + F[1, 2] * M[1] + F[2, 2] * M[2]
                k = math.hypot(about_y * y[e], about_z * z[e])
            n, size = e + end, out.bending_moment[e + end]
            beside[e, end] = k
            out.curvature[n] += k if n == 0 or n == len(beside) else 0.5 * k
            bends = k / size if size > negligible else max(y[e], z[e])
            out.curvature_slope[e, end] = out.moment_slope[e, end] * bends


@njit
def _write_about_axes(given: SectionInput, moment: Array, out: Array) -> None:
    """Moments about the section's axes (nn, 3), at a node the mean of those of the elements beside it."""
    out[:] = 0.0
    for n in range(len(moment)):
        M = moment[n]
        if len(given.first) == 0:
            out[n, 1] = M[1] * given.basis[0, 0] - M[0] * given.basis[1, 0]
            continue
        for e, frames in ((n - 1, given.second), (n, given.first)):
            if 0 <= e < len(frames):
                for j in range(3):
                    out[n, j] += frames[e, 0, j] * M[0] + frames[e, 1, j] * M[1] + frames[e, 2, j] * M[2]
        if 0 < n < len(moment) - 1:
            for j in range(3):
                out[n, j] *= 0.5


@njit
def write_end_forces(residual: Array, basis: Array, maps: Array, force: Array, moment: Array) -> None:
    """Write force and moment (ne, 2, 3) at the ends of elements from residuals (ne, 2 ndof). basis (3, d): the line's
    axes; maps (nn, 3, r): from rotations to moments.
    """
    d, r = basis.shape[1], maps.shape[2]
    for e in range(len(force)):
        for end in range(2):
            k = end * (d + r)
            for i in range(3):
                push, turn = 0.0, 0.0
                for j in range(d):
                    push += basis[i, j] * residual[e, k + j]
                for j in range(r):
                    turn += maps[e + end, i, j] * residual[e, k + d + j]
                force[e, end, i], moment[e, end, i] = push, turn


@njit
def moment_slopes(moment: Array, force: Array, tangent: Array, out: Array) -> None:
    """Slopes of the moment's magnitude at the ends of the elements, into out (ne, 2) [N]. From an end where it is none
    but for round-off, as in a hinge, it grows; 0 in elements without any at their ends, as of a chain.

    moment (nn, 3): across the line at nodes; force, tangent (ne, 2, 3): of the section and unit, at the elements' ends.
    """
    sizes = np.empty(len(moment))
    for n in range(len(moment)):
        sizes[n] = math.sqrt(moment[n, 0] ** 2 + moment[n, 1] ** 2 + moment[n, 2] ** 2)
    negligible = NEGLIGIBLE * largest_of(sizes)
    for e in range(len(out)):
        if max(sizes[e], sizes[e + 1]) <= negligible:
            out[e, 0] = out[e, 1] = 0.0
            continue
        for end in range(2):
            M, F, t, size = moment[e + end], force[e, end], tangent[e, end], sizes[e + end]
            x, y, z = F[1] * t[2] - F[2] * t[1], F[2] * t[0] - F[0] * t[2], F[0] * t[1] - F[1] * t[0]
            if size > negligible:
                out[e, end] = (M[0] * x + M[1] * y + M[2] * z) / size
            else:
                out[e, end] = (1.0 - 2.0 * end) * math.sqrt(x * x + y * y + z * z)


@njit
def largest_of(sizes: Array) -> float:
    """0 of none."""
    largest = 0.0
    for size in sizes:
        largest = max(largest, size)
    return largest


@njit
def largest_between_nodes(arc: Array, values: Array, slope: Array) -> tuple[float, float, int]:
    """The largest value along a line, its arc length and element, between nodes too; of equal ones the first.

    arc (nn,): of the nodes. values, slope (ne, 2): at the elements' ends.
    """
    best, at, element = values[0, 0], arc[0], 0
    for e in range(len(values)):
        L = arc[e + 1] - arc[e]
        top, x = top_of_cubic(values[e, 0], values[e, 1], slope[e, 0] * L, slope[e, 1] * L)
        top = min(top, max(values[e, 0], values[e, 1]) + 2.0 * L * L / 8.0 * _bend(arc, values, e))
        if top > best + TIE * abs(best):
            best, at, element = top, arc[e] + x * L, e
    return best, at, element


@njit
def _bend(arc: Array, values: Array, e: int) -> float:
    """The larger second derivative by the values of an element and those beside it; inf of one that is alone."""
    largest_bend = math.inf if len(values) == 1 else 0.0
    for other in range(max(e - 1, 0), min(e + 2, len(values))):
        if other != e:
            turned = _chord(arc, values, e) - _chord(arc, values, other)
            both = arc[e + 1] - arc[e] + arc[other + 1] - arc[other]
            largest_bend = max(largest_bend, 2.0 * abs(turned) / both)
    return largest_bend


@njit
def _chord(arc: Array, values: Array, e: int) -> float:
    return (values[e, 1] - values[e, 0]) / (arc[e + 1] - arc[e])


@njit
def top_of_cubic(first: float, second: float, rise: float, fall: float) -> tuple[float, float]:
    """Largest value, and its place in 0..1, of the cubic with these values and slopes at 0 and 1.

    Only where it rises at 0 and falls at 1 it is looked for between them.
    """
    if not rise > 0.0 > fall:
        return (first, 0.0) if first >= second - TIE * abs(first) else (second, 1.0)
    a, b = 3.0 * (rise + fall - 2.0 * (second - first)), 2.0 * (3.0 * (second - first) - 2.0 * rise - fall)
    x = 2.0 * rise / (math.sqrt(b * b - 4.0 * a * rise) - b)  # of a x^2 + b x + rise, the slope at x
    return first + x * (rise + x * (0.5 * b + x * a / 3.0)), x
