"""From a case file, a base scene with a table or product of overrides, to its cases, checked scenes."""

from __future__ import annotations

import hashlib
import math
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass, replace
from functools import cache
from itertools import product
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

from riser_soil import __version__
from riser_soil.core.quantities import FROZEN, Instant, Text
from riser_soil.errors import SceneError
from riser_soil.results.folder import CHECKPOINT
from riser_soil.scene.columns import lines_of
from riser_soil.scene.document import Document, parse, read_text, refuse_others
from riser_soil.scene.dump import dump_scene
from riser_soil.scene.explain import problems_in
from riser_soil.scene.files import NamedFile, wrong_file
from riser_soil.scene.identity import paths_in
from riser_soil.scene.overrides import override, put_once
from riser_soil.scene.problem import shown
from riser_soil.scene.reader import checked, error_of, read_document
from riser_soil.scene.scene import Scene

MOST_CASES = 100_000
MOST_LINES = 20
MOST_LETTERS = 100
_NAME = re.compile(rf"[A-Za-z0-9_+=][\w.+=-]{{,{MOST_LETTERS - 1}}}", re.ASCII)
_NEEDS = "the case file is empty; it needs base, and table or product"
_ALLOWED = f"must be a name of at most {MOST_LETTERS} letters, digits and . _ + = -, that begins with no point or minus"


def _name_given(text: str) -> str:
    if not is_name(text):
        raise PydanticCustomError("choice", "{text}", {"text": _ALLOWED})
    return text


def is_name(text: str) -> bool:
    """Whether it can be the name of a case, and of its folder."""
    return _NAME.fullmatch(text) is not None


Overrides = dict[str, Any]
"""Values by the paths that `run --set` takes."""
CaseName = Annotated[Text, AfterValidator(_name_given)]


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
    document = refuse_others(parse(read_text(file), str(file), _NEEDS), "case file")
    try:
        cases = Cases.model_validate(document.data, context={"folder": file.parent})
    except ValidationError as err:
        raise error_of(problems_in(err, document.data, Cases), document) from err
    if not cases.table and not cases.product:
        raise SceneError(f"{file}: has neither table nor product; add one of them: in what the cases differ")
    return cases


@dataclass(frozen=True)
class Case:
    """A run to be had. values: by their paths, in what it differs from the base scene. scene: resolved, as text.

    key: digest of its scene, the files that this names, and the program's version: what would give the same results.
    """

    name: str
    values: Overrides
    scene: str = ""
    key: str = ""


def read_cases(file: Path, overrides: Sequence[str] = ()) -> tuple[Cases, list[Case]]:
    """The cases of a file, all scenes checked; overrides: of the base scene. SceneError has one line per problem."""
    reported = read_case_file(file)
    document = read_document(reported.base)
    cases, problems = [], dict[str, None]()
    for case in named_cases(file, reported):
        try:
            own = deepcopy(document)
            _put(own, reported.values, f"{file}: set")
            override(own, overrides)
            _put(own, case.values, f"{file}: case {case.name}:")
            cases.append(_resolved(case, own, reported.base.parent))
        except SceneError as err:
            problems |= dict.fromkeys(str(err).splitlines())  # what is the base's to blame is told once
    if problems:
        more = len(problems) - MOST_LINES
        raise SceneError("\n".join([*list(problems)[:MOST_LINES], *([f"… and {more} more"] if more > 0 else [])]))
    return reported, cases


def named_cases(file: Path, reported: Cases) -> list[Case]:
    """All combinations in their order, the last key of the product changing first; SceneError where names coincide."""
    short = _short_names([*reported.product, *(path for row in reported.table for path in row.values)])
    rows = [Case(row.name or _name(row.values, short), row.values) for row in reported.table]
    axes = [rows] if rows else []
    axes += [_axis(path, values, short) for path, values in reported.product.items()]
    count = math.prod(len(axis) for axis in axes)
    if count > MOST_CASES:
        raise SceneError(f"{file}: {count} cases, more than {MOST_CASES}; divide them over several files")
    cases = [_together(parts) for parts in product(*axes)]
    _refuse_twice(file, rows, reported.product)
    for name, times in Counter(case.name for case in cases).items():
        if times > 1:
            raise SceneError(f"{file}: {times} cases would be named {name}; give rows and groups names of their own")
        if not is_name(name):
            raise SceneError(f"{file}: case {name}: more than {MOST_LETTERS} letters; give rows and groups short names")
    return cases


def _refuse_twice(file: Path, rows: Sequence[Case], axes: Mapping[str, Any]) -> None:
    """Raises SceneError for a path that the table and the product set, or two keys of the product."""
    set_by = [{path for row in rows for path in row.values}, *(_paths(name, axis) for name, axis in axes.items())]
    for path, times in Counter(path for paths in set_by for path in paths).items():
        if times > 1:
            raise SceneError(f"{file}: {path}: is set {times} times in one case; let one key alone set it")


def _paths(name: str, axis: Any) -> set[str]:
    """All that a key of the product sets."""
    return {path for group in axis.values() for path in group} if isinstance(axis, Mapping) else {name}


def _axis(path: str, values: Sequence[Any] | Mapping[str, Overrides], short: Mapping[str, str]) -> list[Case]:
    if isinstance(values, Mapping):
        return [Case(name, group) for name, group in values.items()]
    return [Case(_value_name(path, value, n, short), {path: value}) for n, value in enumerate(values, start=1)]


def _together(parts: Sequence[Case]) -> Case:
    return Case("-".join(part.name for part in parts), {path: v for part in parts for path, v in part.values.items()})


def _name(values: Overrides, short: Mapping[str, str]) -> str:
    return "-".join(_value_name(path, value, None, short) for path, value in values.items())


def _value_name(path: str, value: Any, number: int | None, short: Mapping[str, str]) -> str:
    """`Hs=6.5`, `kind=rigid`; of lists and mappings the number among the values: `position_2`."""
    if isinstance(value, list | dict) and number is not None:
        return f"{short[path]}_{number}"
    text = f"{value:g}" if isinstance(value, float) and float(f"{value:g}") == value else str(value)
    return short[path] + "=" + re.sub(r"[^\w.+-]+", "_", text, flags=re.ASCII).strip("_")


def _short_names(paths: Sequence[str]) -> dict[str, str]:
    """The last words of each path that tell it from the others; numbers of lists don't tell alone."""
    unique = list(dict.fromkeys(paths))
    found = {}
    for path in unique:
        words = path.split(".")
        endings = (words[-n:] for n in range(1, len(words) + 1))
        telling = (e for e in endings if not e[0].isdecimal() and sum(_ends(other, e) for other in unique) == 1)
        found[path] = re.sub(r"[^\w]+", "_", "_".join(next(telling, words)), flags=re.ASCII)
    return found


def _ends(path: str, words: list[str]) -> bool:
    return path.split(".")[-len(words) :] == words


def _put(document: Document, values: Overrides, place: str) -> None:
    for path, value in values.items():
        put_once(document, path, deepcopy(value), f"{place} {path}={shown(value)}")


def _resolved(case: Case, document: Document, folder: Path) -> Case:
    """The case with its scene; its results have their place among the cases, whatever the scene says."""
    scene = checked(document, folder)
    scene = scene.model_copy(update={"output": scene.output.model_copy(update={"directory": None})})
    text = dump_scene(scene)
    return replace(case, scene=text, key=_key(scene, text))


def _key(scene: Scene, text: str) -> str:
    reported = hashlib.sha256(f"{__version__}\n{text}".encode())
    for _, at in paths_in(scene):
        file = at / CHECKPOINT if at.is_dir() else at  # of a run that the case begins with the end of
        if file.is_file():
            reported.update(_digest(file, file.stat().st_mtime_ns))
    return reported.hexdigest()


@cache
def _digest(file: Path, modified: int) -> bytes:
    return hashlib.sha256(file.read_bytes()).digest()
