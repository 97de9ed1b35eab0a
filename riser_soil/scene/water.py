"""Scene language: the water around the riser, its surface, current and waves."""

import math
from itertools import pairwise
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, Field, model_validator

from riser_soil.core.quantities import (
    FROZEN,
    SHORTEST,
    Angle,
    Coordinate,
    Count,
    Density,
    Length,
    Real,
    Time,
    TimeOrNone,
    Velocity,
    wrong,
)

# A sea of more components is no better, and each costs time at every point in every iteration.
_MOST_COMPONENTS = 10000


class Current(BaseModel):
    """A horizontal current that is steady and changes with height only."""

    model_config = FROZEN

    profile: tuple[tuple[Coordinate, Velocity, Velocity], ...] = Field(
        min_length=1,
        description="velocity by height, [[z, ux, uy], ...] [m, m/s, m/s], z increasing; linear between the heights, "
        "constant beyond",
    )

    @model_validator(mode="after")
    def _rises(self) -> Self:
        if any(b[0] - a[0] < SHORTEST for a, b in pairwise(self.profile)):
            allowed = f"the heights z must increase, by {SHORTEST:g} m at least"
            raise wrong("profile", allowed, "sort the points [z, ux, uy] by z")
        return self


class Airy(BaseModel):
    """A regular linear wave; its crest is at x = y = 0 as its clock starts, unless phase_deg says else."""

    model_config = FROZEN

    height: Length = Field(description="height from trough to crest [m]")
    period: Time = Field(description="period [s]")
    direction_deg: Angle = Field(default=0.0, description="direction towards which it travels, from x towards y [deg]")
    phase_deg: Angle = Field(
        default=0.0, description="phase of the crest at x = y = 0 as the waves' clock starts [deg]"
    )


class Jonswap(BaseModel):
    """An irregular long-crested sea with a JONSWAP spectrum."""

    model_config = FROZEN

    Hs: Length = Field(description="significant wave height [m]")
    Tp: Time = Field(description="period of the spectrum's peak [s]")
    gamma: Annotated[Real, Field(ge=1.0, le=7.0)] = Field(default=3.3, description="peak enhancement factor [-]")
    seed: Annotated[int, Field(strict=True, ge=0)] = Field(
        default=1, description="which of all seas with this spectrum; the same seed gives the same sea [-]"
    )
    components: Annotated[Count, Field(le=_MOST_COMPONENTS)] = Field(
        default=100, description="number of linear waves that make up the sea [-]"
    )
    direction_deg: Angle = Field(default=0.0, description="direction towards which it travels, from x towards y [deg]")


class Waves(BaseModel):
    """Linear waves, regular (airy) or irregular (jonswap); they act in dynamic stages."""

    model_config = FROZEN

    airy: Airy | None = Field(default=None, description="a regular wave: height, period, direction_deg, phase_deg")
    jonswap: Jonswap | None = Field(
        default=None, description="an irregular sea: Hs, Tp, gamma, seed, components, direction_deg"
    )
    stretching: Literal["wheeler", "vertical"] = Field(
        default="wheeler",
        description="motion up to the surface: wheeler (heights are stretched with the surface) or vertical (above the "
        "mean level as at that level)",
    )
    ramp: TimeOrNone = Field(
        default=0.0,
        description="time over which the waves grow smoothly from nothing, in the first dynamic stage and anew in one "
        "after a static stage [s]; by default one (peak) period",
    )

    @model_validator(mode="before")
    @classmethod
    def _grow_over_a_period(cls, data: Any) -> Any:
        return {**data, "ramp": _period(data)} if isinstance(data, dict) and data.get("ramp") is None else data

    @model_validator(mode="after")
    def _one_kind(self) -> Self:
        if self.airy is None and self.jonswap is None:
            raise wrong("airy", "no wave is given", "give airy: {height, period} or jonswap: {Hs, Tp}")
        if self.airy is not None and self.jonswap is not None:
            raise wrong("jonswap", "airy and jonswap are both given", "leave out one of the two")
        return self

    @property
    def height(self) -> float:
        """Height of the wave, or significant height [m]."""
        return self.airy.height if self.airy else self._sea.Hs

    @property
    def period(self) -> float:
        """Period of the wave, or of the spectrum's peak [s]."""
        return self.airy.period if self.airy else self._sea.Tp

    @property
    def direction_deg(self) -> float:
        """Direction towards which they travel, from x towards y [deg]."""
        return self.airy.direction_deg if self.airy else self._sea.direction_deg

    @property
    def height_key(self) -> tuple[str, str]:
        """Where the height is given."""
        return ("airy", "height") if self.airy else ("jonswap", "Hs")

    @property
    def _sea(self) -> Jonswap:
        assert self.jonswap is not None
        return self.jonswap


def _period(waves: dict[str, Any]) -> Any:
    """What is given as the waves' period, if it is a period."""
    for kind, key in (("airy", "period"), ("jonswap", "Tp")):
        given = waves.get(kind)
        period = given.get(key) if isinstance(given, dict) else getattr(given, key, None)
        if isinstance(period, int | float) and not isinstance(period, bool) and 0.0 < period < math.inf:
            return float(period)
    return 0.0


class Water(BaseModel):
    """The water; still and without a surface unless it is given more."""

    model_config = FROZEN

    density: Density = Field(default=1025.0, description="density of the water [kg/m3]")
    surface_level: Coordinate | None = Field(
        default=None, description="height z of the mean surface [m]; without it everything is submerged"
    )
    depth: Length | None = Field(
        default=None,
        description="depth for the waves [m]; by default down to the seabed, or deep water in a scene without one",
    )
    current: Current | None = Field(default=None, description="current, {profile: [[z, ux, uy], ...]}; none by default")
    waves: Waves | None = Field(default=None, description="waves, {airy: ...} or {jonswap: ...}; none by default")

    @model_validator(mode="after")
    def _waves_on_a_surface(self) -> Self:
        if self.waves is not None and self.surface_level is None:
            raise wrong("surface_level", "waves need a surface", "give the height z of the mean surface [m]")
        return self
