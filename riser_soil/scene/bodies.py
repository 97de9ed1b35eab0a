"""Scene language: bodies that lines hang on: points of three degrees of freedom, rigid bodies of six.

A further kind is a model here with `turns`, whether it has rotations, and a case of `_properties` in
`assembly/bodies_and_joints.py`.
"""

from typing import Annotated, ClassVar, Literal, Self

from pydantic import BaseModel, Field, model_validator

from riser_soil.core.quantities import (
    FROZEN,
    Area,
    Bounds,
    Coefficient,
    Length,
    LengthOrNone,
    NonNegative,
    OneOf,
    Position,
    Positive,
    Volume,
    registry,
    wrong,
)

BodyMass = Annotated[Positive, Bounds(1e-30, 1e30, "kg")]
BodyInertia = Annotated[NonNegative, Bounds(1e-42, 1e42, "kg.m2", zero=True)]
RotationalDrag = Annotated[NonNegative, Bounds(1e-60, 1e60, "m5", zero=True)]
ContactStiffness = Annotated[Positive, Bounds(1e-30, 1e36, "N/m")]
AXES = "by body axis [x, y, z]"


class BodyTouch(BaseModel):
    """How a body touches the seabed: with spheres about points fixed to it, as a pipe as long as it is wide."""

    model_config = FROZEN

    radius: LengthOrNone | None = Field(
        default=None,
        description="radius of the spheres [m], 0 for the points themselves; by default that of a sphere of its "
        "volume, where it displaces nothing the radius of the lines joined to it; 0 of points, and with contact_at: "
        "axis",
    )
    points: Annotated[tuple[Position, ...], Field(min_length=1)] | None = Field(
        default=None,
        description="of a rigid body: where it touches, in its axes [m]; by default at its centre of buoyancy",
    )
    width: Length | None = Field(
        default=None,
        description="diameter and length of the pipe as which it presses on the seabed [m], all points together; by "
        "default the diameter of a sphere of its volume, or of as much water as it has mass where it displaces nothing",
    )
    stiffness: ContactStiffness | None = Field(
        default=None,
        description="force per penetration of all points together [N/m], of a rigid or spring seabed; by default that "
        "of a spring seabed times width, and on a rigid one contact.stiffness times width, or with auto what its "
        "larger of weight and buoyancy presses in by a thousandth of width",
    )
    friction: Coefficient | None = Field(
        default=None,
        description="friction coefficient in all directions [-]; by default contact.friction's across a pipe, if any",
    )


Touch = Annotated[
    BodyTouch | None,
    Field(description="how it touches the seabed, where there is one; by default with the sphere of its volume"),
]


class PointBody(BaseModel):
    """A point with mass and buoyancy, alike in all directions: a buoy or a clump weight."""

    model_config = FROZEN

    turns: ClassVar[bool] = False
    kind: Literal["point"] = Field(description="point: three degrees of freedom")
    position: Position = Field(description="where it is at first, [x, y, z] [m]")
    mass: BodyMass = Field(description="mass [kg]")
    volume: Volume = Field(default=0.0, description="volume of water that it displaces [m3]")
    drag_area: Area = Field(default=0.0, description="drag coefficient times area, in all directions [m2]")
    added_mass: Coefficient = Field(
        default=0.0, description="added mass coefficient, on the mass of the water displaced, in all directions [-]"
    )
    contact: Touch = None


class SolidBody(BaseModel):
    """A rigid body, such as a mid-water arch. Its axes are the global ones at first."""

    model_config = FROZEN

    turns: ClassVar[bool] = True
    kind: Literal["rigid"] = Field(description="rigid: six degrees of freedom")
    position: Position = Field(description="where the origin of its axes is at first, [x, y, z] [m]")
    mass: BodyMass = Field(description="mass [kg]")
    inertia: tuple[BodyInertia, BodyInertia, BodyInertia] = Field(
        description=f"moments of inertia about its centre of gravity, {AXES}, which are its main axes [kg.m2]"
    )
    centre_of_gravity: Position = Field(default=(0.0, 0.0, 0.0), description="centre of gravity in body axes [m]")
    volume: Volume = Field(default=0.0, description="volume of water that it displaces [m3]")
    centre_of_buoyancy: Position = Field(default=(0.0, 0.0, 0.0), description="centre of buoyancy in body axes [m]")
    drag_area: tuple[Area, Area, Area] = Field(
        default=(0.0, 0.0, 0.0), description=f"drag coefficient times area, {AXES}, at the centre of buoyancy [m2]"
    )
    rotational_drag: tuple[RotationalDrag, RotationalDrag, RotationalDrag] = Field(
        default=(0.0, 0.0, 0.0),
        description=f"moment of drag over half the water's density times the square of the angular velocity, {AXES} "
        "[m5]",
    )
    added_mass: tuple[Coefficient, Coefficient, Coefficient] = Field(
        default=(0.0, 0.0, 0.0),
        description=f"added mass coefficients, on the mass of the water displaced, {AXES}, at the centre of buoyancy "
        "[-]",
    )
    added_inertia: tuple[BodyInertia, BodyInertia, BodyInertia] = Field(
        default=(0.0, 0.0, 0.0), description=f"added moments of inertia about the centre of buoyancy, {AXES} [kg.m2]"
    )
    contact: Touch = None

    @model_validator(mode="after")
    def _has_inertia(self) -> Self:
        if min(self.inertia) == 0.0:
            remedy = "give all three, or make it a point"
            raise wrong("inertia", "a rigid body without a moment of inertia can't turn", remedy)
        return self


BODIES = registry(PointBody, SolidBody)
Body = Annotated[PointBody | SolidBody, OneOf(BODIES)]
