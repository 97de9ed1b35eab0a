"""Where the riser lies on a ground: what contacts tell alike from its gaps and forces, whatever the ground is."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import NamedTuple

import numpy as np

from riser_soil.contact.landing import lifted
from riser_soil.contact.touchdown import Stretch, stretches, touchdown
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart
from riser_soil.seabed.law import NormalLaw


class Lying(NamedTuple):
    """The line over the ground at n points, arguments of `touchdown`, (n,) each: arc length and share of the line's
    length [m], gap less that at which the force begins [m], force per length [N/m].
    """

    arc: Array
    share: Array
    clearance: Array
    force: Array


class LyingContact(LinePart, ABC):
    """Base of the contacts of a line with a ground, by a law of the force per length. A `Contact`."""

    def __init__(self, line: Line, law: NormalLaw) -> None:
        super().__init__(line)
        self.law = law

    @abstractmethod
    def lying(self, state: State) -> Lying:
        """The points that carry force; asked on the rank alone that evaluates contact."""

    @abstractmethod
    def clearance(self, state: State) -> Array:
        """Gap (nn,) of the nodes less that at which the force begins [m], inf far away; asked there alone, too."""

    def penetration(self, state: State) -> Array:
        """Penetration (nn,) [m] of the nodes' undersides into the ground as it is now, 0 above it."""
        if not self.active:
            return np.zeros(self.line.nodes)
        return np.maximum(0.0, -self.clearance(state) - self.law.start)

    def touchdown_arc(self, state: State) -> float:
        """Arc length [m] of the touchdown point; nan where nothing touches. See `touchdown`."""
        return touchdown(*self.lying(state)) if self.active else float("nan")

    def stretches(self, state: State) -> list[Stretch]:
        """Where the riser lies, from its start on."""
        return stretches(*self.lying(state)) if self.active else []

    def predict(self, guess: State) -> Array:
        """Increments of a first guess that lands, see `landing`."""
        if not self.active:
            return guess.u
        present = self.clearance(State.at_rest(guess.t, guess.u.size))
        return lifted(guess, self.line.translation_dofs[:, -1], present, self.clearance(guess), self.law.start)
