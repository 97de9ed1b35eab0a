"""Scene language: features of a soil block's top along the riser, a trench or the groove of an embedded pipe."""

import math
from typing import Annotated, Self

from pydantic import BaseModel, Field, model_validator

from riser_soil.core.quantities import FROZEN, SHORTEST, Interval, Length, Positive, wrong

Steepness = Annotated[Positive, Field(le=80.0)]
Embedment = Annotated[Positive, Field(le=0.5)]


class Trench(BaseModel):
    """A trench under the riser with a level floor and sloping sides and ends."""

    model_config = FROZEN

    depth: Length = Field(description="depth of the floor below the seabed [m]")
    width: Length = Field(description="width of the floor [m], half on either side of the riser's line")
    side_slope_deg: Steepness = Field(default=30.0, description="steepness of the sides from the horizontal [deg]")
    along: Interval | None = Field(
        default=None,
        description="where the floor begins and ends, [from, to], as x, or y of a riser along y [m]; by default the "
        "trench passes through the whole block",
    )
    run_out: Length | None = Field(
        default=None, description="horizontal length of the ramps at its ends [m]; by default as steep as the sides"
    )

    @model_validator(mode="after")
    def _has_a_length(self) -> Self:
        if self.along is not None and self.along[1] - self.along[0] < SHORTEST:
            raise wrong("along", "the first bound must be smaller than the second", "write [from, to] in metres")
        if self.along is None and self.run_out is not None:
            raise wrong("run_out", "the trench passes through the whole block", "give along too, or leave it out")
        return self

    @property
    def side(self) -> float:
        """Horizontal length of a side [m]."""
        return self.depth / math.tan(math.radians(self.side_slope_deg))

    @property
    def half_width(self) -> float:
        """Half of its width at the seabed [m]."""
        return 0.5 * self.width + self.side

    def height(self, along: float, across: float, diameter: float) -> float:
        """Height z over the seabed [m], <= 0, at a place along the riser's axis and across from its line [m]."""
        first, last = self.along or (-math.inf, math.inf)
        ramp = self.run_out or self.side
        beyond = max((abs(across) - 0.5 * self.width) / self.side, (first - along) / ramp, (along - last) / ramp, 0.0)
        return -self.depth * max(0.0, 1.0 - beyond)


class Groove(BaseModel):
    """The groove of a pipe that lies embedded, along the whole block: the soil has the pipe's shape."""

    model_config = FROZEN

    embedment: Embedment = Field(description="depth of the pipe's underside over its diameter, w/D, at most 0.5 [-]")
    diameter: Length | None = Field(default=None, description="the pipe's diameter [m]; by default the riser's largest")

    def height(self, along: float, across: float, diameter: float) -> float:
        """Height z over the seabed [m], <= 0, across from the line of a riser of this diameter [m]."""
        D = self.diameter or diameter
        R, axis = 0.5 * D, (0.5 - self.embedment) * D
        return min(0.0, axis - math.sqrt(R * R - across * across)) if abs(across) < R else 0.0


SeabedFeature = Trench | Groove
