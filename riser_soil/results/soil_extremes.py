"""Largest values in the soil over a stage: settlement, stress, strength used, plastic strain, with place and time."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from riser_soil.core import outputs
from riser_soil.core.arrays import Array
from riser_soil.core.saved_state import Saved
from riser_soil.core.snapshot import SoilMesh, SoilSnapshot
from riser_soil.results.largest import Largest

_FIGURES = [(output, figure) for output in outputs.OF_SOIL for figure in output.figures if figure.node is not None]
TOLERANCE = 1e-6  # share of the largest value so far by which the solver's tolerance may exceed it


class SoilExtremes:
    """Largest values so far of all figures of the soil."""

    def __init__(self) -> None:
        self._largest = Largest(len(_FIGURES), beside=3, tolerance=TOLERANCE)

    def update(self, t: float, soil: SoilSnapshot, where: Mapping[str, Array]) -> None:
        """Take in a snapshot. t: s, in a static stage its load factor. where: from `places`."""
        values, positions = [], []
        for output, figure in _FIGURES:
            field = output.value(soil)
            assert figure.node is not None
            values.append(figure.of(field))
            positions.append(_first(where[output.where][figure.node(field)]))
        self._largest.update(np.array([t]), np.array([values]), *np.transpose(positions)[:, None])

    def nested(self) -> dict[str, Any]:
        """{value, position, time} by the names of the figures; empty before the first snapshot."""
        each = {figure.name: self._largest.of(n) for n, (_, figure) in enumerate(_FIGURES)}
        return {
            name: {"value": value, "position": position, "time": t}
            for name, (value, t, *position) in each.items()
            if math.isfinite(value)
        }

    def state(self) -> Saved:
        return self._largest.state()

    def restore(self, saved: Saved) -> None:
        self._largest.restore(saved)


def places(mesh: SoilMesh) -> dict[str, Array]:
    """Where the soil's values are, (n, 3) [m]: undeformed points and centres of cells."""
    return {"soil points": mesh.points, "soil cells": mesh.points[mesh.cells].mean(axis=1)}


def _first(positions: Array) -> Array:
    """The position (3,) with the least x, then y, then z, of (n, 3): however ranks share out the mesh."""
    x, y, z = np.round(positions, 6).T
    return np.asarray(positions[np.lexsort((z, y, x))[0]])
