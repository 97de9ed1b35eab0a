"""Frames of deep calls lie in one chunk with that of a function that has room for them."""

from __future__ import annotations

import resource
from collections.abc import Callable

from riser_soil.core.frame_room import with_room

DEPTHS, CALLS = range(0, 200, 5), 500


def pages_taken_at_depth(depth: int) -> int:
    """Pages that the system gives while a short function is called again and again at a depth of calls."""
    if depth > 0:
        return pages_taken_at_depth(depth - 1)

    def short(a: int, b: int) -> int:
        return a + b

    def longer(n: int) -> int:
        """Its frames and those of what it calls end at many places of a chunk."""
        return short(n, n) if n == 0 else longer(n - 1)

    before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    for _ in range(CALLS):
        longer(5)
    return resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before


def most_pages(of: Callable[[int], int]) -> int:
    return max(of(depth) for depth in DEPTHS)


def test_deep_calls_take_no_memory_again_and_again() -> None:
    assert most_pages(with_room(lambda depth: pages_taken_at_depth(depth))) < CALLS / 5


def test_it_does_what_the_function_does() -> None:
    @with_room
    def total(a: int, *more: int, scale: int = 1) -> int:
        """A sum."""
        return scale * (a + sum(more))

    assert total(1, 2, 3, scale=2) == 12
    assert total.__doc__ == "A sum."
