"""Contents that flow along the line, and slugs in them: the part "contents".

Contents of the mass m per length run along the pipe at the speed u. The axis is at x(s, t), with the arc length s. The
contents at s then have the acceleration

    d2x/dt2 + 2 u d2x/dsdt + u^2 d2x/ds2,

so that the pipe bears m times its negative, and their weight. The second term is Coriolis's, the third the centrifugal
one. No term with the rate of m comes in, as each slug keeps its mass on its way.

Contents at rest that fill the pipe evenly count in the mass and the weight of its elements. Here is the rest: what
slugs have beyond those, and the second and third term of all that flows. By the shape functions N of `hermite` they are

    (M q'' + C q' + K q)_a,   M = int m N_a N_b ds,   C = int 2 m u N_a dN_b/ds ds,   K = int m u^2 N_a d2N_b/ds2 ds,

exact for slugs that end within elements. The effective tension does not contain the flux of momentum, m u^2.
Source: Paidoussis, Fluid-Structure Interactions, vol. 1 (1998), chapter 3, plug flow; from memory.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, as_list
from riser_soil.core.compiled import njit
from riser_soil.core.part import Traits, Weights
from riser_soil.riser import hermite
from riser_soil.riser.configuration import Configuration, Maps
from riser_soil.riser.hermite import add_mass_to, add_weighed
from riser_soil.riser.line import UP, Line
from riser_soil.riser.line_part import CompiledPart
from riser_soil.riser.part_kernels import LineForces, add_energy, add_forces, add_tangent, add_work
from riser_soil.riser.stations import gauss

POINTS, SHARES = (tuple(as_list(values)) for values in gauss(4))  # exact for products of two cubics


@dataclass(frozen=True)
class SlugTrain:
    """A stretch of other contents, followed by others like it where `spacing` is not zero.

    density: beyond that of the contents around it [kg/m3]. front: distance of its leading end from where the flow comes
    in, when the clock begins [m]. length, spacing: of one slug, and from front to front [m].
    """

    density: float
    length: float
    front: float
    spacing: float = 0.0

    def fronts(self, moved: float, end: float) -> list[float]:
        """Those of the slugs that are in a pipe of the length `end`, after all have moved so far [m]."""
        first = self.front + moved
        if self.spacing == 0.0:
            return [first] if 0.0 < first < end + self.length else []
        least, most = math.ceil((first - end - self.length) / self.spacing), math.floor(first / self.spacing)
        return [first - k * self.spacing for k in range(max(least, 0), most + 1)]


@dataclass(frozen=True)
class Flow:
    """Contents of the density [kg/m3] that move along the arc at the speed [m/s], and the slugs in them.

    clock: its reading when the stage begins [s]; runs: whether it goes on in the stage. grows: whether weight and
    centrifugal force are multiplied by the stage's time, the load factor of statics.
    """

    density: float
    speed: float
    slugs: Sequence[SlugTrain] = ()
    gravity: float = 0.0
    clock: float = 0.0
    runs: bool = True
    grows: bool = False

    def stretches(self, t: float, end: float) -> list[tuple[float, float, float]]:
        """First and last arc length [m] of the slugs in the pipe, and density beyond the contents around [kg/m3]."""
        moved = abs(self.speed) * (self.clock + (t if self.runs else 0.0))
        slugs = [(front - slug.length, front, slug.density) for slug in self.slugs for front in slug.fronts(moved, end)]
        within = [(max(first, 0.0), min(last, end), density) for first, last, density in slugs]
        return within if self.speed >= 0.0 else [(end - last, end - first, density) for first, last, density in within]


class FlowMatrices(NamedTuple):
    """Matrices of contents in the elements, conjugate to q: mass [kg], coriolis [kg/s] and centrifugal [kg/s2], each
    (ne, 4, 4), and weight (ne, 4) [N].
    """

    mass: Array
    coriolis: Array
    centrifugal: Array
    weight: Array

    @classmethod
    def zeros(cls, ne: int) -> FlowMatrices:
        mass, coriolis, centrifugal = np.zeros((3, ne, 4, 4))
        return cls(mass, coriolis, centrifugal, np.zeros((ne, 4)))


class Bore(NamedTuple):
    """Arc lengths of the nodes (nn,) [m], section of the bore (ne,) [m2], speed [m/s] and gravity [m/s2]."""

    arc: Array
    area: Array
    speed: float
    gravity: float


class ContentsData(NamedTuple):
    """Matrices where a step starts and where it ends; the upward direction (d,)."""

    then: FlowMatrices
    now: FlowMatrices
    up: Array


class InnerFlow(CompiledPart):
    """Slugs and the flow of all contents: in group I what slugs add to the mass, in F all the rest.

    line: the riser's field. inner_diameter (ne,) [m]. All but the kinetic energy of slugs, at the pipe's own velocity,
    is external work: the flow brings energy and takes it along.
    """

    line: Line

    name = "contents"

    def __init__(self, line: Line, inner_diameter: Array, flow: Flow) -> None:
        super().__init__(line)
        still = flow.speed == 0.0 and not flow.runs
        self.traits = Traits("IF" if flow.slugs else "F", symmetric=still, follows=True)
        self._flow, self._times = flow, (math.nan, math.nan)
        self._bore = Bore(line.arc, 0.25 * np.pi * inner_diameter**2, flow.speed, flow.gravity)
        self._even = FlowMatrices.zeros(line.length.size)
        add_stretch(self._bore, 0.0, float(line.arc[-1]), flow.density, 0.0, self._even)

    def make_kernel_data(self) -> ContentsData:
        ne = self.line.length.size
        return ContentsData(FlowMatrices.zeros(ne), FlowMatrices.zeros(ne), np.ascontiguousarray(UP @ self.line.basis))

    def renew_kernel_data(self, start: float, end: float) -> None:
        if (start, end) != self._times:
            self._write_matrices(start, self._data.then)
            self._write_matrices(end, self._data.now)
            self._times = start, end

    def _write_matrices(self, t: float, out: FlowMatrices) -> None:
        """Write the matrices at a time [s]."""
        for values, even in zip(out, self._even, strict=True):
            values[:] = even
        for first, last, density in self._flow.stretches(t, float(self.line.arc[-1])):
            add_stretch(self._bore, first, last, density, density, out)
        if self._flow.grows:
            out.centrifugal[:] *= t
            out.weight[:] *= t


@njit
def add_stretch(bore: Bore, first: float, last: float, density: float, own: float, out: FlowMatrices) -> None:
    """Add contents between two arc lengths [m]: their flow by the density, mass and weight by `own` [kg/m3]."""
    for e in range(bore.area.size):
        begin, length = bore.arc[e], bore.arc[e + 1] - bore.arc[e]
        a, b = max((first - begin) / length, 0.0), min((last - begin) / length, 1.0)
        if a < b:
            _add_piece(bore, e, length, a, b, density, own, out)


@njit
def _add_piece(
    bore: Bore, e: int, length: float, a: float, b: float, density: float, own: float, out: FlowMatrices
) -> None:
    """Add contents from xi = a to b of an element."""
    u, area = bore.speed, bore.area[e]
    for g in range(4):
        xi = a + (b - a) * POINTS[g]
        volume = (b - a) * SHARES[g] * length * area
        N, slope, bend = hermite.shape(xi, length), hermite.slope(xi, length), hermite.bend(xi, length)
        for i in range(4):
            out.weight[e, i] += bore.gravity * own * volume * N[i]
            for j in range(4):
                out.mass[e, i, j] += own * volume * N[i] * N[j]
                out.coriolis[e, i, j] += 2.0 * u * density * volume * N[i] * slope[j]
                out.centrifugal[e, i, j] += u * u * density * volume * N[i] * bend[j]


@add_forces.of(ContentsData)
def _add_forces(part: ContentsData, at: Configuration, out: LineForces) -> None:
    add_weighed(part.now.mass, at.acceleration, out.inertia_q, at.D)
    _add_force(part.now, part.up, at, out.force_q)


@njit
def _add_force(matrices: FlowMatrices, up: Array, at: Configuration, out: Array) -> None:
    """Add what belongs to group F to out (ne, 4, d)."""
    add_weighed(matrices.coriolis, at.rate, out, at.D)
    add_weighed(matrices.centrifugal, at.q, out, at.D)
    for e in range(out.shape[0]):
        for k in range(4):
            for i in range(out.shape[2]):
                out[e, k, i] += matrices.weight[e, k] * up[i]


@add_tangent.of(ContentsData)
def _add_tangent(part: ContentsData, at: Configuration, maps: Maps, weights: Weights, K: Array) -> None:
    add_mass_to(K, weights.inertia, at.P, maps.acceleration_rows, part.now.mass, at.D, at.R)
    add_mass_to(K, weights.force, at.P, maps.rate_rows, part.now.coriolis, at.D, at.R)
    add_mass_to(K, weights.force, at.P, maps.place_rows, part.now.centrifugal, at.D, at.R)


@add_energy.of(ContentsData)
def _add_energy(part: ContentsData, at: Configuration, energy: Array) -> None:
    momentum = np.zeros(at.rate.shape)
    add_weighed(part.now.mass, at.rate, momentum, at.D)
    energy[0] += 0.5 * _product(momentum, at.rate)


@add_work.of(ContentsData)
def _add_work(part: ContentsData, first: Configuration, last: Configuration, work: Array) -> None:
    """External is the work against the mean force of the step, and the change of kinetic energy by that of the mass."""
    shape = last.q.shape
    force, mean, momentum = np.zeros(shape), np.zeros(shape), np.zeros(shape)
    _add_force(part.then, part.up, first, force)
    _add_force(part.now, part.up, last, force)
    for e in range(shape[0]):
        for k in range(4):
            for i in range(shape[2]):
                work[1] -= 0.5 * force[e, k, i] * (last.q[e, k, i] - first.q[e, k, i])
                mean[e, k, i] = 0.5 * (first.rate[e, k, i] + last.rate[e, k, i])
    add_weighed(part.now.mass, mean, momentum, last.D)
    changed = 0.5 * _product(momentum, mean)
    momentum[:] = 0.0
    add_weighed(part.then.mass, mean, momentum, last.D)
    changed -= 0.5 * _product(momentum, mean)
    work[1] += changed
    work[2] += changed


@njit
def _product(a: Array, b: Array) -> float:
    """Sum of the products of the entries of two arrays (ne, 4, d)."""
    total = 0.0
    for e in range(a.shape[0]):
        for k in range(4):
            for i in range(a.shape[2]):
                total += a[e, k, i] * b[e, k, i]
    return total
