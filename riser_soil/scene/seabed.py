"""Seabeds that stand in for a continuum."""

from typing import Annotated, Literal

from pydantic import BaseModel, Discriminator, Field, Tag

from riser_soil.scene.quantities import FROZEN, Positive, Real, by_kind

ContactAt = Literal["axis", "outer"]

Level = Annotated[Real, Field(description="height z of the seabed and of the soil's top face [m]")]
Toucher = Annotated[ContactAt, Field(description="what touches: the pipe's axis or its outer surface")]


class RigidSeabed(BaseModel):
    """A level rigid plane; its penalty stiffness is `contact.stiffness`."""

    model_config = FROZEN

    kind: Literal["rigid"] = Field(description="rigid or spring")
    level: Level = 0.0
    contact_at: Toucher = "outer"


class SpringSeabed(BaseModel):
    """A level bed of linear springs that push, never pull."""

    model_config = FROZEN

    kind: Literal["spring"] = Field(description="rigid or spring")
    level: Level = 0.0
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
