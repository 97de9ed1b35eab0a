"""Contact of the pipe's cylinder with the soil's surface: pressure by gap, integrated over the soil under the pipe."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from riser_soil.contact.along_step import landing_predictor, work_along_step
from riser_soil.contact.closest_point import Axis
from riser_soil.contact.cylinder_gap import gaps_of
from riser_soil.contact.ground import CandidatePairs, add_blocks, touching_boxes
from riser_soil.contact.integration_points import PointMemory, divisions
from riser_soil.contact.near_points import (
    FEW,
    NearPoints,
    PairsByFacet,
    Surface,
    boxes,
    by_facet,
    near_points,
    points_of,
    points_workspace,
)
from riser_soil.contact.on_condensed_soil import FULL, POINTS, Touched
from riser_soil.contact.pressed_points import (
    Pairs,
    PressedPoints,
    PressWorkspace,
    Start,
    pair_tangents,
    press_workspace,
    write_axis,
)
from riser_soil.contact.soil_contact import SOIL, CandidateRange, SoilContact
from riser_soil.contact.surface_kernels import SurfaceContactData, Watched
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.part import Forces, MatrixBlock, State, Weights
from riser_soil.core.saved_state import Saved, gathered, within
from riser_soil.riser.line import Line
from riser_soil.riser.moving_nodes import Trial
from riser_soil.riser.placed_line import LineTrials
from riser_soil.riser.sections import larger_beside
from riser_soil.seabed.law import NormalLaw

if TYPE_CHECKING:
    from riser_soil.soil.condensed import SoilSurface

AROUND = 0.25  # radii around the pipe in which facets are candidates: each of them couples its nodes to the element


@dataclass(frozen=True, eq=False)
class SurfaceState:
    """Contact evaluated at a state: the riser there, and the points of the soil's surface that press on it."""

    trial: Trial
    pressed: PressedPoints

    def on_elements(self, F: Array) -> Array:
        """Element residuals (ne, 2 ndof) of what is conjugate to q (ne, 4, d)."""
        return self.trial.pull_back(F)


class SurfaceContact(SoilContact):
    """Part "contact": between the pipe's cylinder and the soil's surface, see `SoilContact`.

    A point of the soil's surface bears the pressure p(−gap) times its area where the soil is placed (before all steps,
    at small strain), along the normal from the pipe's curved axis, and the element under whose axis it lies bears the
    opposite through its shape functions: neither the riser's nodes nor those of the soil are special. All forces derive
    from the potential ∫ ψ(−gap) dA: the tangent is symmetric, and the forces on riser and soil sum to zero in all
    directions. Where the soil moves, the surface across the riser is a smooth curve through the nodes (strip8 of
    `facets`): flat facets would cut off the round groove that the pipe has pressed.

    radius (ne,): of the pipe [m]. pressure: its law of the penetration, [N/m2] where other contacts have [N/m]; with a
    history, such as suction has, for each point of the soil. spacing: of the integration points along and across the
    riser [m], see `divisions`. along (2,): horizontal unit vector of the riser on the ground; by default its first
    axis. reach: by default half a facet above the soil, but no more than a quarter radius around the pipe.
    """

    def __init__(
        self,
        line: Line,
        radius: Array,
        surface: SoilSurface,
        pressure: NormalLaw,
        spacing: tuple[float, float],
        *,
        along: Array | None = None,
        reach: CandidateRange | None = None,
    ) -> None:
        super().__init__(line, pressure, surface)
        self._radius, self._basis = radius, np.ascontiguousarray(line.basis)
        if not self.active:
            return
        half = 0.5 * self._soil.facet_size
        self._reach = reach or CandidateRange(half, min(half, AROUND * float(radius.max())))
        axis = line.basis[:2, 0] if along is None else along
        if surface.moves and self._soil.has_quads:
            self._soil.smooth(axis)
        self._parts = divisions(surface.points, self._soil.facets, axis, spacing, float(line.length.min()))
        self._first = np.append(0, np.cumsum(self._parts[:, :2].prod(axis=1)))[:-1]
        self._memory = PointMemory(pressure.initial_history(()))
        self._start: tuple[Array, Array, Start] | None = None  # for which accepted places of line and soil it holds

    def evaluate(self, state: State) -> SurfaceState:
        """Contact at a state. What the trial caches does not refer to it: Python would free such a cycle late."""
        trial = self.line.trial(state)
        pressed: PressedPoints = trial.once((self, "surface"), self._evaluate)
        return SurfaceState(trial, pressed)

    def _evaluate(self, trial: Trial) -> PressedPoints:
        deformed = self._soil.deformed(trial.state)
        axis, surface = self.axis(trial), self.surface(deformed)
        within = self._acts_within
        elements, facets = touching_boxes(*boxes(axis, within, within), deformed, self._soil.corners)
        near = near_points(axis, surface, elements, facets, within)
        return PressedPoints.of(axis, surface, self._basis, near, self.law.kernel_data, self._memory.history)

    @property
    def _acts_within(self) -> float:
        """Gap [m] within which the law may act in a step that starts here."""
        return float(self.law.reach if len(self._memory.numbers) else self.law.start)

    def start(self) -> Start:
        """Where the present step starts; kept until line or soil are accepted elsewhere."""
        cached, here = self._start, (self.line.x, self._soil.committed)
        if cached is None or cached[0] is not here[0] or cached[1] is not here[1]:
            placed = self.line.once(LineTrials).then
            placed.move(self.accepted)
            cached = self._start = *here, (self._in_space(placed.at.q), self._soil.settled)
        return cached[2]

    def kernel_data(self, deformed: Array, touched: Touched) -> SurfaceContactData:
        axis = Axis(np.zeros((self.line.length.size, 4, 3)), self.line.length, self._radius)
        none, box = np.empty(0, dtype=np.int64), np.zeros((self.line.length.size, 3))
        watched = Watched(PairsByFacet(none, none, none), box, box, 0.0)
        pipe, law = (axis, self.surface(deformed), self._basis, self.line.origin), self.law.kernel_data
        return SurfaceContactData(*pipe, law, self._memory.history, np.zeros(1), watched, self._room(FEW), touched)

    def _room(self, count: int) -> PressWorkspace:
        """Workspace for so many points that touch."""
        return press_workspace(points_workspace(count), len(self.law.columns))

    def at_start(self, data: SurfaceContactData) -> SurfaceContactData:
        """The kernel data with the gap within which the law may act in a step that starts here, and the history."""
        data.reach[0] = self._acts_within
        history = self._memory.history
        return data if data.history is history else data._replace(history=history)

    def place(self, state: State) -> Axis:
        """The riser's axis."""
        return self.axis(self.line.trial(state))

    def place_in(self, data: SurfaceContactData) -> Axis:
        return data.axis._replace(q=data.axis.q.copy())

    def _boxes(self, axes: Sequence[Axis]) -> tuple[Array, Array]:
        """Boxes, low and high (ne, 3), around the pipe's elements where their axes are, wider by the candidates' range
        and as far as the law reaches.
        """
        reach = self.law.reach
        around = [boxes(axis, self._reach.above + reach, self._reach.around + reach) for axis in axes]
        return np.min([low for low, _ in around], axis=0), np.max([high for _, high in around], axis=0)

    def candidates(self, places: Sequence[Axis], surface: Array) -> CandidatePairs:
        pairs = touching_boxes(*self._boxes(places), surface, self._soil.corners)
        return CandidatePairs.of(len(self._soil.facets), *pairs)

    def watch(
        self, data: SurfaceContactData, places: Sequence[Axis], pairs: CandidatePairs, slack: float
    ) -> SurfaceContactData:
        low, high = self._boxes(places)
        chosen = by_facet(pairs.on_line, pairs.facet, len(self._soil.facets))
        level = float(data.surface.deformed[:, 2].max()) + slack
        return data._replace(watched=Watched(chosen, low + slack, high - slack, level))

    def with_room(self, data: SurfaceContactData) -> SurfaceContactData:
        if not data.touched.counts[FULL]:
            return data
        return data._replace(pressed=self._room(2 * len(data.pressed.force)))

    def adopt(self, state: State, data: SurfaceContactData) -> None:
        n, energy = data.touched.counts[POINTS], float(data.touched.energy[0])
        pressed = PressedPoints.copied(data.axis, data.surface, self._basis, n, energy, data.pressed)
        self.line.trial(state).once((self, "surface"), lambda _: pressed)

    def surface(self, deformed: Array) -> Surface:
        """The soil's surface with its points at (np, 3) [m]."""
        return Surface(self._soil.facets, self._parts, self._first, self._soil.measured, deformed)

    def first_heights(self, points: NearPoints) -> Array:
        """Heights (n,) of points before the riser came [m]."""
        return self._soil.heights_at(points.facet, points.xi, self._soil.at_first)

    def axis(self, trial: Trial) -> Axis:
        """The riser's axis at a trial."""
        return Axis(self._in_space(trial.q), self.line.length, self._radius)

    def _in_space(self, q: Array) -> Array:
        """q (ne, 4, d) of the elements in global axes (ne, 4, 3)."""
        out = np.empty((len(q), 4, 3))
        write_axis(self.line.origin, self._basis, q, out)
        return out

    @property
    def radius(self) -> float:
        """Largest of the pipe [m]."""
        return float(self._radius.max())

    def blocks(self) -> dict[str, MatrixBlock]:
        """Blocks of the pairs, and of each element, whose directors turn."""
        return super().blocks() | {self.line.name: self.line.element_block()}

    def pair_dofs(self, on_line: IntArray, facet: IntArray) -> IntArray:
        """Dofs of an element and of a facet."""
        return np.hstack([self.line.element_block().rows[on_line], self._soil.facet_dofs(facet)])

    def element_forces(self, state: State) -> Array:
        """Element residual (ne, 2 ndof)."""
        contact = self.evaluate(state)
        return contact.on_elements(contact.pressed.spread(contact.pressed.on_riser)[0])

    def residual(self, state: State, forces: Forces) -> None:
        """Add dψ/du: minus the force on the riser, minus the force on the soil."""
        contact = self.evaluate(state)
        self.add_residual(contact, contact.pressed.on_riser, forces)

    def add_residual(self, contact: SurfaceState, f: Array, forces: Forces) -> None:
        """Add the residual of forces f (n, 3) on the pipe at the points."""
        F, soil = contact.pressed.spread(f)
        self.line.scatter(contact.on_elements(F), forces.end)
        forces.end[self._soil.part] += soil.ravel()

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        """Add d²ψ/du², unweighted: contact forces are those at the end of the step."""
        contact = self.evaluate(state)
        at, P = contact.pressed, contact.trial.turn.P
        by_dofs = pair_tangents(*at.forms, at.force, at.slope, at.pairs, P)
        self.add_tangent(values, contact, by_dofs, at.on_riser)

    def add_tangent(self, values: dict[str, Array], contact: SurfaceState, by_dofs: Array, f: Array) -> None:
        """Add the derivative of the residual of forces f (n, 3) on the pipe; by_dofs (m, nr, nr): of pairs, at constant
        P.
        """
        pairs: Pairs = contact.pressed.pairs
        add_blocks(values[SOIL], self.places(values[SOIL], pairs.element, pairs.facet), by_dofs)
        contact.trial.add_turning(values[self.line.name], 1.0, contact.pressed.spread(f)[0])

    def potential(self, state: State) -> float:
        return self.evaluate(state).pressed.potential

    def work_to(self, state: State) -> float:
        pressed = self.evaluate(state).pressed
        return pressed.work(pressed.on_riser, self.start())

    def lost_by_scheme(self, extracted: float, lost: float, before: State, after: State) -> float:
        """With suction, the work of the forces less that of the law along the step [J]; else all that is lost."""
        if not self.law.columns:
            return lost
        return extracted - self._by_law(self.evaluate(before).pressed.points, self.evaluate(after).pressed.points)

    def _by_law(self, first: NearPoints, last: NearPoints) -> float:
        """Work [J] of the law along a step, at points that touch before or after it."""
        numbers = np.union1d(first.number, last.number)
        area, ways = np.zeros(len(numbers)), np.full((2, len(numbers)), -self.law.reach)
        for way, points in zip(ways, (first, last), strict=True):
            at = np.searchsorted(numbers, points.number)
            area[at], way[at] = points.area, -points.gap
        return float(area @ work_along_step(self.law, ways[0], ways[1], self._memory.at(numbers)))

    def commit(self, state: State) -> None:
        """Keep the history of the points."""
        super().commit(state)
        if self.law.columns:
            pressed = self.evaluate(state).pressed
            self._memory.keep(pressed.points.number, pressed.history)

    def force_per_length(self, state: State) -> Array:
        """Contact force per length at the nodes (nn,) [N/m]: the size of the sum of the points' forces, shared linearly
        by two nodes; < 0 where it pulls the riser down.
        """
        if not self.active:
            return np.zeros(self.line.nodes)
        pressed = self.evaluate(state).pressed
        total = self.at_nodes(pressed.points, pressed.on_riser @ self._basis)
        size = np.linalg.norm(total, axis=1) / self.line.tributary_length
        return np.asarray(np.where(total[:, -1] < 0.0, -size, size))

    def at_nodes(self, points: NearPoints, values: Array) -> Array:
        """Values at points (n, k) shared linearly by the two nodes beside them (nn, k)."""
        total, along = np.zeros((self.line.nodes, values.shape[1])), points.along[:, None]
        np.add.at(total, points.element, (1.0 - along) * values)
        np.add.at(total, points.element + 1, along * values)
        return total

    def max_penetration(self, state: State) -> float:
        """Deepest penetration of the soil's surface into the pipe [m], >= 0: an error."""
        return float(np.max(-self.evaluate(state).pressed.points.gap, initial=0.0)) if self.active else 0.0

    def depth(self, state: State) -> Array:
        """Depth (nn,) [m] of the nodes' undersides below the soil's surface before the riser came, 0 above it."""
        if not self.active:
            return np.zeros(self.line.nodes)
        return np.maximum(0.0, -self._above(self.line.trial(state), self._soil.at_first))

    def force_on_riser(self, state: State) -> Array:
        """Sum of the contact forces on the riser (3,) [N], global axes."""
        return self.within_line(self.evaluate(state).pressed.on_riser.sum(axis=0)) if self.active else np.zeros(3)

    def within_line(self, force: Array) -> Array:
        """The share of a force (3,) that a line in a plane feels."""
        return np.asarray(self._basis @ (force @ self._basis))

    def force_on_soil(self, state: State) -> Array:
        """Sum of the contact forces on the soil (3,) [N], global axes."""
        return np.asarray(-self.evaluate(state).pressed.on_riser.sum(axis=0)) if self.active else np.zeros(3)

    def force_on_soil_per_length(self, state: State) -> Array:
        """The points' forces on the nodes of their facets (nn, 3) [N/m], shared linearly by two nodes of the riser."""
        if not self.active:
            return np.zeros((self.line.nodes, 3))
        pressed = self.evaluate(state).pressed
        return self.soil_per_length(pressed.points, pressed.on_riser)

    def soil_per_length(self, points: NearPoints, f: Array) -> Array:
        """Force on the soil by length of the riser (nn, 3) [N/m], from forces f (n, 3) on the pipe at the points."""
        return np.asarray(-self.at_nodes(points, f) / self.line.tributary_length[:, None])

    def stretch(self, state: State) -> float:
        if not self.active:
            return 1.0
        pressed = self.evaluate(state).pressed
        return self._soil.stretch(pressed.surface.deformed, pressed.points.facet)

    def gaps(self, points: Array, state: State) -> Array:
        """Gaps (n,) between the pipe at a state and points (n, 3) [m]."""
        return gaps_of(self.axis(self.line.trial(state)), points)[0]

    def brought_to(self, points: Array, gaps: Array, state: State) -> Array:
        """Points (n, 3), those near the pipe at given gaps (n,) from it [m]."""
        near, out = gaps < AROUND * self.radius, points.copy()
        if near.any():
            present, away = gaps_of(self.axis(self.line.trial(state)), points[near])
            out[near] += (gaps[near] - present)[:, None] * away
        return out

    def surface_renewed(self, before: Array, memories: Sequence[PointMemory] = ()) -> None:
        """The soil's surface has other nodes than those (np, 3) before: the history of points, here and in other
        memories, goes over to the points that lie there now.
        """
        settled, here = self._soil.settled, self.line.trial(self.accepted)
        axis = self.axis(here)
        near = np.flatnonzero((gaps_of(axis, before)[0][self._soil.facets] < self.radius).any(axis=1))
        numbers, *places = points_of(self.surface(before), self.surface(settled), near)
        for memory in (self._memory, *memories):
            memory.go_over(numbers, *places)
        self._start = None
        self._stored = self._evaluate(here).potential
        self.line.forget()

    def clearance(self, state: State) -> Array:
        """Gap (nn,) under the nodes less that at which the force begins [m]; inf beside the soil."""
        return self._above(self.line.trial(state), self._soil.deformed(state)) - self.law.start

    def predict(self, guess: State) -> Array:
        """Increments of a first guess that lands, see `along_step`: only of nodes below the soil's highest point."""
        if not self.active:
            return guess.u
        moved = self.line.nodal(guess.u)[:, : self.line.dimension]
        x, surface = self.line.to_global(self.line.x + moved), self._soil.deformed(guess)
        radius = larger_beside(self._radius)
        low = np.flatnonzero(x[:, 2] - radius < surface[:, 2].max() + self.law.start)
        was = self.line.to_global(self.line.x[low]), self._soil.settled
        present, guessed = (
            self._over(*place, radius[low]) - self.law.start for place in (was, (x[low], surface))
        )
        return landing_predictor(guess, self.line.translation_dofs[low, -1], present, guessed, self.law.start)

    def _above(self, trial: Trial, surface: Array) -> Array:
        """Height (nn,) of the nodes' undersides above a surface (np, 3) [m]; inf beside it."""
        return self._over(self.line.to_global(trial.x), surface, larger_beside(self._radius))

    def _over(self, x: Array, surface: Array, radius: Array) -> Array:
        """Height (n,) [m] of undersides over the surface at places x (n, 3) with radii (n,); inf beside it."""
        return np.asarray(x[:, 2] - radius - self._soil.heights(x[:, :2], surface))

    def state(self) -> Saved:
        """The pattern, the energy stored, and the history of the points."""
        return super().state() | (gathered({"points": self._memory}) if self.active else {})

    def restore(self, saved: Saved) -> None:
        super().restore(saved)
        if self.active:
            self._memory.restore(within(saved, "points"))
