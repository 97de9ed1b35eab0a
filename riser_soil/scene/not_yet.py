"""Keys and values of the scene language that are not supported yet.

They are named as such instead of being called unknown. A value that switches the thing off is dropped.
"""

import copy
from collections.abc import Iterator
from typing import Any

from riser_soil.scene.problem import Path, Problem

# key -> values that mean "off"; the key itself is not part of the models. `*` stands for any name or number.
KEYS: dict[tuple[str, ...], tuple[Any, ...]] = {
    ("stages", "*", "initial_velocity"): (None,),
}

# key -> values of the language that can't be chosen yet; the key is part of the models.
VALUES: dict[tuple[str, ...], tuple[Any, ...]] = {
    ("soil", "inertia"): (True,),
    ("contact", "method"): ("surface",),
}


def taken_out(data: Any) -> tuple[Any, list[Problem]]:
    """A copy of the data without the keys of KEYS, and problems for what this version does not support."""
    rest = copy.deepcopy(data)
    return rest, [*_keys(rest), *_values(rest)]


def _keys(data: Any) -> Iterator[Problem]:
    for pattern, off in KEYS.items():
        for path, parent in _matches(data, pattern):
            value = parent.pop(path[-1])
            if not _among(value, off):
                yield Problem(path, "not supported yet", "leave the key out")


def _values(data: Any) -> Iterator[Problem]:
    for pattern, refused in VALUES.items():
        for path, parent in _matches(data, pattern):
            if _among(parent[path[-1]], refused):
                yield Problem(path, "not supported yet", "choose another value or leave the key out")


def _among(value: Any, values: tuple[Any, ...]) -> bool:
    """Membership that tells true from 1."""
    return any(type(value) is type(other) and value == other for other in values)


def _matches(data: Any, pattern: tuple[str, ...], path: Path = ()) -> Iterator[tuple[Path, dict[Any, Any]]]:
    """Paths present in the data that fit a pattern, each with the mapping that holds its last key."""
    word, rest = pattern[0], pattern[1:]
    if not rest:
        if isinstance(data, dict) and word in data:
            yield (*path, word), data
        return
    entries = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in list(entries):
        if word in ("*", key):
            yield from _matches(value, rest, (*path, key))
