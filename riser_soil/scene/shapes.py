"""Scene language: unstressed and initial shape of the riser, and an end that hangs off at an angle or a tension."""

import math
from itertools import pairwise
from typing import Annotated, Literal, Self

from pydantic import BaseModel, Discriminator, Field, Tag, model_validator

from riser_soil.core.quantities import (
    FLATTEST,
    FROZEN,
    SHORTEST,
    Angle,
    Axis,
    HangOffAngle,
    Position,
    PositiveForce,
    by_key,
    word_or,
    wrong,
)


class PointsShape(BaseModel):
    """A curve through given points; distances along it are scaled to the length of the segments."""

    model_config = FROZEN

    points: tuple[Position, ...] = Field(
        min_length=2, description="points from start to end, [[x, y, z], ...] [m]"
    )

    @model_validator(mode="after")
    def _goes_on(self) -> Self:
        if any(math.dist(a, b) < SHORTEST for a, b in pairwise(self.points)):
            raise wrong("points", f"two points in a row must not coincide ({SHORTEST:g} m)", "remove one of the two")
        return self


class CircularArc(BaseModel):
    """An arc of a circle about an axis."""

    model_config = FROZEN

    centre: Position = Field(description="a point on the circle's axis, [x, y, z] [m]")
    from_point: Position = Field(alias="from", description="where the riser starts, [x, y, z] [m]")
    angle_deg: Angle = Field(description="angle from start to end, right-handed about the axis [deg]")
    axis: Axis = Field(
        default=(0.0, 0.0, 1.0), description="direction of the circle's axis, of any length [-]"
    )

    @model_validator(mode="after")
    def _is_an_arc(self) -> Self:
        if math.hypot(*self.axis) < FLATTEST:
            raise wrong("axis", "must not be the zero vector", "give the direction about which the arc turns")
        if self.radius < SHORTEST:
            raise wrong("from", "must not lie on the circle's axis", "move `from` or `centre`")
        if self.angle_deg == 0.0:
            raise wrong("angle_deg", "must not be zero", "use `unstressed: straight` for a straight riser")
        return self

    @property
    def radius(self) -> float:
        """Distance of the arc from the circle's axis [m]."""
        arm = [f - c for f, c in zip(self.from_point, self.centre, strict=True)]
        size = math.hypot(*self.axis)
        along = sum(r * a for r, a in zip(arm, self.axis, strict=True)) / size
        return math.hypot(*[r - along * a / size for r, a in zip(arm, self.axis, strict=True)])

    @property
    def length(self) -> float:
        """Length of the arc [m]."""
        return self.radius * math.radians(abs(self.angle_deg))


class ArcShape(BaseModel):
    """A circular riser."""

    model_config = FROZEN

    arc: CircularArc = Field(description="the circle's centre, the first point, the angle and the axis")


Unstressed = Annotated[
    Annotated[Literal["straight"], Tag("<word>")]
    | Annotated[PointsShape, Tag("<PointsShape>")]
    | Annotated[ArcShape, Tag("<ArcShape>")],
    Discriminator(
        by_key({"points": PointsShape, "arc": ArcShape}),
        custom_error_type="choice",
        custom_error_message="must be straight, {points: [[x, y, z], ...]} or {arc: {...}}",
    ),
]

Initial = Annotated[
    Annotated[Literal["straight", "catenary", "unstressed"], Tag("<word>")]
    | Annotated[PointsShape, Tag("<PointsShape>")],
    Discriminator(
        word_or(PointsShape),
        custom_error_type="choice",
        custom_error_message="must be straight, catenary, unstressed or {points: [[x, y, z], ...]}",
    ),
]


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
            problem = (
                "neither angle nor tension is given" if self.angle is None else "angle and tension are both given"
            )
            raise wrong("angle", problem, "give one of them: angle [deg] or tension [N]")
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
