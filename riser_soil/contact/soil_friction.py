"""Friction between the pipe's cylinder and the soil's surface, point by point: the part "soil friction"."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from riser_soil.contact.integration_points import PointMemory
from riser_soil.contact.near_points import NearPoints
from riser_soil.contact.on_condensed_soil import POINTS
from riser_soil.contact.pressed_points import PressedPoints
from riser_soil.contact.sliding_points import (
    AREA,
    Resistance,
    SlidingPoints,
    SoilFrictionData,
    find_tractions,
    friction_tangents,
    sliding_workspace,
)
from riser_soil.contact.surface_contact import SurfaceContact, SurfaceState
from riser_soil.contact.surface_kernels import SurfaceContactData
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.part import Energy, Forces, MatrixBlock, State, Traits, Weights, Work
from riser_soil.core.saved_state import Saved, Stateful, gathered, within
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart


@dataclass(frozen=True, eq=False)
class SlidingState:
    """Friction at a state, at the n points that press; contact: the state of these."""

    contact: SurfaceState
    points: SlidingPoints


SoilAdhesion = Callable[[IntArray, Array], Array]
"""Facets (n,) and heights of points on them before the riser came (n,) [m] -> the soil's adhesion there (n,) [Pa]."""


class SoilFriction(LinePart):
    """Part "soil friction": friction at the integration points of a `SurfaceContact`; group E.

    memory: tractions [Pa] and areas [m2] of points, kept from step to step.
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
        self.memory = PointMemory(np.zeros(AREA + 1))
        self._slid: Array = np.zeros(self.line.nodes)

    def stick(self) -> None:
        """From now on nothing slides, as in small vibrations about rest."""
        self._resistance, self._adhesion = self._resistance._replace(mu=np.full(2, np.inf)), None
        self.line.forget()

    def blocks(self) -> dict[str, MatrixBlock]:
        """Blocks of contact."""
        return self.contact.blocks()

    def evaluate(self, state: State) -> SlidingState:
        """Tractions of the points that press. What the trial caches doesn't refer to it, as in contact."""
        contact = self.contact.evaluate(state)
        points: SlidingPoints = contact.trial.once((self, "sliding"), lambda _: self._evaluate(contact.pressed))
        return SlidingState(contact, points)

    def _evaluate(self, pressed: PressedPoints) -> SlidingPoints:
        start = self.contact.start()
        out = sliding_workspace(len(pressed.force))
        out.before[...], out.most[...] = self.memory.at(pressed.points.number), self._most(pressed.points)
        touching = pressed.points, len(out.most), pressed.force
        find_tractions(self._resistance, *touching, start, pressed.axis, pressed.surface, out)
        return out

    def _most(self, points: NearPoints) -> Array | float:
        """Adhesion of points (n,) [Pa]."""
        return np.inf if self._adhesion is None else self._adhesion(points.facet, self.contact.first_heights(points))

    def kernel_data(self, contact: SurfaceContactData) -> SoilFrictionData:
        """Kernel data for the line solver, on soil that does not yield; contact: those of the contact."""
        assert self._adhesion is None
        room, q = sliding_workspace(len(contact.pressed.force)), np.zeros((self.line.length.size, 4, 3))
        return SoilFrictionData(contact, self._resistance, self.memory.history, q, room)

    def at_start(self, data: SoilFrictionData, contact: SurfaceContactData) -> SoilFrictionData:
        """The kernel data for a step that starts at the accepted state, beside those that the contact has now; the very
        same where arrays are but written to.
        """
        data.q[...] = self.contact.start()[0]
        if data.contact is contact and data.history is self.memory.history:
            return data
        room, wanted = data.points, len(contact.pressed.force)
        points = room if len(room.most) == wanted else sliding_workspace(wanted)
        return data._replace(contact=contact, history=self.memory.history, points=points)

    def adopt(self, state: State, data: SoilFrictionData) -> None:
        """Adopt the line solver's evaluation of friction at a state, after contact's."""
        n = data.contact.touched.counts[POINTS]
        points = SlidingPoints(*(each[:n].copy() for each in data.points))
        self.line.trial(state).once((self, "sliding"), lambda _: points)

    def element_forces(self, state: State) -> Array:
        """Element residual (ne, 2 ndof)."""
        sliding = self.evaluate(state)
        return sliding.contact.on_elements(sliding.contact.pressed.spread(sliding.points.on_riser)[0])

    def residual(self, state: State, forces: Forces) -> None:
        sliding = self.evaluate(state)
        self.contact.add_residual(sliding.contact, sliding.points.on_riser, forces)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        """Add the derivative of the residual, unweighted: friction is that at the end of the step."""
        sliding = self.evaluate(state)
        at, P, start = sliding.contact.pressed, sliding.contact.trial.turn.P, self.contact.start()
        pressed = at.points, at.force, at.slope
        by_dofs = friction_tangents(
            self._resistance, *pressed, start, at.axis, at.surface, at.basis, at.forms[0], at.pairs, sliding.points, P
        )
        self.contact.add_tangent(values, sliding.contact, by_dofs, sliding.points.on_riser)

    def energy(self, state: State) -> Energy:
        """Energy stored in the elastic movement of the surface along itself."""
        sliding = self.evaluate(state)
        return Energy(potential=self._stored(sliding.points.traction, sliding.contact.pressed.points.area))

    def _stored(self, traction: Array, area: Array) -> float:
        """Energy stored [J] by tractions (n, 3) [Pa] over areas (n,) [m2]."""
        return float(0.5 / self._resistance.stiffness * np.sum(area * np.sum(traction**2, axis=1)))

    def work(self, before: State, after: State) -> Work:
        """Energy dissipated: the work that friction extracts less the change of the energy stored; never negative."""
        points, history = self.evaluate(after).points, self.memory.rows
        extracted = -float(np.sum(points.on_riser * points.moved))
        stored_before = self._stored(history[:, :AREA], history[:, AREA])
        return Work(dissipated=extracted - self.energy(after).potential + stored_before)

    def commit(self, state: State) -> None:
        """Keep the tractions."""
        sliding = self.evaluate(state)
        points = sliding.contact.pressed.points
        self._slid = self._slid + self._nodal_slip(sliding)
        self.memory.keep(points.number, np.column_stack([sliding.points.traction, points.area]))

    def _nodal_slip(self, sliding: SlidingState) -> Array:
        """Plastic slip in the step at the nodes (nn,) [m]: the mean over the points that press, shared by two nodes."""
        pressed, points = sliding.contact.pressed, sliding.points
        plastic = np.einsum("nri,ni->nr", points.along, points.traction - points.elastic) / self._resistance.stiffness
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
        return self.contact.soil_per_length(sliding.contact.pressed.points, sliding.points.on_riser)

    def state(self) -> Saved:
        return {"slid": self._slid} | gathered({"points": self.memory})

    def restore(self, saved: Saved) -> None:
        self._slid = saved["slid"]
        self.memory.restore(within(saved, "points"))
