"""What parts, fields and step controls may do for the time stepper beyond their contracts; see `core.part`."""

from __future__ import annotations

from typing import Any, Protocol, runtime_checkable

from riser_soil.core.arrays import Array
from riser_soil.core.part import State


@runtime_checkable
class Adaptive(Protocol):
    """A part whose pattern covers what may come; it says when the motion has left it."""

    outgrown: bool

    def rebuild(self, state: State) -> None: ...


@runtime_checkable
class Predictor(Protocol):
    """A part or field that knows a better first guess of a step than the last increment."""

    def predict(self, guess: State) -> Array: ...


@runtime_checkable
class Remembering(Protocol):
    """A part whose forces depend on the way there; `memory` is what it keeps of that way, replaced by each commit."""

    memory: Any


@runtime_checkable
class MomentumCorrecting(Protocol):
    """A part whose rates at the end of a step are more than the state's; it starts each step from the state's."""

    def begin(self, state: State) -> None: ...

    def add_momentum_correction(self, state: State, out: Array) -> None:
        """Add the momentum beyond that of the state's rates."""
        ...


@runtime_checkable
class Turning(Protocol):
    """A field whose dofs refer to axes that turn with it."""

    offset: int
    size: int

    def in_new_axes(self, conjugate: Array, increments: Array) -> Array:
        """Forces (field's slice) conjugate to the increments, as those of the step after these increments have them."""
        ...


@runtime_checkable
class Demanding(Protocol):
    """Steps that only go on when their local error [m] is small."""

    def fault(self, error: float) -> str:
        """What is wrong with a step of this error; empty for a good one."""
        ...
