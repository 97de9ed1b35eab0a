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
from riser_soil.contact.pressed_points import Pairs, PressedPoints, pair_tangents, press_workspace, write_axis
from riser_soil.contact.soil_contact import SOIL, CandidateRange, LoopContact, SoilContact
from riser_soil.contact.surface_loop import (
    LoopFriction,
    TouchData,
    TouchWorkspace,
    Watched,
    add_touch,
    add_touch_tangent,
    write_touch_work,
)
from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.bound import Bound, Packed
from riser_soil.core.part import Energy, Forces, MatrixBlock, State, Weights, Work
from riser_soil.core.saved_state import Saved, gathered, within
from riser_soil.riser.line import Line
from riser_soil.riser.moving_nodes import Trial
from riser_soil.riser.part_kernels import FULL, POINTS
from riser_soil.riser.sections import larger_beside
from riser_soil.seabed.law import NormalLaw

if TYPE_CHECKING:
    from riser_soil.soil.condensed import SoilSurface

AROUND = 0.25  # radii around the pipe in which facets are candidates: each of them couples its nodes to the element


@dataclass(frozen=True, eq=False)
class SurfaceState:
    """Riser and soil at a state, and what touches."""

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
        self._stored: float | None = None  # [J] at the accepted state on soil that moves, once one is known

    def evaluate(self, state: State) -> SurfaceState:
        """Riser and soil at a state. What the trial keeps does not hold the trial: Python would find so large a cycle
        late.
        """
        trial = self.line.trial(state)
        found: PressedPoints = trial.once((self, "surface"), self._evaluate)
        return SurfaceState(trial, found)

    def _evaluate(self, trial: Trial) -> PressedPoints:
        deformed = self._soil.deformed(trial.state)
        axis, surface = self.axis(trial), self.surface(deformed)
        elements, facets = self._pairs(axis, deformed, CandidateRange(self._acts_within, self._acts_within))
        near = near_points(axis, surface, elements, facets, self._acts_within)
        return PressedPoints.of(axis, surface, self._basis, near, self.law.kernel_data, self._memory.kept)

    @property
    def _acts_within(self) -> float:
        """Gap [m] within which the law may act in a step that starts here."""
        return float(self.law.reach if len(self._memory.numbers) else self.law.start)

    def in_loop(self, friction: LoopFriction | None) -> SurfaceInLoop:
        return SurfaceInLoop(self, friction)

    def touch_data(self) -> TouchData:
        """For the line solver, with workspace for axis and surface."""
        axis = Axis(np.zeros((self.line.length.size, 4, 3)), self.line.length, self._radius)
        surface, law = self.surface(self._soil.settled), self.law.kernel_data
        return self.at_start(TouchData(axis, surface, self._basis, self.line.origin, law, self._memory.kept, 0.0))

    def at_start(self, touch: TouchData) -> TouchData:
        """Kernel data of the contact for a step that starts here: history, and the gap within which the law may act."""
        return touch._replace(kept=self._memory.kept, reach=self._acts_within)

    def watch(self, axes: Sequence[Axis], settled: Array) -> tuple[Array, Array, PairsByFacet]:
        """Boxes, low and high (ne, 3), around the pipe's elements where their axes are, wider by the candidates' range,
        and the pairs that may touch within; settled (np, 3): the surface.
        """
        reach = self.law.reach
        around = [boxes(axis, self._reach.above + reach, self._reach.around + reach) for axis in axes]
        low, high = np.min([low for low, _ in around], axis=0), np.max([high for _, high in around], axis=0)
        elements, facets = touching_boxes(low, high, settled, self._soil.corners)
        return low, high, by_facet(elements, facets, len(self._soil.facets))

    def surface(self, deformed: Array) -> Surface:
        """The soil's surface with its points at (np, 3) [m]."""
        return Surface(self._soil.facets, self._parts, self._first, self._soil.measured, deformed)

    def first_heights(self, points: NearPoints) -> Array:
        """Heights (n,) of points before the riser came [m]."""
        return self._soil.heights_at(points.facet, points.xi, self._soil.at_first)

    def axis(self, trial: Trial) -> Axis:
        """The riser's axis at a trial."""
        q = np.empty((self.line.length.size, 4, 3))
        write_axis(self.line.origin, self._basis, trial.q, q)
        return Axis(q, self.line.length, self._radius)

    @property
    def radius(self) -> float:
        """Largest of the pipe [m]."""
        return float(self._radius.max())

    @property
    def around(self) -> float:
        """How far beside the pipe facets are candidates [m]."""
        return self._reach.around

    def _pairs(self, axis: Axis, deformed: Array, reach: CandidateRange) -> tuple[IntArray, IntArray]:
        """Elements and facets (n,) whose boxes touch, those of the pipe wider by the reach."""
        low, high = boxes(axis, reach.above, reach.around)
        found: tuple[IntArray, IntArray] = touching_boxes(low, high, deformed, self._soil.corners)
        return found

    def blocks(self) -> dict[str, MatrixBlock]:
        """Those of the pairs; all dofs of each element, whose directors turn."""
        return super().blocks() | {self.line.name: self.line.element_block()}

    def pair_dofs(self, on_line: IntArray, facet: IntArray) -> IntArray:
        """Dofs of an element and of a facet."""
        return np.hstack([self.line.element_block().rows[on_line], self._soil.facet_dofs(facet)])

    def candidates(self, state: State) -> CandidatePairs:
        axis = self.axis(self.line.trial(state))
        pairs = self._pairs(axis, self._soil.deformed(state), self._reach)
        return CandidatePairs.of(len(self._soil.facets), *pairs)

    def element_forces(self, state: State) -> Array:
        """Element residual (ne, 2 ndof)."""
        found = self.evaluate(state)
        return found.on_elements(found.pressed.spread(found.pressed.on_riser)[0])

    def residual(self, state: State, forces: Forces) -> None:
        """Add dψ/du: minus the force on the riser, minus the force on the soil."""
        found = self.evaluate(state)
        self.add_residual(found, found.pressed.on_riser, forces)

    def add_residual(self, found: SurfaceState, f: Array, forces: Forces) -> None:
        """Add that of forces f (n, 3) on the pipe at the points."""
        F, soil = found.pressed.spread(f)
        self.line.scatter(found.on_elements(F), forces.end)
        forces.end[self._soil.part] += soil.ravel()

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        """Add d²ψ/du², unweighted: contact stands at the end of the step."""
        found = self.evaluate(state)
        at, P = found.pressed, found.trial.turn.P
        by_dofs = pair_tangents(*at.forms, at.force, at.slope, at.pairs, P)
        self.add_tangent(values, found, by_dofs, at.on_riser)

    def add_tangent(self, values: dict[str, Array], found: SurfaceState, by_dofs: Array, f: Array) -> None:
        """Add the derivative of the residual of forces f (n, 3) on the pipe; by_dofs (m, nr, nr): of pairs, P held."""
        pairs: Pairs = found.pressed.pairs
        add_blocks(values[SOIL], self.places(values[SOIL], pairs.element, pairs.facet), by_dofs)
        found.trial.add_turning(values[self.line.name], 1.0, found.pressed.spread(f)[0])

    def energy(self, state: State) -> Energy:
        """Potential of the penalty."""
        return Energy(potential=self.evaluate(state).pressed.potential)

    def work(self, before: State, after: State) -> Work:
        """What the force at the end of the step took out beyond the change of its potential; by the time scheme what
        it took beyond the work of the law along the step, all of it without suction.
        """
        last = self.evaluate(after).pressed
        if self._soil.moves:  # by the areas of the step's end; those of its start have stored what was stored
            first = self._evaluate(self.line.trial(before))
            stored = first.potential if self._stored is None else self._stored
        else:
            first = self.evaluate(before).pressed
            stored = first.potential
        taken = last.work(last.on_riser, first)
        lost = taken - last.potential + stored
        by_scheme = taken - self._by_law(first.points, last.points) if self.law.columns else lost
        return Work(dissipated=lost, by_scheme=by_scheme)

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
        if not self.active:
            return
        if self._soil.moves:
            self._stored = self.evaluate(state).pressed.potential
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
        """By length of the riser (nn, 3) [N/m]: of forces f (n, 3) on the pipe at the points."""
        return np.asarray(-self.at_nodes(points, f) / self.line.tributary_length[:, None])

    def stretch(self, state: State) -> float:
        if not self.active:
            return 1.0
        pressed = self.evaluate(state).pressed
        return self._soil.stretch(pressed.surface.deformed, pressed.points.facet)

    def gaps(self, points: Array, state: State) -> Array:
        """Between the pipe at a state and points (n, 3) [m]."""
        return gaps_of(self.axis(self.line.trial(state)), points)[0]

    def brought_to(self, points: Array, gaps: Array, state: State) -> Array:
        """Points (n, 3), those near the pipe at given gaps (n,) from it [m]."""
        near, out = gaps < AROUND * self.radius, points.copy()
        if near.any():
            found, away = gaps_of(self.axis(self.line.trial(state)), points[near])
            out[near] += (gaps[near] - found)[:, None] * away
        return out

    def surface_renewed(self, before: Array, memories: Sequence[PointMemory] = ()) -> None:
        """The soil's surface has other nodes than those (np, 3) before: what is remembered of points, here and by
        others, goes over to those that lie there now.
        """
        settled, here = self._soil.settled, self.line.trial(State.at_rest(0.0, self._soil.end))
        axis = self.axis(here)
        near = np.flatnonzero((gaps_of(axis, before)[0][self._soil.facets] < self.radius).any(axis=1))
        numbers, *places = points_of(self.surface(before), self.surface(settled), near)
        for memory in (self._memory, *memories):
            memory.go_over(numbers, *places)
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
        was = self.line.to_global(self.line.x[low]), self._soil.deformed(State.at_rest(guess.t, guess.u.size))
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
        """That of the pattern, and the history of the points."""
        if not self.active:
            return super().state()
        stored = {} if self._stored is None else {"stored": np.array(self._stored)}
        return super().state() | gathered({"points": self._memory}) | stored

    def restore(self, saved: Saved) -> None:
        super().restore(saved)
        if self.active:
            self._memory.restore(within(saved, "points"))
            self._stored = float(saved["stored"]) if "stored" in saved else None


class SurfaceInLoop(LoopContact):
    """`SurfaceContact` in the line solver, with its friction, if any."""

    contact: SurfaceContact

    def __init__(self, contact: SurfaceContact, friction: LoopFriction | None) -> None:
        super().__init__(contact, contact.around)
        self._line, self._friction = contact.line, friction
        self.parts = (contact,) if friction is None else (contact, friction.part)
        self._touch = contact.touch_data()
        self.deformed, ne = self._touch.surface.deformed, self._line.length.size
        self.met: BoolArray = np.zeros(len(self.deformed), dtype=np.bool_)
        self._data, self._workspace = Packed(self._touch), Packed(self._with_room(FEW))
        none, low_high = np.empty(0, dtype=np.int64), (np.zeros((ne, 3)), np.zeros((ne, 3)))
        self._watched = Packed(Watched(PairsByFacet(none, none, none), *low_high, 0.0))

    def _with_room(self, count: int) -> TouchWorkspace:
        """For so many points that touch."""
        if self._friction is not None:
            self._friction.make_room(count)
        pressed = press_workspace(points_workspace(count), len(self.contact.law.columns))
        return TouchWorkspace(pressed, self.found, self.met, self.energy)

    def begin(self, before: State) -> None:
        self._data.renew(self.contact.at_start(self._touch))
        if self._friction is not None:
            self._friction.begin(before)

    def look(self, before: State, tried: bool) -> IntArray:
        if self.found[FULL]:
            self._workspace.renew(self._with_room(2 * len(self._workspace.value.pressed.force)))
        axes = [self.contact.axis(self._line.trial(before))]
        if tried:
            axes.append(self._touch.axis._replace(q=self._touch.axis.q.copy()))
        low, high, pairs = self.contact.watch(axes, self.deformed)
        level = float(self.deformed[:, 2].max()) + self.slack
        self._watched.renew(Watched(pairs, low + self.slack, high - self.slack, level))
        return np.unique(self._touch.surface.facets[pairs.facets])

    def forces(self, top: Packed, at: Packed, forces: Packed, border: Packed) -> list[Bound]:
        out = forces, border, self._workspace
        touched = Bound(add_touch, self._data, self._watched, top, at, *out)
        return [touched] if self._friction is None else [touched, self._friction.forces(self._data, top, *out)]

    def tangent(self, top: Packed, at: Packed, K: Packed, border: Packed) -> list[Bound]:
        out = at, K, border, self._workspace
        touched = Bound(add_touch_tangent, self._data, top, *out)
        return [touched] if self._friction is None else [touched, self._friction.tangent(self._data, top, *out)]

    def account(self, top: Packed, first: Packed) -> list[Bound]:
        return [Bound(write_touch_work, self._data, top, first, self._workspace, Packed(self.work))]

    def add_work(self, before: State, after: State, work: dict[str, Work]) -> float:
        stored = super().add_work(before, after, work)
        if self._friction is None:
            return stored
        by_friction, turned = self._friction.account(self._workspace.value.pressed.near.area[: self.found[POINTS]])
        work[self._friction.part.name] += turned
        return stored + by_friction
