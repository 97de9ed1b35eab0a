"""Figures of summary.json: their values at one instant, and their extremes with times."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import numpy as np

from riser_soil.core import outputs
from riser_soil.core.arrays import Array
from riser_soil.core.output import Figure
from riser_soil.core.saved_state import Saved
from riser_soil.core.snapshot import Record, SoilMesh, SoilSnapshot
from riser_soil.results.largest import Range

_END = ("position", "force", "resultant_force", "moment", "effective_tension", "angle_deg")
# In the order of the file; what the table of outputs has beyond them comes behind.
_ORDER = (
    *(f"start.{name}" for name in _END),
    *(f"end.{name}" for name in _END),
    "touchdown_arc",
    "touchdown_position",
    "touchdown_points",
    "max_bending_moment",
    "max_curvature",
    "min_bend_radius",
    "max_bend_utilisation",
    "max_tension_utilisation",
    "max_wall_von_mises_stress",
    "max_stress_utilisation",
    "min_effective_tension",
    "min_wall_tension",
    "max_wall_tension",
    "max_penetration",
    "max_embedment",
    "contact_force",
)
_FIGURES = outputs.figures(_ORDER)
FIGURE_NAMES = frozenset(figure.name for _, figure in _FIGURES)
# Left out where nothing is known of what they need, or they are not wanted.
_SOMETIMES = frozenset(figure.name for output, figure in _FIGURES if output.needs)
_SIZE = sum(figure.size for _, figure in _FIGURES)
_OUTPUTS = [(output.name, output.value) for output in outputs.of_instant() if output.figures]
_FIRST = itertools.accumulate((figure.size for _, figure in _FIGURES), initial=0)
# Of each figure: its output, where it stands in a packed vector, how it follows from the output's value.
_PLACES: list[tuple[str, int | slice, Callable[[Any], Any]]] = [
    (output.name, first if figure.size == 1 else slice(first, first + figure.size), figure.of)
    for (output, figure), first in zip(_FIGURES, _FIRST, strict=False)
]
# Those that sit somewhere along the riser.
_PLACED = [(output.name, figure) for output, figure in _FIGURES if figure.placed]
# Of each output: how it follows from what is seen, and its figures, as in _PLACES and with their place behind them.
_PACKED = [
    (
        get,
        [(at, of) for owner, at, of in _PLACES if owner == name],
        [(at, figure) for at, (owner, figure) in enumerate(_PLACED, start=_SIZE) if owner == name],
    )
    for name, get in _OUTPUTS
]


def pack(record: Record) -> Array:
    """All figures of one instant as one vector, of many as rows, in the order of the summary, and behind them the arc
    lengths [m] of those that sit somewhere along the riser; nan for what is not known.
    """
    vector = np.full((*record.position.shape[:-2], _SIZE + len(_PLACED)), np.nan)
    for get, figures, placed in _PACKED:
        if (value := get(record)) is not None:
            for at, of in figures:
                vector[..., at] = of(value)
            for n, figure in placed:
                vector[..., n] = _arc(figure, value, record.arc)
    return vector


def _values(record: Record) -> dict[str, Any]:
    return {name: get(record) for name, get in _OUTPUTS}


def _figure(figure: Figure, value: Any) -> Any:
    return math.nan if value is None else figure.of(value)


def unpack(vector: Array) -> dict[str, Any]:
    """The nested form of a packed vector: scalars as numbers, vectors as lists."""
    nested: dict[str, Any] = {}
    first = 0
    for _, figure in _FIGURES:
        values = [float(x) for x in vector[first : first + figure.size]]
        _put(nested, figure.path, values if figure.size > 1 else values[0])
        first += figure.size
    return nested


def places_of(name: str) -> slice:
    """Where a figure stands in a packed vector."""
    first = 0
    for _, figure in _FIGURES:
        if figure.name == name:
            return slice(first, first + figure.size)
        first += figure.size
    raise KeyError(name)


_AT_PLACED = np.array([places_of(figure.name).start for _, figure in _PLACED])


def final_state(record: Record) -> dict[str, Any]:
    """The summary's `final`: one instant's figures, with the arc length [m] of those that sit along the riser."""
    values = _values(record)
    final: dict[str, Any] = {}
    for output, figure in _FIGURES:
        found = _figure(figure, values[output.name])
        if figure.name in _SOMETIMES and not np.isfinite(found).all():
            continue
        value: Any = [float(x) for x in found] if figure.size > 1 else float(found)
        if figure.placed:
            value = {"value": value, "arc": float(_arc(figure, values[output.name], record.arc))}
        _put(final, figure.path, value)
    return final


def _arc(figure: Figure, value: Any, arc: Array) -> Any:
    if figure.arc is not None:
        return figure.arc(value)
    assert figure.node is not None
    return arc[figure.node(value)]


class Extremes:
    """Smallest and largest of every figure, with their times and places along the riser; nan does not count."""

    def __init__(self) -> None:
        self._range = Range(_SIZE, beside=1)

    def update(self, t: Array | float, vector: Array) -> None:
        """t: s (static stages: load factor); vector: from `pack`; both of one instant, or of many in turn."""
        rows = np.atleast_2d(vector)
        arcs = np.full((len(rows), _SIZE), np.nan)
        arcs[:, _AT_PLACED] = rows[:, _SIZE:]
        self._range.update(np.atleast_1d(t), rows[:, :_SIZE], arcs)

    def nested(self) -> dict[str, Any]:
        """{min, max, t_min, t_max} of each figure, and {arc_min, arc_max} [m] of those that sit somewhere along the
        riser; vectors by component.
        """
        parts = {key: unpack(values) for key, values in self._range.columns().items()}
        nested: dict[str, Any] = {}
        for _, figure in _FIGURES:
            least = _get(parts["min"], figure.path)
            if figure.name not in _SOMETIMES or np.isfinite(least).all():
                _put(nested, figure.path, {key: _get(part, figure.path) for key, part in parts.items()})
        (arc_min,), (arc_max,) = self._range.beside["min"], self._range.beside["max"]
        for (_, figure), at in zip(_PLACED, _AT_PLACED, strict=True):
            with suppress(KeyError):  # one that is unknown was left out
                _get(nested, figure.path).update(arc_min=float(arc_min[at]), arc_max=float(arc_max[at]))
        return nested

    def state(self) -> Saved:
        return self._range.state()

    def restore(self, saved: Saved) -> None:
        self._range.restore(saved)


def _put(nested: dict[str, Any], path: tuple[str, ...], value: Any) -> None:
    *outer, last = path
    for key in outer:
        nested = nested.setdefault(key, {})
    nested[last] = value


def _get(nested: dict[str, Any], path: tuple[str, ...]) -> Any:
    value: Any = nested
    for key in path:
        value = value[key]
    return value


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
            values = output.value(soil)
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
    """The position (3,) with the least x, then y, then z, of (n, 3): however ranks share out the mesh."""
    x, y, z = np.round(positions, 6).T
    return np.asarray(positions[np.lexsort((z, y, x))[0]])
