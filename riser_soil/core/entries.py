"""Entries of kernels: C functions of one address, where they find those of the arguments in memory, see `Packed`.

numba compiles an entry (`numba.cfunc`) of a source that is written by the kinds of the arguments. In an ordinary call
it would unpack each array of a tuple anew, in about 0.3 us, as long as an element takes. Each kind of argument is
unpacked by a kernel of its own, which all entries share.

An entry is compiled when it is called first, and with it all others that are wanted by then, see `side_by_side`.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Iterator
from functools import cache, cached_property
from itertools import count
from operator import attrgetter
from typing import Any, NamedTuple

import numba
import numpy as np
from numba import config, types

from riser_soil.core.arrays import IntArray
from riser_soil.core.compiled import OPTIONS, compiling, keeping, njit, place_of
from riser_soil.core.frame_room import with_room
from riser_soil.core.kinds import BY_ADDRESS, ArrayKind, Kind, TupleKind, classes, mark
from riser_soil.core.packed import layout
from riser_soil.core.side_by_side import side_by_side

ENTRY = types.ExternalFunctionPointer(types.void(types.voidptr, types.voidptr), None)
"""Type of an entry for those that call it by address. It gets the address of its row twice, as numba casts none: once
as that of addresses, once as that of entries, for kernels that call others."""


class Calls(NamedTuple):
    """Bound kernels for compiled code: their functions and rows (n,). The kernels are kept with the arrays. Functions
    are there once a `Bound` is called.
    """

    functions: Any
    rows: Any


BY_ADDRESS.add(Calls)


class Entry:
    """The entry of a kernel for arguments of some kinds, under a name that is unique in the machine code."""

    def __init__(self, kernel: Any, kind: TupleKind) -> None:
        unpack = {f"unpack{n}": _unpack(each) for n, each in enumerate(kind.items)}
        arguments = ", ".join(f"{each}(rows, {n}, same)" for n, each in enumerate(unpack))
        lines = f"rows = carray(row, {len(unpack)})", f"kernel({arguments})"
        heading = f"{kernel.py_func.__name__}_{mark(kind)}(row, same)"
        self._function = _function(heading, lines, kernel.py_func, {"kernel": kernel, **unpack})
        self.module, self.place = kernel.py_func.__module__, place_of(self._function, kind, __name__)
        self._wanted_in: list[tuple[IntArray, int]] = []

    @property
    def free(self) -> bool:
        """Whether no process has compiled it, nor does now."""
        return self.place.free

    def do(self) -> None:
        """Compile it, or read it from disk, and write its address where it is wanted."""
        address = self.compiled.address
        for addresses, n in self._wanted_in:
            addresses[n] = address
        self._wanted_in.clear()

    @cached_property
    @with_room
    def compiled(self) -> Any:
        """The C function, which has its address."""
        signature = types.void(types.CPointer(types.voidptr), types.CPointer(ENTRY))
        with keeping(self.place):
            return numba.cfunc(signature, cache=True, **OPTIONS)(self._function)

    def put_address(self, addresses: IntArray, n: int) -> None:
        """Write its address among others, now or before anything is called."""
        self._wanted_in.append((addresses, n))
        WANTED.append(self)


WANTED: list[Entry] = []
"""Entries that something is bound to since they were compiled last."""


@cache
def entry_of(kernel: Any, kind: TupleKind) -> Entry:
    """The entry of a kernel for arguments of some kinds, wanted from now on."""
    entry = Entry(kernel, kind)
    WANTED.append(entry)
    return entry


def compile_wanted() -> None:
    """Compile all entries that are wanted, side by side, or read them from disk. Kernels of a module, which call the
    same functions, are as a rule compiled by the same process. Nothing is where kernels run as Python.
    """
    if config.DISABLE_JIT:
        return
    entries = [*dict.fromkeys(WANTED)]
    WANTED.clear()
    missing = [each for each in sorted(entries, key=attrgetter("module")) if not each.place.filled]
    if len(missing) > 1:
        with compiling():
            side_by_side(missing)
    for each in entries:
        each.do()


@cache
def _unpack(kind: Kind) -> Any:
    """A kernel that makes argument n of the words in memory, which it sees as addresses, ints and floats. It is
    compiled once for all entries that have such an argument.
    """
    words, named = sum(map(struct.calcsize, layout(kind))) // 8, _tuples(kind)
    views = {"addresses": "address", "ints": "np.int64", "floats": "np.float64"}
    lines = ["address, entry = rows.dtype, carray(same, 1).dtype"]
    lines += [f"{view} = carray(rows[n], {words}, {dtype})" for view, dtype in views.items()]
    lines += [f"return {_value(kind, count(), named)}"]
    given = {word: each for each, word in named.items()} | {_view_name(each): _view(each) for each in _arrays(kind)}
    return njit(_function("unpack(rows, n, same)", lines, _value, given))


@cache
def _view(kind: ArrayKind) -> Any:
    """A kernel that makes an array of its words, the first of which is number k of an argument's. What numba does for
    an expression takes longer than what it does for a call.
    """
    shape = "".join(f"ints[k + {axis + 1}], " for axis in range(kind.ndim))
    line = f"return carray(addresses[k], ({shape}), np.{np.dtype(kind.dtype).type.__name__})"
    return njit(_function(f"{_view_name(kind)}(addresses, ints, k)", [line], _value, {}))


def _view_name(kind: ArrayKind) -> str:
    return f"view{kind.ndim}_{np.dtype(kind.dtype).name}"


def _function(heading: str, lines: Iterable[str], like: Any, given: dict[str, Any]) -> Any:
    """The function of a source, for which numba looks where another function's is, as this is written nowhere."""
    names = {"__name__": like.__module__, "carray": numba.carray, "np": np, **given}
    source = "".join(f"    {line}\n" for line in lines)
    exec(compile(f"def {heading}:\n{source}", like.__code__.co_filename, "exec"), names)
    return names[heading[: heading.index("(")]]


def _tuples(kind: Kind) -> dict[type, str]:
    """What the NamedTuples of a kind are called in sources."""
    tuples = (each for each in dict.fromkeys(classes(kind)) if issubclass(each, tuple) and each is not tuple)
    return {each: f"Tuple{n}" for n, each in enumerate(tuples)}


def _arrays(kind: Kind) -> Iterator[ArrayKind]:
    """The arrays within a kind, but those of `Calls`."""
    if isinstance(kind, TupleKind) and kind.named is not Calls:
        for each in kind.items:
            yield from _arrays(each)
    elif isinstance(kind, ArrayKind):
        yield kind


def _value(kind: Kind, words: Iterator[int], named: dict[type, str]) -> str:
    """Python's expression for a value that lies in the next words. named: what NamedTuples are called there."""
    if isinstance(kind, TupleKind):
        if kind.named is Calls:
            each = (f"carray(addresses[{next(words)}], ints[{next(words)}], {dtype})" for dtype in ("entry", "address"))
            return f"{named[Calls]}({', '.join(each)})"
        return f"{named.get(kind.named, '')}({''.join(f'{_value(each, words, named)}, ' for each in kind.items)})"
    if isinstance(kind, ArrayKind):
        at, *_ = (next(words) for _ in range(1 + kind.ndim))
        return f"{_view_name(kind)}(addresses, ints, {at})"
    word = next(words)
    return {float: f"floats[{word}]", int: f"ints[{word}]", bool: f"ints[{word}] != 0"}[kind]
