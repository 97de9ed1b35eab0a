"""Keys and values of a scene that are not supported: keys to come, and characters that no file of results can hold.

Keys to come are named as such instead of being called unknown. A value that switches the thing off is dropped.
"""

import copy
import unicodedata
from collections.abc import Iterator
from typing import Any

from riser_soil.scene.problem import Path as KeyPath
from riser_soil.scene.problem import Problem, matching, value_at

# key -> values that mean "off"; the key itself is not part of the models. `*` stands for any name or number.
KEYS: dict[tuple[str, ...], tuple[Any, ...]] = {
    ("stages", "*", "initial_velocity"): (None,),
}


def without_unsupported(data: Any) -> tuple[Any, list[Problem]]:
    """A copy of a scene's data without the keys of KEYS, and its problems.

    Problems: what this version does not support, and characters that files of results can't have.
    """
    rest = copy.deepcopy(data)
    return rest, [*_unsupported_keys(rest), *_unwritable(rest)]


def _unsupported_keys(data: Any) -> Iterator[Problem]:
    """Remove the keys of KEYS from the data; problems where their values do not mean "off"."""
    for pattern, off in KEYS.items():
        for path, value in matching(data, pattern):
            del value_at(data, path[:-1])[path[-1]]
            if not _among(value, off):
                yield Problem(path, "not supported yet", "leave the key out")


def _unwritable(data: Any, path: KeyPath = ()) -> Iterator[Problem]:
    """Texts and keys with characters that no result's file takes: NUL, other control characters, half a surrogate."""
    entries = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in entries:
        texts = "".join(text for text in (key, value) if isinstance(text, str))
        wrong = {c for c in texts if unicodedata.category(c) in ("Cc", "Cs")} - {*"\t\n\r"}
        if wrong:
            named = ", ".join(f"U+{ord(c):04X}" for c in sorted(wrong))
            yield Problem((*path, key), f"a text has no control characters, which {named} is", "leave them out")
        yield from _unwritable(value, (*path, key))


def _among(value: Any, values: tuple[Any, ...]) -> bool:
    """Whether a value is among others, true and 1 being different values."""
    return any(type(value) is type(other) and value == other for other in values)
