"""Overrides of scene values on the command line: `--set riser.segments.0.elements=70`."""

from collections.abc import Sequence
from copy import deepcopy
from typing import Any

from riser_soil.errors import SceneError
from riser_soil.scene.document import Document, parse
from riser_soil.scene.problem import Path, dotted, shown, value_at


def override(document: Document, assignments: Sequence[str]) -> None:
    """Replace values of the document by `path=value`, the value read as YAML; of one path the last one counts."""
    for assignment in assignments:
        _override(document, assignment)


def _override(document: Document, assignment: str) -> None:
    dots, sign, text = assignment.partition("=")
    words = dots.strip().split(".")
    if not sign or not all(words):
        raise SceneError(
            f"--set {assignment}: must be path=value; write for example --set riser.segments.0.elements=70"
        )
    put_once(document, dots.strip(), _value(text, assignment), f"--set {assignment}", again=True)


def put_once(document: Document, dots: str, value: Any, place: str, again: bool = False) -> None:
    """Put a value as `put` does; SceneError where it would undo another override. again: the same path may be."""
    words = dots.split(".")
    for path, earlier in document.overrides.items():
        if [str(item) for item in path[: len(words)]] == words and not (again and len(path) == len(words)):
            raise SceneError(f"{place}: {dots}: undoes {earlier}; leave one of the two out")
    put(document, dots, value, place)


def put(document: Document, dots: str, value: Any, place: str) -> None:
    """Replace the value at a dotted path by plain data. place: the override, as messages name its place."""
    path = _store(document, dots.split("."), value, place)
    _forget_places_below(document, path)
    document.overrides[path] = place


def _value(text: str, assignment: str) -> Any:
    try:
        return parse(text, "--set").data if text.strip() else None
    except SceneError as err:
        raise SceneError(
            f"--set {assignment}: not plain YAML; write a number, a word, a [list] or {{mapping}}"
        ) from err


def _store(document: Document, words: list[str], value: Any, place: str) -> Path:
    """Put the value at its path, making the mappings that are not there yet; give the path."""
    data = document.data
    path: Path = ()
    for n, word in enumerate(words):
        key = _key(data, word, path, place)
        path = (*path, key)
        if n == len(words) - 1:
            document.replaced.setdefault(path, deepcopy(value_at(document.data, path)))
            data[key] = value
        elif isinstance(data, dict) and data.get(key) is None:
            data[key] = {}
            document.overrides[path] = place
        data = data[key]
    return path


def _key(data: Any, word: str, path: Path, place: str) -> str | int:
    """The word as key of a mapping or as index of a list."""
    if isinstance(data, dict):
        return word
    if not isinstance(data, list):
        raise SceneError(
            f"{place}: {dotted(path)}: value {shown(data)}: has no parts; shorten the path"
        )
    if not word.isdecimal() or int(word) >= len(data):
        allowed = (
            f"a number from 0 to {len(data) - 1} must follow, not {shown(word)}"
            if data
            else "the list is empty"
        )
        raise SceneError(f"{place}: {dotted(path)}: {allowed}; correct the path")
    return int(word)


def _forget_places_below(document: Document, path: Path) -> None:
    for places in (document.lines, document.overrides):
        for known in [p for p in places if p[: len(path)] == path]:
            del places[known]
