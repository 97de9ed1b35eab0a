"""A scene from a data file, and what of the file it does not have, line by line."""

from __future__ import annotations

from typing import Any

from riser_soil.imported_scene import ImportedScene, friction
from riser_soil.orcaflex.data_file import DataFile, Item
from riser_soil.orcaflex.environment import seabed, water
from riser_soil.orcaflex.line_types import contact_diameter, friction_of, line_type
from riser_soil.orcaflex.lines import LineEnd, chosen, contents, ends, segments, support
from riser_soil.orcaflex.unread import unread
from riser_soil.orcaflex.vessels import motion
from riser_soil.orcaflex.waves import waves

GRAVITY = 9.80665  # m/s2, of the SI system


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
    contact, told = friction(*friction_of(first))
    if told:
        first.left("SeabedAxialFrictionCoefficient", told)
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
