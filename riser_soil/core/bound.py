"""Kernels bound to their arguments: compiled functions that are called by address, from compiled code or Python.

The caller needs neither the arguments nor their types. So a loop over kernels is compiled once, not once for each set
of parts, and each kernel is compiled once, whatever others there are. A call takes some 15 ns, from Python 0.3 us.

What numba compiles of a kernel here is its entry: a C function (`numba.cfunc`) of one address, where it finds those of
the arguments in memory, each a row of words of 8 bytes, see `Packed`. The entry's source is written by the kinds of the
arguments (`_source`). In an ordinary call numba would unpack each array of a tuple anew, in about 0.3 us, as long as an
element takes. Packing copies no numbers: what a kernel writes to an array is seen in Python, and the other way round.

With NUMBA_DISABLE_JIT=1 kernels are called with the values themselves.
"""

from __future__ import annotations

import ctypes
import struct
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import count
from typing import Any, NamedTuple

import numba
import numpy as np
from numba import config, types

from riser_soil.core.compiled import OPTIONS, keeping, njit
from riser_soil.core.kinds import ArrayKind, Kind, TupleKind, classes, kind_of, mark

FORMATS: dict[Kind, str] = {float: "d", int: "q", bool: "?7x"}
ENTRY = types.ExternalFunctionPointer(types.void(types.voidptr, types.voidptr), None)
"""Type of an entry for those that call it by address. It gets the address of its row twice, as numba casts none: once
as that of addresses, once as that of entries, for kernels that call others."""
CALL = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)


class Packed:
    """An array, or a NamedTuple of arrays, floats, ints, bools and tuples of these, in memory: a word for a number, one
    for the address of an array's items and one for the length of each of its axes.

    value: what was packed last; kind: its kind; address: the same as long as this lives.
    """

    def __init__(self, value: Any) -> None:
        self.kind = kind_of(value)
        self._layout = struct.Struct("".join(_layout(self.kind)))
        self._memory = np.zeros(self._layout.size, dtype=np.uint8)
        self.address = int(self._memory.ctypes.data)
        self.renew(value)

    def renew(self, value: Any) -> None:
        """Put another value of the same kind in its place."""
        self.value = value
        self._layout.pack_into(self._memory.data, 0, *_words(value))


def _layout(kind: Kind) -> Iterator[str]:
    """The format of a kind's words for `struct`."""
    if isinstance(kind, TupleKind):
        for each in kind.items:
            yield from _layout(each)
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


class Bound:
    """A kernel with its arguments, called without any; keeps the arguments alive and returns nothing.

    function, row: what others call it by, the address of its entry and the one that this is called with.
    """

    def __init__(self, kernel: Any, *arguments: Packed) -> None:
        self._addresses = np.array([each.address for each in arguments], dtype=np.int64)
        self._kept, self.row = arguments, int(self._addresses.ctypes.data)
        if config.DISABLE_JIT:
            self.function: Any = partial(_interpreted, kernel, arguments)
            self._call: Callable[[int, int], None] = self.function
        else:
            entry = _entry(kernel, TupleKind(tuple, tuple(each.kind for each in arguments)))
            self.function, self._call = entry.address, CALL(entry.address)

    def __call__(self) -> None:
        self._call(self.row, self.row)


def _interpreted(kernel: Any, arguments: Sequence[Packed], row: int, same: int) -> None:
    kernel(*(each.value for each in arguments))


def bound(stub: Any, data: tuple[Any, ...] | Packed, *arguments: Packed) -> Bound:
    """The kernel that a function chosen by type has for this data, packed or not, bound to it and to its other
    arguments.
    """
    packed = data if isinstance(data, Packed) else Packed(data)
    return Bound(stub.kernels[type(packed.value)], packed, *arguments)


class Calls(NamedTuple):
    """Bound kernels for compiled code: their functions and rows (n,). The kernels are kept with the arrays."""

    functions: Any
    rows: Any


@njit
def call_each(given: Calls) -> None:
    """Call bound kernels one after the other."""
    for n in range(given.rows.size):
        given.functions[n](given.rows[n], given.rows[n])


class _Addresses:
    """Addresses (n,) that keep what they point to, as the base of the arrays that are made of them."""

    def __init__(self, values: Sequence[int], kept: Sequence[Bound]) -> None:
        self._values, self._kept = np.array(values, dtype=np.int64), kept
        self.__array_interface__ = self._values.__array_interface__


def calls(*bound: Bound) -> Calls:
    """Bound kernels to be called one after the other."""
    functions, rows = [each.function for each in bound], [each.row for each in bound]
    made = np.array(functions, dtype=object) if config.DISABLE_JIT else np.asarray(_Addresses(functions, bound))
    return Calls(made, np.asarray(_Addresses(rows, bound)))


def in_turn(*bound: Bound) -> Bound:
    """Bound kernels as one, called one after the other."""
    return Bound(call_each, Packed(calls(*bound)))


_entries: dict[tuple[Any, Kind], Any] = {}


def _entry(kernel: Any, kind: TupleKind) -> Any:
    """A kernel's entry for arguments of these kinds."""
    if (kernel, kind) not in _entries:
        _entries[kernel, kind] = _compiled(kernel.py_func, kernel, kind)
    return _entries[kernel, kind]


def _compiled(function: Any, kernel: Any, kind: TupleKind) -> Any:
    """An entry under a name that is unique in the machine code, compiled where it isn't on disk.

    numba looks for the source where its file says that it is: in that of the kernel, as it is written nowhere.
    """
    name, places = f"{function.__name__}_{mark(kind)}", {each: f"Tuple{n}" for n, each in enumerate(_tuples(kind))}
    given = {"__name__": function.__module__, "carray": numba.carray, "kernel": kernel, "np": np}
    given |= {word: each for each, word in places.items()}
    exec(compile(_source(name, kind, places), function.__code__.co_filename, "exec"), given)
    entry: Any = given[name]
    signature = types.void(types.CPointer(types.voidptr), types.CPointer(ENTRY))
    with keeping(entry, kind, __name__):
        return numba.cfunc(signature, cache=True, **OPTIONS)(entry)


def _tuples(kind: Kind) -> list[type]:
    """The NamedTuples of a kind, each once."""
    return [each for each in dict.fromkeys(classes(kind)) if issubclass(each, tuple) and each is not tuple]


def _source(name: str, kind: TupleKind, named: dict[type, str]) -> str:
    """Python's source of an entry: it sees the words of each argument as addresses, ints and floats, and makes the
    arguments of them. named: what the NamedTuples are called there.
    """
    lines, values = [f"rows = carray(row, {len(kind.items)})", "address, entry = rows.dtype, carray(same, 1).dtype"], []
    for n, each in enumerate(kind.items):
        words = sum(map(struct.calcsize, _layout(each))) // 8
        for view, dtype in (("addresses", "address"), ("ints", "np.int64"), ("floats", "np.float64")):
            lines.append(f"{view}{n} = carray(rows[{n}], {words}, {dtype})")
        values.append(_value(each, n, count(), named))
    body = "".join(f"    {line}\n" for line in (*lines, f"kernel({', '.join(values)})"))
    return f"def {name}(row, same):\n{body}"


def _value(kind: Kind, n: int, words: Iterator[int], named: dict[type, str]) -> str:
    """Python's expression for a value that lies in the next words of argument n."""
    if isinstance(kind, TupleKind):
        if kind.named is Calls:
            dtypes: tuple[str, ...] = "entry", "address"
            return f"{named[Calls]}({', '.join(_array(1, n, words, dtype) for dtype in dtypes)})"
        items = "".join(f"{_value(each, n, words, named)}, " for each in kind.items)
        return f"{named.get(kind.named, '')}({items})"
    if isinstance(kind, ArrayKind):
        return _array(kind.ndim, n, words, f"np.{np.dtype(kind.dtype).type.__name__}")
    word = next(words)
    return {float: f"floats{n}[{word}]", int: f"ints{n}[{word}]", bool: f"ints{n}[{word}] != 0"}[kind]


def _array(ndim: int, n: int, words: Iterator[int], dtype: str) -> str:
    at, *shape = (next(words) for _ in range(1 + ndim))
    return f"carray(addresses{n}[{at}], ({''.join(f'ints{n}[{axis}], ' for axis in shape)}), {dtype})"
