"""Kinds of values, as far as compiled code hangs on them: NamedTuples, dtypes and axes, not lengths nor numbers."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

_PLAIN: dict[type, type] = {np.float64: float, np.int64: int, np.bool_: bool}


class ArrayKind(NamedTuple):
    """Arrays of one dtype and number of axes; packed: contiguous, in rows, of items that may be written."""

    dtype: str
    ndim: int
    packed: bool


class TupleKind(NamedTuple):
    """Tuples of one class with items of these kinds."""

    named: type
    items: tuple[Kind, ...]


Kind = ArrayKind | TupleKind | type


def kind_of(value: Any) -> Kind:
    """The kind of an array, of a tuple with all that is in it; of other values their type."""
    if isinstance(value, np.ndarray):
        return ArrayKind(value.dtype.str, value.ndim, value.flags.carray)
    if isinstance(value, tuple):
        return TupleKind(type(value), tuple(map(kind_of, value)))
    return _PLAIN.get(type(value), type(value))


def classes(kind: Kind) -> Iterator[type]:
    """Classes that a kind consists of, some of them several times."""
    if isinstance(kind, TupleKind):
        yield kind.named
        for each in kind.items:
            yield from classes(each)
    elif isinstance(kind, type):
        yield kind


BY_ADDRESS: set[type] = set()
"""NamedTuples of addresses: kernels that have them among their arguments are called by address alone."""


def mark(kind: Kind) -> str:
    """A word for a kind."""
    return hashlib.sha256(repr(kind).encode()).hexdigest()[:12]
