"""Case file: a base scene, the parameters that cases vary, and how their results are evaluated."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated, Any

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    Discriminator,
    Field,
    Tag,
    ValidationError,
    ValidationInfo,
)
from pydantic_core import PydanticCustomError

from riser_soil.core.quantities import FROZEN, Angle, Instant, Length, Share, Text, Time
from riser_soil.errors import SceneError
from riser_soil.scene.columns import lines_of
from riser_soil.scene.document import parse, read_text, refuse_others
from riser_soil.scene.explain import problems_in
from riser_soil.scene.files import NamedFile, wrong_file
from riser_soil.scene.reader import error_of
from riser_soil.scene.vessel_offset import Offset
from riser_soil.scene.wave_kinds import Seed
from riser_soil.variants.variant import Overrides

MOST_LETTERS = 100
MOST_SEEDS = 1000
WAYS = ("sea_states", "directions", "offsets", "soil", "seeds", "table", "product")  # keys by which cases vary
_NAME = re.compile(rf"[A-Za-z0-9_+=][\w.+=-]{{,{MOST_LETTERS - 1}}}", re.ASCII)
PERCENT = re.compile(r"(\d+(?:\.\d*)?) *%")
_NEEDS = f"the case file is empty; it needs base, and one of {', '.join(WAYS)}"
_ALLOWED = f"must be a name of at most {MOST_LETTERS} letters, digits and . _ + = -, that begins with no point or minus"


def _name_given(text: str) -> str:
    if not is_name(text):
        raise PydanticCustomError("choice", "{text}", {"text": _ALLOWED})
    return text


def is_name(text: str) -> bool:
    """Whether a text can be the name of a case, and of its folder."""
    return _NAME.fullmatch(text) is not None


CaseName = Annotated[Text, AfterValidator(_name_given)]


class TableRow(BaseModel):
    """One row of the table."""

    model_config = FROZEN

    name: CaseName | None = Field(default=None, description="name of the case; by default it follows from its values")
    values: Overrides = Field(alias="set", min_length=1, description="values of the scene by their paths, as of --set")


def _rows(given: Any, info: ValidationInfo) -> Any:
    """Rows of the table: those of a CSV file where its name is given."""
    if not isinstance(given, str):
        return given
    file = (Path((info.context or {}).get("folder", ".")) / given).absolute()
    lines = list(lines_of(file))
    if len(lines) < 2:
        raise wrong_file(f"{file}: must have a line of paths of the scene, and a row for each case; complete it")
    (at, paths), *rows = lines
    if len(set(paths)) < len(paths) or not all(paths):
        raise wrong_file(f"{file}:{at}: every column needs a path of its own; correct the first line")
    return [_row(f"{file}:{number}", paths, cells) for number, cells in rows]


def _row(place: str, paths: list[str], cells: list[str]) -> dict[str, Any]:
    """A row of the table by its cells; an empty cell means the base scene's value."""
    if len(cells) != len(paths):
        raise wrong_file(f"{place}: the row has {len(cells)} values for {len(paths)} columns; complete it")
    try:
        values = {path: parse(cell, place).data for path, cell in zip(paths, cells, strict=True) if cell}
    except SceneError as err:
        raise wrong_file(f"{err}") from err
    name = values.pop("name", None)
    return ({} if name is None else {"name": str(name)}) | {"set": values}


def _sea_states(given: Any, info: ValidationInfo) -> Any:
    """Sea states by their names: those of a CSV file where its name is given."""
    if not isinstance(given, str):
        return given
    states: dict[str, Any] = {}
    for row in _rows(given, info):
        name = row.get("name") or "-".join(f"{key}={value}" for key, value in row["set"].items())
        if name in states:
            raise wrong_file(f"{given}: two sea states are named {name}; give each a name of its own")
        states[name] = row["set"]
    return states


def _axis_of(value: Any) -> str | None:
    return "<list>" if isinstance(value, list | tuple) else "<groups>" if isinstance(value, dict) else None


_Axis = Annotated[
    Annotated[tuple[Any, ...], Field(min_length=1), Tag("<list>")]
    | Annotated[dict[CaseName, Overrides], Field(min_length=1), Tag("<groups>")],
    Discriminator(
        _axis_of,
        custom_error_type="choice",
        custom_error_message="must be a list of values, or a mapping of names to {path: value}",
    ),
]


def _number_or(kinds: type | tuple[type, ...], word: str, value: Any) -> str | None:
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return "<number>" if is_number else f"<{word}>" if isinstance(value, kinds) else None


_OFFSETS = "must be a distance [m], a share of the water depth, as 5 %, or a mapping of names to offsets [dx, dy]"


def _share_given(text: str) -> str:
    percent = PERCENT.fullmatch(text)
    if percent is None or not float(percent[1]) > 0.0:
        raise PydanticCustomError("choice", "{text}", {"text": _OFFSETS})
    return text


_Offsets = Annotated[
    Annotated[Length, Tag("<number>")]
    | Annotated[str, AfterValidator(_share_given), Tag("<share>")]
    | Annotated[dict[CaseName, Offset], Field(min_length=1), Tag("<places>")],
    Discriminator(
        lambda value: "<share>" if isinstance(value, str) else _number_or(dict, "places", value),
        custom_error_type="choice",
        custom_error_message=_OFFSETS,
    ),
]
_Seeds = Annotated[
    Annotated[int, Field(strict=True, ge=1, le=MOST_SEEDS), Tag("<number>")]
    | Annotated[tuple[Seed, ...], Field(min_length=1, max_length=MOST_SEEDS), Tag("<list>")],
    Discriminator(
        lambda value: _number_or((list, tuple), "list", value),
        custom_error_type="choice",
        custom_error_message="must be how many seeds there are, or a list of them",
    ),
]


class Statistics(BaseModel):
    """Statistics over the last dynamic stage of each case."""

    model_config = FROZEN

    since: Instant = Field(
        default=0.0, description="time of that stage from which on means and characteristic extremes count [s]"
    )


class WantedExtremes(BaseModel):
    """Characteristic extremes from cases that differ in the seed of their waves alone."""

    model_config = FROZEN

    fractile: Share = Field(
        default=0.9, description="probability that the extreme in the duration is not beyond the characteristic one [-]"
    )
    duration: Time = Field(default=10800.0, description="how long the sea state lasts that extremes are for [s]")
    confidence: Share = Field(default=0.9, description="of the interval around the characteristic extreme [-]")


class Cases(BaseModel):
    """A case file: values of all cases, and the parameters that they vary."""

    model_config = FROZEN

    base: NamedFile = Field(description="scene file of all cases")
    values: Overrides = Field(default={}, alias="set", description="values that all cases have in place of the base's")
    sea_states: Annotated[dict[CaseName, Overrides], BeforeValidator(_sea_states)] = Field(
        default={},
        min_length=1,
        description="{name: {Hs: …, Tp: …}}, keys of the base scene's waves or whole paths of the scene; or a CSV file "
        "with a column for each",
    )
    directions: tuple[Angle, ...] = Field(
        default=(), min_length=1, description="directions towards which the waves travel, from x towards y [deg]"
    )
    offsets: _Offsets | None = Field(
        default=None,
        description="of the vessel [m]: a distance, or a share of the water depth as 5 %, for near, mean and far along "
        "the line's plane; or {name: [dx, dy]}",
    )
    soil: dict[CaseName, Overrides] = Field(
        default={},
        min_length=1,
        description="bounds of the ground, {lower: {path: value, …}, best: {}, upper: {…}}, paths as of --set",
    )
    seeds: _Seeds | None = Field(
        default=None, description="seeds of the waves: how many, counted from 1, or a list of them"
    )
    table: Annotated[tuple[TableRow, ...], BeforeValidator(_rows)] = Field(
        default=(),
        description="cases one by one, [{name: …, set: {path: value}}, …], or a CSV file with a column for each path",
    )
    product: dict[str, _Axis] = Field(
        default={},
        description="path: [values], or name: {value's name: {path: value}}; every combination is a case, with a table "
        "for each of its rows",
    )
    statistics: Statistics = Field(default=Statistics(), description="mean and standard deviation in time")
    extremes: WantedExtremes = Field(
        default=WantedExtremes(), description="characteristic extremes over the seeds of a sea state"
    )


def read_case_file(file: Path) -> Cases:
    """Read a case file; SceneError has one line per problem. It is plain YAML: nothing in it is executed."""
    document = refuse_others(parse(read_text(file), str(file), _NEEDS), "case file")
    try:
        cases = Cases.model_validate(document.data, context={"folder": file.parent})
    except ValidationError as err:
        raise error_of(problems_in(err, document.data, Cases), document) from err
    if not any(getattr(cases, way) for way in WAYS):
        raise SceneError(f"{file}: its cases differ in nothing; give one of {', '.join(WAYS)}")
    return cases
