"""Contact of the riser with a rigid, spring or hysteretic seabed, integrated along its elements."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, Protocol

import numpy as np

from riser_soil.contact import seabed_stations
from riser_soil.contact.along_step import landing_predictor, work_along_step
from riser_soil.contact.contact import ContactResults, LineContact, size_of
from riser_soil.contact.law import Penalty
from riser_soil.contact.seabed_loop import SeabedData, seabed_data
from riser_soil.contact.seabed_stations import StationForces
from riser_soil.contact.touchdown import PointsAlong
from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.part import Energy, Forces, State, Traits, Weights, Work
from riser_soil.core.roles import Predictor
from riser_soil.core.saved_state import Saved, Stateful
from riser_soil.riser import stations
from riser_soil.riser.line import Line
from riser_soil.riser.sections import larger_beside
from riser_soil.riser.trial import Trial
from riser_soil.seabed.grounds import Ground, Plane
from riser_soil.seabed.law import NormalLaw

CoveredBySoil = Callable[[Array], BoolArray]


"""Horizontal positions (n, 2) [m] -> whether something other than the seabed lies there, such as a block of soil."""


class Covering(Protocol):
    """What lies on the seabed in places as compiled code has it, see `CoveredBySoil`."""

    def cover(self) -> Any:
        """Its numbers, of a type with a kernel of `seabed_loop.covered_by`."""
        ...

    def renew_cover(self, cover: Any) -> None:
        """Let it be that of the present place."""
        ...


class ContactElements(NamedTuple):
    """Elements in contact at a trial state: m elements, ng stations each, d dimensions.

    elements (m,). force, slope (m, ng): force per length [N/m] and its derivative by the penetration [N/m2].
    normal (m, ng, d): gradient of the distance from the ground; bend (m, ng, d, d) its derivative, None where zero.
    resistance (m, ng, d): minus the force per length on the riser [N/m]. stored (m, ng): energy per length [N].
    """

    elements: IntArray
    force: Array
    slope: Array
    normal: Array
    bend: Array | None
    resistance: Array
    stored: Array


class StationContact(NamedTuple):
    """Contact kinematics of the line at a trial state: position (ne, ng, d) and penetration (ne, ng) of the stations
    [m]; normal (ne, ng, d): gradient of their distance from the ground.
    """

    position: Array
    penetration: Array
    normal: Array
    touching: ContactElements


class SeabedContact(LineContact):
    """Part "seabed": force per length of riser by its penetration into the ground, in group E.

    line: the riser's field. radius (ne,): distance [m] from the axis to the line that touches, 0 for the axis itself.
    rule: the stations of an element, Gauss points by default; its two ends make it the classical contact of nodes.
    covered: where the seabed does not act; covering: the same for compiled code. at: the stations; share (ne, ng): arc
    length that each stands for [m].
    memory (ne, ng, nh): the law's history.
    """

    name = "seabed"

    def __init__(
        self,
        line: Line,
        radius: Array,
        ground: Ground,
        law: NormalLaw,
        rule: stations.QuadratureRule = stations.THREE_POINTS,
        covered: CoveredBySoil | None = None,
        covering: Covering | None = None,
    ) -> None:
        super().__init__(line, law)
        self.ground, self._radius, self._covered, self._covering = ground, radius, covered, covering
        self._frame = seabed_stations.frame_of(line)
        self.at = stations.stations(line.length, rule)
        self._forces = StationForces(line, self.at)
        self.share = line.length[:, None] * rule.weights
        arc = line.arc[:-1, None] + line.length[:, None] * rule.points
        self._along = PointsAlong(arc.ravel(), self.share.ravel())
        linear = np.stack([1.0 - rule.points, rule.points])
        self._nodes = seabed_stations.OverNodes(larger_beside(radius), line.tributary_length, linear)
        self.memory = law.initial_history((line.length.size, rule.points.size))
        roles = Predictor, Stateful
        self.traits = Traits("E", symmetric=True, path_dependent=True, gradual=law.gradual, roles=roles)

    def evaluate(self, trial: Trial) -> StationContact:
        """The stations over the ground, and what touches."""
        found: StationContact = trial.once((self, "stations"), self._evaluate)
        return found

    def _evaluate(self, trial: Trial) -> StationContact:
        x = stations.interpolate(self.at, trial.q)
        penetration, normal, bend = self._over_ground(x, self._radius)
        at = seabed_stations.touched(self.law.kernel_data, penetration, self.memory)
        force, slope, stored, normals, resistance = seabed_stations.answers(
            self.law.kernel_data, at, penetration, self.memory, normal
        )
        bends = None if self.ground.flat else bend[at]
        return StationContact(
            x, penetration, normal, ContactElements(at, force, slope, normals, bends, resistance, stored)
        )

    def _over_ground(self, x: Array, radius: Array) -> tuple[Array, Array, Array]:
        """Penetration (ne, ng) of stations x (ne, ng, d), its normal, and the normal's derivative, empty where zero;
        radius (ne,): as of the contact.
        """
        found = self._penetration(x, radius)
        if self._covered is not None:
            covered = self._covered(self.line.to_global(x).reshape(-1, 3)[:, :2])
            found[0][covered.reshape(found[0].shape)] = -np.inf
        return found

    def _penetration(self, x: Array, radius: Array) -> tuple[Array, Array, Array]:
        """The same, whatever covers the ground."""
        ne, ng, d = x.shape
        found = np.empty((ne, ng)), np.empty((ne, ng, d)), np.empty((0 if self.ground.flat else ne, ng, d, d))
        seabed_stations.over_ground(self._frame, self.ground.kernel_data, radius, x, *found)
        return found

    def element_forces(self, state: State) -> tuple[None, Array]:
        """Element residuals (inertia, force), each (ne, 2 ndof) or None."""
        trial = self.line.trial(state)
        touching = self.evaluate(trial).touching
        return None, self._forces.in_elements(trial, touching.elements, touching.resistance)

    def residual(self, state: State, forces: Forces) -> None:
        self.line.scatter(self.element_forces(state)[1], forces.end)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        """Unweighted: contact stands at the end of the step."""
        trial = self.line.trial(state)
        t = self.evaluate(trial).touching
        self._forces.add_tangent(values[self.line.name], trial, t.elements, t.resistance, self._by_position(t))

    def _by_position(self, t: ContactElements) -> Array:
        """Derivative (m, ng, d, d) of the resistance by the position."""
        found: Array = seabed_stations.by_positions(t.force, t.slope, t.normal, t.bend)
        return found

    def kernel_data(self) -> SeabedData | None:
        if self._covered is not None and self._covering is None:
            return None
        stations = self.at, self.share, self._radius, self.memory, self._nodes
        cover = None if self._covering is None else self._covering.cover()
        self.in_loop = seabed_data(self.line, *stations, self.ground.kernel_data, self.law, cover)
        return self.in_loop

    def renew_kernel_data(self, start: float, end: float) -> None:
        if self.memory is not self.in_loop.memory:  # else the loop has kept it
            self.in_loop.memory[:] = self.memory
            self.memory = self.in_loop.memory
        if self._covering is not None:
            self._covering.renew_cover(self.in_loop.cover)

    def energy(self, state: State) -> Energy:
        """Energy stored by the law, which it can return."""
        touching = self.evaluate(self.line.trial(state)).touching
        return Energy(potential=seabed_stations.integral(self.share, touching.elements, touching.stored))

    def work(self, before: State, after: State) -> Work:
        """Energy dissipated: the work of the force at the end of the step less the change of the energy stored.

        Never negative on a plane, where the stored energy is convex in the penetration. What that force takes beyond
        the work of the law along the step is the time scheme's; on ground without a history it is all.
        """
        first, last = (self.evaluate(self.line.trial(state)) for state in (before, after))
        t = last.touching
        taken = seabed_stations.work_of(self.share, t.elements, t.resistance, first.position, last.position)
        lost = taken - self.energy(after).potential + self.energy(before).potential
        return Work(dissipated=lost, by_scheme=taken - self._by_law(first, last) if self.law.columns else lost)

    def _by_law(self, first: StationContact, last: StationContact) -> float:
        """Work [J] of the law along a step."""
        work = work_along_step(self.law, first.penetration, last.penetration, self.memory)
        return float(np.sum(self.share * work))

    def commit(self, state: State) -> None:
        """Keep the law's history."""
        if self.memory.size:
            found = self.evaluate(self.line.trial(state))
            self.memory = self.law.update(found.penetration, self.memory).history

    def results(self, state: State) -> Array:
        """See `ContactResults.within`."""
        found: Array = self.line.trial(state).once((self, "results"), self._results_at)
        return found

    def _results_at(self, trial: Trial) -> Array:
        out = np.zeros(size_of(self.line.nodes, self.share.size))
        if self.active:
            found, results = self.evaluate(trial), ContactResults.within(out, self.line.nodes, self.share.size)
            touching, force = np.zeros(len(self.share), dtype=bool), np.zeros_like(self.share)
            touching[found.touching.elements], force[found.touching.elements] = True, found.touching.force
            over = self._frame, self.ground.kernel_data, self._nodes, float(self.law.start), self.share, trial.x
            seabed_stations.put_contact(*over, (touching, found.penetration, force, found.normal), results)
            if self._covered is not None:
                below = self._covered(self.line.to_global(trial.x)[:, :2])
                results.penetration[below] = results.depth[below] = 0.0
        return out

    def _results(self, state: State) -> ContactResults:
        return ContactResults.within(self.results(state), self.line.nodes, self.share.size)

    def force_per_length(self, state: State) -> Array:
        """Contact force per length at the nodes (nn,) [N/m]: the stations' forces, shared linearly by two nodes."""
        return self._results(state).force_per_length

    def at_nodes(self, values: Array) -> Array:
        """Means at the nodes (nn,) of values at the stations (ne, ng), which count with their share of arc length."""
        return np.asarray(seabed_stations.shared(self.share * values, self._nodes.linear) / self._nodes.length)

    def penetration(self, state: State) -> Array:
        """Penetration (nn,) [m] of the nodes' undersides, 0 above the ground."""
        return self._results(state).penetration

    def depth(self, state: State) -> Array:
        """The same: this ground is where it lay at first."""
        return self._results(state).depth

    def max_penetration(self, state: State) -> float:
        """Deepest penetration of a station [m], >= 0: an error where the ground is rigid."""
        return float(self._results(state).deepest[0])

    def force_on_riser(self, state: State) -> Array:
        """Sum of the contact forces on the riser (3,) [N], global axes."""
        return self._results(state).on_riser

    @property
    def along(self) -> PointsAlong:
        """The stations, ne ng points."""
        return self._along

    def contact_along_line(self, state: State) -> tuple[Array, Array]:
        found = self._results(state)
        return found.clearance, found.force

    def _clearance(self, x: Array, radius: Array) -> Array:
        """Gap (n,) of places x (n, d) with radii (n,) less that at which the force begins [m]."""
        penetration, _, _ = self._over_ground(x[:, None], radius)
        return -penetration[:, 0] - self.law.start

    def predict(self, guess: State) -> Array:
        """Increments of a first guess that lands, see `along_step`; into soft clay the riser sinks on as it does."""
        if not self.active or self.traits.gradual:
            return guess.u
        if self._covered is None:
            increments = guess.u.copy()
            ground, moved = self.ground.kernel_data, self.line.nodal(increments)
            seabed_stations.land(self._frame, ground, self._nodes.radius, self.law.start, self.line.x, moved)
            return increments
        moved = self.line.nodal(guess.u)[:, : self.line.dimension]
        x, radius, start = self.line.x + moved, self._nodes.radius, self.law.start
        low = np.flatnonzero(self._penetration(x[:, None], radius)[0][:, 0] > -start)
        present, guessed = (self._clearance(at[low], radius[low]) for at in (self.line.x, x))
        return landing_predictor(guess, self.line.translation_dofs[low, -1], present, guessed, start)

    def state(self) -> Saved:
        return {"memory": self.memory.copy()}

    def restore(self, saved: Saved) -> None:
        self.memory = saved["memory"]


class Cushion(SeabedContact):
    """Part "cushion": a seabed of springs over the soil, whose stiffness falls with the load factor t as (1 - t)².

    At first it holds the riser just above the soil; its last share goes over to the soil at t = 1. The soil is loaded
    gradually, and Newton's method meets a contact that grows, instead of a riser that falls from its first shape into
    soil that has not felt it yet. level: of the soil's top [m]; it bears the weight per length [N/m] at a penetration
    of `depth` [m], with which the riser's underside touches the soil.
    """

    name = "cushion"

    def __init__(
        self, line: Line, radius: Array, level: float, weight: float, depth: float, covered: CoveredBySoil
    ) -> None:
        law = Penalty(weight / depth, 0.25 * depth)
        super().__init__(line, radius, Plane.level(level + depth), law, stations.THREE_POINTS, covered)

    def _evaluate(self, trial: Trial) -> StationContact:
        found, share = super()._evaluate(trial), (1.0 - min(trial.state.t, 1.0)) ** 2
        t = found.touching
        faded = t._replace(
            force=share * t.force, slope=share * t.slope, resistance=share * t.resistance, stored=share * t.stored
        )
        return found._replace(touching=faded)
