"""Scene language: joints between ends and arcs of lines, and points of bodies."""

from typing import Annotated, Literal, Self

from pydantic import BaseModel, Field, model_validator

from riser_soil.core.quantities import FROZEN, Bounds, Position, Positive, RotationalStiffness, Text, Vector, wrong
from riser_soil.scene.stages import Place

JointStiffness = Annotated[Positive, Bounds(1e-30, 1e36, "N/m")]


class JointPoint(BaseModel):
    """A point of a line or of a body."""

    model_config = FROZEN

    line: Text | None = Field(default=None, description="name of a line; or give body")
    at: Place | None = Field(
        default=None, description="start, end or arc length of the line [m], where it gets a node"
    )
    body: Text | None = Field(default=None, description="name of a body; or give line and at")
    offset: Position = Field(default=(0.0, 0.0, 0.0), description="place on a rigid body, in its axes [m]")

    @model_validator(mode="after")
    def _of_one(self) -> Self:
        if (self.line is None) == (self.body is None):
            raise wrong("line", "a point is one of a line or of a body", "give line and at, or body")
        if (self.line is None) != (self.at is None):
            raise wrong("at", "the place along a line belongs to line", "give both line and at, or body alone")
        if self.line is not None and any(self.offset):
            raise wrong("offset", "is a place on a rigid body", "leave it out")
        return self


class SprungStiffness(BaseModel):
    """The stiffness of a joint that gives."""

    model_config = FROZEN

    translation: JointStiffness | None = Field(
        default=None, description="force per distance of the points [N/m]; rigid by default"
    )
    rotation: RotationalStiffness | None = Field(
        default=None, description="moment per angle from that of the first shape [N.m/rad]; free by default"
    )


class Joint(BaseModel):
    """What holds two points together."""

    model_config = FROZEN

    kind: Literal["pinned", "clamped", "sprung"] = Field(
        description="pinned: the points stay together; clamped: and so do their directions; sprung: by a stiffness"
    )
    between: tuple[JointPoint, JointPoint] = Field(description="the two points, each {line, at} or {body, offset}")
    position: Position | None = Field(
        default=None,
        description="where it is at first [m]: needed between ends of lines that have no support, and at an arc",
    )
    stiffness: SprungStiffness | None = Field(
        default=None, description="of a sprung joint, {translation: N/m, rotation: N.m/rad}"
    )
    keep_distance: Literal[True, False] = Field(
        default=False,
        description="whether the points stay as far apart as they are at first, the second on an arm that turns with "
        "the first; else they come together before the first stage",
    )

    @model_validator(mode="after")
    def _as_stiff_as_its_kind(self) -> Self:
        if self.kind == "sprung" and self.stiffness is None:
            raise wrong("stiffness", "a sprung joint lacks it", "give {translation: N/m} or {rotation: N.m/rad}")
        if self.kind != "sprung" and self.stiffness is not None:
            raise wrong("stiffness", f"a {self.kind} joint does not give", "make it sprung, or leave it out")
        return self

    def first_of(self, point: JointPoint, place: Vector) -> Vector:
        """First place of a point [m] on a body or line that begins at a place."""
        x, y, z = (a + b for a, b in zip(place, point.offset, strict=True))
        return x, y, z
