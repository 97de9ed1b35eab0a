"""Case file: a base scene, and a table or product of overrides, or both."""

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

from riser_soil.core.quantities import FROZEN, Instant, Text
from riser_soil.errors import SceneError
from riser_soil.scene.columns import lines_of
from riser_soil.scene.document import parse, read_text
from riser_soil.scene.explain import problems_in
from riser_soil.scene.files import NamedFile, wrong_file
from riser_soil.scene.reader import error_of

MOST_LETTERS = 100
_NAME = re.compile(rf"[A-Za-z0-9_+=][\w.+=-]{{,{MOST_LETTERS - 1}}}", re.ASCII)
_NEEDS = "the case file is empty; it needs base, and table or product"
_ALLOWED = f"must be a name of at most {MOST_LETTERS} letters, digits and . _ + = -, that begins with no point or minus"


def _name(text: str) -> str:
    if not is_name(text):
        raise PydanticCustomError("choice", "{text}", {"text": _ALLOWED})
    return text


def is_name(text: str) -> bool:
    """Whether it can be the name of a case, and of its folder."""
    return _NAME.fullmatch(text) is not None


Overrides = dict[str, Any]
"""Values by the paths that `run --set` takes."""
CaseName = Annotated[Text, AfterValidator(_name)]


class TableRow(BaseModel):
    """One row of the table."""

    model_config = FROZEN

    name: CaseName | None = Field(default=None, description="name of the case; by default it follows from its values")
    values: Overrides = Field(alias="set", min_length=1, description="values of the scene by their paths, as of --set")


def _rows(given: Any, info: ValidationInfo) -> Any:
    """The rows of a CSV file in place of its name."""
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
    """An empty cell leaves the base scene's value."""
    if len(cells) != len(paths):
        raise wrong_file(f"{place}: the row has {len(cells)} values for {len(paths)} columns; complete it")
    try:
        values = {path: parse(cell, place).data for path, cell in zip(paths, cells, strict=True) if cell}
    except SceneError as err:
        raise wrong_file(f"{err}") from err
    name = values.pop("name", None)
    return ({} if name is None else {"name": str(name)}) | {"set": values}


def _axis(value: Any) -> str | None:
    return "<list>" if isinstance(value, list | tuple) else "<groups>" if isinstance(value, dict) else None


_Axis = Annotated[
    Annotated[tuple[Any, ...], Field(min_length=1), Tag("<list>")]
    | Annotated[dict[CaseName, Overrides], Field(min_length=1), Tag("<groups>")],
    Discriminator(
        _axis,
        custom_error_type="choice",
        custom_error_message="must be a list of values, or a mapping of names to {path: value}",
    ),
]


class Statistics(BaseModel):
    """Of the last dynamic stage of each case."""

    model_config = FROZEN

    since: Instant = Field(default=0.0, description="time of that stage from which on means are taken [s]")


class Cases(BaseModel):
    """A case file: what all cases have, and in what they differ."""

    model_config = FROZEN

    base: NamedFile = Field(description="scene file of all cases")
    values: Overrides = Field(default={}, alias="set", description="values that all cases have in place of the base's")
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


def read_case_file(file: Path) -> Cases:
    """The case file; SceneError has one line per problem found. Plain YAML: nothing in it is ever executed."""
    document = parse(read_text(file), str(file), _NEEDS)
    try:
        cases = Cases.model_validate(document.data, context={"folder": file.parent})
    except ValidationError as err:
        raise error_of(problems_in(err, document.data, Cases), document) from err
    if not cases.table and not cases.product:
        raise SceneError(f"{file}: has neither table nor product; add one of them: in what the cases differ")
    return cases
