"""Seabeds that stand in for a continuum."""

from itertools import pairwise
from typing import Annotated, Literal

from pydantic import AfterValidator, BaseModel, Discriminator, Field, Tag
from pydantic_core import PydanticCustomError

from riser_soil.scene.quantities import (
    FROZEN,
    SHORTEST,
    BedStiffness,
    Coefficient,
    Coordinate,
    NonNegative,
    PositiveStrengthGradient,
    Ratio,
    Stress,
    UnitWeight,
    by_kind,
)

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


class RigidSeabed(BaseModel):
    """A rigid ground; its penalty stiffness is `contact.stiffness`."""

    model_config = FROZEN

    kind: Literal["rigid"] = Field(description="rigid, spring or hysteretic")
    level: Level = 0.0
    slope_deg: Slope = 0.0
    profile: Profile = None
    contact_at: Toucher = "outer"


class SpringSeabed(BaseModel):
    """A bed of linear springs that push, never pull."""

    model_config = FROZEN

    kind: Literal["spring"] = Field(description="rigid, spring or hysteretic")
    level: Level = 0.0
    slope_deg: Slope = 0.0
    profile: Profile = None
    contact_at: Toucher = "outer"
    stiffness: BedStiffness = Field(description="force per length of pipe and penetration [N/m2]")


class RandolphQuiggin(BaseModel):
    """Hysteretic law of Randolph & Quiggin (2009); `riser_soil.seabed.randolph_quiggin` tells what is certain of it."""

    model_config = FROZEN

    kind: Literal["randolph-quiggin"] = Field(description="randolph-quiggin or aubeny-biscontin")
    su: Stress = Field(description="undrained shear strength at the surface [Pa]")
    su_gradient: PositiveStrengthGradient = Field(default=0.0, description="its growth with depth [Pa/m]")
    unit_weight: UnitWeight = Field(default=0.0, description="submerged unit weight, for the soil's buoyancy [N/m3]")
    a: Ratio = Field(default=6.0, description="factor of the bearing capacity a (z/D)^b [-]")
    b: NonNegative = Field(default=0.25, lt=1.0, description="power of the bearing capacity a (z/D)^b [-]")
    K_max: Ratio = Field(default=200.0, description="greatest stiffness, over the ultimate pressure [-]")
    f_suc: NonNegative = Field(default=0.6, lt=1.0, description="suction over the ultimate resistance [-]")
    lambda_suc: Ratio = Field(default=1.0, description="decay length of suction over the greatest penetration [-]")
    lambda_rep: Coefficient = Field(default=0.3, description="softening of repenetration [-]")
    f_b: Coefficient = Field(default=1.5, description="factor of the soil's buoyancy [-]")


class AubenyBiscontin(BaseModel):
    """Hysteretic law of Aubeny & Biscontin (2009); `riser_soil.seabed.aubeny_biscontin` tells what is certain of it."""

    model_config = FROZEN

    kind: Literal["aubeny-biscontin"] = Field(description="randolph-quiggin or aubeny-biscontin")
    su: Stress = Field(description="undrained shear strength at the surface [Pa]")
    su_gradient: PositiveStrengthGradient = Field(default=0.0, description="its growth with depth [Pa/m]")
    a: Ratio = Field(default=6.73, description="factor of the backbone a (y/D)^b [-]")
    b: NonNegative = Field(default=0.29, lt=1.0, description="power of the backbone a (y/D)^b [-]")
    k_over_su: Ratio = Field(default=660.0, description="initial stiffness over the shear strength [-]")
    omega: Ratio = Field(default=0.433, description="asymptote of the rebound [-]")
    phi: NonNegative = Field(default=0.203, lt=1.0, description="suction over the resistance before the uplift [-]")
    psi: Ratio = Field(default=0.661, description="length of the separation over that of the rebound [-]")


Law = Annotated[
    Annotated[RandolphQuiggin, Tag("<RandolphQuiggin>")] | Annotated[AubenyBiscontin, Tag("<AubenyBiscontin>")],
    Discriminator(
        by_kind({"randolph-quiggin": RandolphQuiggin, "aubeny-biscontin": AubenyBiscontin}),
        custom_error_type="kind",
        custom_error_message="randolph-quiggin, aubeny-biscontin",
    ),
]


class HystereticSeabed(BaseModel):
    """A bed of clay that remembers: it resists penetration, holds the pipe by suction, and softens."""

    model_config = FROZEN

    kind: Literal["hysteretic"] = Field(description="rigid, spring or hysteretic")
    level: Level = 0.0
    slope_deg: Slope = 0.0
    profile: Profile = None
    contact_at: Toucher = "outer"
    law: Law = Field(description="{kind: randolph-quiggin, su: ...} or {kind: aubeny-biscontin, su: ...}")


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
