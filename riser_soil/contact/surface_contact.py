"""Contact of the pipe's cylinder with the soil's surface: pressure by gap, integrated over the soil under the pipe."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from riser_soil.contact.candidates import CandidatePairs, touching_boxes
from riser_soil.contact.cylinder_gap import Axis, NearPoints, Surface, gap_forms, near_points
from riser_soil.contact.detection import add_blocks, add_shares
from riser_soil.contact.gap import heights
from riser_soil.contact.integration_points import divisions
from riser_soil.contact.law import Penalty
from riser_soil.contact.soil_contact import SOIL, CandidateRange, SoilContact
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit
from riser_soil.core.part import Energy, Forces, MatrixBlock, State, Weights, Work
from riser_soil.riser.line import Line
from riser_soil.riser.sections import larger_beside
from riser_soil.riser.trial import Trial
from riser_soil.soil.surface import SoilTop


@dataclass(frozen=True, eq=False)
class ActivePairs:
    """What touches at a trial: n points in m pairs of an element and a facet.

    points: the n points. pair (n,): of each point; element, facet (m,): of each pair. forms, C: see `gap_forms`.
    force (n,) [N] = area times pressure, slope (n,) [N/m]: derivative by the penetration;
    potential [J] of all. dimension: d of the line.
    """

    points: NearPoints
    pair: IntArray
    element: IntArray
    facet: IntArray
    forms: Array
    C: Array
    force: Array
    slope: Array
    potential: float
    dimension: int

    @property
    def on_line(self) -> Array:
        """Force of each point on the line (n, d) [N]: against the normal, which the positions' share in δg has."""
        d = self.dimension
        return np.asarray(self.force[:, None] * (self.forms[:, 0, :d] + self.forms[:, 0, 2 * d : 3 * d]))

    @cached_property
    def gradient(self) -> Array:
        """dψ/dz (m, nz) of the pairs by z: q of the element, then the facet's nodes [N, N.m]."""
        out = np.zeros((len(self.element), self.forms.shape[2]))
        _add_gradients(out, self.pair, self.force, self.forms)
        return out

    def hessian(self) -> Array:
        """d²ψ/dz² (m, nz, nz) of the pairs."""
        nz = self.forms.shape[2]
        out = np.zeros((len(self.element), nz, nz))
        core = -self.force[:, None, None] * self.C
        core[:, 0, 0] += self.slope
        _add_hessians(out, self.pair, core, self.forms)
        return out


@dataclass(frozen=True, eq=False)
class SurfaceState:
    """Riser and soil at a state: the axis, the deformed points (np, 3) of the surface [m], and what touches."""

    trial: Trial
    deformed: Array
    pressed: ActivePairs


class SurfaceContact(SoilContact):
    """Part "contact": between the pipe's cylinder and the soil's surface, see `SoilContact`.

    A point of the soil's surface bears the pressure p(−gap) times its undeformed area, along the normal from the pipe's
    curved axis, and the element under whose axis it lies bears the opposite through its shape functions: neither the
    riser's nodes nor those of the soil are special. All forces derive from the potential ∫ ψ(−gap) dA: the tangent is
    symmetric, and the forces on riser and soil sum to zero in all directions.

    radius (ne,): of the pipe [m]. pressure: its law of the penetration, [N/m2] where other contacts have [N/m].
    spacing: of the integration points along and across the riser [m]. upright: contact sees the soil's surface move up
    and down alone, and presses on it so; the horizontal forces on the riser are then borne by nothing. along (2,):
    horizontal unit vector of the riser on the ground; by default its first axis. reach: by default half a facet to all
    sides of the pipe.
    """

    def __init__(
        self,
        line: Line,
        radius: Array,
        surface: SoilTop,
        pressure: Penalty,
        spacing: tuple[float, float],
        *,
        upright: bool = False,
        along: Array | None = None,
        reach: CandidateRange | None = None,
    ) -> None:
        super().__init__(line, pressure, surface)
        self._radius, self._upright = radius, upright
        if not self.active:
            return
        self._reach = reach or CandidateRange(0.5 * self._soil.facet_size, 0.5 * self._soil.facet_size)
        axis = line.basis[:2, 0] if along is None else along
        self._parts = divisions(surface.points, self._soil.facets, axis, spacing)

    def evaluate(self, state: State) -> SurfaceState:
        """Riser and soil at a state."""
        found: SurfaceState = self.line.trial(state).once((self, "surface"), self._evaluate)
        return found

    def _evaluate(self, trial: Trial) -> SurfaceState:
        deformed = self._seen(trial.state)
        axis = self._axis(trial)
        surface = Surface(self._soil.facets, self._parts, self._soil.at_first, deformed)
        elements, facets = self._pairs(axis, deformed, CandidateRange(self.law.start, self.law.start))
        near = near_points(axis, surface, elements, facets, self.law.start)
        forms, C = gap_forms(axis, surface, near, self.line.basis)
        if self._upright:
            first = 4 * self.line.dimension
            forms[:, :, first::3] = forms[:, :, first + 1 :: 3] = 0.0
        pairs, pair = np.unique(near.element * len(self._soil.facets) + near.facet, return_inverse=True)
        element, facet = np.divmod(pairs, len(self._soil.facets))
        answer = self.law.update(-near.gap, self.law.initial_history(near.gap.shape))
        weighed = near.area * answer.force, near.area * answer.slope, float(near.area @ answer.stored)
        pressed = ActivePairs(near, pair, element, facet, forms, C, *weighed, self.line.dimension)
        return SurfaceState(trial, deformed, pressed)

    def _seen(self, state: State) -> Array:
        """The surface's points (np, 3) as contact sees them [m]."""
        deformed = self._soil.deformed(state)
        if self._upright:
            deformed[:, :2] = self._soil.at_first[:, :2]
        return deformed

    def _axis(self, trial: Trial) -> Axis:
        q = trial.q @ self.line.basis.T
        q[:, ::2] += self.line.origin
        return Axis(q, self.line.length, self._radius)

    def _pairs(self, axis: Axis, deformed: Array, reach: CandidateRange) -> tuple[IntArray, IntArray]:
        """Elements and facets (n,) whose boxes touch, those of the pipe wider by the reach."""
        handles = axis.q[:, 1::2] * axis.length[:, None, None] / 3.0
        corners = np.stack([axis.q[:, 0], axis.q[:, 0] + handles[:, 0], axis.q[:, 2] - handles[:, 1], axis.q[:, 2]], 1)
        wide = axis.radius[:, None] + np.array([reach.around, reach.around, reach.above])
        return touching_boxes(corners.min(axis=1) - wide, corners.max(axis=1) + wide, deformed, self._soil.facets)

    def blocks(self) -> dict[str, MatrixBlock]:
        """Those of the pairs; all dofs of each element, whose directors turn."""
        return super().blocks() | {self.line.name: self.line.element_block()}

    def pair_dofs(self, on_line: IntArray, facet: IntArray) -> IntArray:
        """Dofs of an element and of a facet."""
        return np.hstack([self.line.element_block().rows[on_line], self._soil.facet_dofs(facet)])

    def candidates(self, state: State) -> CandidatePairs:
        axis = self._axis(self.line.trial(state))
        pairs = self._pairs(axis, self._seen(state), self._reach)
        return CandidatePairs.of(len(self._soil.facets), *pairs)

    def element_forces(self, state: State) -> tuple[None, Array]:
        """Element residuals (inertia, force), each (ne, 2 ndof) or None."""
        found = self.evaluate(state)
        return None, found.trial.pull_back(self._on_line(found))

    def residual(self, state: State, forces: Forces) -> None:
        """Add dψ/du: minus the force on the riser, minus the force on the soil."""
        pressed = self.evaluate(state).pressed
        self.line.scatter(self.element_forces(state)[1], forces.end)
        add_shares(forces.end, self._soil.facet_dofs(pressed.facet), self._on_facets(pressed))

    def _on_line(self, found: SurfaceState) -> Array:
        """Residual conjugate to q (ne, 4, d)."""
        d = self.line.dimension
        F = np.zeros((self.line.length.size, 4, d))
        np.add.at(F, found.pressed.element, found.pressed.gradient[:, : 4 * d].reshape(-1, 4, d))
        return F

    def _on_facets(self, pressed: ActivePairs) -> Array:
        """Residual (m, 3 nv) of the pairs' facets [N]."""
        return pressed.gradient[:, 4 * self.line.dimension :]

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        """Add d²ψ/du², unweighted: contact stands at the end of the step."""
        found = self.evaluate(state)
        pressed = found.pressed
        by_dofs = self._by_dofs(found.trial, pressed)
        places = self.places(pressed.element, pressed.facet)
        add_blocks(values[SOIL], places, np.swapaxes(by_dofs, 1, 2) @ pressed.hessian() @ by_dofs)
        found.trial.add_turning(values[self.line.name], 1.0, self._on_line(found))

    def _by_dofs(self, trial: Trial, pressed: ActivePairs) -> Array:
        """Derivative (m, nz, nr) of the pairs' q and facet nodes by their dofs."""
        P, d = trial.turn.P[pressed.element], self.line.dimension
        n, soil = d + P.shape[3], pressed.forms.shape[2] - 4 * d
        out = np.zeros((len(P), 4 * d + soil, 2 * n + soil))
        for side in range(2):
            q, dofs = 2 * side * d, side * n
            out[:, q : q + d, dofs : dofs + d] = np.eye(d)
            out[:, q + d : q + 2 * d, dofs + d : dofs + n] = P[:, side]
        out[:, 4 * d :, 2 * n :] = np.eye(soil)
        return out

    def energy(self, state: State) -> Energy:
        """Potential of the penalty."""
        return Energy(potential=self.evaluate(state).pressed.potential)

    def work(self, before: State, after: State) -> Work:
        """What the force at the end of the step took out beyond the change of its potential."""
        first, last = self.evaluate(before), self.evaluate(after)
        pressed, d = last.pressed, self.line.dimension
        moved_q = (last.trial.q - first.trial.q)[pressed.element].reshape(len(pressed.element), 4 * d)
        facets = self._soil.facets[pressed.facet]
        moved = (last.deformed - first.deformed)[facets].reshape(len(facets), 3 * facets.shape[1])
        taken = float(np.sum(pressed.gradient * np.hstack([moved_q, moved])))
        return Work(dissipated=taken - self.energy(after).potential + self.energy(before).potential)

    def force_per_length(self, state: State) -> Array:
        """Contact force per length at the nodes (nn,) [N/m], >= 0: the size of the sum of the points' forces, shared
        linearly by two nodes.
        """
        total = np.zeros((self.line.nodes, self.line.dimension))
        if self.active:
            pressed = self.evaluate(state).pressed
            element, along = pressed.points.element, pressed.points.along[:, None]
            np.add.at(total, element, (1.0 - along) * pressed.on_line)
            np.add.at(total, element + 1, along * pressed.on_line)
        return np.asarray(np.linalg.norm(total, axis=1) / self.line.tributary_length)

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
        if not self.active:
            return np.zeros(3)
        return np.asarray(-self.line.basis @ self._on_line(self.evaluate(state))[:, ::2].sum(axis=(0, 1)))

    def force_on_soil(self, state: State) -> Array:
        """Sum of the contact forces on the soil (3,) [N], global axes."""
        if not self.active:
            return np.zeros(3)
        return np.asarray(-self._on_facets(self.evaluate(state).pressed).reshape(-1, 3).sum(axis=0))

    def stretch(self, state: State) -> float:
        if not self.active:
            return 1.0
        found = self.evaluate(state)
        return self._soil.stretch(found.deformed, found.pressed.facet)

    def clearance(self, state: State) -> Array:
        """Gap (nn,) under the nodes less that at which the force begins [m]; inf beside the soil."""
        return self._above(self.line.trial(state), self._seen(state)) - self.law.start

    def _above(self, trial: Trial, surface: Array) -> Array:
        """Height (nn,) of the nodes' undersides above a surface (np, 3) [m]; inf beside it."""
        x = self.line.to_global(trial.x)
        facet, xi = self._soil.locate(x[:, :2], surface)
        return np.asarray(x[:, 2] - larger_beside(self._radius) - heights(facet, xi, self._soil.facets, surface))


@njit
def _add_gradients(out: Array, pair: IntArray, force: Array, forms: Array) -> None:
    for i in range(len(pair)):
        for c in range(forms.shape[2]):
            out[pair[i], c] -= force[i] * forms[i, 0, c]


@njit
def _add_hessians(out: Array, pair: IntArray, core: Array, forms: Array) -> None:
    nz, k = forms.shape[2], forms.shape[1]
    row = np.empty((k, nz))
    for i in range(len(pair)):
        row[:] = 0.0
        for a in range(k):
            for b in range(k):
                if core[i, a, b] != 0.0:
                    for c in range(nz):
                        row[a, c] += core[i, a, b] * forms[i, b, c]
        _add_products(out[pair[i]], row, forms[i])


@njit
def _add_products(out: Array, row: Array, form: Array) -> None:
    for a in range(form.shape[0]):
        for r in range(form.shape[1]):
            for c in range(form.shape[1]):
                out[r, c] += form[a, r] * row[a, c]
