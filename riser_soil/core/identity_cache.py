"""Identity cache: values computed from an object, kept by the object's identity."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Generic, TypeVar

Of = TypeVar("Of")
Made = TypeVar("Made")


class IdentityCache(Generic[Of, Made]):
    """Values computed from the first objects since `forget`, and from the latest ones; objects must not change while
    kept.

    Equal objects are not the same: comparing them would take as long as making. Whoever makes passes the function along
    with the object, so that nothing here holds on to its owner.
    """

    def __init__(self, *, latest: int = 1, first: int = 0) -> None:
        self._first: deque[tuple[Of, Made]] = deque(maxlen=first)
        self._latest: deque[tuple[Of, Made]] = deque(maxlen=latest)

    def made_of(self, of: Of, make: Callable[[Of], Made]) -> Made:
        """The value of an object: the cached one, or a new one by `make`."""
        for known, made in self._latest:
            if known is of:
                return made
        for known, made in self._first:
            if known is of:
                return made
        made = make(of)
        if len(self._first) == self._first.maxlen:
            self._latest.appendleft((of, made))
        else:
            self._first.append((of, made))
        return made

    def forget(self) -> None:
        """Drop all."""
        self._first.clear()
        self._latest.clear()
