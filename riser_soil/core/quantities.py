"""Quantities of the scene language, numbers with units and bounds, and its tagged unions by the key `kind`.

Every quantity has a physical range. A riser is from a tenth of a metre to some kilometres long; the ranges hold all
that such a riser has when it is scaled in length by a millionth to a million, by Froude's law (forces by the cube of
the length, EI by its fifth power) or with the materials kept (gravity by its inverse). Values beyond are mistakes of
units or powers of ten, and would lead to overflow or round-off during the run.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import reduce
from operator import or_
from typing import Annotated, Any, Literal, TypeVar, get_args

from pydantic import BaseModel, ConfigDict, Discriminator, Field, GetCoreSchemaHandler, Tag
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

FROZEN = ConfigDict(defer_build=True, extra="forbid", frozen=True, allow_inf_nan=False, validate_default=False)

MOST_ELEMENTS = 1_000_000
Model = TypeVar("Model", bound=BaseModel)


"""Elements of a riser: each costs some 10 kB, and every step of the run half a minute with so many."""


@dataclass(frozen=True)
class Bounds:
    """Least and greatest size of a quantity, whatever its sign. A least size of 0 is none: a component may be as small
    as it likes. zero: whether there may be nothing of the quantity.
    """

    least: float
    most: float
    unit: str
    zero: bool = False

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_after_validator_function(self.checked, handler(source))

    def checked(self, value: float) -> float:
        """The value, or PydanticCustomError."""
        if value == 0.0 or self.least <= abs(value) <= self.most:
            return value
        raise PydanticCustomError("size", "{text}", {"text": self._in_words})

    @property
    def _in_words(self) -> str:
        if self.least == 0.0:
            return f"must be at most {self.most:g} {self.unit} in size"
        return f"must be {'0, or ' if self.zero else ''}from {self.least:g} to {self.most:g} {self.unit} in size"


_LENGTH = Bounds(1e-12, 1e12, "m")
_TIME = Bounds(1e-12, 1e12, "s")
_STRESS = Bounds(1e-15, 1e24, "Pa")
_STRENGTH_GRADIENT = Bounds(1e-15, 1e18, "Pa/m", zero=True)
_WEIGHT = Bounds(1e-24, 1e24, "N/m")
_RATIO = Bounds(1e-9, 1e9, "(no unit)")

SHORTEST = _LENGTH.least
"""Least distance of two points [m]."""
NEAREST = _TIME.least
"""Least time between two instants [s]."""
FARTHEST = 1e12
"""Greatest number in a table, in SI units."""
FLATTEST = 1e-12
"""Least length of a vector that gives a direction."""

Real = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Positive = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0)]
NonNegative = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0)]
Share = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0, lt=1)]
Part = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0, le=1)]
PoissonRatio = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=-1, lt=0.5)]
Count = Annotated[int, Field(strict=True, ge=1, le=1_000_000_000)]
ElementCount = Annotated[int, Field(strict=True, ge=1, le=MOST_ELEMENTS)]
Text = Annotated[str, Field(strict=True)]

Length = Annotated[Positive, _LENGTH]
LengthOrNone = Annotated[NonNegative, replace(_LENGTH, zero=True)]
ArcLength = Annotated[NonNegative, Bounds(0.0, 1e12, "m")]
Coordinate = Annotated[Real, Bounds(0.0, 1e12, "m")]
Area = Annotated[NonNegative, Bounds(1e-24, 1e24, "m2", zero=True)]
Volume = Annotated[NonNegative, Bounds(1e-36, 1e36, "m3", zero=True)]
Angle = Annotated[Real, Bounds(0.0, 1e6, "deg")]
NeutralAngle = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-90, le=90)]
HangOffAngle = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0, lt=90)]
Time = Annotated[Positive, _TIME]
TimeOrNone = Annotated[NonNegative, replace(_TIME, zero=True)]
Instant = Annotated[NonNegative, Bounds(0.0, 1e12, "s")]
Frequency = Annotated[Positive, Bounds(1e-12, 1e12, "Hz")]
Velocity = Annotated[Real, Bounds(0.0, 1e9, "m/s")]
Gravity = Annotated[NonNegative, Bounds(1e-9, 1e9, "m/s2", zero=True)]
Density = Annotated[Positive, Bounds(1e-9, 1e9, "kg/m3")]
KinematicViscosity = Annotated[Positive, Bounds(1e-12, 1e3, "m2/s")]
Mass = Annotated[NonNegative, Bounds(1e-30, 1e30, "kg", zero=True)]
MassPerLength = Annotated[Positive, Bounds(1e-18, 1e18, "kg/m")]
RotaryInertiaPerLength = Annotated[NonNegative, Bounds(1e-36, 1e36, "kg.m", zero=True)]
WeightPerLength = Annotated[Real, replace(_WEIGHT, zero=True)]
PositiveWeightPerLength = Annotated[Positive, _WEIGHT]
UnitWeight = Annotated[NonNegative, Bounds(1e-15, 1e18, "N/m3", zero=True)]
AxialStiffness = Annotated[Positive, Bounds(1e-30, 1e36, "N")]
_BENDING_STIFFNESS = Bounds(1e-40, 1e45, "N.m2")
BendingStiffness = Annotated[Positive, _BENDING_STIFFNESS]
BendingStiffnessOrNone = Annotated[NonNegative, replace(_BENDING_STIFFNESS, zero=True)]
Tension = Annotated[Positive, Bounds(1e-30, 1e36, "N")]
RotationalStiffness = Annotated[Positive, Bounds(1e-36, 1e42, "N.m/rad")]
BedStiffness = Annotated[Positive, Bounds(1e-15, 1e24, "N/m2")]
Pressure = Annotated[Real, Bounds(0.0, 1e24, "Pa")]
Stress = Annotated[Positive, _STRESS]
StressOrNone = Annotated[NonNegative, replace(_STRESS, zero=True)]
StrengthGradient = Annotated[Real, _STRENGTH_GRADIENT]
PositiveStrengthGradient = Annotated[NonNegative, _STRENGTH_GRADIENT]
Ratio = Annotated[Positive, _RATIO]
RateGain = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=1)]
StrainRate = Annotated[Positive, Bounds(1e-18, 1e12, "1/s")]
Coefficient = Annotated[NonNegative, replace(_RATIO, zero=True)]
Factor = Annotated[Real, Bounds(0.0, 1e9, "(no unit)")]
SolverTolerance = Annotated[Positive, Bounds(1e-16, 1.0, "(no unit)")]
PositiveForce = Annotated[Positive, Bounds(1e-30, 1e36, "N")]
_ForceComponent = Annotated[Real, Bounds(0.0, 1e36, "N")]
_LineForceComponent = Annotated[Real, Bounds(0.0, 1e24, "N/m")]
_MomentComponent = Annotated[Real, Bounds(0.0, 1e42, "N.m")]
_AxisComponent = Annotated[Real, Bounds(0.0, 1e12, "(no unit)")]

Vector = tuple[float, float, float]
Position = tuple[Coordinate, Coordinate, Coordinate]
Force = tuple[_ForceComponent, _ForceComponent, _ForceComponent]
ForcePerLength = tuple[_LineForceComponent, _LineForceComponent, _LineForceComponent]
Moment = tuple[_MomentComponent, _MomentComponent, _MomentComponent]
Axis = tuple[_AxisComponent, _AxisComponent, _AxisComponent]
Angles = tuple[Angle, Angle, Angle]
Interval = tuple[Coordinate, Coordinate]

_AUTO_OR_NUMBER = Discriminator(
    lambda value: word_or_number(value),
    custom_error_type="choice",
    custom_error_message="must be auto or a number",
)
_Auto = Annotated[Literal["auto"], Tag("<word>")]
AutoOrTime = Annotated[_Auto | Annotated[Time, Tag("<number>")], _AUTO_OR_NUMBER]
AutoOrLength = Annotated[_Auto | Annotated[Length, Tag("<number>")], _AUTO_OR_NUMBER]
AutoOrLengthOrNone = Annotated[_Auto | Annotated[LengthOrNone, Tag("<number>")], _AUTO_OR_NUMBER]
AutoOrBedStiffness = Annotated[_Auto | Annotated[BedStiffness, Tag("<number>")], _AUTO_OR_NUMBER]


def wrong(key: str, allowed: str, remedy: str) -> PydanticCustomError:
    """An error about `key` of the mapping under validation: what is allowed, and what to do."""
    return PydanticCustomError("conflict", "{text}", {"key": key, "text": f"{allowed}; {remedy}"})


def tag_of(model: type[BaseModel]) -> str:
    """Name of one alternative of a key; the angle brackets keep it apart from the keys of a scene."""
    return f"<{model.__name__}>"


def word_or(model: type[BaseModel]) -> Callable[[Any], str | None]:
    """Choose between words (tag `<word>`) and a mapping read by `model`, by the type of the value."""

    def pick(value: Any) -> str | None:
        if isinstance(value, str):
            return "<word>"
        return tag_of(model) if isinstance(value, dict | model) else None

    return pick


def word_or_number(value: Any) -> str:
    """Choose between words (tag `<word>`) and a number (tag `<number>`), by the type of the value."""
    return "<word>" if isinstance(value, str) else "<number>"


def by_key(models: dict[str, type[BaseModel]]) -> Callable[[Any], str | None]:
    """Choose the model of a mapping by the key that only this model has; words have the tag `<word>`."""

    def pick(value: Any) -> str | None:
        if isinstance(value, str):
            return "<word>"
        if isinstance(value, BaseModel):
            return tag_of(type(value))
        keys = [key for key in models if isinstance(value, dict) and key in value]
        return tag_of(models[keys[0]]) if keys else None

    return pick


def by_kind(models: dict[str, type[BaseModel]]) -> Callable[[Any], str | None]:
    """Choose the model of a mapping by the word at its key `kind`."""

    def pick(value: Any) -> str | None:
        if isinstance(value, BaseModel):
            return tag_of(type(value))
        kind = value.get("kind") if isinstance(value, dict) else None
        return tag_of(models[kind]) if isinstance(kind, str) and kind in models else None

    return pick


def registry(*models: type[Model]) -> dict[str, type[Model]]:
    """Models by their `kind`, a Literal of one word."""
    return {get_args(model.model_fields["kind"].annotation)[0]: model for model in models}


@dataclass(frozen=True, eq=False)
class OneOf:
    """Annotates a key whose value is a mapping read by the model of its kind."""

    models: Mapping[str, type[BaseModel]]

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        tagged = tuple(Annotated[model, Tag(tag_of(model))] for model in self.models.values())
        chosen = Discriminator(
            by_kind(dict(self.models)), custom_error_type="kind", custom_error_message=", ".join(self.models)
        )
        return handler.generate_schema(Annotated[reduce(or_, tagged), chosen])

    @property
    def words(self) -> str:
        """The kinds, for a description."""
        return " or ".join(self.models)

    @property
    def examples(self) -> str:
        """A mapping of each kind with the keys that it requires, for a description."""
        return " or ".join(_example(kind, model) for kind, model in self.models.items())


def _example(kind: str, model: type[BaseModel]) -> str:
    required = [name for name, key in model.model_fields.items() if key.is_required() and name != "kind"]
    return f"{{{', '.join([f'kind: {kind}', *(f'{name}: ...' for name in required)])}}}"
