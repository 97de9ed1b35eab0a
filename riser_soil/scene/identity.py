"""Identity of a scene: its values and the contents of the files that it names, to be compared with those of a run."""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from riser_soil.scene.problem import NOTHING, dotted, shown
from riser_soil.scene.problem import Path as KeyPath
from riser_soil.scene.scene import Scene


class Difference(NamedTuple):
    """The first key by which two scenes differ, and its values in one line each."""

    key: str
    then: str
    now: str

    def __str__(self) -> str:
        return f"{self.key} was {self.then} and is {self.now}"


def identity_of(scene: Scene) -> dict[str, Any]:
    """Identity of a scene in JSON's terms: values, all defaults filled in, and by its key the SHA-256 of each file
    named.
    """
    values = scene.model_dump(mode="json", by_alias=True)
    return {"values": values, "files": {dotted(key): _digest(at) for key, at in paths_in(scene) if at.is_file()}}


def paths_in(scene: Scene) -> Iterator[tuple[KeyPath, Path]]:
    """The files and folders that a scene names, with their keys."""
    return _paths(scene.model_dump(by_alias=True))


def first_difference(
    then: Mapping[str, Any], now: Mapping[str, Any], but: Collection[KeyPath] = ()
) -> Difference | None:
    """Between what `identity_of` gave then and now. but: keys that may differ, with all below them."""
    for key, before, after in _differences(then["values"], now["values"], but):
        return Difference(dotted(key), _value_in_words(before), _value_in_words(after))
    for key in sorted({*then["files"], *now["files"]}):
        free = any(_below(tuple(key.split(".")), each) for each in but)
        if not free and then["files"].get(key) != now["files"].get(key):
            return Difference(key, "a file of other content", "changed since")
    return None


def _differences(then: Any, now: Any, but: Collection[KeyPath], at: KeyPath = ()) -> Iterator[tuple[KeyPath, Any, Any]]:
    if any(_below(at, free) for free in but):
        return
    if isinstance(then, dict) and isinstance(now, dict):
        for name in [*then, *(name for name in now if name not in then)]:
            yield from _differences(then.get(name, NOTHING), now.get(name, NOTHING), but, (*at, name))
    elif isinstance(then, list) and isinstance(now, list) and len(then) == len(now):
        for n, (before, after) in enumerate(zip(then, now, strict=True)):
            yield from _differences(before, after, but, (*at, n))
    elif then != now:
        yield at, then, now


def _below(key: KeyPath, above: KeyPath) -> bool:
    return key[: len(above)] == above


def _value_in_words(value: Any) -> str:
    return "missing" if value is NOTHING else shown(value)


def _paths(value: Any, at: KeyPath = ()) -> Iterator[tuple[KeyPath, Path]]:
    if isinstance(value, Path):
        yield at, value
    elif isinstance(value, dict):
        for name, item in value.items():
            yield from _paths(item, (*at, name))
    elif isinstance(value, list | tuple):
        for n, item in enumerate(value):
            yield from _paths(item, (*at, n))


def _digest(file: Path) -> str:
    with file.open("rb") as content:
        return hashlib.file_digest(content, "sha256").hexdigest()
