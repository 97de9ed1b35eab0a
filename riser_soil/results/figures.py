"""Figures of summary.json: at one instant, their values as a packed vector; over a stage, their extremes with times."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np

from riser_soil.core import outputs
from riser_soil.core.arrays import Array, as_list
from riser_soil.core.output import Figure
from riser_soil.core.saved_state import Saved
from riser_soil.core.snapshot import Record
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
_FIGURES = [figure for _, figure in outputs.figures(_ORDER)]
FIGURE_NAMES = frozenset(figure.name for figure in _FIGURES)
# Figures that are missing where what they need is unknown, or where they are not wanted.
_SOMETIMES = frozenset(figure.name for output in outputs.of_instant() if output.needs for figure in output.figures)
_SIZE = sum(figure.size for figure in _FIGURES)
_FIRST = itertools.accumulate((figure.size for figure in _FIGURES), initial=0)
# In a packed vector: the numbers of each figure, and behind those of all the arc length of each that has a place.
_NUMBERS = {figure.name: slice(first, first + figure.size) for figure, first in zip(_FIGURES, _FIRST, strict=False)}
_ARCS = {figure.name: at for at, figure in enumerate((each for each in _FIGURES if each.placed), start=_SIZE)}
_PLACED = [_NUMBERS[name].start for name in _ARCS]


def pack(record: Record) -> Array:
    """All figures of one instant as one vector, of many as rows, in the order of the summary, and behind them the arc
    lengths [m] of those that have a place along the riser; nan for what is not known.
    """
    vector = np.full((*record.position.shape[:-2], _SIZE + len(_ARCS)), np.nan)
    for output in outputs.of_instant():
        if not output.figures or (value := output.value(record)) is None:
            continue
        for figure in output.figures:
            numbers = _NUMBERS[figure.name]
            vector[..., numbers if figure.size > 1 else numbers.start] = figure.of(value)
            if figure.placed:
                vector[..., _ARCS[figure.name]] = _arc(figure, value, record.arc)
    return vector


def _arc(figure: Figure, value: Any, arc: Array) -> Any:
    if figure.arc is not None:
        return figure.arc(value)
    assert figure.node is not None
    return arc[figure.node(value)]


def places_of(name: str) -> slice:
    """Numbers of a figure in a packed vector."""
    return _NUMBERS[name]


def final_state(vector: Array) -> dict[str, Any]:
    """The summary's `final` by a packed vector: figures, with the arc length [m] of those that have a place."""
    final: dict[str, Any] = {}
    for figure in _known(vector):
        value = _plain(figure, vector)
        if figure.placed:
            value = {"value": value, "arc": float(vector[_ARCS[figure.name]])}
        _put(final, figure.path, value)
    return final


def _known(vector: Array) -> list[Figure]:
    """Figures without those of which nothing is known."""
    return [each for each in _FIGURES if each.name not in _SOMETIMES or np.isfinite(vector[_NUMBERS[each.name]]).all()]


def _plain(figure: Figure, vector: Array) -> Any:
    """A number, or a list of three."""
    values = as_list(vector[_NUMBERS[figure.name]])
    return values if figure.size > 1 else values[0]


class Extremes:
    """Least and largest value of every figure in a stage so far, with their times and places along the riser; nan does
    not count. latest: the packed vector of the last instant, nan before there is one.
    """

    def __init__(self) -> None:
        self._range = Range(_SIZE, beside=1)
        self.latest: Array = np.full(_SIZE + len(_ARCS), np.nan)

    def update(self, t: Array | float, vector: Array) -> None:
        """t: s (static stages: load factor); vector: from `pack`; both of one instant, or of many in turn."""
        rows = np.atleast_2d(vector)
        arcs = np.full((len(rows), _SIZE), np.nan)
        arcs[:, _PLACED] = rows[:, _SIZE:]
        self._range.update(np.atleast_1d(t), rows[:, :_SIZE], arcs)
        self.latest = rows[-1]

    def nested(self) -> dict[str, Any]:
        """{min, max, t_min, t_max} of each figure, and {arc_min, arc_max} [m] of those that have a place along the
        riser; vectors by component.
        """
        columns, (arc_min,), (arc_max,) = self._range.columns(), *self._range.beside.values()
        nested: dict[str, Any] = {}
        for figure in _known(columns["min"]):
            extremes = {key: _plain(figure, values) for key, values in columns.items()}
            if figure.placed:
                extremes |= {"arc_min": _plain(figure, arc_min), "arc_max": _plain(figure, arc_max)}
            _put(nested, figure.path, extremes)
        return nested

    def state(self) -> Saved:
        return self._range.state() | {"latest": self.latest.copy()}

    def restore(self, saved: Saved) -> None:
        self._range.restore(saved)
        self.latest = saved["latest"].copy()


def _put(nested: dict[str, Any], path: tuple[str, ...], value: Any) -> None:
    *outer, last = path
    for key in outer:
        nested = nested.setdefault(key, {})
    nested[last] = value
