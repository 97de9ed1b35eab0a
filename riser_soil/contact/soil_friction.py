"""Friction between the pipe's cylinder and the soil's surface, point by point: the part "soil friction"."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from riser_soil.contact.closest_point import Axis
from riser_soil.contact.coulomb import traction
from riser_soil.contact.cylinder_gap import Slide, slide
from riser_soil.contact.integration_points import PointMemory
from riser_soil.contact.near_points import NearPoints, Surface
from riser_soil.contact.pressed_points import PressedPoints, add_products, in_dofs
from riser_soil.contact.surface_contact import SurfaceContact, SurfaceState
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.part import Energy, Forces, MatrixBlock, State, Traits, Weights, Work
from riser_soil.core.saved_state import Saved, Stateful, gathered, within
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart

AREA = 3  # column of the memory, behind the traction


@dataclass(frozen=True, eq=False)
class SlidingState:
    """Friction at a state: elastic guess (n, 3) and traction (n, 3) on the riser [Pa] of the n points that press."""

    found: SurfaceState
    moved: Slide
    elastic: Array
    traction: Array

    @property
    def on_riser(self) -> Array:
        """Force on the pipe at each point (n, 3) [N], global axes."""
        return np.asarray(self.found.pressed.points.area[:, None] * self.traction)


SoilAdhesion = Callable[[IntArray, Array], Array]
"""Facets (n,) and heights of points on them before the riser came (n,) [m] -> what the soil holds the pipe by at most
(n,) [Pa].
"""

Sliding = tuple[Slide, Array, Array]  # what a trial keeps of a SlidingState: all but what holds the trial


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
        self._mu, self._stiffness, self._adhesion = np.array([axial, lateral]), stiffness, adhesion
        self._memory = PointMemory(np.zeros(AREA + 1))
        self._at_start: tuple[Axis, Surface] | None = None
        self._slid: Array = np.zeros(self.line.nodes)

    def stick(self) -> None:
        """From now on nothing slides, as in small vibrations about rest."""
        self._mu, self._adhesion = np.full(2, np.inf), None
        self.line.forget()

    def blocks(self) -> dict[str, MatrixBlock]:
        """Those of contact."""
        return self.contact.blocks()

    def evaluate(self, state: State) -> SlidingState:
        """Tractions of the points that press."""
        found = self.contact.evaluate(state)
        made: Sliding = found.trial.once((self, "sliding"), lambda _: self._evaluate(found))
        return SlidingState(found, *made)

    def _evaluate(self, found: SurfaceState) -> Sliding:
        pressed = found.pressed
        now = pressed.axis, pressed.surface
        moved = slide(pressed.points, self._start(found.trial.state), now, self.line.basis)
        before = self._memory.at(pressed.points.number)[:, :AREA]
        elastic = before - self._stiffness * moved.moved
        t, _, _ = self._return(_along(moved.along, elastic), pressed)
        return moved, elastic, np.einsum("nri,nr->ni", moved.along, t)

    def _return(self, elastic: Array, pressed: PressedPoints) -> tuple[Array, Array, Array]:
        """Components (n, r) of the traction, their derivatives by those of t* and by the penetration."""
        pressure, slope = pressed.force / pressed.points.area, pressed.slope / pressed.points.area
        return traction(elastic, pressure, slope, self._mu, self._most(pressed.points))

    def _most(self, points: NearPoints) -> Array | float:
        """Adhesion of points (n,) [Pa]."""
        return np.inf if self._adhesion is None else self._adhesion(points.facet, self.contact.first_heights(points))

    def _start(self, state: State) -> tuple[Axis, Surface]:
        """The pipe's axis and the soil's surface at the start of the step."""
        if self._at_start is None:
            rest = State.at_rest(state.t, state.u.size)
            found = self.contact.evaluate(rest).pressed
            self._at_start = found.axis, found.surface
        return self._at_start

    def element_forces(self, state: State) -> Array:
        """Element residual (ne, 2 ndof)."""
        sliding = self.evaluate(state)
        return sliding.found.on_elements(sliding.found.pressed.spread(sliding.on_riser)[0])

    def residual(self, state: State, forces: Forces) -> None:
        sliding = self.evaluate(state)
        self.contact.add_residual(sliding.found, sliding.on_riser, forces)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        """Unweighted: friction stands at the end of the step."""
        sliding = self.evaluate(state)
        pressed = sliding.found.pressed
        (pair, element, _), forms = pressed.pairs, pressed.forms
        nz, area = forms.shape[2], pressed.points.area[:, None, None]
        by_z = np.zeros((len(element), nz, nz))
        turning = np.einsum("ni,niz->nz", sliding.traction, sliding.moved.by_s_z)
        left = np.concatenate([sliding.moved.by_z, turning[:, None]], axis=1)
        right = np.concatenate([self._traction_by_z(sliding, forms), forms[:, -1:]], axis=1)
        add_products(by_z, pair, -area * left, right)
        by_dofs = in_dofs(by_z, element, sliding.found.trial.turn.P)
        self.contact.add_tangent(values, sliding.found, by_dofs, sliding.on_riser)

    def _traction_by_z(self, sliding: SlidingState, forms: Array) -> Array:
        """Derivative (n, 3, nz) of the traction."""
        moved, pressed, k = sliding.moved, sliding.found.pressed, self._stiffness
        at, by_place = _along(moved.along, sliding.elastic), forms[:, -1]
        t, by_elastic, by_penetration = self._return(at, pressed)
        elastic = -k * np.einsum("nri,niz->nrz", moved.along, moved.by_z)
        turned = _along(moved.along_by_s, sliding.elastic) - k * _along(moved.along, moved.moved_by_s)
        elastic += turned[:, :, None] * by_place[:, None]
        components = by_elastic @ elastic - by_penetration[:, :, None] * forms[:, None, 0]
        out = np.einsum("nri,nrz->niz", moved.along, components)
        return np.asarray(out + np.einsum("nri,nr->ni", moved.along_by_s, t)[:, :, None] * by_place[:, None])

    def anew(self) -> PointMemory:
        """The next step starts from a surface with other nodes: tractions of the points, to go over to them."""
        self._at_start = None
        return self._memory

    def energy(self, state: State) -> Energy:
        """Stored in what the surface gives elastically along itself."""
        sliding = self.evaluate(state)
        return Energy(potential=self._stored(sliding.traction, sliding.found.pressed.points.area))

    def _stored(self, traction: Array, area: Array) -> float:
        return float(0.5 / self._stiffness * np.sum(area * np.sum(traction**2, axis=1)))

    def work(self, before: State, after: State) -> Work:
        """Energy dissipated by friction: its work less the change of the energy stored; never negative."""
        sliding, kept = self.evaluate(after), self._memory.rows
        area = sliding.found.pressed.points.area
        taken = -float(np.sum(area[:, None] * sliding.traction * sliding.moved.moved))
        return Work(dissipated=taken - self.energy(after).potential + self._stored(kept[:, :AREA], kept[:, AREA]))

    def commit(self, state: State) -> None:
        """Keep the tractions."""
        sliding = self.evaluate(state)
        points = sliding.found.pressed.points
        self._slid = self._slid + self._nodal_slip(sliding)
        self._memory.keep(points.number, np.column_stack([sliding.traction, points.area]))
        self._at_start = None

    def _nodal_slip(self, sliding: SlidingState) -> Array:
        """Plastic slip in the step at the nodes (nn,) [m]: the mean over the points that press, shared by two nodes."""
        pressed = sliding.found.pressed
        plastic = _along(sliding.moved.along, sliding.traction - sliding.elastic) / self._stiffness
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
        return self.contact.within_line(self.evaluate(state).on_riser.sum(axis=0))

    def force_on_soil(self, state: State) -> Array:
        """Sum of the friction on the soil (3,) [N], global axes."""
        return np.asarray(-self.evaluate(state).on_riser.sum(axis=0)) if self.line.active else np.zeros(3)

    def force_on_soil_per_length(self, state: State) -> Array:
        """The points' friction on the nodes of their facets (nn, 3) [N/m], shared by two nodes of the riser."""
        if not self.line.active:
            return np.zeros((self.line.nodes, 3))
        sliding = self.evaluate(state)
        return self.contact.soil_per_length(sliding.found.pressed.points, sliding.on_riser)

    def state(self) -> Saved:
        return {"slid": self._slid} | gathered({"points": self._memory})

    def restore(self, saved: Saved) -> None:
        self._slid, self._at_start = saved["slid"], None
        self._memory.restore(within(saved, "points"))


def _along(directions: Array, vectors: Array) -> Array:
    """Components (n, r) of vectors (n, 3) by directions (n, r, 3)."""
    return np.asarray(np.einsum("nri,ni->nr", directions, vectors))
