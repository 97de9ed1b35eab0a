"""Saved state: the committed state of all its owners as named arrays, for a restart between two steps.

A stage is saved between two steps. Built anew from its scene and given the saved state back, it continues as if it had
not been interrupted, to the last bit. So an owner saves all that the next steps depend on, unless it is the scene's,
and nothing that they find again by themselves.

An owner within another has its names after that one's and a "/": `stepper/before/u`. Numbers are arrays without axes;
what is neither, such as texts and lists of them, is JSON as bytes, see `packed`. Each rank saves its own share.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any, Protocol, TypeVar, runtime_checkable

import numpy as np
import numpy.typing as npt

AnyArray = npt.NDArray[Any]
Saved = dict[str, AnyArray]
T = TypeVar("T")


@runtime_checkable
class Stateful(Protocol):
    """Owner of committed state, the same from one accepted step to the next."""

    def state(self) -> Saved:
        """The committed state, in arrays that do not change any more."""
        ...

    def restore(self, saved: Saved) -> None:
        """Take over what `state` gave, of this owner or of one built from the same scene; `saved` stays as it is."""
        ...


def gathered(owners: Mapping[str, Stateful]) -> Saved:
    """The states of owners, each under its name."""
    return {f"{name}/{key}": value for name, owner in owners.items() for key, value in owner.state().items()}


def restore_all(owners: Mapping[str, Stateful], saved: Saved) -> None:
    """Restore owners from what `gathered` gave of them."""
    for name, owner in owners.items():
        owner.restore(within(saved, name))


def within(saved: Saved, name: str) -> Saved:
    """The saved state of the owner of a name."""
    first = f"{name}/"
    return {key[len(first) :]: value for key, value in saved.items() if key.startswith(first)}


def under(name: str, saved: Saved) -> Saved:
    """Saved arrays under the name of their owner."""
    return {f"{name}/{key}": value for key, value in saved.items()}


def values_of(record: object) -> Saved:
    """Arrays and numbers of a record, such as a dataclass, by the names of its attributes."""
    return {name: np.array(value) for name, value in vars(record).items()}


def record_of(kind: type[T], saved: Saved) -> T:
    """A record from what `values_of` gave of it."""
    return kind(**{name: value.copy() if value.ndim else value.item() for name, value in saved.items()})


def packed(value: object) -> AnyArray:
    """Bytes (n,) of a value in JSON's terms; numbers keep all their digits, nan and inf included."""
    return np.frombuffer(json.dumps(value).encode(), dtype=np.uint8)


def unpacked(saved: AnyArray) -> Any:
    """A value from `packed`; its tuples have become lists."""
    return json.loads(saved.tobytes())
