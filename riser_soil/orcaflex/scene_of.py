"""A scene from a data file, and what of the file it does not have, line by line."""

from __future__ import annotations

import math
import re
from typing import Any

from riser_soil.errors import SceneError
from riser_soil.imported_scene import ImportedScene
from riser_soil.orcaflex.data_file import DataFile, Item, folded
from riser_soil.orcaflex.environment import water
from riser_soil.orcaflex.left_out import left_out
from riser_soil.orcaflex.lines import LineEnd, LineWithEnds, lay, line_of, line_types_of
from riser_soil.orcaflex.seabed import ground_of
from riser_soil.orcaflex.vessels import motion
from riser_soil.orcaflex.waves import waves
from riser_soil.scene.problem import Path as KeyPath

GRAVITY = 9.80665  # m/s2, of the SI system
ALL = "all"
_ENDS = ("start", "end")


def scene_of(file: DataFile, line: str | None = None, stem: str = "scene") -> ImportedScene:
    """The scene of one of the file's lines, by default the first, or of all of them, each from its lower end to its
    upper one; SceneError with all that stands against it, and all that would be left out.

    stem: of the names of the files that it refers to.
    """
    chosen = _chosen(file, line)
    lines = [each for item in chosen if (each := line_of(file, item))]
    data: dict[str, Any] = {"title": _title(file, chosen), "gravity": GRAVITY}
    types, environment = line_types_of(lines), file.section("Environment")
    data["water"] = water(environment, any("by_reynolds" in each.get("drag", {}) for each in types.values()))
    data |= {"line_types": types} | _as_riser_or_lines(lines, line == ALL)
    if lines:
        pipes = [lines[0].at_ends[0], *(pipe for each in lines for pipe in each.types.values())]
        data |= ground_of(environment, pipes, GRAVITY)
    for each in lines:
        lay(each, data["seabed"].get("level", -math.inf))
    stages, files = _stages(file, lines, data["water"], stem, line == ALL)
    imported = ImportedScene(data | {"stages": stages}, left_out(file), files, _origins(file, lines, line == ALL))
    file.end_if_refused(imported.remarks)
    return imported


def _chosen(file: DataFile, name: str | None) -> list[Item]:
    """The line of this name, by default the file's first, or all; SceneError where there is none."""
    lines = file.objects("Lines")
    if name == ALL and lines:
        return lines
    chosen = [each for each in lines if name is None or folded(each.title) == folded(name)]
    if not chosen:
        known = ", ".join(each.title for each in lines) or "none"
        raise SceneError(f"{file.document.name}: there is no line {name or 'at all'}; it has {known}")
    for n, each in enumerate(lines):
        if each.values is not chosen[0].values:
            each.remark("Name", f"a scene has one riser; --line {each.title!r} imports this one, --line all all lines")
            file.read.add((_section(file, "Lines"), n))
    return chosen[:1]


def _section(file: DataFile, name: str) -> str:
    """A section's name as the file has it."""
    return next(key for key in file.document.data if folded(key) == folded(name))


def _title(file: DataFile, chosen: list[Item]) -> str:
    return chosen[0].name if len(chosen) == 1 else file.document.name


def _as_riser_or_lines(lines: list[LineWithEnds], several: bool) -> dict[str, Any]:
    """Part of the scene; empty where the line was refused."""
    if several:
        return {"lines": {each.item.title: each.data for each in lines}}
    return {"riser": lines[0].data} if lines else {}


def _origins(file: DataFile, lines: list[LineWithEnds], several: bool) -> dict[KeyPath, int]:
    """The file's lines by what of the scene comes from them."""
    environment, origins = file.section("Environment"), dict[KeyPath, int]()
    asked = {("water",): "Density", ("water", "waves"): "WaveTrains", ("water", "current"): "RefCurrentSpeed",
             ("seabed",): "SeabedModel"}  # fmt: skip
    origins |= {path: environment.line(key) for path, key in asked.items()}
    origins["stages",] = file.section("General").line("StageDuration")
    for line in lines:
        whole: KeyPath = ("lines", line.item.title) if several else ("riser",)
        origins |= {(*whole, *path): number for path, number in line.origins.items()}
        origins |= {("line_types", name): pipe.item.line("Name") for name, pipe in line.types.items()}
    return origins


def _stages(
    file: DataFile, lines: list[LineWithEnds], water: dict[str, Any], stem: str, several: bool
) -> tuple[list[dict[str, Any]], dict[str, str]]:
    """A static stage; where there are waves, which the water gets, a dynamic one with them from their build-up on."""
    general = file.section("General")
    durations = general.all_numbers("StageDuration")
    hang = {"name": "hang", "kind": "static"}
    sea = waves(file.section("Environment"), durations[0] if durations else 0.0, GRAVITY, water["depth"])
    if not sea or not durations:
        return [hang], {}
    water["waves"] = sea
    files, moved = dict[str, str](), dict[str, dict[str, Any]]()
    for line in lines:
        if ends := _driven(file, line, stem, files):
            moved[line.item.title] = {"motion": ends}
    storm = {"name": "waves", "kind": "dynamic", "duration": sum(durations), "time_step": _time_step(general)}
    if several:
        return [hang, storm | ({"lines": moved} if moved else {})], files
    return [hang, *({**storm, **each} for each in moved.values() or [{}])], files


def _driven(file: DataFile, line: LineWithEnds, stem: str, files: dict[str, str]) -> dict[str, Any]:
    """Motions of a line's ends that vessels carry; files gets the RAOs, one file for each vessel."""
    driven = {key: _on_vessel(file, end, stem, files) for key, end in zip(_ENDS, line.ends, strict=True)}
    return {key: motion for key, motion in driven.items() if motion}


def _on_vessel(file: DataFile, end: LineEnd, stem: str, files: dict[str, str]) -> dict[str, Any] | None:
    if end.vessel is None:
        return None
    vessel = re.sub(r"\W+", "_", end.vessel.title).strip("_") or "vessel"
    vessel_motion = motion(file, end.vessel, f"{stem}_{vessel}_rao.csv")
    if vessel_motion is None:
        return None
    files[vessel_motion[0]["rao"]] = vessel_motion[1]
    return {"vessel": vessel_motion[0]}


def _time_step(general: Item) -> Any:
    if general.choice("ImplicitUseVariableTimeStep", "No") == "no" and general.has("ImplicitConstantTimeStep"):
        return general.number("ImplicitConstantTimeStep")
    general.remark("ImplicitUseVariableTimeStep", "steps of a length of their own: they are `auto` here")
    return "auto"
