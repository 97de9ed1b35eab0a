"""Functions of compiled code that are chosen by the type of their first argument, as methods are by their object.

Each part of a riser, and each law that one calls, has its kernel data in a NamedTuple of arrays, whose type chooses its
own kernels while what calls them is compiled:

    @by_type
    def add_forces(part, at, out): "…"

    @add_forces.of(InertiaData)
    def _inertia(part, at, out): …
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any

from numba.extending import overload

from riser_soil.core.compiled import NO_ENTRY, njit
from riser_soil.core.kernel_cache import KERNELS_FOR

Kernel = Callable[..., Any]


def by_type(stub: Any, apart: bool = True) -> Any:
    """A function whose kernels are chosen by the type of its first argument, a NamedTuple.

    stub: its name, text and arguments. Its attribute `of` takes the kernel for a type, see the module's text, and
    compiles it like all others; kernels: by type. apart: see `compiled.njit`.
    """
    kernels: dict[type, Any] = {}

    @wraps(stub)
    def chosen(part: Any, *rest: Any) -> Any:
        return kernels[type(part)](part, *rest)

    @overload(chosen, jit_options=NO_ENTRY | {"forceinline": not apart}, strict=False)
    def choose(part: Any, *rest: Any) -> Kernel | None:
        kernel = kernels.get(getattr(part, "instance_class", type(None)))  # the NamedTuple, as numba sees it
        return None if kernel is None else kernel.py_func

    def of(data: type) -> Callable[[Kernel], Kernel]:
        def keep(kernel: Kernel) -> Kernel:
            kernels[data] = njit(kernel, apart=apart)
            KERNELS_FOR.setdefault(data, set()).add((stub.__module__, kernel.__module__))
            return kernel

        return keep

    vars(chosen).update(of=of, kernels=kernels)
    return chosen


def bound_by_type(stub: Any) -> Any:
    """A function chosen by the type of its first argument, for kernels that are called by address alone (`bound`): each
    is inlined where it is called.
    """
    return by_type(stub, apart=False)
