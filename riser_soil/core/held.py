"""Tuples of arrays held where compiled code finds them at once.

As an argument numba reads each array of a tuple anew at each call, in about 0.3 us, as long as an element takes.
The arrays are those that were given, so what is written to them is seen on both sides.
"""

from __future__ import annotations

from typing import Any

from numba import types
from numba.experimental import structref

from riser_soil.core.compiled import njit


@structref.register
class _HeldType(types.StructRef):
    """The type of `Held`."""

    def preprocess_fields(self, fields: Any) -> Any:
        return tuple((name, types.unliteral(kind)) for name, kind in fields)


class Held(structref.StructRefProxy):
    """A tuple held for compiled code, which reads it as `value`; made by `hold`."""


structref.define_proxy(Held, _HeldType, ["value"])


@njit
def hold(value: tuple) -> Held:
    """Hold a tuple; its construction is cached, as that of `Held` in interpreted code is not."""
    return Held(value)
