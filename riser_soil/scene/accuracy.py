"""Scene language: an accuracy in place of elements, time steps, the soil's mesh and the penalty."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Annotated, Any

from pydantic import BeforeValidator

from riser_soil.core.quantities import wrong

FINEST, COARSEST = 1e-4, 0.2
_PERCENT = re.compile(r"\s*(\d+(?:\.\d*)?|\.\d+)\s*%\s*")
_REPORTED = "must be a percentage from 0.01 % to 20 %"


def _share(value: Any) -> float:
    """A percentage as a share."""
    match = _PERCENT.fullmatch(value) if isinstance(value, str) else None
    share = float(match[1]) / 100.0 if match else value
    if isinstance(share, bool) or not isinstance(share, float) or not FINEST <= share <= COARSEST:
        raise wrong("", _REPORTED, "write accuracy: 1 %")
    return share


Accuracy = Annotated[float, BeforeValidator(_share, json_schema_input_type=str | float)]


def with_placeholders(data: dict[str, Any]) -> dict[str, Any]:
    """A scene's data with what an accuracy stands for, to be chosen later; refused where it is given beside it."""
    if data.get("accuracy") is None:
        return data
    for key in _chosen_keys(data):
        raise wrong("accuracy", f"chooses what {key} gives", f"leave out {key}, or accuracy")
    lines, stages = data.get("lines"), data.get("stages")
    if data.get("riser") is not None:
        data = data | {"riser": _with_elements(data["riser"])}
    if isinstance(lines, dict):
        data = data | {"lines": {name: _with_elements(line) for name, line in lines.items()}}
    if isinstance(data.get("soil"), dict):
        data = data | {"soil": data["soil"] | {"mesh": "auto"}}
    if isinstance(stages, list):
        data = data | {"stages": [_stepped(stage) for stage in stages]}
    return data


def _chosen_keys(data: dict[str, Any]) -> Iterator[str]:
    """Paths of keys that an accuracy stands for."""
    lines = data.get("lines")
    for line in (("riser",), *(("lines", str(name)) for name in (lines if isinstance(lines, dict) else ()))):
        for n, segment in enumerate(_listed(data, *line, "segments")):
            given = [key for key in ("elements", "element_length") if _given(segment, key)]
            yield from (".".join((*line, "segments", str(n), key)) for key in given)
    for n, stage in enumerate(_listed(data, "stages")):
        yield from (f"stages.{n}.{key}" for key in ("time_step", "tolerance") if _given(stage, key))
    for part, key in (("contact", "stiffness"), ("soil", "mesh")):
        if _given(data.get(part), key) and data[part][key] != "auto":
            yield f"{part}.{key}"


def _listed(data: Any, *keys: str) -> list[Any]:
    for key in keys:
        data = data.get(key) if isinstance(data, dict) else None
    return data if isinstance(data, list) else []


def _given(data: Any, key: str) -> bool:
    return isinstance(data, dict) and data.get(key) is not None


def _with(data: Any, **more: Any) -> Any:
    return data | more if isinstance(data, dict) else data


def _with_elements(line: Any) -> Any:
    segments = _listed(line, "segments")
    return _with(line, segments=[_with(each, elements=1) for each in segments]) if segments else line


def _stepped(stage: Any) -> Any:
    dynamic = isinstance(stage, dict) and stage.get("kind") == "dynamic"
    return _with(stage, time_step="auto") if dynamic else stage
