"""Line types of a data file."""

from __future__ import annotations

import math
from typing import Any

from riser_soil.orcaflex.data_file import FORCE, MASS, Item

_EQUAL = 1e-9
_LEFT = {
    "Cs": "slamming", "Ce": "slamming", "Cl": "lift", "CompressionIsLimited": "a limit of compression",
    "ExpansionTable": "expansion", "ClashStiffness": "clashing",
}  # fmt: skip


def line_type(item: Item) -> dict[str, Any]:
    """A scene's line type."""
    outer = item.number("OD")
    found = {"outer_diameter": outer, "inner_diameter": item.number("ID", 0.0)} | _section(item, outer)
    _tell(item, outer)
    for ours, theirs, size in (("max_tension", "AllowableTension", FORCE), ("min_bend_radius", "MinRadius", 1.0)):
        if (value := item.numbers(theirs, 1, math.inf)[0]) not in (0.0, math.inf):
            found[ours] = value * size
    return found | _coefficients(item, outer)


def contact_diameter(item: Item) -> float:
    """What lies on the seabed [m]."""
    return item.number("OuterContactDiameter", item.number("OD"))


def friction_of(item: Item) -> tuple[float, float]:
    """Coefficients of friction along and across; before version 11 the latter was called normal."""
    across = item.number("SeabedLateralFrictionCoefficient", item.number("SeabedNormalFrictionCoefficient", 0.0))
    return item.number("SeabedAxialFrictionCoefficient", across), across


def _section(item: Item, outer: float) -> dict[str, Any]:
    category = item.word("Category", "General")
    if category == "Homogeneous pipe":
        return _homogeneous(item, outer)
    if category != "General":
        raise item.error("Category", f"is {category}; only General and Homogeneous pipe can be carried over")
    in_x, in_y = item.numbers("EI", 2, math.inf)
    if math.isfinite(in_y) and abs(in_y - in_x) > _EQUAL * in_x:
        item.left("EI", f"EI about y of {in_y:g}: it is that about x here")
    if not all(map(math.isfinite, (in_x, axial := item.stiffness("EA", math.nan)))):
        key = "EA" if math.isfinite(in_x) else "EI"
        raise item.error(key, f"is {item.get(key)!r}: only plain numbers can be carried over, no tables")
    found = {"mass": item.number("MassPerUnitLength") * MASS, "EA": axial * FORCE, "EI": in_x * FORCE}
    if math.isfinite(twist := item.stiffness("GJ", math.nan)):
        found["GJ"] = twist * FORCE
    return found


def _homogeneous(item: Item, outer: float) -> dict[str, Any]:
    """Of an elastic pipe: E A, E I, G 2 I."""
    inner, E = item.number("ID", 0.0), item.number("E") * FORCE
    for key in ("CoatingThickness", "LiningThickness"):
        if item.number(key, 0.0):
            raise item.error(key, "a coat can't be carried over; save the line type as General")
    area, inertia = math.pi / 4.0 * (outer**2 - inner**2), math.pi / 64.0 * (outer**4 - inner**4)
    twist = E * inertia / (1.0 + item.number("PoissonRatio"))
    return {"mass": item.number("MaterialDensity") * MASS * area, "EA": E * area, "EI": E * inertia, "GJ": twist}


def _coefficients(item: Item, outer: float) -> dict[str, Any]:
    """Drag and added mass; drag on another diameter is on the outer one here."""
    found: dict[str, Any] = {}
    for ours, theirs in (("drag", "Cd"), ("added_mass", "Ca")):
        values = item.get(theirs)
        if any(isinstance(each, str) for each in (values if isinstance(values, list) else [values])):
            item.left(theirs, f"{theirs} by a table ({values}): the line type has no {ours}")
            continue
        x, y, along = item.numbers(theirs, 3, math.nan)
        if math.isfinite(y) and y != x:
            item.left(theirs, f"{theirs} of {y:g} in y: it is that in x here")
        if math.isfinite(x):
            found[ours] = {"normal": x, "tangential": along if math.isfinite(along) else 0.0}
    for way, key in (("normal", "NormalDragLiftDiameter"), ("tangential", "AxialDragLiftDiameter")):
        if "drag" in found:
            found["drag"][way] *= item.number(key, outer) / outer
    return found


def _tell(item: Item, outer: float) -> None:
    for key, what in _LEFT.items():
        if item.word(key) not in ("", "0", "0.0", "No", "None"):
            item.left(key, f"{key} {item.word(key)}: {what}")
    if (ratio := item.number("PoissonRatio", 0.5)) != 0.5:
        item.left("PoissonRatio", f"PoissonRatio {ratio:g}: the pipe stretches with effective tension here, as for 0.5")
    if item.has("OuterContactDiameter") and contact_diameter(item) != outer:
        item.left("OuterContactDiameter", f"OuterContactDiameter {contact_diameter(item):g}: OD touches here")
