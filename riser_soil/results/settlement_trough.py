"""Settlement trough: the settlement of the soil's surface in sections across the riser, fixed in space."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from riser_soil.assembly import LineAssembly
from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.part import State
from riser_soil.core.saved_state import Saved
from riser_soil.riser.hermite import axis_at
from riser_soil.riser.line import Line

if TYPE_CHECKING:
    from riser_soil.contact.soil_contact import SoilContact

HALF_WIDTH = 3.0  # outer diameters
UPRIGHT = 1e-6  # horizontal share of the riser's direction below which there is no across


def offsets_of(riser: LineAssembly) -> tuple[float, ...]:
    """Places along a section [m], from right to left."""
    given = riser.scene.output.sections
    half = HALF_WIDTH * riser.scales.diameter if given.half_width is None else given.half_width
    return tuple(float(x) for x in np.linspace(-half, half, given.points))


def count_of(riser: LineAssembly) -> int:
    """Number of sections."""
    return len(riser.scene.output.sections.arcs or (0.0,))


def sections_of(riser: LineAssembly) -> TroughSections | None:
    """The scene's sections; None where there is no soil, or on a rank that does not evaluate contact."""
    if riser.soil is None or not riser.soil.contact.active:
        return None
    return TroughSections(riser.line, riser.soil.contact, riser.scene.output.sections.arcs, offsets_of(riser))


class TroughSections:
    """Sections across the riser, laid where it lies over its arc lengths `arcs` [m]; None: at the touchdown point."""

    def __init__(
        self, line: Line, contact: SoilContact, arcs: Sequence[float] | None, offsets: Sequence[float]
    ) -> None:
        self._line, self._contact, self._given, self._offsets = line, contact, arcs, np.array(offsets)
        count = len(arcs or (0.0,))
        self._arc: Array = np.full(count, np.nan)
        self._position: Array = np.full((count, 3), np.nan)
        self._direction: Array = np.full((count, 3), np.nan)

    @property
    def laid(self) -> bool:
        """Whether all sections have a place."""
        return not np.isnan(self._direction).any()

    def lay(self, nodes: Array, tangent: Array, touchdown_arc: float) -> None:
        """Lay them across the riser as it lies now; those that have no place stay.

        nodes (nn, 3): positions; tangent (ne, 2, 3): of the elements' ends; touchdown_arc: m, nan without.
        """
        for n, arc in enumerate(self._given or (touchdown_arc,)):
            if np.isnan(arc):
                continue
            (position,), (slope,) = axis_at(self._line.arc, nodes[None], tangent[None], np.array([arc]))
            level = np.array([slope[0], slope[1], 0.0])
            size = float(np.linalg.norm(level))
            if size > UPRIGHT:
                self._arc[n], self._position[n] = arc, position
                self._direction[n] = np.cross([0.0, 0.0, 1.0], level / size)

    def values(self, state: State) -> dict[str, Array]:
        """Places of the sections and settlement in them at a state; nan in one without a place, and beside the soil."""
        across = self._offsets[None, :, None] * self._direction[:, None, :2]
        xy = self._position[:, None, :2] + across
        settlement, there = np.full(xy.shape[:2], np.nan), self._there
        settlement[there] = self._contact.settlement(xy[there].reshape(-1, 2), state).reshape(-1, len(self._offsets))
        places = {"arc": self._arc, "position": self._position, "direction": self._direction}
        return {f"section_{name}": value.copy() for name, value in places.items()} | {"settlement_across": settlement}

    @property
    def _there(self) -> BoolArray:
        return np.asarray(~np.isnan(self._direction).any(axis=1))

    def state(self) -> Saved:
        return {"arc": self._arc.copy(), "position": self._position.copy(), "direction": self._direction.copy()}

    def restore(self, saved: Saved) -> None:
        places: tuple[Array, ...] = tuple(saved[name].copy() for name in ("arc", "position", "direction"))
        self._arc, self._position, self._direction = places
