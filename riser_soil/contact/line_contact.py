"""Base class of the contacts of a line: touchdown point and contact intervals."""

from __future__ import annotations

from abc import ABC, abstractmethod

from riser_soil.contact.touchdown import ContactInterval, PointsAlong, contact_intervals, touchdown
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart
from riser_soil.seabed.law import NormalLaw


class LineContact(LinePart, ABC):
    """Base of the contacts of a line with a ground, by a law of the force per length. A `RiserContact`."""

    def __init__(self, line: Line, law: NormalLaw) -> None:
        super().__init__(line)
        self.law = law

    @property
    @abstractmethod
    def along(self) -> PointsAlong:
        """Where contact forces and gaps are told along the line."""

    @abstractmethod
    def contact_along_line(self, state: State) -> tuple[Array, Array]:
        """Gaps (n,) there, less that at which the force begins [m], and forces (n,) per length [N/m]; called only on
        the rank that evaluates contact.
        """

    def touchdown_arc(self, state: State) -> float:
        """Arc length [m] of the touchdown point; nan where nothing touches. See `touchdown`."""
        return touchdown(*self.along, *self.contact_along_line(state)) if self.active else float("nan")

    def contact_intervals(self, state: State) -> list[ContactInterval]:
        """Intervals of contact along the riser, from its start on."""
        return contact_intervals(*self.along, *self.contact_along_line(state)) if self.active else []
