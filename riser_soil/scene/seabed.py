"""Scene language: rigid, spring and hysteretic seabeds."""

from functools import cached_property
from itertools import pairwise
from typing import Annotated, Literal, Self

from pydantic import AfterValidator, BaseModel, Discriminator, Field, Tag, model_validator
from pydantic_core import PydanticCustomError

from riser_soil.core.kinds import OneOf
from riser_soil.core.quantities import (
    FROZEN,
    SHORTEST,
    BedStiffness,
    Coordinate,
    by_kind,
)
from riser_soil.scene.files import GivenByName, NamedFile
from riser_soil.scene.height_grid import HeightGrid, read_heights
from riser_soil.seabed.bearing import Strength
from riser_soil.seabed.law import SeabedLaw
from riser_soil.seabed.laws import LAWS

ContactAt = Literal["axis", "outer"]


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
        """What the file holds."""
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
    grid: Grid = None
    contact_at: Toucher = "outer"

    @property
    def undrained_strength(self) -> Strength | None:
        """Of clay, by depth; None of other ground."""
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
