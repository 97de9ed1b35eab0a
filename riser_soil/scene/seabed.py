"""Seabeds that stand in for a continuum."""

from itertools import pairwise
from typing import Annotated, Literal

from pydantic import AfterValidator, BaseModel, Discriminator, Field, Tag
from pydantic_core import PydanticCustomError

from riser_soil.scene.quantities import FROZEN, Positive, Real, by_kind

ContactAt = Literal["axis", "outer"]


def _runs_forward(points: tuple[tuple[float, float], ...] | None) -> tuple[tuple[float, float], ...] | None:
    if points is not None and len(points) < 2:
        text = "must have at least two points; write [[s, z], [s, z]], or give level and slope_deg"
        raise PydanticCustomError("conflict", "{text}", {"text": text})
    if any(b[0] <= a[0] for a, b in pairwise(points or ())):
        text = "the distances s must increase; sort the points [s, z] by s"
        raise PydanticCustomError("conflict", "{text}", {"text": text})
    return points


Level = Annotated[Real, Field(description="height z of the seabed and of the soil's top face [m]")]
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
    tuple[tuple[Real, Real], ...] | None,
    AfterValidator(_runs_forward),
    Field(
        description="heights of the seabed along the riser's plane, [[s, z], ...]: s is the horizontal distance from "
        "the riser's start towards its end [m], z the height [m]; a smooth curve through them, straight beyond, "
        "constant across the plane; instead of level and slope_deg"
    ),
]


class RigidSeabed(BaseModel):
    """A rigid ground; its penalty stiffness is `contact.stiffness`."""

    model_config = FROZEN

    kind: Literal["rigid"] = Field(description="rigid or spring")
    level: Level = 0.0
    slope_deg: Slope = 0.0
    profile: Profile = None
    contact_at: Toucher = "outer"


class SpringSeabed(BaseModel):
    """A bed of linear springs that push, never pull."""

    model_config = FROZEN

    kind: Literal["spring"] = Field(description="rigid or spring")
    level: Level = 0.0
    slope_deg: Slope = 0.0
    profile: Profile = None
    contact_at: Toucher = "outer"
    stiffness: Positive = Field(description="force per length of pipe and penetration [N/m2]")


Seabed = Annotated[
    Annotated[RigidSeabed, Tag("<RigidSeabed>")] | Annotated[SpringSeabed, Tag("<SpringSeabed>")],
    Discriminator(
        by_kind({"rigid": RigidSeabed, "spring": SpringSeabed}),
        custom_error_type="kind",
        custom_error_message="rigid, spring",
    ),
]
