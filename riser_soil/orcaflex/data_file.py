"""A data file's objects: values by name, where each stands, and which of them were asked for.

OrcaFlex reads names of data, of objects and of choices in any case, so they are compared without it.
"""

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
_OTHERS = ("basefile", "includefile", "restartingfrom")
_NONE = ("", "~", "null")
_BYTE_ORDER_MARK = "\ufeff"  # at the beginning of each file that was joined to others


def folded(word: Any) -> str:
    """A word as it is compared: in lower case, with single blanks."""
    return " ".join(str(word).split()).lower()


@dataclass
class DataFile:
    """A whole file.

    read: the places of values that were asked for. remarks: what they can't stand for in a scene. refused: what a scene
    can't do without and can't be made of them; all of it is found before `end_if_refused` ends the import.
    """

    document: Document
    read: set[Keys] = field(default_factory=set)
    remarks: list[Remark] = field(default_factory=list)
    refused: list[Remark] = field(default_factory=list)

    def section(self, name: str) -> Item:
        """A section that is one object, as Environment; empty where there is none."""
        key, value = self._item_of(name)
        return Item(self, key, _by_name((key,), value if isinstance(value, dict) else {}))

    def objects(self, section: str) -> list[Item]:
        """Objects of a section that is a list of them, as Lines."""
        key, value = self._item_of(section)
        return _items(self, (key,), value)

    def find(self, section: str, name: str) -> Item | None:
        """The object of this name in a section; None where there is none."""
        return next((each for each in self.objects(section) if folded(each.title) == folded(name)), None)

    def named(self, section: str, name: str, asking: Item, key: str) -> Item | None:
        """The object of this name, for which another one asks by a key; refused where there is none."""
        item = self.find(section, name)
        if item is None:
            known = ", ".join(each.title for each in self.objects(section)) or "none"
            asking.refuse(key, f"{name} is not among the {section} ({known}); correct the name")
        return item

    def end_if_refused(self, remarks: list[Remark]) -> None:
        """SceneError with the remarks and all that was refused, a line for each, if anything was."""
        if not self.refused:
            return
        name = self.document.name
        refused = [f"{name}:{line}: {text}" for line, text in sorted(set(self.refused))]
        head = [f"{name}:{line}: not carried over: {text}" for line, text in remarks]
        head.append(f"{name}: gives no scene, and none is written; entries that prevent it: {len(refused)}")
        raise SceneError("\n".join([*head, *refused]))

    def _item_of(self, section: str) -> tuple[str, Any]:
        return next(((key, each) for key, each in self.document.data.items() if folded(key) == folded(section)),
                    (section, None))  # fmt: skip


@dataclass(frozen=True)
class Item:
    """An object, or a row of a table: by name of each value in lower case its place in the file, and the value."""

    file: DataFile
    name: str
    values: Mapping[str, tuple[Keys, Any]]

    @property
    def title(self) -> str:
        """The object's own name; to ask for it does not count as reading the object."""
        return str(self.values.get("name", ((), ""))[1] or "")

    def has(self, key: str) -> bool:
        """Whether a value is given; ~ is none."""
        return self.values.get(folded(key), ((), None))[1] is not None

    def get(self, key: str) -> Any:
        """A value as YAML has it, None where there is none; it counts as read."""
        if folded(key) not in self.values:
            return None
        place, value = self.values[folded(key)]
        self.file.read.add(place)
        return value

    def word(self, key: str, default: str = "") -> str:
        """A value as a word, such as a name."""
        value = self.get(key)
        return default if value is None else str(value)

    def choice(self, key: str, default: str = "") -> str:
        """A value that is one of several words, in lower case."""
        return folded(self.word(key, default))

    def number(self, key: str, default: float | None = None) -> float:
        """A finite number; refused, and nan, where there is none and no default."""
        value = self.number_in(key, self.get(key), default)
        return self.refuse(key, f"is {self.get(key)}, not a finite number; correct it") if math.isinf(value) else value

    def positive(self, key: str, default: float | None = None) -> float:
        """A number above 0; refused, and nan, where there is none."""
        value = self.number(key, default)
        return self.refuse(key, f"is {self.get(key)}; give a number above 0") if value <= 0.0 else value

    def stiffness(self, key: str, default: float | None = None) -> float:
        """A number that may be Infinity."""
        return self.number_in(key, self.get(key), default)

    def numbers(self, key: str, count: int, default: float = 0.0) -> list[float]:
        """A list of numbers, or one number as its first; the default stands for what is not there."""
        value = self.get(key)
        given = value if isinstance(value, list) else [value]
        return [self.number_in(key, each, default) for each in (given + [None] * count)[:count]]

    def all_numbers(self, key: str) -> list[float]:
        """All numbers of a list, or of one number; none where there is nothing."""
        value = self.get(key)
        given = [] if value is None else value if isinstance(value, list) else [value]
        return [self.number_in(key, each, None) for each in given]

    def rows(self, first: str) -> list[Item]:
        """Rows of the table whose columns begin with one of this name: `first, second, third`."""
        for names, (place, table) in self.values.items():
            columns = [folded(name) for name in names.split(",")]
            if columns[0] == folded(first) and isinstance(table, list):
                return [self._row(columns, (*place, n), row) for n, row in enumerate(table)]
        return []

    def items(self, key: str) -> list[Item]:
        """Objects that this one has in a list."""
        place, value = self.values.get(folded(key), ((), None))
        return _items(self.file, place, value)

    def part(self, key: str) -> Item:
        """An object that this one has; empty where there is none."""
        place, value = self.values.get(folded(key), ((), None))
        return Item(self.file, f"{self.name}: {key}", _by_name(place, value if isinstance(value, dict) else {}))

    def remark(self, key: str, text: str) -> None:
        """Tells that a value, which counts as read, is not carried over."""
        self.get(key)
        self.file.remarks.append((self.line(key), f"{self.name}: {text}"))

    def refuse(self, key: str, text: str) -> float:
        """Tells that there is no scene because of a value; nan, in place of what it would have been."""
        self.get(key)
        self.file.refused.append((self.line(key), f"{self.name}: {key}: {text}"))
        return math.nan

    def line(self, key: str) -> int:
        """Line of a value, or of the object where it has none of this name."""
        if folded(key) in self.values:
            return self.file.document.where(self.values[folded(key)][0])[0]
        places = [place for place, _ in self.values.values()] or [()]
        return self.file.document.where(places[0][:-1])[0]

    def _row(self, columns: list[str], place: Keys, row: Any) -> Item:
        cells = row if isinstance(row, list) else [row]
        return Item(self.file, self.name, {name: ((*place, n), cell) for n, (name, cell) in
                                           enumerate(zip(columns, cells, strict=False))})  # fmt: skip

    def number_in(self, key: str, value: Any, default: float | None = None) -> float:
        """A value of a key as a number; refused, and nan, where it is none and there is no default."""
        if value is None and default is not None:
            return default
        try:
            number = math.nan if value is None else float(value)
        except (TypeError, ValueError):
            number = math.nan
        if math.isnan(number):
            shown = "missing" if value is None else f"{value!r}, not a number"
            return self.refuse(key, f"is {shown}; correct it")
        return number


def read_data(file: Path) -> DataFile:
    """The data in a file; SceneError where it can't be read, or is none of OrcaFlex."""
    text = text_of(file).replace(_BYTE_ORDER_MARK, "")
    # In YAML 1.1 Yes is a truth value and 1e6 a word.
    document = parse(text.replace("%YAML 1.1", "", 1), file.name, "is empty; give a text data file of OrcaFlex")
    _refuse_parts(document)
    names = {folded(key) for key in document.data} if isinstance(document.data, dict) else set[str]()
    if not {"lines", "general"} <= names:
        raise SceneError(f"{file}: has no General and Lines; give a text data file (.yml) of OrcaFlex 11, of one model")
    document.data = _plain(document.data)
    data = DataFile(document)
    general = data.section("General")
    if general.choice("UnitsSystem") != "si":
        general.refuse("UnitsSystem", f"is {general.word('UnitsSystem') or 'missing'}; save it in SI units")
    return data


def unit_vector(azimuth: float) -> tuple[float, float]:
    """Towards an azimuth [deg] from x towards y; exact along the axes."""
    angle = math.radians(azimuth)
    return round(math.cos(angle), 15) + 0.0, round(math.sin(angle), 15) + 0.0


def _refuse_parts(document: Document) -> None:
    """SceneError for a file that takes data from others, by a key or by a list of them."""
    several = document.data if isinstance(document.data, list) else [document.data]
    for n, each in enumerate(several):
        for key in each if isinstance(each, dict) else ():
            if folded(key) in _OTHERS:
                place = (key,) if each is document.data else (n, key)
                line = document.where(place)[0]
                raise SceneError(f"{document.name}:{line}: {key}: takes from another file; save as one file")


def _plain(value: Any) -> Any:
    """Without quotes around what stands for nothing, and with OrcaFlex's words for truth values."""
    if isinstance(value, dict):
        return {key: _plain(each) for key, each in value.items()}
    if isinstance(value, list):
        return [_plain(each) for each in value]
    if isinstance(value, bool):
        return "Yes" if value else "No"
    if isinstance(value, str):
        return None if value.strip().lower() in _NONE else value.strip()
    return value


def _by_name(place: Keys, values: Mapping[str, Any]) -> dict[str, tuple[Keys, Any]]:
    return {folded(key): ((*place, key), value) for key, value in values.items()}


def _items(file: DataFile, place: Keys, value: Any) -> list[Item]:
    return list(_each(file, place, value)) if isinstance(value, list) else []


def _each(file: DataFile, place: Keys, values: list[Any]) -> Iterator[Item]:
    for n, each in enumerate(values):
        if isinstance(each, dict):
            yield Item(file, f"{place[-1]} {name_of(each) or n + 1}", _by_name((*place, n), each))


def name_of(values: Mapping[str, Any]) -> str:
    """The name that an object has among its values."""
    return next((str(value) for key, value in values.items() if folded(key) == "name" and value is not None), "")
