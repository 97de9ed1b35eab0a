"""Scene language: an end that hangs off at an angle or with a top tension, and what is solved for that."""

from typing import Literal, Self

from pydantic import BaseModel, Field, model_validator

from riser_soil.core.quantities import FROZEN, HangOffAngle, PositiveForce, wrong


class HangOff(BaseModel):
    """What an end's place, or a segment's length, is solved for, in the first static stage."""

    model_config = FROZEN

    angle: HangOffAngle | None = Field(
        default=None, description="between the riser at this end and the vertical [deg], solved to 0.01 deg"
    )
    tension: PositiveForce | None = Field(
        default=None, description="effective tension at this end [N], solved to 0.01 %; or give angle"
    )
    by: Literal["layback", "anchor", "length"] = Field(
        default="layback",
        description="what is solved for: layback (this end's horizontal distance from the other one, along the line "
        "between them in plan), anchor (the same, but the other end moves) or length (of the segment at the other end)",
    )

    @model_validator(mode="after")
    def _one_of_two(self) -> Self:
        if (self.angle is None) == (self.tension is None):
            told = "neither angle nor tension is given" if self.angle is None else "angle and tension are both given"
            raise wrong("angle", told, "give one of them: angle [deg] or tension [N]")
        return self

    @property
    def asked(self) -> float:
        """The angle [deg] or tension [N]."""
        value = self.angle if self.angle is not None else self.tension
        assert value is not None  # the validator has seen to it
        return value

    @property
    def unit(self) -> str:
        return "deg" if self.angle is not None else "N"
