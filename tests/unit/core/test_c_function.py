"""C functions that compiled code gets as arguments."""

from __future__ import annotations

import ctypes

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.c_function import CFunction
from riser_soil.core.compiled import njit

POINTER = ctypes.POINTER(ctypes.c_double)


@ctypes.CFUNCTYPE(None, POINTER, POINTER)
def _add(to: ctypes.Array[ctypes.c_double], value: ctypes.Array[ctypes.c_double]) -> None:
    to[0] += value[0]


@njit
def _call(function: CFunction, to: Array, value: Array) -> None:
    function(to.ctypes.data + 0, value.ctypes.data + 0)


def test_kernels_call_it_compiled_or_not() -> None:
    address = ctypes.cast(_add, ctypes.c_void_p).value
    assert address is not None
    function, to = CFunction(address, 2, _add), np.ones(1)
    _call(function, to, np.array([2.0]))
    _call.py_func(function, to, np.array([4.0]))
    assert to[0] == 7.0
