"""Numbers in memory where compiled functions find them by an address: arrays and tuples of them, laid out as by numba.

A function that is called by its address shares tuples with others without its caller knowing their types, see `bound`.
As an argument of an ordinary call numba would read each array of a tuple anew, in about 0.3 us, as long as an element
takes. The arrays are those that were packed, so what is written to them is seen on both sides.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from typing import Any

import numba
import numpy as np

FORMATS: dict[type, str] = {float: "d", np.float64: "d", int: "q", np.int64: "q", bool: "?", np.bool_: "?"}


class Packed:
    """An array, or a NamedTuple of arrays, floats, ints, bools and tuples of these, in memory.

    value: what was packed last; kind: numba's type of it; address: the same as long as this lives.
    """

    def __init__(self, value: Any) -> None:
        self.kind = numba.typeof(value)
        self._layout = struct.Struct("".join(_layout(value)))
        self._memory = np.zeros(self._layout.size, dtype=np.uint8)
        self.address = int(self._memory.ctypes.data)
        self.renew(value)

    def renew(self, value: Any) -> None:
        """Put another value of the same type in its place."""
        self.value = value
        self._layout.pack_into(self._memory.data, 0, *_words(value))


def _layout(value: Any) -> Iterator[str]:
    """The format of a value for `struct`; a tuple begins and ends where a word of 8 bytes may."""
    if isinstance(value, np.ndarray):
        yield f"{5 + 2 * value.ndim}q"
    elif isinstance(value, tuple):
        yield "0q"
        for each in value:
            yield from _layout(each)
        yield "0q"
    elif type(value) in FORMATS:
        yield FORMATS[type(value)]
    else:
        raise TypeError(f"{type(value).__name__} can't be packed")


def _words(value: Any) -> Iterator[Any]:
    """As numba's data models have them: an array that compiled code doesn't own begins with two null pointers."""
    if isinstance(value, np.ndarray):
        yield from (0, 0, value.size, value.itemsize, value.ctypes.data, *value.shape, *value.strides)
    elif isinstance(value, tuple):
        for each in value:
            yield from _words(each)
    else:
        yield value
