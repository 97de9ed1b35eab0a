"""Room for the frames of deep calls, in one piece.

CPython keeps the frames of Python's functions in chunks of 16 KiB. It gives a chunk back as soon as the first frame in
it ends, so that a function that is called again and again across the end of a chunk takes memory from the system each
time. A compiler, which calls itself to any depth, does so half a million times in a minute, a tenth of its time. A
frame that needs more than a chunk gets one of the next power of two that holds it: the rest is room for others.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

SLOTS = 70_000  # of 8 bytes: of a chunk of 1 MiB they leave room for a thousand frames

Function = TypeVar("Function", bound=Callable[..., object])


def with_room(function: Function) -> Function:
    """A decorator: the frame of the function is so large that those of deep calls lie in one chunk with it."""
    function.__code__ = function.__code__.replace(co_stacksize=SLOTS)
    return function
