"""Largest values in the soil over a stage, with their places and times: the summary's `soil`."""

from __future__ import annotations

from typing import Any

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
            if figure.node is not None and (figure.name not in grown or value > grown[figure.name]["value"]):
                position = where[output.where][figure.node(values)]
                grown[figure.name] = {"value": value, "position": [float(x) for x in position], "time": t}
    return grown
