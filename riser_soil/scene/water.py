"""Scene language: the water around the riser, its surface, current and waves."""

from itertools import pairwise
from typing import Annotated, Any, Literal, Self

from pydantic import AfterValidator, BaseModel, Field, model_validator
from pydantic_core import PydanticCustomError

from riser_soil.core.quantities import (
    FROZEN,
    NEAREST,
    SHORTEST,
    Coordinate,
    Density,
    Instant,
    KinematicViscosity,
    Length,
    LengthOrNone,
    TimeOrNone,
    Velocity,
    wrong,
)
from riser_soil.scene.wave_kinds import Airy, GivenSpectrum, Jonswap, PiersonMoskowitz, Record, Regular, WaveKind

KINDS = ("airy", "jonswap", "pierson_moskowitz", "spectrum", "record")
ALONE = ("regular", "trains")
_MOST_TRAINS = 10
_AIRY = "a regular linear wave: height, period, direction_deg, phase_deg"
_REGULAR = "a regular wave of finite height: height, period, theory, direction_deg, phase_deg"
_JONSWAP = "an irregular sea: Hs, Tp, gamma, seed, components, direction_deg, spreading"
_PIERSON_MOSKOWITZ = "an irregular, fully developed sea: as jonswap, without gamma"
_SPECTRUM = "an irregular sea with the spectrum in a file: file, seed, components, direction_deg, spreading"
_RECORD = "a sea that repeats a record of the surface: file, position, direction_deg, shortest_period, longest_period"


def _rising(points: tuple[tuple[float, float, float], ...] | None) -> tuple[tuple[float, float, float], ...] | None:
    if any(b[0] - a[0] < SHORTEST for a, b in pairwise(points or ())):
        text = f"the heights z must increase, by {SHORTEST:g} m at least; sort the points [z, ...] by z"
        raise PydanticCustomError("conflict", "{text}", {"text": text})
    return points


Profile = Annotated[
    tuple[tuple[Coordinate, Velocity, Velocity], ...],
    AfterValidator(_rising),
    Field(
        min_length=1,
        description="velocity by height, [[z, ux, uy], ...] [m, m/s, m/s], z increasing; linear between the heights, "
        "constant beyond",
    ),
]


MarineGrowth = Annotated[
    tuple[tuple[Coordinate, LengthOrNone, Density], ...],
    AfterValidator(_rising),
    Field(min_length=1),
]


class CurrentAtTime(BaseModel):
    """A current at a time."""

    model_config = FROZEN

    time: Instant = Field(description="time on the clock of the waves, from the first dynamic stage on [s]")
    profile: Profile


class Current(BaseModel):
    """A horizontal current by height, steady or changing in time."""

    model_config = FROZEN

    profile: Profile | None = Field(default=None, description="of a steady current: velocity by height")
    history: Annotated[tuple[CurrentAtTime, ...], Field(min_length=2)] | None = Field(
        default=None,
        description="in place of profile: a current that changes in time, [{time, profile}, ...], a cubic spline in "
        "time, level at its ends and beyond",
    )

    @model_validator(mode="after")
    def _one_of_both(self) -> Self:
        if (self.profile is None) == (self.history is None):
            what = "profile is missing" if self.profile is None else "profile and history are both given"
            raise wrong("profile", what, "give profile: [[z, ux, uy], ...], or a history of profiles in its place")
        if any(b.time - a.time < NEAREST for a, b in pairwise(self.history or ())):
            raise wrong("history", f"times must increase, by {NEAREST:g} s at least", "sort the profiles by time")
        return self

    @property
    def each(self) -> tuple[tuple[tuple[str | int, ...], tuple[tuple[float, float, float], ...]], ...]:
        """All profiles, each with its path."""
        if self.profile is not None:
            return ((("profile",), self.profile),)
        return tuple((("history", n, "profile"), each.profile) for n, each in enumerate(self.history or ()))


class Train(BaseModel):
    """One of several wave trains: waves of one kind."""

    model_config = FROZEN

    airy: Airy | None = Field(default=None, description=_AIRY)
    jonswap: Jonswap | None = Field(default=None, description=_JONSWAP)
    pierson_moskowitz: PiersonMoskowitz | None = Field(default=None, description=_PIERSON_MOSKOWITZ)
    spectrum: GivenSpectrum | None = Field(default=None, description=_SPECTRUM)
    record: Record | None = Field(default=None, description=_RECORD)

    @model_validator(mode="after")
    def _one_kind(self) -> Self:
        _only_one({kind: getattr(self, kind) for kind in KINDS}, "leave out one of the two")
        return self


class Waves(BaseModel):
    """Linear waves, regular or irregular, or the sum of several trains of them, or a regular wave of finite height.

    They act in dynamic stages.
    """

    model_config = FROZEN

    airy: Airy | None = Field(default=None, description=_AIRY)
    jonswap: Jonswap | None = Field(default=None, description=_JONSWAP)
    pierson_moskowitz: PiersonMoskowitz | None = Field(default=None, description=_PIERSON_MOSKOWITZ)
    spectrum: GivenSpectrum | None = Field(default=None, description=_SPECTRUM)
    record: Record | None = Field(default=None, description=_RECORD)
    regular: Regular | None = Field(default=None, description=_REGULAR)
    trains: Annotated[tuple[Train, ...], Field(min_length=2, max_length=_MOST_TRAINS)] | None = Field(
        default=None, description="several trains that add up, as swell and wind sea, [{jonswap: ...}, ...]"
    )
    stretching: Literal["wheeler", "vertical"] | None = Field(
        default=None,
        description="motion of linear waves up to the surface: wheeler (heights are stretched with the surface, the "
        "default) or vertical (above the mean level as at that level)",
    )
    ramp: TimeOrNone = Field(
        default=0.0,
        description="time over which the waves grow smoothly from nothing, in the first dynamic stage and anew in one "
        "after a static stage [s]; by default one (peak) period",
    )

    @model_validator(mode="before")
    @classmethod
    def _no_ramp_is_none(cls, data: Any) -> Any:
        if isinstance(data, dict) and data.get("ramp", 0.0) is None:
            return {key: value for key, value in data.items() if key != "ramp"}
        return data

    @model_validator(mode="after")
    def _one_kind(self) -> Self:
        _only_one({kind: getattr(self, kind) for kind in (*KINDS, *ALONE)}, "leave out one of the two")
        if self.regular is not None and self.stretching is not None:
            raise wrong("stretching", "a wave of finite height knows the motion up to its surface", "leave it out")
        return self

    @model_validator(mode="after")
    def _grow_over_a_period(self) -> Self:
        return self if "ramp" in self.model_fields_set else self.model_copy(update={"ramp": self.period})

    @property
    def each(self) -> tuple[tuple[tuple[str | int, ...], WaveKind], ...]:
        """All trains, each with its path."""
        if self.regular is not None:
            return ((("regular",), self.regular),)
        trains = {(): self} if self.trains is None else {("trains", n): train for n, train in enumerate(self.trains)}
        kinds = (((*path, kind), getattr(train, kind)) for path, train in trains.items() for kind in KINDS)
        return tuple((path, given) for path, given in kinds if given is not None)

    @property
    def period(self) -> float:
        """Longest period of the trains, of an irregular one that of its peak [s]."""
        return max(train.period for _, train in self.each)

    @property
    def toward(self) -> tuple[float, ...]:
        """All directions towards which waves travel, from x towards y [rad]."""
        return tuple(dict.fromkeys(angle for _, train in self.each for angle in train.toward))

    @property
    def count(self) -> int:
        """Number of linear waves."""
        return sum(train.count for _, train in self.each)


def _only_one(given: dict[str, Any], remedy: str) -> None:
    """One of several keys must be given."""
    first, *others = [key for key, value in given.items() if value is not None] or [""]
    if not first:
        raise wrong("airy", "no wave is given", "give airy: {height, period} or jonswap: {Hs, Tp}")
    if others:
        raise wrong(others[0], f"{first} and {others[0]} are both given", remedy)


class Water(BaseModel):
    """The water; still and without a surface unless it is given more."""

    model_config = FROZEN

    density: Density = Field(default=1025.0, description="density of the water [kg/m3]")
    kinematic_viscosity: KinematicViscosity = Field(
        default=1.19e-6, description="for Reynolds's numbers [m2/s]; by default of sea water at 15 degrees Celsius"
    )
    surface_level: Coordinate | None = Field(
        default=None, description="height z of the mean surface [m]; without it everything is submerged"
    )
    depth: Length | None = Field(
        default=None,
        description="depth for the waves [m]; by default down to the seabed, or deep water in a scene without one",
    )
    current: Current | None = Field(
        default=None, description="current, {profile: [[z, ux, uy], ...]} or {history: [...]}; none by default"
    )
    marine_growth: MarineGrowth | None = Field(
        default=None,
        description="growth on the riser by height, [[z, thickness, density], ...] [m, m, kg/m3], z increasing; linear "
        "between the heights, constant beyond; none by default",
    )
    waves: Waves | None = Field(
        default=None, description="waves, {airy: ...}, {jonswap: ...} or another kind; none by default"
    )

    @model_validator(mode="after")
    def _waves_on_a_surface(self) -> Self:
        if self.waves is not None and self.surface_level is None:
            raise wrong("surface_level", "waves need a surface", "give the height z of the mean surface [m]")
        return self
