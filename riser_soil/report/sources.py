"""What a report is made from: load cases with their runs and axes, tables of cases, fatigue, statistics, modes."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from riser_soil.errors import ResultsError
from riser_soil.report.report_file import ReportFile
from riser_soil.results import Run
from riser_soil.scene.scene import Scene

SEED, TABLE = "seed", "table"
_CASES, _CHARACTERISTIC, _FATIGUE, _MODES = "cases.csv", "characteristic.csv", "fatigue.json", "modes.nc"
_DAMAGE = "fatigue.csv"
_FIRST, _STATUS, _REASON = "case", "status", "reason"
_TOP_LEVEL = {*Scene.model_fields, *(field.alias for field in Scene.model_fields.values())} - {"soil"}  # an axis, too


@dataclass(frozen=True, eq=False)
class LoadCase:
    """A run, or one line of a run of several, by the name that the report has for it.

    axes: in what it differs from its neighbours, by the names of a case file's axes: `offset`, `seed`. given: values of
    the scene by their paths. folder: where it was found, as it was named. line: of several lines, the name of this one.
    """

    name: str
    run: Run
    folder: str
    axes: Mapping[str, str] = field(default_factory=dict)
    given: Mapping[str, str] = field(default_factory=dict)
    line: str = ""

    @property
    def scene(self) -> Scene | None:
        """The checked scene; None where it can't be read."""
        return self.run.checked_scene

    @cached_property
    def data(self) -> dict[str, Any]:
        """The scene as plain data; empty where its file can't be read."""
        try:
            return self.run.scene
        except ResultsError:
            return {}

    @property
    def whole(self) -> dict[str, Any]:
        """The scene as plain data, of one of several lines that of all of them."""
        try:
            return Run(self.run.folder).scene
        except ResultsError:
            return {}

    def value(self, path: str) -> Any:
        """The scene's value at a dotted path; None where there is none. The vessel's offset is that of the run, whose
        scene has its ends in their places.
        """
        if path == "vessel.offset":
            offset = (self.run.summary.get("vessel") or {}).get("offset")
            return None if offset is None else offset[: 3 if offset[2] else 2]
        value: Any = self.whole if self.line else self.data
        for key in path.split("."):
            if isinstance(value, list):
                value = value[int(key)] if key.isdecimal() and int(key) < len(value) else None
            else:
                value = value.get(key) if isinstance(value, dict) else None
        return value

    @property
    def group(self) -> tuple[tuple[str, str], ...]:
        """Key shared with the cases of its folder that differ in their seed alone."""
        return tuple((name, value) for name, value in self.axes.items() if not is_seed(name))

    @property
    def stages(self) -> list[dict[str, Any]]:
        """Load steps of which something was computed, as in the summary."""
        return [stage for stage in self.run.summary["stages"] if stage["final"] is not None]


@dataclass(frozen=True, eq=False)
class Sources:
    """All that a report has.

    failed: names of cases that were not computed, with the reasons. characteristic: rows of that file, by its heads.
    """

    given: ReportFile
    cases: Sequence[LoadCase]
    whole: Mapping[str, Run]
    failed: Mapping[str, str]
    characteristic: Sequence[Mapping[str, str]]
    fatigue: Mapping[str, Any] | None
    damage: Mapping[str, list[float]]
    statistics: Sequence[Mapping[str, Any]]
    modes: Path | None

    @property
    def first(self) -> LoadCase:
        return self.cases[0]

    @property
    def runs(self) -> int:
        """Number of load cases: lines of one run are one."""
        return len({case.folder for case in self.cases})

    @cached_property
    def groups(self) -> dict[str, list[LoadCase]]:
        """Cases that differ in their seed alone, by a name of all of them."""
        groups: dict[object, list[LoadCase]] = {}
        for case in self.cases:
            groups.setdefault((Path(case.folder).parent, case.line, case.group or case.name), []).append(case)
        named: dict[str, list[LoadCase]] = {}
        for each in groups.values():
            name = _group_name(each)
            named[name if name not in named else f"{name} of {Path(each[0].folder).parent.parent.name}"] = each
        return named


def is_seed(axis: str) -> bool:
    """Whether an axis is that of seeds: by its name, or as the path of a scene."""
    return axis.rpartition(".")[2] == SEED


def opened(given: ReportFile) -> Sources:
    """All that the report file names; ResultsError for what can't be read, or where nothing was recorded."""
    whole = {name: Run(folder) for name, folder in given.runs.items()}
    cases = [case for name, run in whole.items() for case in _of_run(name, run, given.runs[name])]
    failed: dict[str, str] = {}
    characteristic: list[dict[str, str]] = []
    for folder in given.cases:
        opened_cases, lost = _of_cases(folder, {case.name for case in cases})
        cases += opened_cases
        failed |= lost
        characteristic += _rows(folder / _CHARACTERISTIC) if (folder / _CHARACTERISTIC).is_file() else []
        whole |= {case.name: case.run for case in opened_cases if case.run.lines}
    if not cases:
        raise ResultsError(f"{given.cases[0]}: no case of it is done, so there is nothing to report")
    for case in cases:
        if not case.stages or case.run.time.size == 0:
            raise ResultsError(f"{case.run.place}: nothing was recorded, so there is nothing to report")
    cases = [*_with_differences(cases)]
    names = [case.name for case in cases]
    if given.reference is not None and given.reference not in names:
        known = ", ".join(names)
        raise ResultsError(f'report: reference "{given.reference}" is none of the cases; it can be one of {known}')
    return Sources(
        given,
        cases,
        whole,
        failed,
        characteristic,
        None if given.fatigue is None else _assessment(given.fatigue / _FATIGUE),
        {} if given.fatigue is None else _columns(given.fatigue / _DAMAGE),
        [row for file in given.statistics for row in _statistics(file)],
        None if given.modes is None else _modes(given.modes),
    )


def _of_run(name: str, run: Run, folder: str) -> Iterator[LoadCase]:
    for line, own in run.of_lines.items():
        yield LoadCase(f"{name} {line}".strip(), own, folder, line=line)


def _of_cases(folder: Path, known: set[str]) -> tuple[list[LoadCase], dict[str, str]]:
    """Cases that are done, and those that are not with the reason; behind the folder's name where one has the name of a
    case that is known.
    """
    cases, failed, rows = [], {}, _rows(folder / _CASES)
    prefix = f"{folder.name}: " if any(row[_FIRST] in known for row in rows) else ""
    for row in rows:
        values = list(row.items())
        before = values[1 : [name for name, _ in values].index(_STATUS)]
        axes = {name: value for name, value in before if not _is_path(name) and value}
        given = {name: value for name, value in before if _is_path(name) and value}
        name = prefix + row[_FIRST]
        if row[_STATUS] != "0":
            failed[name] = row[_REASON]
            continue
        place = folder / "cases" / row[_FIRST]
        cases += [
            LoadCase(f"{name} {line}".strip(), own, str(place), axes or given, given, line)
            for line, own in Run(place).of_lines.items()
        ]
    return cases, failed


def _is_path(name: str) -> bool:
    """Whether a column of a table of cases is a value of the scene by its path, and not an axis of the case file."""
    return "." in name or name in _TOP_LEVEL


def _with_differences(cases: Sequence[LoadCase]) -> Iterator[LoadCase]:
    """Cases of no case file with the values of their scenes in which they differ, of lines those of the whole."""
    alone = [case for case in cases if not case.axes]
    flat = {case.name: dict(flattened(case.whole, "")) for case in alone}
    paths = dict.fromkeys(path for each in flat.values() for path in each)
    differ = [path for path in paths if len({str(each.get(path)) for each in flat.values()}) > 1 and _counts(path)]
    for case in cases:
        if case.axes or not differ:
            yield case
        else:
            given = {path: str(flat[case.name].get(path, "–")) for path in differ}
            yield replace(case, axes=given, given=given)


def _counts(path: str) -> bool:
    """Whether a value of the scene is one that was chosen: no title, output, or what was found on the way."""
    computed = ("title", "output", "error_bars", "accuracy", "riser.end.position", "riser.start.position")
    files = (".rao", ".file", ".directory", ".reference")
    return not path.startswith(computed) and not path.endswith(files)


def flattened(value: Any, path: str) -> Iterator[tuple[str, Any]]:
    """Values of nested mappings by their dotted paths; lists of numbers as they are."""
    if isinstance(value, dict) and value:
        for key, inner in value.items():
            yield from flattened(inner, f"{path}.{key}" if path else str(key))
    elif isinstance(value, list) and any(isinstance(item, dict) for item in value):
        for n, inner in enumerate(value):
            yield from flattened(inner, f"{path}.{n}")
    else:
        yield path, value


def _group_name(cases: Sequence[LoadCase]) -> str:
    """The case's own name of one alone, else by what all of them share."""
    first = cases[0]
    if first.line:
        return first.name
    if len(cases) == 1 and not any(is_seed(name) for name in first.axes):
        return first.name
    named = {name: value for name, value in first.group if name != TABLE or len(first.group) == 1}
    if all("." not in name for name in named):
        return ", ".join(value for value in named.values()) or "all seeds"
    parts = first.name.split("-")
    return "-".join(part for part in parts if not part.startswith(f"{SEED}=")) or first.name


def _rows(file: Path) -> list[dict[str, str]]:
    try:
        with file.open(newline="", encoding="utf-8") as opened_file:
            rows = list(csv.DictReader(opened_file))
    except OSError as err:
        raise ResultsError(f"{file}: cannot be read: {err.strerror}; name the folder that riser-soil made") from err
    return rows


def _json(file: Path) -> Any:
    try:
        return json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as err:
        raise ResultsError(f"{file}: cannot be read: {err}; name the folder or file that riser-soil made") from err


def _assessment(file: Path) -> Any:
    """An assessment of fatigue whose sea states are called by short names, in its warnings, too."""
    numbers = _json(file)
    short = short_names([case["run"] for case in numbers["cases"]])
    cases = [case | {"run": short[case["run"]]} for case in numbers["cases"]]
    return numbers | {"cases": cases, "warnings": [_renamed(text, short) for text in numbers["warnings"]]}


def short_names(folders: Sequence[str]) -> dict[str, str]:
    """Each folder's last name, with as many names before it as tell it from the others, by the folder."""
    parts = {folder: Path(folder).parts for folder in folders}
    names = {}
    for folder, own in parts.items():
        others = [each for each in parts.values() if each != own]
        count = next((n for n in range(1, len(own)) if all(each[-n:] != own[-n:] for each in others)), len(own))
        names[folder] = "/".join(own[-count:])
    return names


def _renamed(text: str, names: Mapping[str, str]) -> str:
    """The text with a name in place of each folder, the longest first: one may begin as another does."""
    for folder in sorted(names, key=len, reverse=True):
        text = text.replace(folder, names[folder])
    return text


def _columns(file: Path) -> dict[str, list[float]]:
    """Numbers of a table by the heads of its columns."""
    rows = _rows(file)
    return {name: [float(row[name]) for row in rows] for name in (rows[0] if rows else {})}


def _statistics(file: Path) -> list[dict[str, Any]]:
    rows = _json(file)
    if not isinstance(rows, list) or not all(isinstance(row, dict) and "gumbel" in row for row in rows):
        raise ResultsError(f"{file}: is not a file of riser-soil statistics; write one by -o FILE.json")
    return rows


def _modes(folder: Path) -> Path:
    if not (folder / _MODES).is_file():
        raise ResultsError(f"{folder}: has no {_MODES}; riser-soil modes makes it")
    return folder / _MODES
