"""Scene language: rigid, spring and hysteretic seabeds, and heights of the seabed over a grid from a file."""

from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Literal, Self

from pydantic import AfterValidator, BaseModel, Discriminator, Field, Tag, model_validator
from pydantic_core import PydanticCustomError

from riser_soil.core.quantities import (
    FROZEN,
    SHORTEST,
    BedStiffness,
    Coordinate,
    OneOf,
    by_kind,
)
from riser_soil.scene.columns import LENGTH, CsvColumns, read_columns
from riser_soil.scene.files import GivenByName, NamedFile, wrong_file
from riser_soil.seabed.bearing import Strength
from riser_soil.seabed.law import SeabedLaw
from riser_soil.seabed.laws import LAWS

ContactAt = Literal["axis", "outer"]


@dataclass(frozen=True)
class HeightGrid:
    """Heights z [m], (nx, ny), at increasing x and y [m], at least two of each."""

    x: tuple[float, ...]
    y: tuple[float, ...]
    z: tuple[tuple[float, ...], ...]

    def holds(self, x: float, y: float) -> bool:
        """Whether a point lies within the grid or on its edge."""
        return self.x[0] <= x <= self.x[-1] and self.y[0] <= y <= self.y[-1]

    def height(self, x: float, y: float) -> float:
        """Height z [m] at a point, bilinear between the grid's points and straight beyond."""
        (i, u), (j, v) = _between(self.x, x), _between(self.y, y)
        first, last = ((1.0 - v) * row[j] + v * row[j + 1] for row in self.z[i : i + 2])
        return (1.0 - u) * first + u * last

    @property
    def extent(self) -> str:
        """Extent of the grid, in words."""
        return f"x from {self.x[0]:g} to {self.x[-1]:g} m, y from {self.y[0]:g} to {self.y[-1]:g} m"


def _between(points: tuple[float, ...], at: float) -> tuple[int, float]:
    """Number of the point before a place, and how far the place is from there to the next one."""
    i = min(max(bisect_right(points, at) - 1, 0), len(points) - 2)
    return i, (at - points[i]) / (points[i + 1] - points[i])


def read_heights(file: Path) -> HeightGrid:
    """Read a table of x, y and z, a row for each point of a grid, in any order; PydanticCustomError, with the file and
    its line, for what is wrong."""
    columns = read_columns(file, dict.fromkeys("xyz", LENGTH), required=("x", "y", "z"))
    given = _points(columns)
    x, y = (tuple(sorted(set(columns.values[name]))) for name in "xy")
    for name, points in (("x", x), ("y", y)):
        if len(points) < 2:
            raise wrong_file(f"{file}: the points have {len(points)} different {name}; a grid needs two at least")
        if min(b - a for a, b in pairwise(points)) < SHORTEST:
            raise wrong_file(f"{file}: two {name} are nearer than {SHORTEST:g} m; round them to the same number")
    if len(given) < len(x) * len(y):
        missing = next((a, b) for a in x for b in y if (a, b) not in given)
        text = f"its {len(given)} points have {len(x)} different x and {len(y)} different y, but there is none at"
        remedy = f"a grid has a row for each x with each y: fill the {len(x) * len(y) - len(given)} gaps"
        raise wrong_file(f"{file}: {text} x = {missing[0]:.10g}, y = {missing[1]:.10g} m; {remedy}")
    return HeightGrid(x, y, tuple(tuple(given[a, b] for b in y) for a in x))


def _points(columns: CsvColumns) -> dict[tuple[float, float], float]:
    """Heights by x and y."""
    points: dict[tuple[float, float], float] = {}
    for line, *at, z in zip(columns.lines, *(columns.values[name] for name in "xyz"), strict=True):
        if (at[0], at[1]) in points:
            text = f"there is a row for x = {at[0]:.10g}, y = {at[1]:.10g} m already; remove one of the two"
            raise wrong_file(f"{columns.file}:{line}: {text}")
        points[at[0], at[1]] = z
    return points


def _runs_forward(points: tuple[tuple[float, float], ...] | None) -> tuple[tuple[float, float], ...] | None:
    if points is not None and len(points) < 2:
        text = "must have at least two points; write [[s, z], [s, z]], or give level and slope_deg"
        raise PydanticCustomError("conflict", "{text}", {"text": text})
    if any(b[0] - a[0] < SHORTEST for a, b in pairwise(points or ())):
        text = f"the distances s must increase, by {SHORTEST:g} m at least; sort the points [s, z] by s"
        raise PydanticCustomError("conflict", "{text}", {"text": text})
    return points


Level = Annotated[Coordinate, Field(description="height z of the seabed and of the soil's top face [m]")]
Toucher = Annotated[ContactAt, Field(description="what touches: the pipe's axis or its outer surface")]

Slope = Annotated[
    float,
    Field(
        strict=True,
        ge=-45.0,
        le=45.0,
        description="angle by which the seabed rises from below the riser's start towards its end [deg]; there it has "
        "the height level",
    ),
]
Profile = Annotated[
    tuple[tuple[Coordinate, Coordinate], ...] | None,
    AfterValidator(_runs_forward),
    Field(
        description="heights of the seabed along the riser's plane, [[s, z], ...]: s is the horizontal distance from "
        "the riser's start towards its end [m], z the height [m]; a smooth curve through them, straight beyond, "
        "constant across the plane; instead of level and slope_deg"
    ),
]


Azimuth = Annotated[
    float | None,
    Field(
        strict=True,
        ge=-360.0,
        le=360.0,
        description="direction in plan, from x towards y, in which slope_deg and profile run under several lines, from "
        "below the origin of coordinates on, in place of a riser's plane and start [deg]",
    ),
]


def profile_height(profile: tuple[tuple[float, float], ...], s: float) -> float:
    """Height z [m] at a distance s [m], straight between the points [s, z] and beyond them."""
    pairs = list(pairwise(profile))
    (s0, z0), (s1, z1) = next((pair for pair in pairs if s <= pair[1][0]), pairs[-1])
    return z0 + (z1 - z0) * (s - s0) / (s1 - s0)


class HeightFile(GivenByName):
    """Heights of the seabed at the points of a grid; a smooth surface goes through them."""

    model_config = FROZEN

    file: NamedFile = Field(
        description="CSV file with a header such as x [m], y [m], z [m] and a row for each point of a grid along x "
        "and y, in any order; a relative name is sought beside the scene file"
    )

    @model_validator(mode="after")
    def _can_be_read(self) -> Self:
        assert self.heights.z
        return self

    @cached_property
    def heights(self) -> HeightGrid:
        """Contents of the file."""
        return read_heights(self.file)


Grid = Annotated[
    HeightFile | None,
    Field(
        description="heights of the seabed over x and y from a CSV file: its name, or {file}; instead of level, "
        "slope_deg and profile"
    ),
]


KIND = Field(description="rigid, spring or hysteretic")


class SeabedScene(BaseModel):
    """What all seabeds have, whatever lies there: its shape, and what touches it."""

    model_config = FROZEN

    kind: Annotated[str, KIND]
    level: Level = 0.0
    slope_deg: Slope = 0.0
    profile: Profile = None
    direction_deg: Azimuth = None
    grid: Grid = None
    contact_at: Toucher = "outer"

    @property
    def undrained_strength(self) -> Strength | None:
        """Undrained shear strength of a clay seabed by depth; None of other grounds."""
        return None


class RigidSeabed(SeabedScene):
    """A rigid ground; its penalty stiffness is `contact.stiffness`."""

    kind: Annotated[Literal["rigid"], KIND]


class SpringSeabed(SeabedScene):
    """A bed of linear springs that push, never pull."""

    kind: Annotated[Literal["spring"], KIND]
    stiffness: BedStiffness = Field(description="force per length of pipe and penetration [N/m2]")


LAW = OneOf(LAWS)


class HystereticSeabed(SeabedScene):
    """A bed of hysteretic clay: it resists penetration, holds the pipe by suction, and softens."""

    kind: Annotated[Literal["hysteretic"], KIND]
    law: Annotated[SeabedLaw, LAW] = Field(description=LAW.examples)

    @property
    def undrained_strength(self) -> Strength | None:
        return self.law.undrained_strength


Seabed = Annotated[
    Annotated[RigidSeabed, Tag("<RigidSeabed>")]
    | Annotated[SpringSeabed, Tag("<SpringSeabed>")]
    | Annotated[HystereticSeabed, Tag("<HystereticSeabed>")],
    Discriminator(
        by_kind({"rigid": RigidSeabed, "spring": SpringSeabed, "hysteretic": HystereticSeabed}),
        custom_error_type="kind",
        custom_error_message="rigid, spring, hysteretic",
    ),
]
