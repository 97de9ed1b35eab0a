"""Tables of a data file's VariableData: where a number is asked for, OrcaFlex takes the name of one, too."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

from riser_soil.orcaflex.data_file import Item, folded

Point = tuple[float, float]


def is_name(value: Any) -> bool:
    """Whether a value is the name of a table and no number."""
    try:
        float(value)
    except (TypeError, ValueError):
        return isinstance(value, str)
    return False


def table_of(item: Item, key: str, name: str) -> Item | None:
    """The table of this name, of any kind, for which an object asks by a key; refused where there is none."""
    for kind in item.file.section("VariableData").values:
        for each in item.file.section("VariableData").items(kind):
            if folded(each.title) == folded(name):
                return each
    item.refuse(key, f"is {name!r}, neither a number nor the name of a table of VariableData; correct it")
    return None


def points_of(item: Item, key: str, name: str) -> list[Point]:
    """Points (x, y) of the table, x increasing; refused, and none, where it has no two columns of numbers."""
    table = table_of(item, key, name)
    if table is None:
        return []
    points = [(row.number("IndependentValue"), row.number("DependentValue")) for row in table.rows("IndependentValue")]
    if not points or any(not b[0] > a[0] for a, b in pairwise(points)):
        item.refuse(key, f"the table {name} needs rows IndependentValue, DependentValue that increase; correct them")
        return []
    return points


def value_at(points: list[Point], x: float) -> float:
    """Linear between points, constant beyond them."""
    for (x0, y0), (x1, y1) in pairwise(points):
        if x < x1:
            return y0 + (y1 - y0) * (max(x, x0) - x0) / (x1 - x0)
    return points[-1][1]


def layers_of(item: Item, kind: str) -> list[Point]:
    """Thicknesses [m] and densities [te/m3] of a pipe's coats, from its wall on; kind: Coating or Lining."""
    key = f"{kind}Thickness"
    if is_name(value := item.get(key)):
        table = table_of(item, key, value)
        rows = table.rows("LayerThickness") if table is not None else []
        layers = [(row.number("LayerThickness"), row.number("LayerMaterialDensity")) for row in rows]
        if table is not None and not layers:
            item.refuse(key, f"the table {value} has no rows LayerThickness, LayerMaterialDensity; correct it")
        return layers
    thickness = item.number(key, 0.0)
    return [(thickness, item.number(f"{kind}MaterialDensity"))] if thickness != 0.0 else []
