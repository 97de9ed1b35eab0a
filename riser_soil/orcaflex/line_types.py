"""Line types of a data file: those of a scene, which are alike from end to end, one for each step of a taper."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from riser_soil.imported_scene import twisting_stiffness
from riser_soil.orcaflex.data_file import FORCE, MASS, Item
from riser_soil.orcaflex.variable_data import Point, is_name, layers_of, points_of, value_at

_EQUAL = 1e-9
_STEP = 0.1  # of a taper: by how much of itself the bending stiffness changes from one piece to the next
_MOST_STEPS = 100
_LEFT = {
    "Cs": "slamming", "Ce": "slamming", "Cl": "lift", "CompressionIsLimited": "a limit of compression",
    "ExpansionTable": "expansion", "ClashStiffness": "clashing",
}  # fmt: skip
_LEAST_REYNOLDS = 1.0  # in place of 0, which has no logarithm


@dataclass(frozen=True)
class PipeOfType:
    """A line type where its wall has an outer and an inner diameter [m]. coats, linings: outside, and inside of it,
    thickness [m] and density [te/m3] from the wall on.
    """

    item: Item
    outer: float
    inner: float
    coats: tuple[Point, ...] = ()
    linings: tuple[Point, ...] = ()

    @property
    def outermost(self) -> float:
        """Diameter with coats [m]."""
        return self.outer + 2.0 * sum(thickness for thickness, _ in self.coats)

    @property
    def innermost(self) -> float:
        """Within its linings [m]."""
        return self.inner - 2.0 * sum(thickness for thickness, _ in self.linings)

    @property
    def homogeneous(self) -> bool:
        return self.item.choice("Category", "General") == "homogeneous pipe"

    @property
    def contact_diameter(self) -> float:
        """Diameter of what lies on the seabed [m]."""
        return self.item.number("OuterContactDiameter", self.item.number("ContactDiameter", self.outermost))


def pieces(item: Item, length: float) -> list[tuple[float, PipeOfType]]:
    """Lengths and diameters of a section, from its end towards end A: one, or the steps of a taper.

    A taper's steps have the diameters of their middles, so that what a step lacks at one end it has too much at the
    other. Their remark tells how far they are from the table at most.
    """
    coats, linings = (tuple(layers_of(item, kind)) for kind in ("Coating", "Lining"))
    tables = {key: points_of(item, key, name) for key in ("OD", "ID") if is_name(name := item.get(key))}
    if not all(tables.values()):
        return []

    def diameter(key: str, s: float, default: float | None) -> float:
        if key in tables:
            return value_at(tables[key], s)
        return item.positive(key) if default is None else item.number(key, default)

    def pipe(s: float) -> PipeOfType:
        return PipeOfType(item, diameter("OD", s, None), diameter("ID", s, 0.0), coats, linings)

    if not tables:
        return [(length, pipe(0.0))]
    if not math.isfinite(length):
        length = max(points[-1][0] for points in tables.values())
    arcs = sorted({0.0, length, *(s for points in tables.values() for s, _ in points if 0.0 < s < length)})
    cuts = [*(cut for a, b in pairwise(arcs) for cut in _cuts(a, b, pipe)), length]
    parts = [(b - a, pipe(0.5 * (a + b))) for a, b in pairwise(cuts)]
    if not item.file.refused:
        _remark_on_steps(item, tables, parts, [pipe(s) for s in cuts])
    return parts


def _cuts(a: float, b: float, pipe: Callable[[float], PipeOfType]) -> Iterator[float]:
    """Beginnings of the steps of a straight taper from a to b."""
    first, last = _bending(pipe(a)), _bending(pipe(b))
    if not (first > 0.0 and last > 0.0):
        pipe(a).item.refuse("ID", f"is not less than OD everywhere from {a:g} to {b:g} m; correct one of the tables")
        return
    count = min(max(1, math.ceil(abs(math.log(last / first)) / math.log1p(_STEP) - _EQUAL)), _MOST_STEPS)
    yield from (a + (b - a) * n / count for n in range(count))


def _bending(pipe: PipeOfType) -> float:
    """What the bending stiffness of a homogeneous pipe goes with [m4]; of another the outer diameter counts alone."""
    return pipe.outer**4 - pipe.inner**4 if pipe.inner < pipe.outer else 0.0


def _remark_on_steps(
    item: Item, tables: dict[str, list[Point]], pieces: list[tuple[float, PipeOfType]], at: list[PipeOfType]
) -> None:
    ends = [(pipe, end) for n, (_, pipe) in enumerate(pieces) for end in at[n : n + 2]]
    key = next(iter(tables))
    off = max(abs(pipe.outer - end.outer) / end.outer for pipe, end in ends)
    stiffness = max(abs(_bending(pipe) / _bending(end) - 1.0) for pipe, end in ends)
    of_stiffness = f", {100.0 * stiffness:.2g} % in EI" if at[0].homogeneous else ""
    names = " and ".join(f"{key} by the table {item.word(key)}" for key in tables)
    text = f"{len(pieces)} pieces of constant diameter, {100.0 * off:.2g} % off in OD at most{of_stiffness}"
    item.remark(key, f"{names}: {text}")


def line_type(pipe: PipeOfType) -> dict[str, Any]:
    """A scene's line type."""
    item = pipe.item
    data = {"outer_diameter": pipe.outermost, "inner_diameter": pipe.innermost} | _section(pipe)
    if pipe.outer < pipe.outermost:
        data["pipe_diameter"] = pipe.outer
    _remark_on_rest(pipe)
    for ours, theirs, size in (("max_tension", "AllowableTension", FORCE), ("min_bend_radius", "MinRadius", 1.0)):
        if (value := item.numbers(theirs, 1, math.inf)[0]) not in (0.0, math.inf):
            data[ours] = value * size
    return data | _drag(pipe) | _added_mass(pipe)


def friction_of(item: Item) -> tuple[float, float]:
    """Coefficients of friction along and across; before version 11 the latter was called normal."""
    across = item.number("SeabedLateralFrictionCoefficient", item.number("SeabedNormalFrictionCoefficient", 0.0))
    return item.number("SeabedAxialFrictionCoefficient", across), across


def _section(pipe: PipeOfType) -> dict[str, Any]:
    item = pipe.item
    if pipe.homogeneous:
        return _homogeneous(pipe)
    if item.choice("Category", "General") != "general":
        given = item.word("Category")
        item.refuse("Category", f"is {given}; only General and Homogeneous pipe can be carried over")
        return {}
    in_x, in_y = (_plain_stiffness(item, "EI", value) for value in _pair(item.get("EI")))
    if math.isfinite(in_y) and abs(in_y - in_x) > _EQUAL * in_x:
        item.remark("EI", f"EI about y of {in_y:g}: it is that about x here")
    axial = _plain_stiffness(item, "EA", item.get("EA"))
    for key, size in (("EA", axial), ("EI", in_x)):
        if math.isinf(size):
            item.refuse(key, "is missing, or Infinity; give a number [kN.m2, kN]")
    data = {"mass": item.number("MassPerUnitLength") * MASS, "EA": axial * FORCE, "EI": in_x * FORCE}
    return data | {"GJ": _twisting(pipe, data)}


def _pair(value: Any) -> list[Any]:
    """About x and about y; nothing about y for the same."""
    given = value if isinstance(value, list) else [value]
    return [*given, None, None][:2]


def _plain_stiffness(item: Item, key: str, value: Any) -> float:
    """A number; infinite where there is none. A table is refused: no scene has a stiffness that changes with load."""
    if value is None:
        return math.inf
    if is_name(value):
        return item.refuse(key, f"is {value!r}: a stiffness by a table can't be carried over; give a number")
    return item.number_in(key, value)


def _twisting(pipe: PipeOfType, section: dict[str, float]) -> float:
    """GJ [N m2]; of a line that does not twist one that bears no torque while an end is free to spin."""
    value = pipe.item.get("GJ")
    given = _plain_stiffness(pipe.item, "GJ", value)
    if math.isfinite(given) and given > 0.0:
        return given * FORCE
    size = twisting_stiffness(section["EI"], section["EA"], pipe.outermost)
    reason = f"the line does not twist; {size:g} N.m2 here, without effect unless both ends keep it from spinning"
    if not math.isnan(given):
        pipe.item.remark("GJ", f"GJ {'~' if value is None else value}: {reason}")
    return size


def _homogeneous(pipe: PipeOfType) -> dict[str, Any]:
    """Mass and stiffnesses of an elastic pipe: E A, E I, G 2 I; coats have mass alone."""
    item, E = pipe.item, pipe.item.number("E") * FORCE
    area, inertia = _ring(pipe.outer, pipe.inner), math.pi / 64.0 * (pipe.outer**4 - pipe.inner**4)
    mass, outer, inner = item.number("MaterialDensity") * area, pipe.outer, pipe.inner
    for thickness, density in pipe.coats:
        mass += density * _ring(outer + 2.0 * thickness, outer)
        outer += 2.0 * thickness
    for thickness, density in pipe.linings:
        mass += density * _ring(inner, inner - 2.0 * thickness)
        inner -= 2.0 * thickness
    if (ratio := item.number("PoissonRatio", 0.3)) <= -1.0:
        ratio = item.refuse("PoissonRatio", f"is {ratio:g}; give one above -1")
    twist = E * inertia / (1.0 + ratio)
    EI = E * inertia + item.number("AdditionalEI", 0.0) * FORCE
    return {"mass": mass * MASS, "EA": E * area, "EI": EI, "GJ": twist}


def _ring(outer: float, inner: float) -> float:
    return math.pi / 4.0 * (outer**2 - inner**2)


def _coefficients(item: Item, theirs: str) -> list[tuple[str, Any]]:
    """Keys and values across (x and y) and along a line: a list Cd, or Cdn and Cdz of a pipe, or Cdx, Cdy and Cdz."""
    if item.has(theirs):
        given = item.get(theirs)
        values = [*(given if isinstance(given, list) else [given]), None, None, None][:3]
        return [(theirs, value) for value in values]
    across = f"{theirs}n" if item.has(f"{theirs}n") else f"{theirs}x"
    return [(key, item.get(key)) for key in (across, f"{theirs}y", f"{theirs}z")]


def _drag(pipe: PipeOfType) -> dict[str, Any]:
    """Drag; what refers to another diameter does so to the outer one here."""
    item = pipe.item
    (key, across), (key_y, y), (key_z, along) = _coefficients(item, "Cd")
    normal = item.positive("NormalDragLiftDiameter", pipe.outermost) / pipe.outermost
    axial = item.number("AxialDragLiftDiameter", pipe.outermost) / pipe.outermost
    if y is not None and y != across:
        item.remark(key_y, f"Cd of {y} in y: it is that in x here")
    if across is None and along is None:
        return {}
    if is_name(along):
        points = points_of(item, key_z, along)
        along = points[0][1] if points else 0.0
        item.remark(key_z, f"axial Cd by a table: its first value, {along:g}, for all velocities")
    drag: dict[str, Any] = {"tangential": item.number_in(key_z, along, 0.0) * axial}
    if not is_name(across):
        return {"drag": {"normal": item.number_in(key, across, 0.0) * normal} | drag}
    # A Reynolds number of OrcaFlex is that of the drag diameter, one of a scene that of the outer one.
    points = points_of(item, key, across)
    drag["by_reynolds"] = [[max(Re, _LEAST_REYNOLDS) / normal, Cd * normal] for Re, Cd in points]
    return {"drag": drag} if points else {}


def _added_mass(pipe: PipeOfType) -> dict[str, Any]:
    (key, across), (key_y, y), (key_z, along) = _coefficients(pipe.item, "Ca")
    if y is not None and y != across:
        pipe.item.remark(key_y, f"Ca of {y} in y: it is that in x here")
    if across is None and along is None:
        return {}
    normal, axial = pipe.item.number_in(key, across, 0.0), pipe.item.number_in(key_z, along, 0.0)
    return {"added_mass": {"normal": normal, "tangential": axial}}


def _remark_on_rest(pipe: PipeOfType) -> None:
    item = pipe.item
    for key, what in _LEFT.items():
        if item.choice(key) not in ("", "0", "0.0", "no", "none"):
            item.remark(key, f"{key} {item.word(key)}: {what}")
    default = 0.3 if pipe.homogeneous else 0.5
    if (ratio := item.number("PoissonRatio", default)) != 0.5:
        text = f"PoissonRatio {ratio:g}: the pipe stretches with effective tension here, as for 0.5"
        item.remark("PoissonRatio", text)
    if item.has("OuterContactDiameter") and pipe.contact_diameter != pipe.outermost:
        item.remark("OuterContactDiameter", f"OuterContactDiameter {pipe.contact_diameter:g}: OD touches here")
