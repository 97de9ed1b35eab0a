"""Scene language: contact of the riser with seabed and soil, friction and suction."""

from typing import Literal

from pydantic import BaseModel, Field

from riser_soil.core.quantities import (
    FROZEN,
    AutoOrBedStiffness,
    AutoOrLength,
    AutoOrLengthOrNone,
    Length,
    PositiveWeightPerLength,
    Ratio,
)


class Friction(BaseModel):
    """Coulomb friction on the seabed."""

    model_config = FROZEN

    axial: Ratio = Field(description="friction coefficient along the pipe [-]")
    lateral: Ratio | None = Field(
        default=None, description="friction coefficient across the pipe [-]; that along it by default"
    )
    mobilisation: AutoOrLength = Field(
        default="auto",
        description="slide after which friction is fully mobilised under the pipe's submerged weight [m], or auto: "
        "1/30 of the outer diameter",
    )


class Suction(BaseModel):
    """Tension of a penalty seabed on a pipe that lifts; once broken it is gone until the pipe touches again."""

    model_config = FROZEN

    cap: PositiveWeightPerLength = Field(description="greatest tension per length of pipe [N/m]")
    reach: Length = Field(description="opening over which it breaks away [m]; more than cap/stiffness")


class Contact(BaseModel):
    """Penalty contact."""

    model_config = FROZEN

    method: Literal["line", "node"] = Field(
        default="line",
        description="where contact with the seabed is evaluated: line (along the elements, five Gauss points each) or "
        "node (at the riser's nodes); contact with soil is evaluated at nodes",
    )
    stiffness: AutoOrBedStiffness = Field(
        default="auto",
        description="force per length of pipe and penetration [N/m2], or auto: the larger of 10 times the "
        "soil's Young's modulus at the surface and (submerged weight)/(0.001 outer diameter); a spring "
        "seabed has its own",
    )
    smoothing: AutoOrLengthOrNone = Field(
        default="auto",
        description="contact sets in smoothly between this gap and this penetration [m], or auto: 1/300 of the outer "
        "diameter on soil; on a seabed what the riser sinks in by its weight, within 1/3000 and 1/300 of the diameter",
    )
    friction: Friction | None = Field(default=None, description="friction on the seabed; none by default")
    suction: Suction | None = Field(
        default=None,
        description="suction of a rigid or spring seabed; none by default, and a hysteretic one has its own",
    )
