"""Compiled functions that are called from compiled code, and from Python where somebody does so.

numba makes two wrappers around each function that it compiles, one for Python and one for C, and compiles them with it,
though most of the kernels are called from other kernels alone. They take a third of the time. Here a function is
compiled without them, and once more with one for Python when it is first called from there.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import cached_property
from typing import Any

from numba.core.registry import CPUDispatcher

from riser_soil.core.kernel_cache import BareCache, KernelCache

BARE = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}


class Called(CPUDispatcher):
    """A function compiled for Python."""

    def _compilation_chain_init_hook(self) -> None:
        """Extensions of numba are not needed; looking for them reads a file of each package that is installed."""


class Kernel(CPUDispatcher):
    """A function compiled for compiled code; see `numba.njit` for the options."""

    def __init__(self, function: Callable[..., object], options: dict[str, Any]) -> None:
        # numba asks for the signature again and again, which takes a twentieth of a start where it is found anew.
        vars(function)["__signature__"] = inspect.signature(function)
        self._options = {"nopython": True, "boundscheck": None, **options}
        super().__init__(function, targetoptions={**self._options, **BARE})
        self._cache, self._kept = BareCache(function), KernelCache(function)

    @cached_property
    def called(self) -> CPUDispatcher:
        """The one that Python calls."""
        made = Called(self.py_func, targetoptions={**self._options, "no_cfunc_wrapper": True})
        made._cache = self._kept
        return made

    def add_overload(self, cres: Any) -> None:
        """Keep what has been compiled for some types under a key of its own, for it has no address for Python."""
        key = object()
        self.targetctx.insert_user_function(key, cres.fndesc, [cres.library])
        self.overloads[tuple(cres.signature.args)] = cres._replace(entry_point=key)

    def _compile_for_args(self, *args: Any, **named: Any) -> Any:
        """numba asks for what Python is to call with arguments of new types."""
        known = set(self.called.overloads)
        found = self.called._compile_for_args(*args, **named)
        for kinds in set(self.called.overloads) - known:
            made = self.called.overloads[kinds]
            self._insert([kind._code for kind in kinds], made.entry_point, False)  # not in object mode
        return found
