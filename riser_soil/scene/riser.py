"""Scene language: the riser, its segments, contents, end supports and shapes."""

import math
from itertools import accumulate
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, Discriminator, Field, PrivateAttr, Tag, model_validator

from riser_soil.core.quantities import (
    FROZEN,
    MOST_ELEMENTS,
    Coordinate,
    Density,
    ElementCount,
    Length,
    NeutralAngle,
    Position,
    PositiveForce,
    Pressure,
    RotationalStiffness,
    Stress,
    Text,
    Vector,
    Velocity,
    word_or,
    wrong,
)
from riser_soil.scene.attachments import Attachment
from riser_soil.scene.shapes import HangOff, Initial, Unstressed


def _one_or_two(value: Any) -> str:
    return "<list>" if isinstance(value, list | tuple) else "<number>"


ElementLength = Annotated[
    Annotated[tuple[Length, Length], Tag("<list>")] | Annotated[Length, Tag("<number>")],
    Discriminator(_one_or_two),
]


class Segment(BaseModel):
    """A stretch of riser of one line type, cut into elements of equal or of steadily growing length."""

    model_config = FROZEN

    line_type: Text = Field(description="name of its line type, a key of `line_types`")
    length: Length = Field(description="unstressed length [m]")
    elements: ElementCount | None = Field(default=None, description="number of elements; or give element_length")
    element_length: ElementLength | None = Field(
        default=None,
        description="greatest length of an element [m], or [at the segment's start, at its end], between which it "
        "changes by equal ratios; or give elements",
    )

    @model_validator(mode="after")
    def _cut_once(self) -> Self:
        if self.elements is None and self.element_length is None:
            remedy = "give either elements or element_length [m], or accuracy to the whole scene"
            raise wrong("elements", "the elements are missing", remedy)
        if self.elements is not None and self.element_length is not None:
            raise wrong(
                "elements", "elements and element_length are both given", "leave one out, or set it to null"
            )
        return self

    @model_validator(mode="after")
    def _not_too_fine(self) -> Self:
        if self.elements is None and self.element_count > MOST_ELEMENTS:
            allowed = f"cuts {self.length:g} m into {self.element_count:.4g} elements, more than {MOST_ELEMENTS}"
            raise wrong("element_length", allowed, "take longer elements, and check the units of both lengths")
        return self

    @property
    def element_count(self) -> int:
        """Number of the elements, whichever way they were given."""
        return self.elements if self.elements is not None else graded_count(self.length, *self._first_and_last)

    @property
    def element_lengths(self) -> tuple[float, ...]:
        """Lengths of the elements from start to end [m], whichever way they were given."""
        if self.elements is not None:
            return (self.length / self.elements,) * self.elements
        return graded_lengths(self.length, *self._first_and_last)

    @property
    def _first_and_last(self) -> tuple[float, float]:
        """The element lengths requested at the segment's start and end [m]."""
        given = self.element_length
        assert given is not None  # the validator has seen to it
        return given if isinstance(given, tuple) else (given, given)


class Slug(BaseModel):
    """A stretch of other contents that moves with the flow."""

    model_config = FROZEN

    density: Density = Field(description="density of the slug [kg/m3]")
    length: Length = Field(description="length along the riser [m]")
    front: Coordinate | None = Field(
        default=None,
        description="arc length of its leading end when the first dynamic stage begins [m], which may lie beyond the "
        "riser; by default where the flow comes in",
    )
    spacing: Length | None = Field(
        default=None, description="from its front to that of the next one [m], without end; one slug by default"
    )

    @model_validator(mode="after")
    def _follows_at_a_distance(self) -> Self:
        if self.spacing is not None and self.spacing <= self.length:
            allowed = f"must be longer than the slug ({self.length:g} m), as it counts from front to front"
            raise wrong("spacing", allowed, "lengthen it")
        return self


class Contents(BaseModel):
    """Contents of the pipe."""

    model_config = FROZEN

    density: Density = Field(description="density of the contents [kg/m3]")
    speed: Velocity = Field(
        default=0.0, description="speed of the flow from start to end, below 0 from end to start [m/s]"
    )
    slugs: tuple[Slug, ...] = Field(
        default=(),
        description="stretches of other contents that move at this speed, {density, length, front, spacing}; none by "
        "default",
    )
    pressure: Pressure = Field(default=0.0, description="gauge pressure of the contents at pressure_level [Pa]")
    pressure_level: Coordinate | None = Field(
        default=None, description="height z at which the contents have that pressure [m]; the higher end by default"
    )

    @property
    def uneven_or_moving(self) -> bool:
        """Whether more than even contents at rest are in the pipe."""
        return bool(self.slugs) or self.speed != 0.0

    def front_of(self, slug: Slug, length: float) -> float:
        """Distance of a slug's front from where the flow comes into a riser of this length, at first [m]."""
        if slug.front is None:
            return 0.0
        return slug.front if self.speed >= 0.0 else length - slug.front


class RotationSpring(BaseModel):
    """A rotational spring between the riser's end and its support: a flex joint."""

    model_config = FROZEN

    stiffness: RotationalStiffness = Field(description="rotational stiffness [N.m/rad]")
    neutral_angle: NeutralAngle | None = Field(
        default=None,
        description="angle of the riser from the vertical at which the joint is at rest [deg], in the ends' vertical "
        "plane, positive where the riser, followed upwards, leans towards the upper end; by default the direction of "
        "the initial shape",
    )


Rotation = Annotated[
    Annotated[Literal["free", "fixed"], Tag("<word>")] | Annotated[RotationSpring, Tag("<RotationSpring>")],
    Discriminator(
        word_or(RotationSpring),
        custom_error_type="choice",
        custom_error_message="must be free, fixed or {stiffness: N.m/rad}",
    ),
]


class BendStiffener(BaseModel):
    """A tapered bend stiffener, a cone around the pipe whose base is at the riser's end."""

    model_config = FROZEN

    length: Length = Field(description="length from base to tip [m]")
    base_diameter: Length = Field(description="outer diameter at the base [m]")
    tip_diameter: Length = Field(description="outer diameter at the tip [m], at least the pipe's")
    E: Stress = Field(description="Young's modulus of its material [Pa]")
    density: Density = Field(default=1150.0, description="density of its material [kg/m3]; by default polyurethane's")

    @model_validator(mode="after")
    def _tapers(self) -> Self:
        if self.base_diameter < self.tip_diameter:
            raise wrong("base_diameter", f"is less than tip_diameter ({self.tip_diameter:g} m)", "swap the two")
        return self


class Tensioner(BaseModel):
    """A heave-compensated top tension: a constant upward force in place of a vertical support."""

    model_config = FROZEN

    tension: PositiveForce = Field(description="upward force on the riser's end, the same at every height [N]")


class Support(BaseModel):
    """The support of an end at a prescribed position."""

    model_config = FROZEN

    position: Position = Field(description="prescribed position of the end, [x, y, z] [m]")
    rotation: Rotation = Field(
        default="free",
        description="free, fixed (keeps the direction of the initial shape), or {stiffness: N.m/rad}, "
        "with a neutral_angle [deg] if it rests in another direction",
    )
    bend_stiffener: BendStiffener | None = Field(
        default=None, description="tapered bend stiffener on the pipe at a fixed or sprung end; none by default"
    )
    tensioner: Tensioner | None = Field(
        default=None,
        description="heave-compensated top tension, {tension: N}: the end is held horizontally alone, and z of its "
        "position is a first guess; the vertical part of its motions does not reach the riser",
    )
    hang_off: HangOff | None = Field(
        default=None,
        description="angle or tension with which the riser hangs off here at rest, {angle: deg} or {tension: N}: the "
        "position, the other end's or a segment's length are then a first guess, and solved for",
    )
    _jointed: bool = PrivateAttr(default=False)

    @classmethod
    def by_joint(cls, position: Vector, rotation: Literal["free", "fixed"]) -> Self:
        """The end that a joint holds at this place at first, and that moves with what it is joined to."""
        support = cls(position=position, rotation=rotation)
        support._jointed = True
        return support

    @property
    def jointed(self) -> bool:
        """Whether a joint holds the end, and nothing prescribes its position."""
        return self._jointed


End = Annotated[
    Annotated[Literal["free"], Tag("<word>")] | Annotated[Support, Tag("<Support>")],
    Discriminator(
        word_or(Support),
        custom_error_type="choice",
        custom_error_message="must be free, or a mapping with position and rotation",
    ),
]


class Riser(BaseModel):
    """The riser from `start` (arc length 0) to `end`."""

    model_config = FROZEN

    segments: tuple[Segment, ...] = Field(min_length=1, description="the riser's stretches from start to end")
    contents: Contents | None = Field(default=None, description="what fills the pipe; empty by default")
    attachments: tuple[Attachment, ...] = Field(
        default=(), description="point masses, clump weights and buoyancy modules; none by default"
    )
    start: End = Field(description="the end at arc length 0: free, or position and rotation")
    end: End = Field(description="the end at the full arc length: free, or position and rotation")
    unstressed: Unstressed = Field(
        default="straight",
        description="shape without any load: straight (from start to end; along +x when an end is free), "
        "{points: ...} or {arc: ...}",
    )
    initial: Initial = Field(
        default="unstressed",
        description="shape at the beginning: straight, catenary, unstressed or {points: ...}; by default "
        "catenary when both ends have a position and gravity acts, else unstressed",
    )
    _tied: bool = PrivateAttr(default=False)
    _across: int | None = PrivateAttr(default=None)

    def of_several(self, tied: bool, across: int | None) -> Self:
        """A copy for a scene of several lines. tied: whether joints hold it between its ends; across: see the property.
        """
        line = self.model_copy()
        line._tied, line._across = tied, across
        return line

    @property
    def across(self) -> int | None:
        """The axis, x (0) or y (1), across the vertical plane that it keeps to as one of several lines, if any."""
        return self._across

    @property
    def inner_flow(self) -> Contents | None:
        """Contents that flow or are uneven; None where there are none, or they count in mass and weight alone."""
        return self.contents if self.contents is not None and self.contents.uneven_or_moving else None

    @property
    def is_tied(self) -> bool:
        """Whether joints hold it between its ends."""
        return self._tied

    @model_validator(mode="after")
    def _not_too_fine(self) -> Self:
        if self.element_count > MOST_ELEMENTS:
            allowed = f"the segments have {self.element_count} elements together, more than {MOST_ELEMENTS}"
            raise wrong("segments", allowed, "take longer elements")
        return self

    @property
    def hangs_off(self) -> bool:
        """Whether an end asks for a hang-off angle or tension."""
        return any(isinstance(end, Support) and end.hang_off is not None for end in (self.start, self.end))

    @property
    def element_count(self) -> int:
        """Number of all elements."""
        return sum(segment.element_count for segment in self.segments)

    @property
    def length(self) -> float:
        """Unstressed length of the riser [m]."""
        return math.fsum(segment.length for segment in self.segments)

    @property
    def node_arcs(self) -> list[float]:
        """Arc lengths of the nodes [m]."""
        return list(accumulate((x for segment in self.segments for x in segment.element_lengths), initial=0.0))


def graded_lengths(length: float, first: float, last: float) -> tuple[float, ...]:
    """Lengths [m] that add up to `length`, each the same multiple of the one before, from about `first` to `last`.

    Their number n is the least for which none exceeds the given length: n - 1 equal quotients lead from `first` to
    `last`, and a common factor, between 1 - 1/n and 1 for n > 2, makes the sum right. first = last: n equal lengths.
    """
    n = graded_count(length, first, last)
    if n == 1 or first == last:
        return (length / n,) * n
    terms = [first * (last / first) ** (k / (n - 1)) for k in range(n)]
    scale = length / math.fsum(terms)
    return tuple(scale * term for term in terms)


def graded_count(length: float, first: float, last: float) -> int:
    """Number of elements; found by bisection, as more of them are always longer together."""
    too_few, enough = 0, max(1, math.ceil(length / min(first, last)) + 1)
    while enough - too_few > 1:
        n = (too_few + enough) // 2
        if _sum(n, first, last) >= length * (1.0 - 1e-9):
            enough = n
        else:
            too_few = n
    return enough


def _sum(n: int, first: float, last: float) -> float:
    """Sum of the n terms of the geometric series from `first` to `last`; of one term the smaller."""
    growth = math.log(last / first)
    if n == 1 or growth == 0.0:
        return n * min(first, last)
    return first * math.expm1(growth * n / (n - 1)) / math.expm1(growth / (n - 1))
