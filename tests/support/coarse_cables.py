"""Catenaries of few bars, for tests of what begins with one: it is found in a fraction of the time."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from unittest.mock import patch

from riser_soil.riser.catenary import catenary


@contextmanager
def coarse_cables(bars: int) -> Iterator[None]:
    """Catenaries are cut into about so many bars, into one an element at least."""
    defaults = catenary.__kwdefaults__
    assert defaults is not None
    assert "bars" in defaults
    with patch.dict(defaults, {"bars": bars}):
        yield
