"""Contact of the riser with a rigid, spring or hysteretic seabed, integrated along its elements."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from riser_soil.contact.along_step import Shares
from riser_soil.contact.contact import ContactResults, RiserContact, size_of, write_results
from riser_soil.contact.law import Penalty
from riser_soil.contact.seabed_kernels import (
    SeabedData,
    land,
    seabed_data,
    write_at_nodes,
)
from riser_soil.contact.touchdown import PointsAlong
from riser_soil.core.arrays import Array
from riser_soil.core.bound import Bound, Packed, bound
from riser_soil.core.part import State, Traits
from riser_soil.core.roles import Predictor
from riser_soil.core.saved_state import Saved, Stateful
from riser_soil.riser import stations
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import CompiledPart
from riser_soil.riser.vectors import Vec
from riser_soil.seabed.grounds import Ground, Plane
from riser_soil.seabed.law import NormalLaw
from riser_soil.seabed.points import UNKNOWN, covered_by


class Covering(NamedTuple):
    """What lies on the seabed in places, such as a block of soil; the seabed does not act there.

    make: makes its kernel data, of a type with a kernel of `covered_by`; renew: writes its present place to them.
    """

    make: Callable[[], Any]
    renew: Callable[[Any], None]


class SeabedContact(CompiledPart, RiserContact):
    """Part "seabed": force per length of riser by its penetration into the ground, in group E.

    line: the riser's field. radius (ne,): distance [m] from the axis to the line that touches, 0 for the axis itself.
    rule: the stations of an element, Gauss points by default; its two ends make it the classical contact of nodes.
    covering: where the seabed does not act. at: the stations; share (ne, ng): arc length that belongs to each [m].
    memory (ne, ng, nh): the law's history.
    """

    name = "seabed"
    after_forces = True
    shares: Shares | None = None  # of the law that acts, None for all of it

    def __init__(
        self,
        line: Line,
        radius: Array,
        ground: Ground,
        law: NormalLaw,
        rule: stations.QuadratureRule = stations.THREE_POINTS,
        covering: Covering | None = None,
    ) -> None:
        super().__init__(line, law)
        self.ground, self._radius, self._covering = ground, radius, covering
        self.at = stations.stations(line.length, rule)
        self.share = line.length[:, None] * rule.weights
        arc = line.arc[:-1, None] + line.length[:, None] * rule.points
        self._along = PointsAlong(arc.ravel(), self.share.ravel())
        self._linear = np.stack([1.0 - rule.points, rule.points])  # shares of stations in the nodes of their element
        self.memory = law.initial_history((line.length.size, rule.points.size))
        roles = Predictor, Stateful
        self.traits = Traits("E", symmetric=True, path_dependent=True, gradual=law.gradual, roles=roles)
        self._covered_from: Array | None = None  # the line's places as they were when the cover was renewed
        self._written_trial = -1  # count of the trial whose results were written last

    def make_kernel_data(self) -> SeabedData:
        stations = self.at, self.share, self._radius, self.memory, self._linear
        return seabed_data(self.line, *stations, self.ground, self.law, self._cover, self.shares)

    def kernel_data(self) -> SeabedData:
        data: SeabedData = self._data
        return data

    def bind(self) -> None:
        _ = self._write_results, None if self.traits.gradual else self._landing

    @cached_property
    def _cover(self) -> Any:
        """Kernel data of what lies on the ground, None for nothing."""
        return None if self._covering is None else self._covering.make()

    def renew_kernel_data(self, start: float, end: float) -> None:
        self._renew_cover()

    def _renew_cover(self) -> None:
        """Renew what covers the ground, which moves as the line does: when a step is accepted."""
        if self._covering is not None and self._covered_from is not self.line.x:
            self._covering.renew(self._cover)
            self._covered_from = self.line.x

    @cached_property
    def _results_vector(self) -> Array:
        return np.zeros(size_of(self.line.nodes, self.share.size))

    @cached_property
    def _write_results(self) -> Bound:
        out = ContactResults.within(self._results_vector, self.line.nodes, self.share.size)
        return bound(write_results, self._data, Packed(self._trials.now.at), Packed(out))

    def results(self, state: State) -> Array:
        """Results at an accepted state in one vector, in the order of `ContactResults`."""
        if self.active:
            self.find(state)
            if self._written_trial != self._alone.evaluated_at:
                self._write_results()
                self._written_trial = self._alone.evaluated_at
        return self._results_vector.copy()

    def _results(self, state: State) -> ContactResults:
        return ContactResults.within(self.results(state), self.line.nodes, self.share.size)

    def force_per_length(self, state: State) -> Array:
        """Contact force per length at the nodes (nn,) [N/m]: the stations' forces, shared linearly by two nodes."""
        return self._results(state).force_per_length

    def write_at_nodes(self, values: Array, out: Array) -> Bound:
        """A kernel that writes means at the nodes (nn,) of values at the stations (ne, ng), by shares of arc length."""
        return Bound(write_at_nodes, *map(Packed, (self._data.nodes, self.share, values, out)))

    def penetration(self, state: State) -> Array:
        """Penetration (nn,) [m] of the nodes' undersides, 0 above the ground."""
        return self._results(state).penetration

    def depth(self, state: State) -> Array:
        """Depth (nn,) [m] of the nodes' undersides below the ground as it lay at first: here the penetration."""
        return self._results(state).depth

    def max_penetration(self, state: State) -> float:
        """Deepest penetration of a station [m], >= 0: an error where the ground is rigid."""
        return float(self._results(state).deepest[0])

    def force_on_riser(self, state: State) -> Array:
        """Sum of the contact forces on the riser (3,) [N], global axes."""
        return self._results(state).on_riser

    @property
    def along(self) -> PointsAlong:
        """Points along the line: its stations, ne ng of them."""
        return self._along

    def contact_along_line(self, state: State) -> tuple[Array, Array]:
        results = self._results(state)
        return results.clearance, results.force

    def predict(self, guess: State) -> Array:
        """Increments of a first guess that lands, see `along_step`; into soft clay the riser sinks on as it does."""
        if not self.active or self.traits.gradual:
            return guess.u
        self._renew_cover()
        increments, (place, moved, landing) = guess.u.copy(), self._landing
        place[...], moved[...] = self.line.x, self.line.nodal(guess.u)
        landing()
        self.line.nodal(increments)[...] = moved
        return increments

    @cached_property
    def _landing(self) -> tuple[Array, Array, Bound]:
        place, moved = np.empty(self.line.x.shape), np.empty((self.line.nodes, self.line.ndof))
        return place, moved, Bound(land, Packed(self._data), Packed(place), Packed(moved))

    def state(self) -> Saved:
        return {"memory": self.memory.copy()}

    def restore(self, saved: Saved) -> None:
        self.memory[...] = saved["memory"]
        self._trials.forget()


class Cushion(SeabedContact):
    """Part "cushion": a seabed of springs over the soil, whose stiffness falls with the load factor t as (1 - t)².

    At first it supports the riser just above the soil; its last share goes over to the soil at t = 1. The soil is
    loaded gradually, and Newton's method meets a contact that grows, instead of a riser that falls from its first shape
    into soil that has not felt it yet. level: of the soil's top [m]; it bears the weight per length [N/m] at a
    penetration of `depth` [m], with which the riser's underside touches the soil. stays: whether its stiffness stays.
    """

    name, stays = "cushion", False
    shares: Shares

    def __init__(self, line: Line, radius: Array, level: float, weight: float, depth: float, soil: Covering) -> None:
        law, ground = Penalty(weight / depth, 0.25 * depth), Plane.level(level + depth)
        super().__init__(line, radius, ground, law, stations.THREE_POINTS, beside(soil))
        self.shares = Shares(np.ones(1), np.ones(1))

    def renew_kernel_data(self, start: float, end: float) -> None:
        super().renew_kernel_data(start, end)
        for share, t in zip(self.shares, (start, end), strict=True):
            share[0] = 1.0 if self.stays else (1.0 - min(t, 1.0)) ** 2


class BesideData(NamedTuple):
    """All places beside a soil. soil: the kernel data of what lies there."""

    soil: Any


def beside(soil: Covering) -> Covering:
    """All places beside a soil."""
    return Covering(lambda: BesideData(soil.make()), lambda data: soil.renew(data.soil))


@covered_by.of(BesideData)
def _beside(cover: BesideData, x: Vec, previous: int) -> int:
    """0 beside the soil; over it the number n of what lies there as -2 - n."""
    number = covered_by(cover.soil, x, -2 - previous if previous < UNKNOWN else UNKNOWN)
    return 0 if number < 0 else -2 - number
