"""Soil that covers the seabed below it, for the seabed's stations in the compiled loop."""

from __future__ import annotations

from riser_soil.contact.pairing import Cover, facet_below
from riser_soil.contact.seabed_loop import covered_by
from riser_soil.riser.vectors import Vec

__all__ = ["Cover"]


@covered_by.of(Cover)
def _by_surface(cover: Cover, x: Vec, known: int) -> int:
    return facet_below(cover, x[0], x[1], known)
