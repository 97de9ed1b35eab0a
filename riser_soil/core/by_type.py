"""Functions of compiled code that are chosen by the type of their first argument, as methods are by their object.

A riser alone is solved in one compiled loop over its parts. Each part has its numbers in a NamedTuple of arrays, whose
type chooses the part's own kernels while the loop is compiled:

    @by_type
    def add_forces(part, at, out): "…"

    @add_forces.of(InertiaNumbers)
    def _inertia(part, at, out): …

In compiled code `each(add_forces)`, called with a tuple of parts in the place of one, calls that of each in turn.
"""

from __future__ import annotations

from collections.abc import Callable
from inspect import signature
from typing import Any

from numba.extending import overload

from riser_soil.core.compiled import njit

Kernel = Callable[..., Any]


def by_type(stub: Any) -> Any:
    """A function whose kernels are chosen by the type of its first argument, a NamedTuple.

    stub: its name, text and arguments. Its attribute `of` takes the kernel for a type, see the module's text, and
    compiles it like all others; kernels: by type.
    """
    kernels: dict[type, Kernel] = {}

    @overload(stub, inline="always", strict=False)
    def choose(part: Any, *rest: Any) -> Kernel | None:
        kernel = kernels.get(_type_of(part))
        return None if kernel is None else _calling(stub, ["return kernel_0({})"], [kernel])

    def of(numbers: type) -> Callable[[Kernel], Kernel]:
        def keep(kernel: Kernel) -> Kernel:
            kernels[numbers] = njit(kernel, apart=True)
            return kernel

        return keep

    stub.of, stub.kernels = of, kernels
    return stub


def each(stub: Any, last_by_part: bool = False) -> Kernel:
    """The function that calls one chosen by type with each of a tuple, which may be of different types.

    last_by_part: each part gets a row of its own of the last argument.
    """

    def call(parts: tuple, *rest: Any) -> None:
        """Its compiled code is that of the calls, one after the other."""

    first, *rest = signature(stub).parameters

    @overload(call, inline="always", strict=False)
    def unroll(parts: Any, *given: Any) -> Kernel:
        rows = (f"[{n}]" if last_by_part else "" for n in range(len(parts)))
        lines = [f"kernel_{n}({first}[{n}], {', '.join(rest)}{row})" for n, row in enumerate(rows)]
        return _calling(stub, lines or ["pass"], [stub.kernels[_type_of(part)] for part in parts])

    return call


def _type_of(part: Any) -> type:
    """The NamedTuple that an argument is to be, as numba sees it."""
    found: type = getattr(part, "instance_class", type(None))
    return found


def _calling(stub: Any, lines: list[str], kernels: list[Kernel]) -> Kernel:
    """A function with the arguments of a stub, which numba wants by their names: {} in its lines stands for them."""
    names = ", ".join(signature(stub).parameters)
    made: dict[str, Any] = {f"kernel_{n}": kernel for n, kernel in enumerate(kernels)}
    exec(f"def calling({names}):\n" + "".join(f"    {line.format(names)}\n" for line in lines), made)
    calling: Kernel = made["calling"]
    return calling
