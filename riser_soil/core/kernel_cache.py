"""numba's cache on disk, a folder for each signature.

numba keeps one index for a function, with all types that it was ever called with, and imports the modules of the
NamedTuples among them to read it. A kernel that is called with the data of any law or part would import all of them;
and fail where one is gone, as one of a test is in the next run. Two processes that compile a function for different
types at the same time may even give the machine code of one the other's place in the index. With one signature in a
folder they write the same.
"""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from numba import config
from numba.core.caching import FunctionCache

PACKAGE = Path(__file__).parents[1]


class CacheByTypes:
    """Cache of one function, in the place of numba's own. Looks for nothing on disk before the function is called."""

    def __init__(self, function: Callable[..., object]) -> None:
        self._function, self._folder = function, config.CACHE_DIR
        self._known: dict[str, FunctionCache] = {}  # by the word for the types

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        return self._of(sig).load_overload(sig, target_context)

    def save_overload(self, sig: Any, data: Any) -> None:
        self._of(sig).save_overload(sig, data)

    def _of(self, sig: Any) -> FunctionCache:
        word = mark(sig)
        if word not in self._known:
            with caching_in(str(Path(self._folder, word))):
                self._known[word] = FunctionCache(self._function)
        return self._known[word]


@contextmanager
def caching_in(folder: str) -> Iterator[None]:
    """Caches that are made meanwhile are in this folder."""
    before, config.CACHE_DIR = config.CACHE_DIR, folder
    try:
        yield
    finally:
        config.CACHE_DIR = before


def mark(kinds: Iterable[Any]) -> str:
    """A word for types of numba; another one where a source outside the package is edited."""
    return hashlib.sha256(" ".join([*map(str, kinds), _word(kinds)]).encode()).hexdigest()[:12]


def _word(kinds: Iterable[Any]) -> str:
    """A word for the NamedTuples among types, "" without any; another one where their source is edited."""
    found = sorted(f"{each.__module__}.{each.__qualname__} {_source(each)}" for each in set(_named(kinds)))
    return hashlib.sha256("\n".join(found).encode()).hexdigest()[:12] if found else ""


def _named(types: Iterable[Any]) -> Iterator[type]:
    """NamedTuples among types of numba, and among what they consist of."""
    for given in types:
        if hasattr(given, "instance_class"):
            yield given.instance_class
        yield from _named(getattr(given, "types", ()))
        yield from _named(getattr(given, "field_dict", {}).values())


def _source(named: type) -> str:
    """Of a class outside the package, as those within have cache folders by their sources."""
    path = getattr(sys.modules[named.__module__], "__file__", None)
    if path is None or PACKAGE in Path(path).parents:
        return ""
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()
