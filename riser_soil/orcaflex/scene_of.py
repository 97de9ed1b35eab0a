"""A scene from a data file, and what of the file it does not have, line by line."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from riser_soil.imported_scene import ImportedScene, Remark, friction
from riser_soil.orcaflex.data_file import DataFile, Item
from riser_soil.orcaflex.environment import seabed, water, waves
from riser_soil.orcaflex.lines import (
    LineEnd,
    chosen,
    contact_diameter,
    contents,
    ends,
    friction_of,
    line_type,
    segments,
    support,
)
from riser_soil.orcaflex.vessels import motion
from riser_soil.scene.problem import Path

GRAVITY = 9.80665  # m/s2, of the SI system
_NOTHING = (None, "", 0, "No", "None", "(none)", "(no damping)")
# Settings of pictures, logs and OrcaFlex's own numerics.
_ITS_OWN = re.compile(
    r"Draw|Default|Shaded|.*Pen$|Log|TargetLog|Jacobian|Restart|Statics(Step|Min|Max|Damping|Tol)|.*Policy$"
    r"|WholeSystemStatics|BuoysIncluded|TimeHistoryImport|FirstStage|.*Warn|Ramp(Start|Finish)Time|StartTime"
    r"|WaveCalculation|Name$|Explicit|Implicit|.*LoadingFactor$|Selected|KinematicViscosity|SeaTemperature|Reynolds"
    r"|Calculat|Air|Wind(Type|Ramping|Direction)|Include.*WindLoads|SeabedSlopeDirection"
)
# What a scene has in any case.
_ALIKE = {
    "DynamicsSolutionMethod": "Implicit time domain", "TopEnd": ("End A", "End B"), "Representation": "Finite element",
    "LengthAndEndOrientations": "Explicit", "PreBendSpecifiedBy": "Curvature", "DragFormulation": "Standard",
    "SeabedModel": "Elastic", "WaveKinematicsCutoffDepth": "Infinity", "BulkModulus": "Infinity", "PyModel": "(none)",
    "IncludedInStatics": "Yes", "ContentsMethod": "Uniform", "IncludeAxialContentsInertia": "Yes",
    "CurrentModel": "Variation scheme", "Connection": "Free", "PrimaryMotion": "None",
    "ConnectionShortestViableSegmentFactor": 0.001, "ConnectionApplyRamp": "Yes",
    "ConnectionUseSmoothGrowth": "Yes", "VerticalDensityVariation": "Constant",
}  # fmt: skip
# Sections of which no more than what was asked for matters: RAOs tell all of a vessel's motion.
_ASKED_ALONE = ("VesselTypes", "VariableData", "Groups", "RayleighDampingCoefficients", "SolidFrictionCoefficients")


def scene_of(file: DataFile, line: str | None = None, stem: str = "scene") -> ImportedScene:
    """The scene of one of the file's lines, by default the first, from its lower end to its upper one.

    stem: of the names of the files that it refers to.
    """
    chosen_line = chosen(file, line)
    both, pieces = ends(file, chosen_line), segments(chosen_line)
    if _height(both[0]) > _height(both[1]):
        both, pieces = both[::-1], pieces[::-1]
    types = {piece["line_type"]: _line_type(file, chosen_line, piece["line_type"]) for piece in pieces}
    riser: dict[str, Any] = {"segments": pieces, "start": support(both[0], *both), "end": support(both[1], *both)}
    riser |= {"contents": filled} if (filled := contents(chosen_line)) else {}
    data: dict[str, Any] = {"title": chosen_line.name, "gravity": GRAVITY, "water": water(file.section("Environment"))}
    data |= {"line_types": {name: line_type(item) for name, item in types.items()}, "riser": riser}
    data |= _ground(file, types[pieces[0]["line_type"]], list(types.values()))
    stages, files = _stages(file, both, data["water"], stem)
    found = ImportedScene(data | {"stages": stages}, files=files)
    found.remarks = sorted({*file.remarks, *unread(file)})
    return found


def _line_type(file: DataFile, line: Item, name: str) -> Item:
    return file.named("LineTypes", name, line, "LineType")


def _height(end: LineEnd) -> float:
    return -float("inf") if end.position is None else end.position[2]


def _ground(file: DataFile, first: Item, types: list[Item]) -> dict[str, Any]:
    """Seabed and friction, of the line type at the lower end where they differ along the line."""
    contact, reported = friction(*friction_of(first))
    if reported:
        first.left("SeabedAxialFrictionCoefficient", reported)
    for each in types:
        if contact_diameter(each) != contact_diameter(first) or friction_of(each) != friction_of(first):
            each.left("OD", f"on the seabed it counts as {first.name}: one contact diameter and friction for all")
    return {"seabed": seabed(file.section("Environment"), contact_diameter(first))} | contact


def _stages(
    file: DataFile, both: list[LineEnd], water: dict[str, Any], stem: str
) -> tuple[list[dict[str, Any]], dict[str, str]]:
    """A static stage; where there are waves, which the water gets, a dynamic one with them from their build-up on."""
    general, files = file.section("General"), dict[str, str]()
    durations = general.get("StageDuration") or []
    hang = {"name": "hang", "kind": "static"}
    found = waves(file.section("Environment"), float(durations[0]) if durations else 0.0, GRAVITY, water["depth"])
    if not found or not durations:
        return [hang], files
    water["waves"] = found
    moved = dict[str, Any]()
    for key, end in zip(("start", "end"), both, strict=True):
        if end.vessel and (driven := motion(file, end.vessel, f"{stem}_{key}_rao.csv")):
            moved[key], files[f"{stem}_{key}_rao.csv"] = {"vessel": driven[0]}, driven[1]
    storm = {"name": "waves", "kind": "dynamic", "duration": float(sum(durations)), "time_step": _time_step(general)}
    return [hang, storm | ({"motion": moved} if moved else {})], files


def _time_step(general: Item) -> Any:
    if general.word("ImplicitUseVariableTimeStep", "No") == "No" and general.has("ImplicitConstantTimeStep"):
        return general.number("ImplicitConstantTimeStep")
    general.left("ImplicitUseVariableTimeStep", "steps of a length of their own: they are `auto` here")
    return "auto"


def unread(file: DataFile) -> Iterator[Remark]:
    """Remarks on them, by line; of an object of which nothing was asked for, one."""
    for section, found in file.document.data.items():
        if section not in _ASKED_ALONE:
            yield from _unread(file, (section,), section, found)


def _unread(file: DataFile, place: Path, name: str, value: Any) -> Iterator[Remark]:
    if place in file.read or _says_nothing(name.rpartition(": ")[2], value):
        return
    within = [*_within(name, place, value)] if _asked(file, place) or len(place) == 1 else []
    if within:
        for each in within:
            yield from _unread(file, *each)
    elif len(place) != 2 or place[0] != "LineTypes":
        yield file.document.where(place)[0], name if isinstance(value, dict) else f"{name} {_shown(value)}"


def _within(name: str, place: Path, value: Any) -> Iterator[tuple[Path, str, Any]]:
    """Places, names and values within a value; columns by their own names."""
    if isinstance(value, dict):
        yield from (((*place, key), f"{name}: {key}", each) for key, each in value.items())
    elif isinstance(value, list):
        *front, last = name.split(": ")
        for n, (reported, each) in enumerate(zip(_columns(last, value), value, strict=False)):
            own = f"{reported} {each['Name']}" if isinstance(each, dict) and "Name" in each else reported
            yield (*place, n), ": ".join([*front, own]), each


def _columns(key: str, values: list[Any]) -> list[str]:
    """Names of a list's values: of a table's row its columns, else the list's own."""
    names = [name.strip() for name in key.split(",")]
    return names if len(names) > 1 and not isinstance(values[0], list) else [key] * len(values)


def _asked(file: DataFile, place: Path) -> bool:
    return any(read[: len(place)] == place for read in file.read)


def _says_nothing(key: str, value: Any) -> bool:
    if isinstance(value, list):
        return not value or all(_says_nothing(*each) for each in zip(_columns(key, value), value, strict=False))
    if isinstance(value, dict):
        return all(_says_nothing(name, each) for name, each in value.items())
    alike = _ALIKE.get(key, ())
    return value in _NOTHING or bool(_ITS_OWN.match(key)) or value in (alike if isinstance(alike, tuple) else (alike,))


def _shown(value: Any) -> str:
    text = " ".join(str(value).split())
    return text if len(text) <= 40 else f"{text[:37]}..."
