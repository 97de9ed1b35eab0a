"""A data file's objects: values by name, where each stands, and which of them were asked for."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from riser_soil.errors import SceneError
from riser_soil.imported_scene import Remark, text_of
from riser_soil.scene.document import Document, parse
from riser_soil.scene.problem import Path as Keys

MASS = 1e3  # kg in te
FORCE = 1e3  # N in kN
_OTHERS = ("BaseFile", "IncludeFile", "includefile")


@dataclass
class DataFile:
    """A whole file. read: the places of values that were asked for. remarks: what they can't stand for in a scene."""

    document: Document
    read: set[Keys] = field(default_factory=set)
    remarks: list[Remark] = field(default_factory=list)

    def section(self, name: str) -> Item:
        """A section that is one object, as Environment; empty where there is none."""
        found = self.document.data.get(name) or {}
        return Item(self, name, {key: ((name, key), value) for key, value in found.items()})

    def objects(self, section: str) -> list[Item]:
        """Objects of a section that is a list of them, as Lines."""
        return _items(self, (section,), self.document.data.get(section))

    def named(self, section: str, name: str, asking: Item, key: str) -> Item:
        """The object of this name, for which another one asks by a key."""
        for each in (found := self.objects(section)):
            if each.word("Name") == name:
                return each
        known = ", ".join(each.name for each in found) or "none"
        raise asking.error(key, f"{name} is not among the {section} ({known}); correct the name")


@dataclass(frozen=True)
class Item:
    """An object, or a row of a table: by name of each value its place in the file, and the value."""

    file: DataFile
    name: str
    values: Mapping[str, tuple[Keys, Any]]

    def has(self, key: str) -> bool:
        """Whether a value is given; ~ is none."""
        return self.values.get(key, ((), None))[1] is not None

    def get(self, key: str) -> Any:
        """A value as YAML has it, None where there is none; it counts as read."""
        if key not in self.values:
            return None
        place, value = self.values[key]
        self.file.read.add(place)
        return value

    def word(self, key: str, default: str = "") -> str:
        """A value as a word."""
        value = self.get(key)
        return default if value is None else str(value)

    def number(self, key: str, default: float | None = None) -> float:
        """A finite number; SceneError where there is none, and no default."""
        value = self._number(key, self.get(key), default)
        if not math.isfinite(value):
            raise self.error(key, f"is {self.values[key][1]!r}, not a finite number; correct it")
        return value

    def stiffness(self, key: str, default: float | None = None) -> float:
        """A number that may be Infinity."""
        return self._number(key, self.get(key), default)

    def numbers(self, key: str, count: int, default: float = 0.0) -> list[float]:
        """A list of numbers, or one number as its first; the default stands for what is not there."""
        value = self.get(key)
        given = value if isinstance(value, list) else [value]
        return [self._number(key, each, default) for each in (given + [None] * count)[:count]]

    def rows(self, first: str) -> list[Item]:
        """Rows of the table whose columns begin with one of this name: `first, second, third`."""
        for names, (place, table) in self.values.items():
            columns = [name.strip() for name in names.split(",")]
            if columns[0] == first and isinstance(table, list):
                return [self._row(columns, (*place, n), row) for n, row in enumerate(table)]
        return []

    def items(self, key: str) -> list[Item]:
        """Objects that this one has in a list."""
        place, value = self.values.get(key, ((), None))
        return _items(self.file, place, value)

    def part(self, key: str) -> Item:
        """An object that this one has; empty where there is none."""
        place, value = self.values.get(key, ((), None))
        found = value if isinstance(value, dict) else {}
        return Item(self.file, f"{self.name}: {key}", {name: ((*place, name), each) for name, each in found.items()})

    def left(self, key: str, text: str) -> None:
        """Tells that a value, which counts as read, is not carried over."""
        self.get(key)
        self.file.remarks.append((self.line(key), f"{self.name}: {text}"))

    def line(self, key: str) -> int:
        """Line of a value, or of the object where it has none of this name."""
        places = [place for place, _ in self.values.values()] or [()]
        return self.file.document.where(self.values[key][0] if key in self.values else places[0][:-1])[0]

    def error(self, key: str, text: str) -> SceneError:
        return SceneError(f"{self.file.document.name}:{self.line(key)}: {self.name}: {key}: {text}")

    def _row(self, columns: list[str], place: Keys, row: Any) -> Item:
        cells = row if isinstance(row, list) else [row]
        return Item(self.file, self.name, {name: ((*place, n), cell) for n, (name, cell) in
                                           enumerate(zip(columns, cells, strict=False))})  # fmt: skip

    def _number(self, key: str, value: Any, default: float | None) -> float:
        if value is None and default is not None:
            return default
        try:
            return math.nan if value is None else float(value)
        except (TypeError, ValueError):
            raise self.error(key, f"is {value!r}, not a number; correct it") from None


def read_data(file: Path) -> DataFile:
    """The data in a file; SceneError where it can't be read, or is none of OrcaFlex in SI units."""
    text = text_of(file).replace("%YAML 1.1", "", 1)  # in which Yes is a truth value and 1e6 a word
    document = parse(text, file.name, "is empty; give a text data file of OrcaFlex")
    if not isinstance(document.data, dict) or "Lines" not in document.data or "General" not in document.data:
        raise SceneError(f"{file}: has no General and Lines; give a text data file (.yml) of OrcaFlex 11, of one model")
    data = DataFile(document)
    for key in _OTHERS:
        if key in document.data:
            raise SceneError(f"{file.name}:{document.lines[key,]}: {key}: takes from another file; save as one file")
    general = data.section("General")
    if general.word("UnitsSystem") != "SI":
        raise general.error("UnitsSystem", f"is {general.word('UnitsSystem') or 'missing'}; save it in SI units")
    return data


def unit_vector(azimuth: float) -> tuple[float, float]:
    """Towards an azimuth [deg] from x towards y; exact along the axes."""
    angle = math.radians(azimuth)
    return round(math.cos(angle), 15) + 0.0, round(math.sin(angle), 15) + 0.0


def _items(file: DataFile, place: Keys, found: Any) -> list[Item]:
    return list(_each(file, place, found)) if isinstance(found, list) else []


def _each(file: DataFile, place: Keys, found: list[Any]) -> Iterator[Item]:
    for n, each in enumerate(found):
        if isinstance(each, dict):
            name = f"{place[-1]} {each.get('Name', n + 1)}"
            yield Item(file, name, {key: ((*place, n, key), value) for key, value in each.items()})
