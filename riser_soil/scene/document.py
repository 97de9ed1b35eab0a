"""YAML file as plain data, with the line number of every value.

Long lists of numbers are read apart from the rest, see `number_lists`: a YAML reader takes 0.1 ms for every number.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.error import MarkedYAMLError, YAMLError
from ruamel.yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode

from riser_soil.errors import SceneError
from riser_soil.scene.files import content
from riser_soil.scene.number_lists import NumberList, without_lists
from riser_soil.scene.problem import Path, dotted

_TAG = "tag:yaml.org,2002:"
_SCALARS = {_TAG + name for name in ("str", "int", "float", "bool", "null", "timestamp")}
_MOST_VALUES = 1_000_000
_MOST_BYTES = 64_000_000
_MOST_LETTERS = 2_000_000  # beside long lists of numbers: some 20 s for the YAML reader
_EXCERPT = 80  # characters of a line that a message shows
TAB = re.compile(r" *\t\s*\S")
UNSPACED = re.compile(r"([A-Za-z_]\w*):(?=[^\s/:\\])")  # a key with its value right after the colon
# Keys that only one kind of file has at its top, and the commands that read it.
FILE_KINDS = {
    "scene": {"line_types", "riser", "lines", "stages"},
    "fatigue file": {"curve", "stress_concentration", "design_life"},
    "report file": {"runs", "client", "revision", "required_life"},
    "case file": {"base", "product", "table"},
}
READERS = {
    "scene": "riser-soil run and check read",
    "fatigue file": "riser-soil fatigue reads",
    "report file": "riser-soil report reads",
    "case file": "riser-soil cases reads",
}


@dataclass
class Document:
    """Plain data (dict, list, str, int, float, bool, None) and where each value was written.

    overrides: by the path of a value that was replaced, what replaced it, as messages name it. text: of the file.
    replaced: by the same path the value that was there at first.
    """

    name: str
    data: Any
    lines: dict[Path, int] = field(default_factory=dict)
    overrides: dict[Path, str] = field(default_factory=dict)
    text: str = ""
    replaced: dict[Path, Any] = field(default_factory=dict)

    def line_of(self, path: Path) -> str:
        """The line of the file where a value was written; "" where it was not."""
        if path in self.overrides or path not in self.lines:
            return ""
        return excerpt(self.text, self.lines[path] - 1)

    def where(self, path: Path) -> tuple[int, str]:
        """Sorting number and text of the place of a value, or of the nearest value around it."""
        for n in range(len(path), -1, -1):
            if path[:n] in self.overrides:
                return 0, self.overrides[path[:n]]
            if path[:n] in self.lines:
                return self.lines[path[:n]], f"{self.name}:{self.lines[path[:n]]}"
        return 1, self.name


def read_text(file: FilePath) -> str:
    """The text of a scene file; SceneError when it can't be read."""
    if file.is_dir():
        raise SceneError(f"{file}: is a folder, and a file (.yaml) is wanted here; give its name")
    try:
        return content(file, _MOST_BYTES).decode("utf-8-sig")
    except FileNotFoundError as err:
        raise SceneError(f"{file}: there is no such file; correct the name of the scene file") from err
    except UnicodeDecodeError as err:
        line = err.object.count(b"\n", 0, err.start) + 1
        raise SceneError(f"{file}:{line}: not UTF-8 text; save the scene as UTF-8") from err
    except OSError as err:
        raise SceneError(
            f"{file}: can't be read ({err.strerror}); check the file and its permissions"
        ) from err


NEEDS = "the scene is empty; it needs line_types, riser and stages"


def parse(text: str, name: str, needs: str = NEEDS) -> Document:
    """The document in a YAML text; SceneError with the line when the text is not plain YAML, or with its needs when it
    is empty.
    """
    short, lists = without_lists(text)
    if len(short) > _MOST_LETTERS:
        what = f"{len(short)} letters beside lists of plain numbers, more than {_MOST_LETTERS}"
        raise SceneError(f"{name}: {what}; take tables from CSV files, or write [numbers] without comments")
    try:
        built = _Builder(YAML(typ="safe", pure=True), name, lists)
        document = built.document(short, needs)
        if not built.read_all:
            document = _Builder(YAML(typ="safe", pure=True), name, {}).document(text, needs)
        document.text = text
        return document
    except MarkedYAMLError as err:
        raise SceneError(_broken(err, name, text)) from err
    except YAMLError as err:
        raise SceneError(f"{name}: not valid YAML: {' '.join(str(err).split())}; correct the file") from err
    except RecursionError as err:
        raise SceneError(f"{name}: nested too deeply; a scene is at most some ten levels deep") from err


def _broken(err: MarkedYAMLError, name: str, text: str) -> str:
    """Place and cause of an error of YAML: a tab, a blank that is missing, else what the YAML reader says."""
    marks = [mark for mark in (err.context_mark, err.problem_mark) if mark]
    reason = " ".join(" ".join(str(part) for part in (err.context, err.problem) if part).split())
    if not marks:
        return f"{name}: not valid YAML: {reason}; correct the file"
    lines, first, last = text.splitlines(), marks[0].line, marks[-1].line
    for n, line in enumerate(lines[: last + 1]):
        if TAB.match(line):
            tab = f"not valid YAML: line {n + 1} is indented by a tab; use spaces"
            return f'{name}:{n + 1}: {tab}; the line is "{excerpt(text, n)}"'
    for n in range(max(first - 1, 0), min(last + 1, len(lines))):
        if joined := UNSPACED.match(lines[n].lstrip(" -")):
            blank = f"a blank is missing after the colon of {joined[1]}"
            remedy = f"write {joined[1]}: and the value after a blank"
            return f'{name}:{n + 1}: {blank}; {remedy}; the line is "{excerpt(text, n)}"'
    cause = f"not valid YAML, column {marks[-1].column + 1}: {reason}; correct indentation or quotes here"
    return f'{name}:{last + 1}: {cause}; the line is "{excerpt(text, last)}"'


def excerpt(text: str, n: int) -> str:
    """The line with a number, counted from 0, without indentation, of a long one the beginning; "" beyond the text."""
    line = next(iter(text.splitlines()[n : n + 1]), "").strip()
    return line if len(line) <= _EXCERPT else f"{line[:_EXCERPT]}..."


def refuse_others(document: Document, wanted: str) -> Document:
    """The document, if it is not another kind of file; SceneError where a command was given the wrong one."""
    keys = set(document.data) if isinstance(document.data, dict) else set()
    other = next((kind for kind, own in FILE_KINDS.items() if keys & own), wanted)
    if other != wanted:
        what = f"is a {other}, and a {wanted} is wanted here: {READERS[other]} it"
        raise SceneError(f"{document.name}: {what}")
    return document


class _Builder:
    """Turns YAML nodes into plain data; allows no tags, so that no object is ever built from a scene."""

    def __init__(self, yaml: YAML, name: str, lists: dict[int, NumberList]) -> None:
        self._yaml = yaml
        self._constructor = yaml.constructor
        self._lists, self._found = lists, set[int]()
        self._out = Document(name, None)
        self._open: list[int] = []
        self._count = 0

    @property
    def read_all(self) -> bool:
        """Whether every long list was where the document has a list."""
        return len(self._found) == len(self._lists)

    def document(self, text: str, needs: str) -> Document:
        node = self._yaml.compose(text)
        if node is None:
            raise SceneError(f"{self._out.name}: {needs}")
        self._out.lines[()] = node.start_mark.line + 1
        self._out.data = self._value(node, ())
        return self._out

    def _value(self, node: Node, path: Path) -> Any:
        self._guard(node, path)
        self._open.append(id(node))
        try:
            if isinstance(node, MappingNode) and node.tag == _TAG + "map":
                return self._mapping(node, path)
            if isinstance(node, SequenceNode) and node.tag == _TAG + "seq":
                if node.start_mark.index in self._lists:
                    return self._numbers(node, path)
                return [self._entry(item, item, (*path, i)) for i, item in enumerate(node.value)]
            if isinstance(node, ScalarNode) and node.tag in _SCALARS:
                return self._scalar(node, path)
        finally:
            self._open.pop()
        raise self._error(node, path, f"tag {node.tag}: tags are not allowed in a scene; remove the tag")

    def _numbers(self, node: Node, path: Path) -> list[Any]:
        """A long list that was cut out of the text here."""
        mark = node.start_mark
        numbers = self._lists[mark.index]
        self._found.add(mark.index)
        self._add(numbers.count, node, path)
        self._out.lines.update({(*path, *item): mark.line + 1 + line for item, line in numbers.lines()})
        return numbers.values()

    def _guard(self, node: Node, path: Path) -> None:
        if id(node) in self._open:
            raise self._error(node, path, "refers to itself; remove the alias (*name)")
        self._add(1, node, path)

    def _add(self, values: int, node: Node, path: Path) -> None:
        self._count += values
        if self._count > _MOST_VALUES:
            raise self._error(node, path, f"more than {_MOST_VALUES} values; use fewer aliases or points")

    def _entry(self, marked: Node, node: Node, path: Path) -> Any:
        self._out.lines[path] = marked.start_mark.line + 1
        return self._value(node, path)

    def _scalar(self, node: ScalarNode, path: Path) -> Any:
        if node.tag in (_TAG + "str", _TAG + "timestamp"):
            return node.value
        try:
            return self._constructor.construct_object(node)
        except (ValueError, LookupError, YAMLError) as err:
            raise self._error(
                node, path, f"value {node.value!r} can't be read; write a plain number or word"
            ) from err

    def _mapping(self, node: MappingNode, path: Path) -> dict[str, Any]:
        merged: dict[str, Any] = {}
        own: dict[str, Any] = {}
        for key_node, value_node in node.value:
            if key_node.tag == _TAG + "merge":
                for source in self._merge_sources(value_node):
                    merged = {**self._value(source, path), **merged}
                continue
            key = self._key(key_node, path)
            if key in own:
                raise self._error(key_node, (*path, key), "the key is given twice; remove one of the two")
            own[key] = self._entry(key_node, value_node, (*path, key))
        return {**merged, **own}

    def _merge_sources(self, node: Node) -> Iterator[Node]:
        sources = node.value if isinstance(node, SequenceNode) else [node]
        for source in sources:
            if not isinstance(source, MappingNode):
                raise self._error(
                    source, (), "<< must be followed by an alias (*name) of a mapping; correct it"
                )
            yield source

    def _key(self, node: Node, path: Path) -> str:
        if isinstance(node, ScalarNode) and node.tag in _SCALARS:
            return str(node.value)
        raise self._error(node, path, "a key must be one plain word; write `key: value`")

    def _error(self, node: Node, path: Path, text: str) -> SceneError:
        return SceneError(f"{self._out.name}:{node.start_mark.line + 1}: {dotted(path)}: {text}")
