"""C functions as arguments of compiled code: numba's wrapper address protocol.

Machine code that holds an address is nothing to keep on disk. As an argument the address is asked for at each call,
which takes some microseconds, and the code of the loop around it stays.
"""

from __future__ import annotations

import ctypes
from typing import Any

from numba import types
from numba.experimental import function_type  # noqa: F401 (tells numba of the protocol)


class CFunction(types.WrapperAddressProtocol):
    """A function at an address that takes so many pointers and returns nothing; compiled code hands it addresses of
    arrays, whole numbers, 0 for none. owner: what must live as long as the function.
    """

    def __init__(self, address: int, arguments: int, owner: object) -> None:
        self._address, self._owner = address, owner
        self._signature = types.void(*[types.intp] * arguments)
        self._call = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * arguments)(address)

    def __call__(self, *addresses: int) -> None:
        """Call it from Python, as kernels do that are not compiled."""
        self._call(*map(int, addresses))

    def __wrapper_address__(self) -> int:
        return self._address

    def signature(self) -> Any:
        return self._signature
