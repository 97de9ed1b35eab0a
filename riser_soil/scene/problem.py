"""A problem found in a scene, and its one-line message."""

import difflib
import json
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

Path = tuple[str | int, ...]

_WIDTH = 60


class Missing:
    """Stands for a value that is not there (None is a value: null)."""


NOTHING = Missing()


@dataclass(frozen=True)
class Problem:
    """What is wrong at a path of the scene: what is allowed there, and what to do.

    shows_line: whether the line of the file makes it plain.
    """

    path: Path
    allowed: str
    remedy: str
    shows_line: bool = False


def dotted(path: Path) -> str:
    """The path as it is written in messages and after --set."""
    return ".".join(str(item) for item in path) or "scene"


def value_at(data: Any, path: Path) -> Any:
    """The value at a path of plain data, or NOTHING."""
    for item in path:
        try:
            data = NOTHING if isinstance(data, str) else data[item]
        except (KeyError, IndexError, TypeError):
            return NOTHING
    return data


def matching(data: Any, pattern: tuple[str, ...], path: Path = ()) -> list[tuple[Path, Any]]:
    """Values of plain data whose paths fit a pattern, in which `*` stands for any key or number, each with its path."""
    if not pattern:
        return [(path, data)]
    entries = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list | tuple) else ()
    within = ((key, value) for key, value in entries if pattern[0] in ("*", str(key)))
    return [match for key, value in within for match in matching(value, pattern[1:], (*path, key))]


def shown(value: Any, width: int = _WIDTH) -> str:
    """A value as YAML would write it in one short line; of a long one the first items, or letters."""
    text = json.dumps(value, ensure_ascii=False, default=str)
    if len(text) <= width:
        return text
    if isinstance(value, dict):
        keys = ((json.dumps(str(key), ensure_ascii=False), item) for key, item in value.items())
        return "{" + _first((f"{key}: {shown(item, width // 2)}" for key, item in keys), len(value), width) + "}"
    if isinstance(value, list | tuple):
        return "[" + _first((shown(item, width // 2) for item in value), len(value), width) + "]"
    return json.dumps(f"{value[: width - 5]}...", ensure_ascii=False) if isinstance(value, str) else text


def _first(items: Iterable[str], count: int, width: int) -> str:
    """The first items that have room, and how many there are in all."""
    words, rest = list[str](), f"... ({count} in all)"
    for item in items:
        if len(", ".join([*words, item, rest])) > width - 2:
            break
        words.append(item)
    return ", ".join([*words, rest])


def message(problem: Problem, data: Any) -> str:
    """Path, value, what is allowed and what to do, in one line."""
    value = value_at(data, problem.path)
    given = "missing" if value is NOTHING else f"value {shown(value)}"
    text = f"{dotted(problem.path)}: {given}: {problem.allowed}; {problem.remedy}"
    return legible(" ".join(text.split()))


def legible(text: str) -> str:
    """The text with characters that a terminal can't show as it writes them in Python: \\x00."""
    return "".join(c if c.isprintable() else ascii(c)[1:-1] for c in text)


def did_you_mean(word: str, known: Iterable[str]) -> str | None:
    """The known word nearest to a misspelt one, whatever the case of its letters; None when none is near."""
    by_lower = {name.lower(): name for name in known}
    near = difflib.get_close_matches(word.lower(), list(by_lower), n=1, cutoff=0.5)
    return by_lower[near[0]] if near else None


def hint(word: Any, known: Iterable[str]) -> str:
    """' (did you mean "..."?)' when a known word is near, else nothing."""
    near = did_you_mean(word, known) if isinstance(word, str) else None
    return f' (did you mean "{near}"?)' if near else ""
