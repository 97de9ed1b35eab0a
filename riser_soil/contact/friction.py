"""Friction of the riser on the seabed, integrated along its elements: the part "friction"."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.contact import friction_stations, seabed_stations
from riser_soil.contact.coulomb import Adhesion, adhesions, stuck, traction
from riser_soil.contact.seabed_contact import SeabedContact, StationContact
from riser_soil.contact.seabed_loop import FrictionData
from riser_soil.contact.seabed_stations import StationForces
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.part import Energy, Forces, State, Traits, Weights, Work
from riser_soil.core.saved_state import Saved, Stateful
from riser_soil.riser import stations
from riser_soil.riser.line_part import LinePart
from riser_soil.riser.trial import Trial


class FrictionTraction(NamedTuple):
    """Elements that touch (m,); minus the traction on the riser (m, ng, d) [N/m], its derivative by the position
    (m, ng, d, d).
    """

    elements: IntArray
    resistance: Array
    by_position: Array


class FrictionState(NamedTuple):
    """State at the start of a step: positions (ne, ng, d), directions along the ground (ne, ng, d, r), axial and, in
    space, lateral; traction (ne, ng, d) on the riser.
    """

    position: Array
    along: Array
    traction: Array


class CoulombFriction(LinePart):
    """Part "friction": friction at the stations of a `SeabedContact`, whose normal forces it reads; group E.

    axial, lateral: coefficients, > 0. stiffness (ne,): of the ground along itself, per length [N/m2], see
    `mobilised_within`. adhesion: what clay holds the pipe by at most. The force acts on the axis. Directions are those
    of the start of the step; the traction is kept in the line's constant axes.
    """

    name = "friction"
    traits = Traits("E", symmetric=False, path_dependent=True, gradual=True, roles=(Stateful,))

    def __init__(
        self, contact: SeabedContact, axial: float, lateral: float, stiffness: Array, adhesion: Adhesion | None = None
    ) -> None:
        super().__init__(contact.line)
        self.contact = contact
        self._mu = np.array([axial, lateral])[: self.line.dimension - 1]
        self._stiffness, self._adhesion = stiffness, adhesion or Adhesion()
        self._start_state: FrictionState | None = None
        self._forces = StationForces(self.line, contact.at)
        self._slid: Array = np.zeros(contact.share.shape)
        self._sticks = False

    def stick(self) -> None:
        """From now on nothing slides, as in small vibrations about rest."""
        self._sticks = True
        self.line.forget()

    def evaluate(self, trial: Trial) -> FrictionTraction:
        """Tractions of the elements that touch."""
        found: FrictionTraction = trial.once((self, "sliding"), self._evaluate)
        return found

    def _evaluate(self, trial: Trial) -> FrictionTraction:
        found = self.contact.evaluate(trial)
        touching, start_state, k = found.touching, self._friction_state(trial), self._stiffness
        elastic = friction_stations.elastic_guesses(touching.elements, tuple(start_state), k, found.position)
        tractions = stuck(elastic, touching.force) if self._sticks else self._limited(elastic, found)
        resistance = friction_stations.resistances(touching.elements, start_state.along, k, tractions, touching.normal)
        return FrictionTraction(touching.elements, *resistance)

    def _limited(self, elastic: Array, found: StationContact) -> tuple[Array, Array, Array]:
        pressed = found.touching
        most = adhesions(self._adhesion, found.penetration[pressed.elements])
        return traction(elastic, pressed.force, pressed.slope, self._mu, *most)

    def _friction_state(self, trial: Trial) -> FrictionState:
        return self._friction_state_from(trial.state.t)

    def _friction_state_from(self, t: float) -> FrictionState:
        if self._start_state is None:
            start = self.line.trial(State.at_rest(t, self.line.size))
            self._start_state = self._friction_state_at(start, np.zeros_like(self.contact.evaluate(start).position))
        return self._start_state

    def _friction_state_at(self, trial: Trial, traction: Array) -> FrictionState:
        found = self.contact.evaluate(trial)
        tau, _ = stations.unit_tangents(self.contact.at, trial.chord, trial.turn.tangent)
        return FrictionState(found.position, directions(tau, found.normal), traction)

    def element_forces(self, state: State) -> tuple[None, Array]:
        """Element residuals (inertia, force), each (ne, 2 ndof) or None."""
        trial = self.line.trial(state)
        sliding = self.evaluate(trial)
        return None, self._forces.in_elements(trial, sliding.elements, sliding.resistance)

    def residual(self, state: State, forces: Forces) -> None:
        self.line.scatter(self.element_forces(state)[1], forces.end)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        """Unweighted: friction stands at the end of the step."""
        trial = self.line.trial(state)
        self._forces.add_tangent(values[self.line.name], trial, *self.evaluate(trial))

    def kernel_data(self) -> FrictionData | None:
        """After those of its contact have been asked for."""
        shape, d = self.contact.share.shape, self.line.dimension
        vectors = (np.zeros((*shape, d)) for _ in range(3))
        position, traction, resistance = vectors
        along, mu = np.zeros((*shape, d, d - 1)), (float(self._mu[0]), float(self._mu[-1]))
        self._in_loop = FrictionData(
            *(self.contact.in_loop, mu, self._adhesion, self._stiffness),
            *(position, along, traction, np.zeros(shape), resistance),
        )
        return self._in_loop

    def renew_kernel_data(self, start: float, end: float) -> None:
        start_state, numbers = self._friction_state_from(end), self._in_loop
        if start_state.position is not numbers.position:  # else the loop has kept it
            numbers.position[:], numbers.along[:], numbers.traction[:] = start_state
            numbers.slid[:] = self._slid
            self._start_state, self._slid = (
                FrictionState(numbers.position, numbers.along, numbers.traction),
                numbers.slid,
            )

    def energy(self, state: State) -> Energy:
        """Stored in what the ground gives elastically along itself."""
        sliding = self.evaluate(self.line.trial(state))
        return Energy(potential=self._stored(sliding.elements, sliding.resistance))

    def _stored(self, elements: IntArray, traction: Array) -> float:
        return float(friction_stations.stored(self.contact.share, elements, self._stiffness, traction))

    def work(self, before: State, after: State) -> Work:
        """Energy dissipated by friction: its work less the change of the energy stored; never negative."""
        trial = self.line.trial(after)
        sliding, start_state, share = self.evaluate(trial), self._friction_state(trial), self.contact.share
        way = start_state.position, self.contact.evaluate(trial).position
        taken = seabed_stations.work_of(share, sliding.elements, sliding.resistance, *way)
        stored = self._stored(np.arange(self.line.length.size), start_state.traction)
        return Work(dissipated=taken - self.energy(after).potential + stored)

    def commit(self, state: State) -> None:
        """Keep the traction, and the place and directions from which the next step slides."""
        trial = self.line.trial(state)
        sliding = self.evaluate(trial)
        traction = np.zeros_like(self.contact.evaluate(trial).position)
        traction[sliding.elements] = -sliding.resistance
        slid = self._slide(trial, sliding)
        self._start_state, self._slid = self._friction_state_at(trial, traction), self._slid + slid

    def _slide(self, trial: Trial, sliding: FrictionTraction) -> Array:
        """Plastic slip of each station (ne, ng) in the step, beyond the elastic mobilisation [m]."""
        found, start_state = self.contact.evaluate(trial), tuple(self._friction_state(trial))
        slid: Array = friction_stations.slips(
            sliding.elements, start_state, self._stiffness, found.position, sliding.resistance, found.touching.force
        )
        return slid

    def slip(self) -> Array:
        """Accumulated slip of the riser over the ground at its nodes (nn,) [m], >= 0."""
        return self.contact.at_nodes(self._slid)

    def force_on_riser(self, state: State) -> Array:
        """Sum of the friction on the riser (3,) [N], global axes."""
        if not self.line.active:
            return np.zeros(3)
        sliding = self.evaluate(self.line.trial(state))
        per_station = self.contact.share[sliding.elements][..., None] * sliding.resistance
        return np.asarray(-self.line.basis @ per_station.sum(axis=(0, 1)))

    def state(self) -> Saved:
        """The state at the start of the next step, if there was one, and the slip of the stations."""
        kept = {"slid": self._slid} | (self._start_state._asdict() if self._start_state is not None else {})
        return {name: values.copy() for name, values in kept.items()}

    def restore(self, saved: Saved) -> None:
        start_state = [saved[name] for name in FrictionState._fields if name in saved]
        self._start_state, self._slid = FrictionState(*start_state) if start_state else None, saved["slid"]


def mobilised_within(
    mobilisation: float, axial: float, lateral: float, weight: Array, most: float = np.inf
) -> Array:
    """Stiffness (ne,) [N/m2] at which the larger coefficient is mobilised after so long a slide [m] under the weight
    (ne,) [N/m], or an adhesion that is less [N/m].
    """
    return np.asarray(np.minimum(max(axial, lateral) * weight, most) / mobilisation)


def directions(tau: Array, normal: Array) -> Array:
    """Unit vectors (ne, ng, d, d - 1) along the ground: axial, and in space lateral, from the riser's tangents and the
    ground's normals (ne, ng, d); zero where the riser stands upright on the ground.
    """
    found: Array = friction_stations.directions(np.ascontiguousarray(tau), np.ascontiguousarray(normal))
    return found
