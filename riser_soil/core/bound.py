"""Kernels bound to their arguments: compiled functions that are called by address, from compiled code or Python.

The caller needs neither the arguments nor their types. So a loop over kernels is compiled once, not once for each set
of parts, and each kernel is compiled once, whatever others there are. A call takes some 10 ns, from Python 0.2 us.

Arguments are arrays and tuples of them, packed into memory in numba's layout; compiled functions get their address. In
an ordinary call numba would unpack each array of a tuple anew, in about 0.3 us, as long as an element takes. Packing
copies no numbers: what a kernel writes to an array is seen in Python, and the other way round.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from types import FunctionType
from typing import Any, NamedTuple

import numba
import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from riser_soil.core.arrays import IntArray
from riser_soil.core.compiled import entry, njit
from riser_soil.core.kernel_cache import mark
from riser_soil.core.machine_code import NOTHING, WORD, borrowed, made_tuple, stored

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
    """The words of a value in numba's data models; an array that compiled code doesn't own begins with two null
    pointers.
    """
    if isinstance(value, np.ndarray):
        yield from (0, 0, value.size, value.itemsize, value.ctypes.data, *value.shape, *value.strides)
    elif isinstance(value, tuple):
        for each in value:
            yield from _words(each)
    else:
        yield value


_entries: dict[tuple[Any, ...], Any] = {}


class Bound:
    """A kernel with its arguments, called without any; keeps the arguments alive and returns nothing."""

    def __init__(self, kernel: Any, *arguments: Packed) -> None:
        entry = _entry(kernel, *(each.kind for each in arguments))
        self._addresses = np.array([each.address for each in arguments], dtype=np.int64)
        self._kept, self._call = arguments, entry.ctypes
        self.function, self.row = int(entry.address), int(self._addresses.ctypes.data)

    def __call__(self) -> None:
        self._call(self.row)


def bound(stub: Any, data: tuple[Any, ...], *arguments: Packed) -> Bound:
    """The kernel that a function chosen by type has for this data, bound to it and to its other arguments."""
    return Bound(stub.kernels[type(data)], Packed(data), *arguments)


class Calls(NamedTuple):
    """Bound kernels for compiled code: addresses of functions and of where those of their arguments lie (n,).

    The kernels are kept with the arrays.
    """

    functions: IntArray
    rows: IntArray


@njit
def call_each(given: Calls) -> None:
    """Call bound kernels one after the other."""
    for n in range(given.functions.size):
        _call(given.functions[n], given.rows[n])


class _Addresses:
    """Addresses (n,) that keep what they point to, as the base of the arrays that are made of them."""

    def __init__(self, values: Sequence[int], kept: Sequence[Bound]) -> None:
        self._values, self._kept = np.array(values, dtype=np.int64), kept
        self.__array_interface__ = self._values.__array_interface__


def calls(*bound: Bound) -> Calls:
    """Bound kernels to be called one after the other."""
    columns = [each.function for each in bound], [each.row for each in bound]
    return Calls(*(np.asarray(_Addresses(column, bound)) for column in columns))


def in_turn(*bound: Bound) -> Bound:
    """Bound kernels as one, called one after the other."""
    return Bound(call_each, Packed(calls(*bound)))


def _entry(kernel: Any, *kinds: Any) -> Any:
    """The function of one address that calls a kernel with arguments of these types, which it finds there."""
    key = kernel, *kinds
    if key not in _entries:
        _entries[key] = _compiled(kernel, types.Tuple(kinds))
    return _entries[key]


def _compiled(kernel: Any, kinds: Any) -> Any:
    """Compile the entry of a kernel, under a name that is unique on disk and in the machine code."""

    source, name = kernel.py_func.__code__, f"{kernel.py_func.__name__}_{mark(kinds)}"
    code = _calling.__code__.replace(co_filename=source.co_filename, co_firstlineno=source.co_firstlineno)
    given = {"_kernel": kernel, "_kinds": kinds, "_arguments": _arguments, "__name__": kernel.py_func.__module__}
    calling = FunctionType(code, given, name)
    calling.__qualname__ = name
    return entry(calling, kinds)


_kernel: Any = None
_kinds: Any = None


def _calling(row: int) -> None:
    """Body of an entry. It has globals of its own, as variables of a closure would be part of its key on disk."""
    _kernel(*_arguments(row, _kinds))


@intrinsic
def _arguments(context: Any, row: Any, kinds: Any) -> Any:
    """In compiled code: a tuple of what lies where a row of addresses points to."""
    both = kinds.instance_type

    def load(target: Any, builder: Any, signature: Any, given: Any) -> Any:
        addresses, values = builder.inttoptr(given[0], WORD.as_pointer()), []
        for n, kind in enumerate(both):
            address = builder.load(builder.gep(addresses, [WORD(n)]))
            values.append(borrowed(builder, kind, builder.inttoptr(address, stored(kind).as_pointer())))
        return made_tuple(builder, both, values)

    return both(row, kinds), load


@intrinsic
def _call(context: Any, function: Any, row: Any) -> Any:
    """In compiled code: call a function by its address."""

    def call(target: Any, builder: Any, signature: Any, given: Any) -> Any:
        kind = ir.FunctionType(ir.VoidType(), [WORD])
        builder.call(builder.inttoptr(given[0], kind.as_pointer()), [given[1]])
        return NOTHING

    return types.void(types.intp, types.intp), call
