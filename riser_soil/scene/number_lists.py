"""Fast reading of long lists of numbers in YAML text: a YAML reader takes 0.1 ms for every number.

A long list is replaced in the text by an empty one with as many lines. What the YAML reader finds at its place shows
whether it was a list at all, and not part of a comment or of a quoted text.
"""

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

_LONG = 2000  # characters; shorter lists are left to the YAML reader
_NUMBER = r"-?[0-9][0-9.eE+-]*"
_ROW = rf"- +(?:{_NUMBER}|\[ *{_NUMBER}(?: *, *{_NUMBER})* *\])(?: +#.*)?[ \r]*(?:\n|\Z)"
_ROWS = rf"(?P<indent>^ *){_ROW}(?:(?P=indent){_ROW}){{49,}}"
_LIST = re.compile(rf"{_ROWS}|\[[\[\s]*{_NUMBER}[-+.,\[\]\s0-9eE]{{{_LONG},}}", re.MULTILINE)
_OPEN_POINT = re.compile(r"(?<=[0-9])\.(?![0-9])")
_TOKEN = re.compile(r"[\[\],\n]|[^\[\],\s]+")


@dataclass(frozen=True)
class NumberList:
    """A long list of numbers, or of such lists, as JSON text."""

    text: str

    @property
    def count(self) -> int:
        """Number of values in the list, those of its inner lists and these themselves counted."""
        return self.text.count(",") + self.text.count("[")

    def values(self) -> list[Any]:
        """The list, a new one each time."""
        values: list[Any] = json.loads(self.text)
        return values

    def lines(self) -> Iterator[tuple[tuple[int, ...], int]]:
        """Indices of each item and its line, counted from 0 where the list begins."""
        path: list[int] = []
        line = 0
        for token in _TOKEN.findall(self.text):
            if token == "\n":
                line += 1
            elif token == ",":
                path[-1] += 1
            elif token == "]":
                path.pop()
            else:
                if path:
                    yield tuple(path), line
                if token == "[":
                    path.append(0)


def without_lists(text: str) -> tuple[str, dict[int, NumberList]]:
    """The text with its long lists emptied, and the lists by the character at which they begin in it."""
    parts: list[str] = []
    lists: dict[int, NumberList] = {}
    size = done = 0
    while match := _LIST.search(text, done):
        numbers, end = _rows(match) if match["indent"] is not None else _brackets(match)
        short = _emptied(match, numbers) if numbers else text[match.start() : end]
        parts += [text[done : match.start()], short]
        if numbers:
            lists[size + match.start() - done + short.index("[")] = numbers
        size += match.start() - done + len(short)
        done = end
    return "".join([*parts, text[done:]]), lists


def _rows(match: re.Match[str]) -> tuple[NumberList | None, int]:
    """A list with an item a line, after dashes."""
    items = [row.partition("#")[0].strip()[1:] for row in match[0].splitlines()]
    return _plain("[" + ",\n".join(items) + "\n]"), match.end()


def _brackets(match: re.Match[str]) -> tuple[NumberList | None, int]:
    """A list in brackets; what follows it may look like its items."""
    depth = 0
    for bracket in re.finditer(r"[\[\]]", match[0]):
        depth += 1 if bracket[0] == "[" else -1
        if depth == 0:
            end = bracket.end()
            return _plain(match[0][:end]) if end >= _LONG else None, match.start() + end
    return None, match.end()


def _plain(text: str) -> NumberList | None:
    """A list from JSON text; None where it isn't JSON or has a number too large for Python: left to the YAML reader."""
    text = _OPEN_POINT.sub(".0", text)
    try:
        json.loads(text)
    except ValueError:
        return None
    return NumberList(text)


def _emptied(match: re.Match[str], numbers: NumberList) -> str:
    """An empty list with as many lines, its last one as far indented."""
    if match["indent"] is not None:
        return f"{match['indent']} []" + "\n" * match[0].count("\n")
    lines = numbers.text.count("\n")
    last = numbers.text.rpartition("\n")[2]
    return "[" + "\n" * lines + " " * (len(last) - len(last.lstrip())) * bool(lines) + "]"
