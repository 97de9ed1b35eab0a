"""Friction between the pipe's cylinder and the soil's surface, point by point: the part "soil friction"."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from riser_soil.contact.closest_point import Axis
from riser_soil.contact.coulomb import limits, return_map
from riser_soil.contact.cylinder_gap import Slide, gap_forms, slide_workspace, write_slide, write_slide_columns
from riser_soil.contact.friction import components, read_along, resistance_by_movement, vector_of, write_along
from riser_soil.contact.integration_points import KeptRows, PointMemory, write_kept
from riser_soil.contact.near_points import NearPoints, Surface, first_of
from riser_soil.contact.pressed_points import Pairs, add_products, in_dofs, paired, spread
from riser_soil.contact.surface_contact import SurfaceContact, SurfaceState
from riser_soil.contact.surface_loop import LoopFriction, TouchData, TouchWorkspace, add_pairs
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.bound import Bound, Packed
from riser_soil.core.compiled import njit
from riser_soil.core.part import Energy, Forces, MatrixBlock, State, Traits, Weights, Work
from riser_soil.core.saved_state import Saved, Stateful, gathered, within
from riser_soil.riser.configuration import Configuration
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart
from riser_soil.riser.part_kernels import POINTS, Border, LineForces, TopMotion
from riser_soil.riser.vectors import add, scale, sub, vector, write

AREA = 3  # column of the memory, behind the traction


class Resistance(NamedTuple):
    """Coefficients (2,) of friction, axial and lateral, and stiffness of the soil's surface along itself [N/m3]."""

    mu: Array
    stiffness: float


class SlidingPoints(NamedTuple):
    """Friction at n points in a trial state.

    Kept from the accepted state: history (n, 4) and adhesion (n,) [Pa]. In the trial: way slid (n, 3) [m], directions
    (n, 2, 3), elastic guess and traction (n, 3) [Pa], and force (n, 3) [N] on the riser.
    """

    before: Array
    most: Array
    moved: Array
    along: Array
    elastic: Array
    traction: Array
    on_riser: Array


@dataclass(frozen=True, eq=False)
class SlidingState:
    """Friction at a state: of the n points that press."""

    found: SurfaceState
    points: SlidingPoints


SoilAdhesion = Callable[[IntArray, Array], Array]
"""Facets (n,) and heights of points on them before the riser came (n,) [m] -> what the soil holds the pipe by at most
(n,) [Pa].
"""

Start = tuple[Array, Array]  # where a step starts: q (ne, 4, 3) of the pipe's axis, and the soil's points (np, 3) [m]


class SoilFriction(LinePart):
    """Part "soil friction": friction at the integration points of a `SurfaceContact`; group E.

    axial, lateral: coefficients, > 0, along the pipe and around it. stiffness: of the soil's surface along itself
    [N/m3], see `coulomb`. adhesion: without a limit by default. The slide is that of the axis over the soil, and the
    force acts on the axis. Directions are those of the start of the step; the traction is kept in global axes.
    """

    line: Line

    name = "soil friction"
    traits = Traits("E", symmetric=False, path_dependent=True, roles=(Stateful,))

    def __init__(
        self,
        contact: SurfaceContact,
        axial: float,
        lateral: float,
        stiffness: float,
        adhesion: SoilAdhesion | None = None,
    ) -> None:
        super().__init__(contact.line)
        self.contact = contact
        self._resistance, self._adhesion = Resistance(np.array([axial, lateral]), float(stiffness)), adhesion
        self._memory = PointMemory(np.zeros(AREA + 1))
        self._at_start: Start | None = None
        self._slid: Array = np.zeros(self.line.nodes)

    def stick(self) -> None:
        """From now on nothing slides, as in small vibrations about rest."""
        self._resistance, self._adhesion = self._resistance._replace(mu=np.full(2, np.inf)), None
        self.line.forget()

    def blocks(self) -> dict[str, MatrixBlock]:
        """Those of contact."""
        return self.contact.blocks()

    def evaluate(self, state: State) -> SlidingState:
        """Tractions of the points that press. What the trial keeps does not hold the trial."""
        found = self.contact.evaluate(state)
        made: SlidingPoints = found.trial.once((self, "sliding"), lambda _: self._evaluate(found))
        return SlidingState(found, made)

    def _evaluate(self, found: SurfaceState) -> SlidingPoints:
        pressed, start = found.pressed, self._start(found.trial.state)
        out = sliding_workspace(len(pressed.force))
        out.before[...], out.most[...] = self._memory.at(pressed.points.number), self._most(pressed.points)
        touching = pressed.points, len(out.most), pressed.force
        find_tractions(self._resistance, *touching, start, pressed.axis, pressed.surface, out)
        return out

    def _most(self, points: NearPoints) -> Array | float:
        """Adhesion of points (n,) [Pa]."""
        return np.inf if self._adhesion is None else self._adhesion(points.facet, self.contact.first_heights(points))

    def _start(self, state: State) -> Start:
        if self._at_start is None:
            found = self.contact.evaluate(State.at_rest(state.t, state.u.size)).pressed
            self._at_start = found.axis.q, found.surface.deformed
        return self._at_start

    def in_loop(self) -> FrictionInLoop:
        """For the line solver, on soil that does not yield."""
        assert self._adhesion is None
        q = np.zeros((self.line.length.size, 4, 3))
        return FrictionInLoop(self, SoilFrictionData(self._resistance, self._memory.kept, q))

    def at_start(self, given: SoilFrictionData, state: State) -> SoilFrictionData:
        """Kernel data of the friction for a step that starts at an accepted state."""
        given.q[...] = self.contact.axis(self.line.trial(state)).q
        return given._replace(kept=self._memory.kept)

    def element_forces(self, state: State) -> Array:
        """Element residual (ne, 2 ndof)."""
        sliding = self.evaluate(state)
        return sliding.found.on_elements(sliding.found.pressed.spread(sliding.points.on_riser)[0])

    def residual(self, state: State, forces: Forces) -> None:
        sliding = self.evaluate(state)
        self.contact.add_residual(sliding.found, sliding.points.on_riser, forces)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        """Unweighted: friction stands at the end of the step."""
        sliding = self.evaluate(state)
        at, P, start = sliding.found.pressed, sliding.found.trial.turn.P, self._start(state)
        pressed = at.points, at.force, at.slope
        by_dofs = friction_tangents(
            self._resistance, *pressed, start, at.axis, at.surface, at.basis, at.forms[0], at.pairs, sliding.points, P
        )
        self.contact.add_tangent(values, sliding.found, by_dofs, sliding.points.on_riser)

    def anew(self) -> PointMemory:
        """The next step starts from a surface with other nodes: tractions of the points, to go over to them."""
        self._at_start = None
        return self._memory

    def energy(self, state: State) -> Energy:
        """Stored in what the surface gives elastically along itself."""
        sliding = self.evaluate(state)
        return Energy(potential=self.exchanged(sliding.points, sliding.found.pressed.points.area)[1])

    def exchanged(self, points: SlidingPoints, area: Array) -> tuple[float, float]:
        """What friction at points has taken in the step, and what it stores [J]."""
        taken = -float(np.sum(points.on_riser * points.moved))
        return taken, float(0.5 / self._resistance.stiffness * np.sum(area * np.sum(points.traction**2, axis=1)))

    def work(self, before: State, after: State) -> Work:
        sliding = self.evaluate(after)
        return self.work_of(*self.exchanged(sliding.points, sliding.found.pressed.points.area))

    def work_of(self, taken: float, stored: float) -> Work:
        """Energy dissipated: what friction has taken less the change of the energy stored [J]; never negative."""
        kept = self._memory.rows
        squares = float(np.sum(kept[:, AREA] * np.sum(kept[:, :AREA] ** 2, axis=1)))
        return Work(dissipated=taken - stored + 0.5 / self._resistance.stiffness * squares)

    def commit(self, state: State) -> None:
        """Keep the tractions."""
        sliding = self.evaluate(state)
        points = sliding.found.pressed.points
        self._slid = self._slid + self._nodal_slip(sliding)
        self._memory.keep(points.number, np.column_stack([sliding.points.traction, points.area]))
        self._at_start = None

    def _nodal_slip(self, sliding: SlidingState) -> Array:
        """Plastic slip in the step at the nodes (nn,) [m]: the mean over the points that press, shared by two nodes."""
        pressed, of = sliding.found.pressed, sliding.points
        plastic = np.einsum("nri,ni->nr", of.along, of.traction - of.elastic) / self._resistance.stiffness
        slip, pressing = np.linalg.norm(plastic, axis=1), pressed.points.area * (pressed.force > 0.0)
        slid, share = self.contact.at_nodes(pressed.points, np.stack([pressing * slip, pressing], axis=1)).T
        return np.asarray(slid / np.where(share > 0.0, share, 1.0))

    def slip(self) -> Array:
        """Accumulated slip of the riser over the soil at its nodes (nn,) [m], >= 0."""
        return self._slid

    def force_on_riser(self, state: State) -> Array:
        """Sum of the friction on the riser (3,) [N], global axes."""
        if not self.line.active:
            return np.zeros(3)
        return self.contact.within_line(self.evaluate(state).points.on_riser.sum(axis=0))

    def force_on_soil(self, state: State) -> Array:
        """Sum of the friction on the soil (3,) [N], global axes."""
        return np.asarray(-self.evaluate(state).points.on_riser.sum(axis=0)) if self.line.active else np.zeros(3)

    def force_on_soil_per_length(self, state: State) -> Array:
        """The points' friction on the nodes of their facets (nn, 3) [N/m], shared by two nodes of the riser."""
        if not self.line.active:
            return np.zeros((self.line.nodes, 3))
        sliding = self.evaluate(state)
        return self.contact.soil_per_length(sliding.found.pressed.points, sliding.points.on_riser)

    def state(self) -> Saved:
        return {"slid": self._slid} | gathered({"points": self._memory})

    def restore(self, saved: Saved) -> None:
        self._slid, self._at_start = saved["slid"], None
        self._memory.restore(within(saved, "points"))


def sliding_workspace(n: int) -> SlidingPoints:
    """Workspace for so many points, without adhesion."""
    moved, elastic, traction, on_riser = (np.empty((n, 3)) for _ in range(4))
    before, most, along = np.empty((n, AREA + 1)), np.full(n, np.inf), np.empty((n, 2, 3))
    return SlidingPoints(before, most, moved, along, elastic, traction, on_riser)


@njit
def find_tractions(
    resistance: Resistance,
    near: NearPoints,
    n: int,
    force: Array,
    start: Start,
    axis: Axis,
    surface: Surface,
    out: SlidingPoints,
) -> None:
    """Find the tractions of the first n points, pressed by forces (n,) [N]."""
    k, mu, at = resistance.stiffness, (resistance.mu[0], resistance.mu[1]), slide_workspace(surface.facets.shape[1], 0)
    for i in range(n):
        write_slide(near, i, start, axis, surface, at)
        along, elastic = read_along(at.along.T), sub(vector(out.before[i]), scale(k, vector(at.moved)))
        limit, _ = limits(force[i] / near.area[i], 0.0, mu, (out.most[i], 0.0))
        t, _, _ = return_map(components(along, elastic), limit, (0.0, 0.0))
        traction = vector_of(along, t)
        write(vector(at.moved), out.moved[i])
        write_along(along, out.along[i].T)
        write(elastic, out.elastic[i])
        write(traction, out.traction[i])
        write(scale(near.area[i], traction), out.on_riser[i])


@njit
def friction_tangents(
    resistance: Resistance,
    near: NearPoints,
    force: Array,
    slope: Array,
    start: Start,
    axis: Axis,
    surface: Surface,
    basis: Array,
    forms: Array,
    pairs: Pairs,
    sliding: SlidingPoints,
    P: Array,
) -> Array:
    """Derivative (m, nr, nr) of the residual of friction by the dofs of its pairs, P (ne, 2, d, r) held. force (n,) [N]
    and slope (n,) [N/m]: of the pressure; forms: of the gap, see `gap_forms`.
    """
    n, _, nz = forms.shape
    at, by_z = slide_workspace(surface.facets.shape[1], basis.shape[1]), np.zeros((len(pairs.element), nz, nz))
    left, right = np.empty((n, 4, nz)), np.empty((n, 4, nz))
    for i in range(n):
        write_slide(near, i, start, axis, surface, at)
        write_slide_columns(near, i, axis, basis, at)
        pushed = force[i] / near.area[i], slope[i] / near.area[i], sliding.most[i]
        _write_factors(resistance, pushed, sliding.elastic[i], sliding.on_riser[i], at, forms[i], left[i], right[i])
        for c in range(nz):
            for j in range(3):
                left[i, j, c] = -near.area[i] * at.by_z[j, c]
    add_products(by_z, pairs.pair, left, right)
    return in_dofs(by_z, pairs.element, P)


@njit
def _write_factors(
    resistance: Resistance,
    pushed: tuple[float, float, float],
    elastic: Array,
    on_riser: Array,
    at: Slide,
    forms: Array,
    left: Array,
    right: Array,
) -> None:
    """Write the derivative of a point's traction by z (nz,) to right (4, nz), and below it that of its place on the
    axis; beside which the force, whose point moves along the axis, has the last row of left. pushed: pressure, its
    slope and adhesion.
    """
    k, along, turns = resistance.stiffness, read_along(at.along.T), read_along(at.along_by_s.T)
    limit, rise = limits(pushed[0], pushed[1], (resistance.mu[0], resistance.mu[1]), (pushed[2], 0.0))
    t, by_elastic, by_penetration = return_map(components(along, vector(elastic)), limit, rise)
    by_way, by_gap = resistance_by_movement(along, k, by_elastic), vector_of(along, by_penetration)
    a, b = components(turns, vector(elastic))
    c, d = components(along, vector(at.moved_by_s))
    turned = a - k * c, b - k * d  # t*, with the place on the axis
    (e, f), (g, h) = by_elastic
    follows = e * turned[0] + f * turned[1], g * turned[0] + h * turned[1]
    by_place, force = add(vector_of(along, follows), vector_of(turns, t)), vector(on_riser)
    for z in range(forms.shape[1]):
        x, y, up = at.by_z[0, z], at.by_z[1, z], at.by_z[2, z]
        for j in range(3):
            elastic_part = by_way[j][0] * x + by_way[j][1] * y + by_way[j][2] * up
            right[j, z] = by_place[j] * forms[3, z] - by_gap[j] * forms[0, z] - elastic_part
        right[3, z] = forms[3, z]
        left[3, z] = -force[0] * at.by_s_z[0, z] - force[1] * at.by_s_z[1, z] - force[2] * at.by_s_z[2, z]


class SoilFrictionData(NamedTuple):
    """For the line solver: what resists; what is kept of the points, and q (ne, 4, 3) of the axis, where the step
    starts.
    """

    resistance: Resistance
    kept: KeptRows
    q: Array


@njit
def add_friction(
    touch: TouchData,
    given: SoilFrictionData,
    top: TopMotion,
    out: LineForces,
    border: Border,
    workspace: TouchWorkspace,
    sliding: SlidingPoints,
) -> None:
    """Add the residual of friction to that of the line and to the border's, with contact found."""
    near, n = workspace.pressed.near, workspace.found[POINTS]
    write_kept(given.kept, near.number, n, sliding.before)
    touching, start = (near, n, workspace.pressed.force), (given.q, top.accepted)
    find_tractions(given.resistance, *touching, start, touch.axis, touch.surface, sliding)
    forces = touch.axis, touch.surface, touch.basis, near, n, sliding.on_riser
    spread(*forces, out.end_q, top.rows, border.residual, workspace.met)


@njit
def add_friction_tangent(
    touch: TouchData,
    given: SoilFrictionData,
    top: TopMotion,
    at: Configuration,
    K: Array,
    border: Border,
    workspace: TouchWorkspace,
    sliding: SlidingPoints,
) -> None:
    """Add the derivative of the residual of friction, found last, to K (ne, n, n) and to the border's."""
    n, found = workspace.found[POINTS], workspace.pressed
    near, pressed = first_of(found.near, n), (found.force[:n], found.slope[:n])
    pairs, pipe = paired(near, K.shape[0]), (touch.axis, touch.surface)
    forms, start = gap_forms(*pipe, near, touch.basis)[0], (given.q, top.accepted)
    place = start, *pipe, touch.basis
    by_dofs = friction_tangents(given.resistance, near, *pressed, *place, forms, pairs, sliding, at.P)
    add_pairs(by_dofs, pairs, top.rows, touch.surface.facets, K, border)


class FrictionInLoop(LoopFriction):
    """Its kernels, and what they read and write beside contact."""

    part: SoilFriction

    def __init__(self, friction: SoilFriction, data: SoilFrictionData) -> None:
        self.part = friction
        self._data, self._points = Packed(data), Packed(sliding_workspace(0))

    def begin(self, before: State) -> None:
        self._data.renew(self.part.at_start(self._data.value, before))

    def make_room(self, count: int) -> None:
        self._points.renew(sliding_workspace(count))

    def forces(self, touch: Packed, top: Packed, *out: Packed) -> Bound:
        return Bound(add_friction, touch, self._data, top, *out, self._points)

    def tangent(self, touch: Packed, top: Packed, *out: Packed) -> Bound:
        return Bound(add_friction_tangent, touch, self._data, top, *out, self._points)

    def account(self, area: Array) -> tuple[float, Work]:
        points = SlidingPoints(*(each[: len(area)] for each in self._points.value))
        taken, stored = self.part.exchanged(points, area)
        return stored, self.part.work_of(taken, stored)
