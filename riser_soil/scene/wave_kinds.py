"""Scene language: kinds of waves, regular, irregular by a spectrum, and by a record of the surface."""

import math
from bisect import bisect_left
from functools import cache, cached_property
from itertools import accumulate, pairwise
from typing import Annotated, Literal, Self

from pydantic import BaseModel, Field, model_validator

from riser_soil.core.quantities import FROZEN, Angle, Coordinate, Count, Length, Real, Time, wrong
from riser_soil.scene.files import NamedFile
from riser_soil.scene.wave_files import ElevationRecord, SpectrumTable, read_elevation, read_spectrum

# A sea of more components is no better, and each costs time at every point in every iteration.
MOST_COMPONENTS = 10000
_MOST_DIRECTIONS = 36

Seed = Annotated[int, Field(strict=True, ge=0)]
Components = Annotated[Count, Field(le=MOST_COMPONENTS)]
_TOWARD = "direction towards which it travels, from x towards y [deg]"
_STEPS = 4096  # steps over the half circle, by the trapezoidal rule


class Spreading(BaseModel):
    """Directional spreading: the energy goes with cos^2s of half the angle from the mean direction."""

    model_config = FROZEN

    s: Annotated[Real, Field(ge=0.5, le=200.0)] = Field(
        description="exponent: wind seas have 5 to 15, swell 25 and more [-]"
    )
    directions: Annotated[Count, Field(ge=2, le=_MOST_DIRECTIONS, multiple_of=2)] = Field(
        default=10, description="even number of directions, of equal energy; ten cost six times as much as one [-]"
    )

    @property
    def relative(self) -> tuple[float, ...]:
        """The directions from the mean [rad]."""
        return relative_directions(self.s, self.directions)


class OneWave(BaseModel):
    """What regular waves have; the crest is at x = y = 0 as their clock starts, unless phase_deg says else."""

    model_config = FROZEN

    height: Length = Field(description="height from trough to crest [m]")
    period: Time = Field(description="period [s]")
    direction_deg: Angle = Field(default=0.0, description=_TOWARD)
    phase_deg: Angle = Field(
        default=0.0, description="phase of the crest at x = y = 0 as the waves' clock starts [deg]"
    )

    @property
    def count(self) -> int:
        """Number of linear waves."""
        return 1

    @property
    def toward(self) -> tuple[float, ...]:
        """Directions [rad]."""
        return (math.radians(self.direction_deg),)


class Airy(OneWave):
    """A regular linear wave."""


class Regular(OneWave):
    """A regular wave of finite height, which runs without changing shape."""

    theory: Literal["auto", "stokes", "stream-function"] = Field(
        default="auto",
        description="stokes (of fifth order), stream-function, or auto: by height, period and depth, linear where that "
        "will do",
    )


class DrawnSea(BaseModel):
    """What irregular seas have that are drawn from a spectrum."""

    model_config = FROZEN

    seed: Seed = Field(
        default=1, description="which of all seas with this spectrum; the same seed gives the same sea [-]"
    )
    components: Components = Field(default=100, description="number of linear waves that make up the sea [-]")
    direction_deg: Angle = Field(default=0.0, description=_TOWARD)
    spreading: Spreading | None = Field(
        default=None, description="spreading about direction_deg, {s, directions}; long-crested by default"
    )

    @model_validator(mode="after")
    def _as_many_in_each_direction(self) -> Self:
        if self.spreading is not None and self.components % (count := self.spreading.directions):
            allowed = f"must be a multiple of spreading.directions, {count}, for an equal energy of all"
            raise wrong("components", allowed, "change one of the two")
        return self

    @property
    def count(self) -> int:
        """Number of linear waves."""
        return self.components

    @property
    def toward(self) -> tuple[float, ...]:
        """Directions [rad]."""
        relative = (0.0,) if self.spreading is None else self.spreading.relative
        return tuple(math.radians(self.direction_deg) + angle for angle in relative)


class PeakedSea(DrawnSea):
    """What irregular seas have whose spectrum is told by its height and peak."""

    Hs: Length = Field(description="significant wave height [m]")
    Tp: Time = Field(description="period of the spectrum's peak [s]")

    @property
    def height(self) -> float:
        """Significant height [m]."""
        return self.Hs

    @property
    def period(self) -> float:
        """Period of the spectrum's peak [s]."""
        return self.Tp


class Jonswap(PeakedSea):
    """An irregular sea with a JONSWAP spectrum."""

    gamma: Annotated[Real, Field(ge=1.0, le=7.0)] = Field(default=3.3, description="peak enhancement factor [-]")


class PiersonMoskowitz(PeakedSea):
    """An irregular, fully developed sea with a Pierson-Moskowitz spectrum."""


class GivenSpectrum(DrawnSea):
    """An irregular sea with a spectrum from a file, linear between its rows, nothing beyond them; of netCDF with its
    own directions.
    """

    file: NamedFile = Field(
        description="CSV file with the columns frequency [Hz] (or rad/s) and density [m2/Hz] (or m2 s/rad), or netCDF "
        "(.nc) with freq, dir and efth, as wavespectra writes it; a relative name is sought beside the scene file"
    )
    at: dict[str, Count | Literal[0]] = Field(
        default_factory=dict, description="which sea of a netCDF file that has several, {time: 12}, counted from 0"
    )
    north_deg: Angle = Field(
        default=90.0, description="direction of north, from x towards y, for a file's directions [deg]"
    )

    @model_validator(mode="after")
    def _can_be_read(self) -> Self:
        given = [key for key in ("direction_deg", "spreading") if getattr(self, key)]  # 0 and none are written, too
        if self.table.toward and given:
            raise wrong(given[0], "the file has directions of its own", "leave the key out")
        return self

    @cached_property
    def table(self) -> SpectrumTable:
        """Contents of the file."""
        return read_spectrum(self.file, self.at, math.radians(self.north_deg))

    @property
    def toward(self) -> tuple[float, ...]:
        """Directions [rad]."""
        return self.table.toward or super().toward

    @property
    def height(self) -> float:
        """Significant height, four standard deviations [m]."""
        return 4.0 * math.sqrt(self.table.energy)

    @property
    def period(self) -> float:
        """Period of the spectrum's peak [s]."""
        return 2.0 * math.pi / self.table.peak


class Record(BaseModel):
    """A long-crested sea by a record of the surface's elevation, which it repeats at one place."""

    model_config = FROZEN

    file: NamedFile = Field(
        description="CSV file with the columns t [s] (or min, ms), at even steps, and elevation [m] (or mm, cm, ft); a "
        "relative name is sought beside the scene file"
    )
    position: tuple[Coordinate, Coordinate] = Field(
        default=(0.0, 0.0), description="x and y of the place where it was recorded [m]"
    )
    direction_deg: Angle = Field(default=0.0, description=_TOWARD)
    shortest_period: Time | None = Field(
        default=None, description="shorter waves are filtered out [s]; by default those of two rows and less"
    )
    longest_period: Time | None = Field(
        default=None, description="longer waves are filtered out [s]; by default none but the mean"
    )

    @model_validator(mode="after")
    def _can_be_read(self) -> Self:
        if not 1 <= self.count <= MOST_COMPONENTS:
            what = f"{self.file}: {self.count} waves lie between the shortest and the longest period"
            allowed = f"1 to {MOST_COMPONENTS} are allowed"
            raise wrong("shortest_period", f"{what}; {allowed}", "change the periods, or cut the record")
        return self

    @cached_property
    def record(self) -> ElevationRecord:
        """Contents of the file."""
        return read_elevation(self.file)

    @property
    def harmonics(self) -> range:
        """Numbers of the waves: how many periods each has in the record."""
        whole, rows = self.record.duration, len(self.record.elevation)
        most = math.floor(whole / self.shortest_period * (1.0 + 1e-9)) if self.shortest_period else rows
        least = math.ceil(whole / self.longest_period * (1.0 - 1e-9)) if self.longest_period else 1
        return range(max(1, least), min(most, (rows - 1) // 2) + 1)

    @cached_property
    def waves(self) -> ElevationRecord:
        """The record without what is left out of it."""
        return self.record.of_waves(self.harmonics)

    @property
    def height(self) -> float:
        """Significant height, four standard deviations [m]."""
        return self.waves.significant_height

    @property
    def period(self) -> float:
        """Mean time between crossings of the mean, upwards [s]."""
        return self.waves.mean_period

    @property
    def count(self) -> int:
        """Number of linear waves."""
        return len(self.harmonics)

    @property
    def toward(self) -> tuple[float, ...]:
        """Directions [rad]."""
        return (math.radians(self.direction_deg),)


WaveKind = Airy | Regular | Jonswap | PiersonMoskowitz | GivenSpectrum | Record


@cache
def relative_directions(s: float, count: int) -> tuple[float, ...]:
    """Directions (count,), an even number of them, from the mean [rad], increasing: one for each of `count` sectors of
    equal energy, its cosine being the mean of the sector's.

    The energy in a direction goes with cos^2s(theta/2) (Mitsuyasu et al., Journal of Physical Oceanography 5 (1975)
    750-760, equation 6). So the mean of cos theta is s/(s + 1), and that of sin theta is 0, as over all directions.
    """
    edges = [_within(s, 2.0 * n / count) for n in range(count // 2 + 1)]
    to_one_side = [math.acos((c1 - c0) / (e1 - e0)) for (e0, c0), (e1, c1) in pairwise(edges)]
    return (*(-angle for angle in reversed(to_one_side)), *to_one_side)


def _within(s: float, share: float) -> tuple[float, float]:
    """Energy, and its moment with cos theta, from the mean to the angle within which a share (0 to 1) of it lies."""
    energy, moment = _integrals(s)
    n = bisect_left(energy, share * energy[-1], 1, _STEPS)
    part = (share * energy[-1] - energy[n - 1]) / (energy[n] - energy[n - 1])
    return share * energy[-1], moment[n - 1] + part * (moment[n] - moment[n - 1])


@cache
def _integrals(s: float) -> tuple[list[float], list[float]]:
    """Integrals from 0 to each angle of an even grid to pi: of the energy, of any size, and of its moment with cos
    theta.
    """
    angles = [math.pi * n / _STEPS for n in range(_STEPS + 1)]
    density = [math.cos(0.5 * angle) ** (2.0 * s) for angle in angles]
    moment = [d * math.cos(angle) for d, angle in zip(density, angles, strict=True)]
    energy, first = (list(accumulate((0.5 * (a + b) for a, b in pairwise(q)), initial=0.0)) for q in (density, moment))
    return energy, first
