"""Interface of the riser's contact with any ground, for steps, checks and results."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from riser_soil.contact.touchdown import ContactInterval, PointsAlong
from riser_soil.core.arrays import Array
from riser_soil.core.part import Part, State


@runtime_checkable
class RiserContact(Part, Protocol):
    """Normal contact of the riser, nn nodes, with a ground; friction is a part of its own.

    A rank that is not active tells of a riser that touches nothing: zeros, nan for the touchdown point, no contact
    intervals.
    """

    @property
    def along(self) -> PointsAlong:
        """Where contact forces and gaps are told along the line."""
        ...

    def results(self, state: State) -> Array:
        """All that results tell of it, see `ContactResults.within`; on the rank that evaluates contact."""
        ...

    def force_per_length(self, state: State) -> Array:
        """Contact force per length at the nodes (nn,) [N/m], > 0 where it pushes the riser away, < 0 where it sucks."""
        ...

    def penetration(self, state: State) -> Array:
        """Penetration (nn,) [m] of the nodes' undersides into the ground as it is now, 0 above it."""
        ...

    def depth(self, state: State) -> Array:
        """Depth (nn,) [m] of the nodes' undersides below the ground before the riser came, 0 above it."""
        ...

    def max_penetration(self, state: State) -> float:
        """Deepest penetration [m] of what the contact looks at, nodes or stations between them; >= 0."""
        ...

    def force_on_riser(self, state: State) -> Array:
        """Sum of the contact forces on the riser (3,) [N], global axes."""
        ...

    def touchdown_arc(self, state: State) -> float:
        """Arc length [m] of the touchdown point; nan where nothing touches. See `touchdown`."""
        ...

    def contact_intervals(self, state: State) -> list[ContactInterval]:
        """Intervals of contact along the riser, from its start on."""
        ...

    def predict(self, guess: State) -> Array:
        """Increments (all local dofs) of a first guess of a step in which the riser lands, see `landing`."""
        ...


class LoadsSoil(Protocol):
    """A part by which the riser loads the soil: contact with it, or friction there."""

    def force_on_soil_per_length(self, state: State) -> Array:
        """Force on the soil by length of the riser at its nodes (nn, 3) [N/m], global axes."""
        ...
