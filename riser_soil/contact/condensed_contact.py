"""A line's contact with condensed soil in the line solver, see `solve.soil_border`."""

from __future__ import annotations

from typing import Any

import numpy as np

from riser_soil.contact.on_condensed_soil import Touched, add_contact, add_contact_tangent
from riser_soil.contact.soil_contact import SoilContact
from riser_soil.contact.soil_friction import SoilFriction
from riser_soil.core.arrays import IntArray
from riser_soil.core.bound import Bound, Packed, bound
from riser_soil.core.part import State

SHARE = 0.25  # of the range around the pipe by which soil may move before what may touch is looked for anew


class CondensedContact:
    """Contact with condensed soil, and friction if there is any: their kernels, bound to where they read and write.

    parts: whose forces these are. deformed (np, 3): where the solver writes the top's points [m]. touched: outcome of
    the last evaluation. slack: by which the soil may move before `look` is due [m].
    """

    def __init__(self, contact: SoilContact, friction: SoilFriction | None) -> None:
        self.contact, self._friction = contact, friction
        self.parts: list[SoilContact | SoilFriction] = [contact]
        self.slack, self.deformed = SHARE * contact.around, contact.settled
        nodes = len(self.deformed)
        self.touched = Touched(np.zeros(3, dtype=np.int64), np.zeros(nodes, dtype=np.bool_), np.zeros(1))
        data = contact.kernel_data(self.deformed, self.touched)
        self._packed = [Packed(data)]
        if friction is not None:
            self.parts.append(friction)
            self._packed.append(Packed(friction.kernel_data(data)))

    @property
    def _data(self) -> Any:
        """Kernel data of the contact."""
        return self._packed[0].value

    def _renew(self, data: Any) -> None:
        """Go on with these kernel data of the contact; only what differs is packed, as that costs an iteration's time.
        """
        renewed = [data]
        if self._friction is not None:
            renewed.append(self._friction.at_start(self._packed[1].value, data))
        for packed, value in zip(self._packed, renewed, strict=True):
            if value is not packed.value:
                packed.renew(value)

    def begin(self) -> None:
        """Begin a step from the accepted state, at which the top's points are written."""
        self._renew(self.contact.at_start(self._data))

    def look(self, tried: bool) -> IntArray:
        """Watch what may touch near the accepted place and, if `tried`, near the last trial's: the top's nodes (k,)."""
        places = [self.contact.place(self.contact.accepted), *([self.contact.place_in(self._data)] if tried else [])]
        pairs = self.contact.candidates(places, self.deformed)
        roomy = self.contact.with_room(self._data)
        self._renew(self.contact.watch(roomy, places, pairs, self.slack))
        return self.contact.nodes_of(pairs)

    def forces(self, top: Packed, at: Packed, forces: Packed, border: Packed) -> list[Bound]:
        """Kernels that add to the residuals of the line and of the border."""
        return [bound(add_contact, part, top, at, forces, border) for part in self._packed]

    def tangent(self, top: Packed, at: Packed, K: Packed, border: Packed) -> list[Bound]:
        """Kernels that add to the tangents."""
        return [bound(add_contact_tangent, part, top, at, K, border) for part in self._packed]

    def end(self, state: State) -> None:
        """Hand the last evaluation to the parts, at the end of a step."""
        for part, packed in zip(self.parts, self._packed, strict=True):
            part.adopt(state, packed.value)
