"""What a scene does not have of a data file: values that nothing asked for and that say something."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from riser_soil.imported_scene import Remark
from riser_soil.orcaflex.data_file import DataFile
from riser_soil.scene.problem import Path

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
        for n, (told, each) in enumerate(zip(_columns(last, value), value, strict=False)):
            own = f"{told} {each['Name']}" if isinstance(each, dict) and "Name" in each else told
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
