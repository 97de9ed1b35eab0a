"""Scene language: contact of the riser with seabed and soil, friction and suction."""

from typing import Literal, Self

from pydantic import BaseModel, Field, model_validator

from riser_soil.core.quantities import (
    FROZEN,
    AutoOrBedStiffness,
    AutoOrLength,
    AutoOrLengthOrNone,
    Length,
    Part,
    PositiveWeightPerLength,
    Ratio,
    wrong,
)


class Friction(BaseModel):
    """Friction on the seabed, and on the soil where the pipe's surface touches it: no larger than the coefficients
    times the pressure, nor than the adhesion.
    """

    model_config = FROZEN

    axial: Ratio | None = Field(
        default=None,
        description="friction coefficient along the pipe [-]; by default, with adhesion, ten times the adhesion",
    )
    lateral: Ratio | None = Field(
        default=None, description="friction coefficient across the pipe [-]; that along it by default"
    )
    adhesion: Part | None = Field(
        default=None,
        description="largest friction over the undrained shear strength su of undisturbed clay where it touches [-], 1 "
        "for a fully rough pipe; without such a limit by default, and on ground without su",
    )
    mobilisation: AutoOrLength = Field(
        default="auto",
        description="slide after which friction is fully mobilised under the pipe's submerged weight [m], or auto: "
        "1/30 of the outer diameter",
    )

    @model_validator(mode="after")
    def _has_a_limit(self) -> Self:
        if self.axial is None and self.adhesion is None:
            raise wrong("axial", "the key is required here", "add axial, adhesion or both")
        if self.axial is None and self.lateral is not None:
            raise wrong("lateral", "is given without axial", "give axial, too")
        return self


class Suction(BaseModel):
    """Tension of the ground on a pipe that lifts; once broken it is gone until the pipe touches again."""

    model_config = FROZEN

    cap: PositiveWeightPerLength = Field(
        description="greatest tension per length of pipe [N/m]; on soil spread over what has touched of the "
        "outer diameter",
    )
    reach: Length = Field(description="opening over which it breaks away [m]; more than cap/stiffness")


class Contact(BaseModel):
    """Penalty contact."""

    model_config = FROZEN

    method: Literal["auto", "line", "node", "surface"] = Field(
        default="auto",
        description="where contact is evaluated: node, at the riser's nodes; or else on soil all over its surface, "
        "with the pipe's cylinder (surface), and on a seabed along the elements (line), at five Gauss points each",
    )
    stiffness: AutoOrBedStiffness = Field(
        default="auto",
        description="force per length of pipe and penetration [N/m2], or auto: the larger of 10 times the "
        "soil's Young's modulus at the surface, 20 times on its surface, and (submerged weight)/(0.001 outer "
        "diameter); a spring seabed has its own. On the soil's surface it is spread over the width by which the pipe "
        "touches elastic soil under its weight",
    )
    smoothing: AutoOrLengthOrNone = Field(
        default="auto",
        description="contact sets in smoothly between this gap and this penetration [m], or auto: 1/300 of the outer "
        "diameter at nodes on soil, 0 on its surface; on a seabed what the riser sinks in by its weight, within "
        "1/3000 and 1/300 of the diameter",
    )
    friction: Friction | None = Field(default=None, description="friction on seabed and soil; none by default")
    suction: Suction | None = Field(
        default=None,
        description="suction of a rigid or spring seabed and of soil; none by default, a hysteretic one has its own",
    )

    @property
    def at_nodes(self) -> bool:
        """Whether the riser touches at its nodes only."""
        return self.method == "node"
