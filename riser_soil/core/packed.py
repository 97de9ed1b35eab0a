"""Arguments of kernels in memory, where compiled code finds them by their address.

An argument is a row of words of 8 bytes. Packing copies no numbers: what a kernel writes to an array is seen in Python,
and the other way round.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from typing import Any

import numpy as np

from riser_soil.core.kinds import ArrayKind, Kind, TupleKind, kind_of

FORMATS: dict[Kind, str] = {float: "d", int: "q", bool: "?7x"}


class Packed:
    """An array, or a NamedTuple of arrays, floats, ints, bools and tuples of these, in memory: a word for a number, one
    for the address of an array's items and one for the length of each of its axes.

    value: what was packed last; kind: its kind; address: the same as long as this lives.
    """

    def __init__(self, value: Any) -> None:
        self.kind = kind_of(value)
        self._layout = struct.Struct("".join(layout(self.kind)))
        self._memory = np.zeros(self._layout.size, dtype=np.uint8)
        self.address = int(self._memory.ctypes.data)
        self.renew(value)

    def renew(self, value: Any) -> None:
        """Put another value of the same kind in its place."""
        self.value = value
        self._layout.pack_into(self._memory.data, 0, *_words(value))


def layout(kind: Kind) -> Iterator[str]:
    """The format of a kind's words for `struct`."""
    if isinstance(kind, TupleKind):
        for each in kind.items:
            yield from layout(each)
    elif isinstance(kind, ArrayKind) and kind.packed:
        yield f"{1 + kind.ndim}q"
    elif kind in FORMATS:
        yield FORMATS[kind]
    else:
        name = "an array that is not contiguous or may not be written" if isinstance(kind, ArrayKind) else kind.__name__
        raise TypeError(f"{name} can't be packed")


def _words(value: Any) -> Iterator[Any]:
    if isinstance(value, np.ndarray):
        yield from (value.ctypes.data, *value.shape)
    elif isinstance(value, tuple):
        for each in value:
            yield from _words(each)
    else:
        yield value
