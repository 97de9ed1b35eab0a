"""Contact of the riser with the soil's surface: the part "contact", whatever points of either look at the other."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from riser_soil.contact.along_step import landing_predictor
from riser_soil.contact.contact import RiserContact
from riser_soil.contact.ground import CandidatePairs, DeformedSurface
from riser_soil.contact.on_condensed_soil import Touched
from riser_soil.contact.pairing import Cover, facet_below
from riser_soil.contact.seabed_contact import Covering
from riser_soil.contact.touchdown import PointsAlong
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.part import Energy, MatrixBlock, State, Traits, Work
from riser_soil.core.roles import Adaptive, Predictor
from riser_soil.core.saved_state import Saved, Stateful
from riser_soil.riser.line import Line
from riser_soil.riser.vectors import Vec
from riser_soil.seabed.law import NormalLaw
from riser_soil.seabed.points import covered_by

if TYPE_CHECKING:
    from riser_soil.soil.condensed import SoilSurface

SOIL = "contact.soil"


@dataclass(frozen=True)
class CandidateRange:
    """Candidates: nodes or elements up to `above` [m] over the ground, facets up to `around` [m] beside them."""

    above: float
    around: float = 0.0


class SoilContact(RiserContact):
    """Base of the frictionless penalty contacts between riser and soil, in group E.

    Their tangent has a block for each pair of a node or element of the riser and a facet of the soil's surface. Its
    pattern has the candidate pairs, which may come to touch; the line solver looks at no others. outgrown: a pair has
    touched that has no place in the pattern, so that its tangent is missing, not its residual.

    line: the riser's field; the rank where it is active evaluates contact, and holds the surface. A `place` is what the
    contact knows of the riser: its nodes, or its axis.
    """

    name = "contact"
    traits = Traits("E", symmetric=True, roles=(Adaptive, Predictor, Stateful))
    _reach: CandidateRange

    def __init__(self, line: Line, law: NormalLaw, surface: SoilSurface) -> None:
        super().__init__(line, law)
        self.outgrown = False
        self._stored: float | None = None  # [J] at the accepted state, once it is known
        if not self.active:
            return
        self._soil = DeformedSurface(surface)
        self._patch: CandidatePairs | None = None
        self._missed = CandidatePairs.none(len(self._soil.facets))

    @property
    def around(self) -> float:
        """How far beside the riser facets are candidates [m]."""
        return self._reach.around

    @abstractmethod
    def place(self, state: State) -> Any:
        """Where the riser is at a state."""

    @abstractmethod
    def candidates(self, places: Sequence[Any], surface: Array) -> CandidatePairs:
        """Pairs that may touch near places of the riser, over the surface with its points (np, 3) [m] there."""

    @abstractmethod
    def pair_dofs(self, on_line: IntArray, facet: IntArray) -> IntArray:
        """Local dofs (m, nr) of pairs of a node or element and a facet, (m,) each."""

    @abstractmethod
    def potential(self, state: State) -> float:
        """Energy stored [J] at a state."""

    @abstractmethod
    def work_to(self, state: State) -> float:
        """Work [J] of riser and soil against the forces at a state, on the way there from the accepted state."""

    @abstractmethod
    def kernel_data(self, deformed: Array, touched: Touched) -> Any:
        """Kernel data for the line solver. deformed (np, 3): where it writes the surface's points [m], touched: where
        it writes the outcome.
        """

    @abstractmethod
    def at_start(self, data: Any) -> Any:
        """The kernel data for a step that starts at the accepted state, the very same where arrays are but written to.
        """

    @abstractmethod
    def place_in(self, data: Any) -> Any:
        """Where the riser was in the line solver's last trial."""

    @abstractmethod
    def watch(self, data: Any, places: Sequence[Any], pairs: CandidatePairs, slack: float) -> Any:
        """The kernel data with the pairs that are candidates near places of the riser, and how far the riser may move
        from there until others may touch, while the soil moves by no more than `slack` [m].
        """

    def with_room(self, data: Any) -> Any:
        """The kernel data with room for more points, where the last trial had too little; by default all have room."""
        return data

    @abstractmethod
    def adopt(self, state: State, data: Any) -> None:
        """Adopt the line solver's evaluation of contact at a state."""

    @abstractmethod
    def clearance(self, state: State) -> Array:
        """Gap (nn,) of the nodes less that at which the force begins [m], inf far away; called only on the rank that
        evaluates contact.
        """

    @abstractmethod
    def force_on_soil(self, state: State) -> Array:
        """Sum of the contact forces on the soil (3,) [N], global axes."""

    @abstractmethod
    def force_on_soil_per_length(self, state: State) -> Array:
        """Contact force on the soil by length of the riser at its nodes (nn, 3) [N/m], global axes: what the nodes of
        the soil get, counted where the riser presses.
        """

    @abstractmethod
    def stretch(self, state: State) -> float:
        """Largest area of a facet that presses, projected along its first normal, over its first area; 1 of none."""

    def blocks(self) -> dict[str, MatrixBlock]:
        """Dofs of a node or element and of a facet, candidate pair by pair."""
        patch = self._present_patch()
        rows = self.pair_dofs(patch.on_line, patch.facet)
        return {SOIL: MatrixBlock(rows, rows, patch.filled)}

    def rebuild(self, state: State) -> None:
        """Choose the candidates anew: around a state, and all that was missed in the step so far."""
        if self.active:
            self._patch = self._around(state).joined(self._missed)
        self.outgrown = False

    def _around(self, state: State) -> CandidatePairs:
        return self.candidates([self.place(state)], self._soil.deformed(state))

    def nodes_of(self, pairs: CandidatePairs) -> IntArray:
        """Nodes (k,) of the surface that pairs have in their facets."""
        return np.unique(self._soil.facets[pairs.facet])

    def energy(self, state: State) -> Energy:
        """Potential of the penalty."""
        return Energy(potential=self.potential(state))

    def work(self, before: State, after: State) -> Work:
        """Energy dissipated: the work of the force at the end of the step less the change of its potential, all of it
        by the time scheme.

        ψ is convex in the gap, so this is ≥ 0 where the gap is linear in the step, as where soil and riser move
        vertically. Sliding along a sloping ground adds terms of second order in the sliding distance, of either sign.
        """
        stored, extracted = self.potential(before) if self._stored is None else self._stored, self.work_to(after)
        lost = extracted - self.potential(after) + stored
        return Work(dissipated=lost, by_scheme=self.lost_by_scheme(extracted, lost, before, after))

    def lost_by_scheme(self, extracted: float, lost: float, before: State, after: State) -> float:
        """The time scheme's share [J] of what is lost in a step; extracted: work of the forces in it [J]."""
        return lost

    def commit(self, state: State) -> None:
        """Keep the energy stored; pairs missed on the way do not matter to the next step."""
        self._missed = CandidatePairs.none(len(self._soil.facets))
        self._stored = self.potential(state)

    def places(self, values: Array, on_line: IntArray, facet: IntArray) -> IntArray:
        """Places (m,) of pairs in the pattern, and so in the matrix's `values`, which are to be filled; -1 of pairs
        that the pattern does not have, which are noted.
        """
        patch = self._present_patch()
        if len(values) != len(patch.pairs):
            raise RuntimeError("contact on soil: its pattern was rebuilt, and the matrix is that of the one before")
        places = patch.places(on_line, facet)
        missed = places < 0
        if missed.any():
            self.outgrown = True
            outside = CandidatePairs.of(len(self._soil.facets), on_line[missed], facet[missed])
            self._missed = self._missed.joined(outside)
        patch.filled[places[~missed]] = True
        return places

    def _present_patch(self) -> CandidatePairs:
        if self._patch is None:
            self._patch = self._around(self.accepted)
        return self._patch

    @property
    def accepted(self) -> State:
        """The accepted state of line and soil: no increments of all dofs up to the last of theirs."""
        return State.at_rest(0.0, max(self.line.part.stop, self._soil.end))

    @property
    def settled(self) -> Array:
        """Points (np, 3) of the soil's surface as accepted so far [m]."""
        return self._soil.settled

    @property
    def covering(self) -> Covering:
        """What covers a seabed beside it: the soil as it is now. Used where contact is active."""
        return Covering(self._cover, self._renew_cover)

    def _cover(self) -> Cover:
        return self._soil.cover()

    def _renew_cover(self, cover: Cover) -> None:
        cover.renew(self._soil.settled)

    def settlement(self, xy: Array, state: State) -> Array:
        """Settlement (n,) [m] of the soil's surface at horizontal positions (n, 2) [m] since before the riser came.

        Positive downwards, nan beside the soil. Called only on the rank that evaluates contact.
        """
        soil = self._soil
        return soil.height(xy, soil.at_first) - soil.height(xy, soil.deformed(state))

    @property
    def along(self) -> PointsAlong:
        """Points along the line: its nodes."""
        return PointsAlong(self.line.arc, self.line.tributary_length)

    def contact_along_line(self, state: State) -> tuple[Array, Array]:
        return self.clearance(state), self.force_per_length(state)

    def results(self, state: State) -> Array:
        """Results at an accepted state in one vector, in the order of `ContactResults`."""
        of_nodes = self.force_per_length(state), self.penetration(state), self.depth(state)
        whole = [self.max_penetration(state)], self.force_on_riser(state)
        return np.concatenate([*of_nodes, *self.contact_along_line(state), *whole])

    def penetration(self, state: State) -> Array:
        """Penetration (nn,) [m] of the nodes' undersides into the ground as it is now, 0 above it."""
        if not self.active:
            return np.zeros(self.line.nodes)
        return np.maximum(0.0, -self.clearance(state) - self.law.start)

    def predict(self, guess: State) -> Array:
        """First guess of a step's increments (size,), changed so that nodes which would pass through the top land on
        it.
        """
        if not self.active:
            return guess.u
        present = self.clearance(self.accepted)
        heights, guessed = self.line.translation_dofs[:, -1], self.clearance(guess)
        return landing_predictor(guess, heights, present, guessed, self.law.start)

    def state(self) -> Saved:
        """The pattern and the energy stored, lest a run that is resumed differ by round-off."""
        if not self.active:
            return {}
        stored = {} if self._stored is None else {"stored": np.array(self._stored)}
        return {"patch": self._present_patch().pairs} | stored

    def restore(self, saved: Saved) -> None:
        if self.active:
            self._patch = CandidatePairs(len(self._soil.facets), saved["patch"])
            self._stored = float(saved["stored"]) if "stored" in saved else None


@covered_by.of(Cover)
def _by_surface(cover: Cover, x: Vec, previous: int) -> int:
    return facet_below(cover, x[0], x[1], previous)
