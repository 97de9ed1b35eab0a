"""Contact of the riser with the soil's surface: the part "contact", whatever points of either look at the other."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from riser_soil.contact.along_step import landing_predictor
from riser_soil.contact.contact import RiserContact
from riser_soil.contact.ground import CandidatePairs, DeformedSurface
from riser_soil.contact.pairing import Cover, facet_below
from riser_soil.contact.seabed_contact import Covering
from riser_soil.contact.seabed_kernels import covered_by
from riser_soil.contact.touchdown import PointsAlong
from riser_soil.core.arrays import Array, BoolArray, IntArray, as_list
from riser_soil.core.bound import Bound, Packed
from riser_soil.core.part import MatrixBlock, Part, State, Traits, Work
from riser_soil.core.roles import Adaptive, Predictor
from riser_soil.core.saved_state import Saved, Stateful
from riser_soil.riser.line import Line
from riser_soil.riser.vectors import Vec
from riser_soil.seabed.law import NormalLaw

if TYPE_CHECKING:
    from riser_soil.soil.condensed import SoilSurface

SOIL = "contact.soil"
SHARE = 0.25  # of the range around the pipe by which soil may move before what may touch is looked for anew


@dataclass(frozen=True)
class CandidateRange:
    """Candidates: nodes or elements up to `above` [m] over the ground, facets up to `around` [m] beside them."""

    above: float
    around: float = 0.0


class SoilContact(RiserContact):
    """Base of the frictionless penalty contacts between riser and soil, in group E.

    Their tangent has a block for each pair of a node or element of the riser and a facet of the soil's surface. Its
    pattern holds the pairs that may come to touch. outgrown: a pair has touched that had no place in the pattern and
    was left out there, not in the residual.

    line: the riser's field; the rank where it is active evaluates contact, and holds the surface.
    """

    name = "contact"
    traits = Traits("E", symmetric=True, roles=(Adaptive, Predictor, Stateful))

    def __init__(self, line: Line, law: NormalLaw, surface: SoilSurface) -> None:
        super().__init__(line, law)
        self.outgrown = False
        if not self.active:
            return
        self._soil = DeformedSurface(surface)
        self._patch: CandidatePairs | None = None
        self._missed = CandidatePairs.none(len(self._soil.facets))

    @abstractmethod
    def candidates(self, state: State) -> CandidatePairs:
        """Pairs near each other at a state."""

    @abstractmethod
    def pair_dofs(self, on_line: IntArray, facet: IntArray) -> IntArray:
        """Local dofs (m, nr) of pairs of a node or element and a facet, (m,) each."""

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
        """Largest area of a facet that presses, seen square to it as it was, over that at first; 1 where none does."""

    def blocks(self) -> dict[str, MatrixBlock]:
        """Dofs of a node or element and of a facet, candidate pair by pair."""
        patch = self._present_patch()
        rows = self.pair_dofs(patch.nodes, patch.facet)
        return {SOIL: MatrixBlock(rows, rows, patch.filled)}

    def rebuild(self, state: State) -> None:
        """Choose the candidates anew: around a state, and all that was missed in the step so far."""
        if self.active:
            self._patch = self.candidates(state).joined(self._missed)
        self.outgrown = False

    def commit(self, state: State) -> None:
        """What the step has missed on its way is of no concern to the next."""
        self._missed = CandidatePairs.none(len(self._soil.facets))

    def places(self, values: Array, on_line: IntArray, facet: IntArray) -> IntArray:
        """Where the pattern has pairs (m,), and the matrix its `values`, to be filled; -1, which is noted, where it has
        not.
        """
        patch = self._present_patch()
        if len(values) != len(patch.pairs):
            raise RuntimeError("contact on soil: its pattern was rebuilt, and the matrix is that of the one before")
        places = patch.places(on_line, facet)
        missed = places < 0
        if missed.any():
            self.outgrown = True
            found = CandidatePairs.of(len(self._soil.facets), on_line[missed], facet[missed])
            self._missed = self._missed.joined(found)
        patch.filled[places[~missed]] = True
        return places

    def _present_patch(self) -> CandidatePairs:
        if self._patch is None:
            ends = self.line.offset + self.line.size, self._soil.end
            self._patch = self.candidates(State.at_rest(0.0, max(ends)))
        return self._patch

    @abstractmethod
    def in_loop(self, friction: Any) -> LoopContact:
        """For the line solver; friction: its kernels, see `surface_loop.LoopFriction`, None where there is none."""

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
        """The nodes."""
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
        present = self.clearance(State.at_rest(guess.t, guess.u.size))
        heights, guessed = self.line.translation_dofs[:, -1], self.clearance(guess)
        return landing_predictor(guess, heights, present, guessed, self.law.start)

    def state(self) -> Saved:
        """The pattern: another one, as wide as need be, gives the same forces but to round-off."""
        if not self.active:
            return {}
        return {"patch": self._present_patch().pairs}

    def restore(self, saved: Saved) -> None:
        if self.active:
            self._patch = CandidatePairs(len(self._soil.facets), saved["patch"])


@covered_by.of(Cover)
def _by_surface(cover: Cover, x: Vec, known: int) -> int:
    return facet_below(cover, x[0], x[1], known)


class LoopContact(ABC):
    """Contact with condensed soil in the line solver, see `solve.soil_border`: kernels, bound to where they read and
    write.

    parts: whose forces these are. deformed (np, 3): where the loop writes the top's points [m]. found (3,): see POINTS.
    met (np,): nodes of the top that are not reached, and bear a force in the last trial. energy, work (1,): stored
    then, and that of the forces along the step [J].
    """

    parts: Sequence[Part]
    deformed: Array
    met: BoolArray

    def __init__(self, contact: SoilContact, around: float) -> None:
        self.contact, self.slack = contact, SHARE * around
        self.found: IntArray = np.zeros(3, dtype=np.int64)
        self.energy: Array = np.zeros(1)
        self.work: Array = np.zeros(1)
        self._stored = dict[float, float]()  # energy [J] by the time of states

    @abstractmethod
    def begin(self, before: State) -> None:
        """Begin a step from an accepted state, at which the top's points are written."""

    @abstractmethod
    def look(self, before: State, tried: bool) -> IntArray:
        """Find what may touch near the accepted place and, where asked for, near the last trial: the top's nodes (k,).
        """

    @abstractmethod
    def forces(self, top: Packed, at: Packed, forces: Packed, border: Packed) -> list[Bound]:
        """Kernels that add to the residuals of the line and of the border."""

    @abstractmethod
    def tangent(self, top: Packed, at: Packed, K: Packed, border: Packed) -> list[Bound]:
        """Kernels that add to the tangents."""

    @abstractmethod
    def account(self, top: Packed, first: Packed) -> list[Bound]:
        """Kernels that write the work of the forces at a step's end along it, from a configuration."""

    def add_work(self, before: State, after: State, work: dict[str, Work]) -> float:
        """Add what the parts have turned over in the step solved last; the energy that they store [J]."""
        work[self.contact.name] += self._work(before, after)
        return float(self.energy[0])

    def _work(self, before: State, after: State) -> Work:
        """Work of the step solved last. A law without history dissipates nothing: what is missing is the time scheme's.
        """
        if self.contact.law.columns:
            return self.contact.work(before, after)
        first, last = self._stored.get(before.t), float(self.energy[0])
        if first is None:
            first = self.contact.energy(before).potential
        self._stored = {before.t: first, after.t: last}
        lost = float(self.work[0]) - last + first
        return Work(dissipated=lost, by_scheme=lost)

    def forget(self) -> None:
        """A step was solved elsewhere."""
        self._stored.clear()

    def state(self) -> Saved:
        """What contact has stored at the times known: found anew it would be the same but to round-off."""
        return {"times": np.array([*self._stored]), "stored": np.array([*self._stored.values()])}

    def restore(self, saved: Saved) -> None:
        self._stored = dict(zip(as_list(saved["times"]), as_list(saved["stored"]), strict=True))
