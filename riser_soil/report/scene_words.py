"""The scene of a run in words and figures, by the scene language's own descriptions and units."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from pydantic import BaseModel

from riser_soil.errors import RiserSoilError
from riser_soil.report.tables import NOTHING, ReportTable, compact, number
from riser_soil.results import Run
from riser_soil.scene.scene import Scene

_UNIT = re.compile(r"\[([^\[\],\s]{1,12})\]")
_LONG = 120  # characters
# What stands in a table of its own, or is no part of the model.
_ELSEWHERE = ("title", "line_types", "riser", "stages", "output", "accuracy", "error_bars")
_PIPE = (  # path of a line type's key, its head
    ("outer_diameter", "outer ⌀ [m]"),
    ("inner_diameter", "inner ⌀ [m]"),
    ("mass", "mass [kg/m]"),
    ("EA", "EA [N]"),
    ("EI", "EI [N.m²]"),
    ("EI_y", "EI_y [N.m²]"),
    ("EI_z", "EI_z [N.m²]"),
    ("GJ", "GJ [N.m²]"),
    ("submerged_weight", "submerged weight [N/m]"),
    ("min_bend_radius", "min bend radius [m]"),
    ("max_tension", "max tension [N]"),
    ("drag.normal", "normal drag [-]"),
    ("drag.tangential", "tangential drag [-]"),
    ("added_mass.normal", "normal added mass [-]"),
    ("added_mass.tangential", "tangential added mass [-]"),
    ("damping.ratio", "damping ratio [-]"),
    ("damping.frequency", "of damping [Hz]"),
    ("wall.outer_diameter", "outer ⌀ of the wall [m]"),
    ("wall.inner_diameter", "inner ⌀ of the wall [m]"),
    ("wall.yield_stress", "yield stress [Pa]"),
    ("wall.design_factor", "design factor [-]"),
)


def read(run: Run) -> Scene | None:
    """The run's scene; None where its file can't be read."""
    try:
        return run.read_scene()
    except (RiserSoilError, OSError):
        return None


def prose(scene: Scene, run: Run) -> list[str]:
    """Sentences: the riser, its ends, the ground, the water, the stages."""
    reported = (_riser(scene, run), _hang_off(run), _vessel(run), _ground(scene), _water(scene), _stages(scene))
    return [sentence for sentence in reported if sentence]


def segments_table(scene: Scene) -> ReportTable:
    """The riser's stretches from its start to its end."""
    rows, begin = [], 0.0
    for segment in scene.line.segments:
        size = segment.element_length if segment.elements is None else None
        graded = " to ".join(text(each) for each in (size if isinstance(size, tuple) else (size,)))
        mesh = f"{segment.elements} elements" if size is None else f"elements of {graded} m"
        end = begin + segment.length
        rows.append([segment.line_type, number(begin), number(end), number(segment.length), mesh])
        begin = end
    return ReportTable(("line type", "from arc [m]", "to arc [m]", "length [m]", "mesh"), rows)


def pipes_table(scene: Scene) -> ReportTable:
    """The line types' properties; those that none has are left out."""
    rows = [[name, *(_cell(_at(pipe, path)) for path, _ in _PIPE)] for name, pipe in scene.line_types.items()]
    return compact(ReportTable(("line type", *(head for _, head in _PIPE)), rows))


def parts_table(scene: Scene) -> ReportTable:
    """All else that the scene gives, contents and ends of the riser first, key by key, with unit and meaning."""
    rows: list[Sequence[str]] = []
    for name, value in scene.line:
        if name != "segments":
            rows += _rows(type(scene.line), name, value, ("riser", name))
    for name, value in scene:
        if name not in _ELSEWHERE:
            rows += _rows(type(scene), name, value, (name,))
    return ReportTable(("key", "value", "unit", "meaning"), rows)


def stages_table(scene: Scene) -> ReportTable:
    """What each stage does, key by key."""
    rows: list[Sequence[str]] = []
    for stage in scene.stages:
        for key, value in stage:
            if key != "name":
                rows += _rows(type(stage), key, value, (stage.name, key))
    return ReportTable(("key", "value", "unit", "meaning"), rows)


def text(value: Any) -> str:
    """A value of a scene in short words."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int | float):
        return number(float(value))
    if isinstance(value, list | tuple):
        return f"({', '.join(text(item) for item in value)})" if len(value) <= 12 else f"{len(value)} entries"
    return str(value)


def _rows(model: type[BaseModel], name: str, value: Any, path: tuple[str, ...]) -> Iterator[Sequence[str]]:
    """A row of each key that has a value, nested ones by their paths."""
    if value is None or value == () or value == []:
        return
    if isinstance(value, BaseModel):
        for key, inner in value:
            yield from _rows(type(value), key, inner, (*path, key))
    elif isinstance(value, Mapping):
        for key, inner in value.items():
            yield from _rows(model, name, inner, (*path, str(key)))
    elif isinstance(value, list | tuple) and value and isinstance(value[0], BaseModel):
        for n, inner in enumerate(value):
            yield from _rows(model, name, inner, (*path, str(n)))
    elif name in model.model_fields:  # what a table's file holds is none of them
        meaning = model.model_fields[name].description or ""
        unit = _UNIT.search(meaning) if value == "auto" or not isinstance(value, str) else None
        yield [".".join(path), text(value), unit[1] if unit else "", _clause(meaning)]


def _clause(meaning: str) -> str:
    """A long description's first clause."""
    return meaning if len(meaning) <= _LONG else meaning.split("; ")[0]


def _at(model: BaseModel, path: str) -> Any:
    """The value at a dotted path; None where there is nothing on the way."""
    value: Any = model
    for key in path.split("."):
        value = getattr(value, key, None)
    return value


def _cell(value: Any) -> str:
    return NOTHING if value is None else text(value)


def _riser(scene: Scene, run: Run) -> str:
    length, position = float(run.arc[-1]), run["position"][0]
    start, end = (text([float(x) for x in position[at]]) for at in (0, -1))
    count = len(scene.line.segments)
    inside = scene.line.contents
    filled = f", filled with {number(inside.density)} kg/m³" if inside is not None else ""
    stretches = "one segment" if count == 1 else f"{count} segments"
    meshed = f"A riser of {number(length)} m in {stretches}{filled}, in {len(run.arc) - 1} elements"
    return f"{meshed}; its start at {start} m, its end at {end} m (x, y, z; z up)."


def _hang_off(run: Run) -> str:
    """The hang-off asked for, and what it was solved to."""
    reported = run.summary.get("hang_off")
    if reported is None:
        return ""
    angle, tension = (reported["asked"].get(key) for key in ("angle_deg", "tension"))
    asked = f"at {number(angle)}° from the vertical" if angle is not None else f"with {number(1e-3 * tension)} kN"
    return f"Its {reported['end']} hangs off {asked}, as asked, by a {reported['by']} of {number(reported['value'])} m."


def _vessel(run: Run) -> str:
    """The offset of the vessel."""
    reported = run.summary.get("vessel")
    if reported is None:
        return ""
    moved = (f"{name} from {text(each['from'])} m to {text(each['to'])} m" for name, each in reported["ends"].items())
    return f"The vessel is at an offset of {text(reported['offset'])} m, which moves {', '.join(moved)}."


def _ground(scene: Scene) -> str:
    seabed = None if scene.seabed is None else f"a {scene.seabed.kind} seabed"
    if scene.soil is not None:
        beside = "" if seabed is None else f", with {seabed} beside it"
        return f"The ground is a block of soil ({getattr(scene.soil.law, 'kind', 'given')}){beside}."
    return "There is no ground." if seabed is None else f"The ground is {seabed}."


def _water(scene: Scene) -> str:
    water = scene.water
    if water is None:
        return "It hangs in air."
    has = [word for word, there in (("current", water.current), ("waves", water.waves)) if there is not None]
    surface = "" if water.surface_level is None else f", its surface at z = {number(water.surface_level)} m"
    return f"Water of {number(water.density)} kg/m³{surface}, {'with ' + ' and '.join(has) if has else 'still'}."


def _stages(scene: Scene) -> str:
    lasts = {stage.name: f", {number(stage.duration)} s" for stage in scene.stages if stage.kind != "static"}
    return f"Stages: {', '.join(f'{s.name} ({s.kind}{lasts.get(s.name, str())})' for s in scene.stages)}."
