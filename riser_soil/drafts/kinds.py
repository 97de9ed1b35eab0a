"""Kinds of drafts: what each is made of, and the numbers that it has where none are given."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from riser_soil.drafts.pipes import CrossSection, chain, flexible, steel
from riser_soil.errors import SceneError


@dataclass(frozen=True)
class Kind:
    """A kind of line.

    pipe: its cross-section from diameter, wall and mass. depth, diameter [m], Hs [m]: defaults. angle: of the line at
    its top from the vertical [rad]; 0: it stands upright. laid: length on the seabed, over the depth. floats: whether
    a stretch of it is buoyant.
    """

    title: str
    pipe: Callable[[float, float | None, float | None], CrossSection]
    depth: float
    diameter: float
    Hs: float
    angle: float = 0.0
    laid: float = 0.0
    floats: bool = False

    @property
    def hangs(self) -> bool:
        """Whether it comes down on the seabed."""
        return self.angle > 0.0


KINDS = {
    "steel-catenary": Kind("Steel catenary riser", steel, 1000.0, 0.273, 3.0, math.radians(12.0), 0.25),
    "flexible": Kind("Free-hanging flexible riser", flexible, 100.0, 0.30, 2.0, math.radians(10.0), 0.4),
    "lazy-wave": Kind("Lazy wave", flexible, 150.0, 0.26, 4.0, math.radians(12.0), 0.3, floats=True),
    "top-tensioned": Kind("Top-tensioned riser", steel, 500.0, 0.34, 4.0),
    "mooring": Kind("Mooring line", chain, 150.0, 0.10, 4.0, math.radians(45.0), 0.8),
}


def kind_of(name: str) -> Kind:
    """The kind by its name, or SceneError."""
    if name not in KINDS:
        raise SceneError(f'new "{name}": must be one of {", ".join(KINDS)}')
    return KINDS[name]
