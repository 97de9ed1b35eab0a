"""Optional roles of parts in the time stepping, such as a predictor, a history that starts, or new meshes.

A role that is declared without its methods, such as a misspelt one, is an error at the stage's start, and so are the
methods of a role that is not declared. Parts that keep something from step to step are `Stateful`, see `saved_state`.
"""

from __future__ import annotations

from collections.abc import Iterable
from inspect import get_annotations
from typing import Any, Protocol, runtime_checkable

from riser_soil.core.arrays import Array
from riser_soil.core.part import Model, Part, State
from riser_soil.core.saved_state import Stateful


@runtime_checkable
class Adaptive(Protocol):
    """A part whose sparsity pattern covers candidate contacts; `outgrown` once the motion goes beyond them."""

    outgrown: bool

    def rebuild(self, state: State) -> None: ...


@runtime_checkable
class Predictor(Protocol):
    """A part with a predictor: a better first guess of a step than the increments of `guess`."""

    def predict(self, guess: State) -> Array: ...


@runtime_checkable
class Starting(Protocol):
    """A part whose history begins with the motion that a stage starts from."""

    def begin_stage(self, state: State) -> None:
        """Take note of the accepted state before the first step; not where a stage goes on from a saved state."""
        ...


@runtime_checkable
class MomentumCorrecting(Protocol):
    """A part whose rates at the end of a step are more than the state's; it starts each step from the state's."""

    def begin(self, state: State) -> None: ...

    def add_momentum_correction(self, state: State, out: Array) -> None:
        """Add the momentum beyond that of the state's rates."""
        ...


@runtime_checkable
class Renewing(Protocol):
    """A part that may change the discretisation between two steps."""

    name: str

    def renew(self, state: State) -> bool:
        """Change it after a step that ended in an accepted state, where that is due; whether it was, the same on all
        ranks. Collective.
        """
        ...

    def lose(self, energy: float) -> None:
        """Take note of the energy [J] that was stored before and is not afterwards, once all is in balance again."""
        ...


@runtime_checkable
class Limited(Protocol):
    """A part whose trial states may be none of the thing modelled."""

    def inadmissible(self, state: State) -> str:
        """Why a state in balance is none, the same on all ranks; empty for a good one. Collective."""
        ...


@runtime_checkable
class UpdatedLagrangian(Protocol):
    """A part that is linear about a geometry, which follows the motion from solution to solution where it `moves`."""

    moves: bool

    def place(self, state: State) -> None:
        """Take the geometry of a state of the step, where it is one that the thing can have; collective."""
        ...

    def lag(self, state: State) -> float:
        """How far the geometry is off that of a state, on this rank, as a share."""
        ...


@runtime_checkable
class Yielding(Protocol):
    """A part whose tangent all but vanishes where it flows."""

    def mix_elastic(self, share: float) -> None:
        """From now on the tangent has a share of the elastic one, 0 to 1, in place of as much of its own."""
        ...


ROLES = (Adaptive, Predictor, Stateful, Starting, MomentumCorrecting, Renewing, Limited, UpdatedLagrangian, Yielding)


def with_role(parts: Iterable[Part], role: type) -> list[Any]:
    """The parts that have declared a role."""
    return [part for part in parts if role in part.traits.roles]


def owners(model: Model) -> dict[str, Stateful]:
    """Fields and parts that keep something from step to step, by the names under which it is saved.

    ValueError where two would have one name, so that states could be mistaken for each other.
    """
    named: list[tuple[str, Stateful]] = [(f"fields/{field.name}", field) for field in model.fields]
    named += [(f"parts/{name_of(part)}", part) for part in with_role(model.parts, Stateful)]
    by_name = dict(named)
    if len(by_name) < len(named):
        names = [name for name, _ in named]
        raise ValueError(f'more than one keeps its state as "{max(names, key=names.count)}"')
    return by_name


def name_of(part: Part) -> str:
    """Name of one part: that of its kind, behind the name of its line where there may be several lines."""
    line = getattr(part, "line", None)
    return part.name if line is None or line.name == "riser" else f"{line.name}/{part.name}"


def require_roles(model: Model) -> None:
    """TypeError where a part's methods are not those of the roles that it declares; ValueError as of `owners`."""
    owners(model)
    for part in model.parts:
        for role in ROLES:
            declared = role in part.traits.roles
            if declared != isinstance(part, role):
                said = "is declared and not there" if declared else "is there and not declared"
                raise TypeError(f'part "{part.name}": the role {role.__name__}, {", ".join(_members(role))}, {said}')


def _members(role: type) -> list[str]:
    return sorted({*get_annotations(role), *(name for name in vars(role) if not name.startswith("_"))})
