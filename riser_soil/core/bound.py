"""Kernels bound to their arguments: compiled functions that are called by address, from compiled code or Python.

The caller needs neither the arguments nor their types. So a loop over kernels is compiled once, not once for each set
of parts, and each kernel is compiled once, whatever others there are. A call takes some 15 ns, from Python 0.3 us.

With NUMBA_DISABLE_JIT=1 kernels are called with the values themselves.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from functools import cached_property, partial
from itertools import accumulate, chain, pairwise
from typing import Any

import numpy as np
from numba import config

from riser_soil.core.arrays import IntArray
from riser_soil.core.compiled import njit
from riser_soil.core.entries import WANTED, Calls, compile_wanted, entry_of
from riser_soil.core.kinds import TupleKind
from riser_soil.core.packed import Packed

CALL = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)


class Bound:
    """A kernel with its arguments, called without any; keeps the arguments alive and returns nothing.

    function, row: what others call it by, the address of its entry and the one that this is called with.
    """

    def __init__(self, kernel: Any, *arguments: Packed) -> None:
        self._addresses = np.array([each.address for each in arguments], dtype=np.int64)
        self._kept, self.row = arguments, int(self._addresses.ctypes.data)
        if config.DISABLE_JIT:
            self.function = self._call = partial(_interpreted, kernel, arguments)
        else:
            self.entry = entry_of(kernel, TupleKind(tuple, tuple(each.kind for each in arguments)))

    def __call__(self) -> None:
        if WANTED:
            compile_wanted()
        self._call()

    @cached_property
    def function(self) -> Any:
        return self.entry.compiled.address

    @cached_property
    def _call(self) -> Callable[[], None]:
        return partial(CALL(self.function), self.row, self.row)


def _interpreted(kernel: Any, arguments: Sequence[Packed], *rows: int) -> None:
    kernel(*(each.value for each in arguments))


def bound(stub: Any, data: tuple[Any, ...] | Packed, *arguments: Packed) -> Bound:
    """The kernel that a function chosen by type has for this data, packed or not, bound to it and to its other
    arguments.
    """
    packed = data if isinstance(data, Packed) else Packed(data)
    return Bound(stub.kernels[type(packed.value)], packed, *arguments)


Span = tuple[int, int]
"""The first of some kernels among others, and the one behind the last."""


@njit
def call_span(given: Calls, span: Span) -> None:
    """Call some of the bound kernels one after the other."""
    for n in range(span[0], span[1]):
        given.functions[n](given.rows[n], given.rows[n])


@njit
def call_each(given: Calls) -> None:
    """Call bound kernels one after the other."""
    call_span(given, (0, given.rows.size))


class _Addresses:
    """Addresses (n,) that keep what they point to, as the base of the arrays that are made of them."""

    def __init__(self, values: Sequence[int], kept: Sequence[Bound]) -> None:
        self._values, self._kept = np.array(values, dtype=np.int64), kept
        self.__array_interface__ = self._values.__array_interface__


def calls(*bound: Bound) -> Calls:
    """Bound kernels to be called one after the other."""
    rows, functions = np.asarray(_Addresses([each.row for each in bound], bound)), np.zeros(len(bound), dtype=np.int64)
    if config.DISABLE_JIT:
        return Calls(np.array([each.function for each in bound], dtype=object), rows)
    for n, each in enumerate(bound):
        each.entry.put_address(functions, n)
    return Calls(functions, rows)


def spans(*lists: Sequence[Bound]) -> tuple[Calls, list[Span]]:
    """Bound kernels of several lists, and where each list is among them: each `Calls` is one more in what kernels
    unpack.
    """
    ends = [0, *accumulate(map(len, lists))]
    return calls(*chain(*lists)), list(pairwise(ends))


@njit
def call_until(given: Calls, failure: IntArray) -> None:
    """Call bound kernels one after the other until one of them writes a failure (1,)."""
    for n in range(given.rows.size):
        given.functions[n](given.rows[n], given.rows[n])
        if failure[0] != 0:
            break


NEVER = Packed(np.zeros(1, dtype=np.int64))
"""A failure that none of the kernels writes."""


def in_turn(*bound: Bound, until: Packed = NEVER) -> Bound:
    """Bound kernels as one, called one after the other until a failure (1,) is written: an integer other than zero."""
    return Bound(call_until, Packed(calls(*bound)), until)
