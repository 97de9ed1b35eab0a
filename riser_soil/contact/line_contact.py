"""Base class of the contacts of a line: touchdown point, contact intervals, penetration and predictor."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import NamedTuple

import numpy as np

from riser_soil.contact.landing import landing_predictor
from riser_soil.contact.touchdown import ContactInterval, contact_intervals, touchdown
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart
from riser_soil.seabed.law import NormalLaw


class ContactAlongLine(NamedTuple):
    """Contact forces and gaps at n points of the line, arguments of `touchdown`, (n,) each: arc length and share of the
    line's length [m], gap less that at which the force begins [m], force per length [N/m].
    """

    arc: Array
    share: Array
    clearance: Array
    force: Array


class LineContact(LinePart, ABC):
    """Base of the contacts of a line with a ground, by a law of the force per length. A `RiserContact`."""

    def __init__(self, line: Line, law: NormalLaw) -> None:
        super().__init__(line)
        self.law = law

    @abstractmethod
    def contact_along_line(self, state: State) -> ContactAlongLine:
        """Points along the line with their contact force; called only on the rank that evaluates contact."""

    @abstractmethod
    def clearance(self, state: State) -> Array:
        """Gap (nn,) of the nodes less that at which the force begins [m], inf far away; called only there, too."""

    def penetration(self, state: State) -> Array:
        """Penetration (nn,) [m] of the nodes' undersides into the ground as it is now, 0 above it."""
        if not self.active:
            return np.zeros(self.line.nodes)
        return np.maximum(0.0, -self.clearance(state) - self.law.start)

    def touchdown_arc(self, state: State) -> float:
        """Arc length [m] of the touchdown point; nan where nothing touches. See `touchdown`."""
        return touchdown(*self.contact_along_line(state)) if self.active else float("nan")

    def contact_intervals(self, state: State) -> list[ContactInterval]:
        """Intervals of contact along the riser, from its start on."""
        return contact_intervals(*self.contact_along_line(state)) if self.active else []

    def predict(self, guess: State) -> Array:
        """Increments of a first guess that lands, see `landing`."""
        if not self.active:
            return guess.u
        present = self.clearance(State.at_rest(guess.t, guess.u.size))
        heights, guessed = self.line.translation_dofs[:, -1], self.clearance(guess)
        return landing_predictor(guess, heights, present, guessed, self.law.start)
