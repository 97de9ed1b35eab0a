"""Largest values in the soil over a stage, with their places and times: the summary's `soil`."""

from __future__ import annotations

from typing import Any

import numpy as np

from riser_soil.core import outputs
from riser_soil.core.arrays import Array
from riser_soil.core.snapshot import SoilMesh, SoilSnapshot


def places(mesh: SoilMesh) -> dict[str, Array]:
    """Where values sit, (n, 3) [m]: undeformed points and centres of cells."""
    return {"soil points": mesh.points, "soil cells": mesh.points[mesh.cells].mean(axis=1)}


def with_largest(largest: dict[str, Any], where: dict[str, Array], t: float, soil: SoilSnapshot) -> dict[str, Any]:
    """The largest values so far and those of a snapshot: {value, position, time} by the names of the figures.

    where: of `places`. t: s, in a static stage its load factor.
    """
    grown = dict(largest)
    for output in outputs.OF_SOIL:
        for figure in output.figures:
            values = output.get(soil)
            value = float(figure.of(values))
            if figure.node is None or (figure.name in grown and not _exceeds(value, grown[figure.name]["value"])):
                continue
            position = _first(where[output.where][figure.node(values)])
            grown[figure.name] = {"value": value, "position": [float(x) for x in position], "time": t}
    return grown


def _exceeds(value: float, before: float) -> bool:
    """By more than the solver's tolerance may bring about."""
    return value > before + 1e-6 * abs(before)


def _first(positions: Array) -> Array:
    """Of (n, 3) the one with the least x, then y, then z: the same however the mesh is shared out."""
    x, y, z = np.round(positions, 6).T
    return np.asarray(positions[np.lexsort((z, y, x))[0]])
