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
from inspect import signature
from typing import Any

from numba.extending import overload

from riser_soil.core.compiled import njit
from riser_soil.core.kernel_cache import KERNELS_FOR

Kernel = Callable[..., Any]


def by_type(stub: Any, apart: bool = True) -> Any:
    """A function whose kernels are chosen by the type of its first argument, a NamedTuple.

    stub: its name, text and arguments. Its attribute `of` takes the kernel for a type, see the module's text, and
    compiles it like all others; kernels: by type. apart: see `compiled.njit`.
    """
    kernels: dict[type, Kernel] = {}

    @overload(stub, inline="always", strict=False)
    def choose(part: Any, *rest: Any) -> Kernel | None:
        kernel = kernels.get(_type_of(part))
        return None if kernel is None else _calling(stub, kernel)

    def of(data: type) -> Callable[[Kernel], Kernel]:
        def keep(kernel: Kernel) -> Kernel:
            kernels[data] = njit(kernel, apart=apart)
            KERNELS_FOR.setdefault(data, set()).add(kernel.__module__)
            return kernel

        return keep

    stub.of, stub.kernels = of, kernels
    return stub


def bound_by_type(stub: Any) -> Any:
    """A function chosen by the type of its first argument, for kernels that are called by address alone (`bound`): each
    is inlined where it is called.
    """
    return by_type(stub, apart=False)


def _type_of(part: Any) -> type:
    """The NamedTuple that an argument is to be, as numba sees it."""
    found: type = getattr(part, "instance_class", type(None))
    return found


def _calling(stub: Any, kernel: Kernel) -> Kernel:
    """A function with the arguments of a stub, which numba wants by their names."""
    names = ", ".join(signature(stub).parameters)
    made: dict[str, Any] = {"kernel": kernel}
    exec(f"def calling({names}):\n    return kernel({names})\n", made)
    calling: Kernel = made["calling"]
    return calling
