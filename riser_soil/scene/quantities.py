"""Number types with their bounds, and the settings shared by every model of the scene language."""

from collections.abc import Callable
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Discriminator, Field, Tag
from pydantic_core import PydanticCustomError

FROZEN = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, validate_default=False)

Real = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Positive = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0)]
NonNegative = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0)]
PoissonRatio = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=-1, lt=0.5)]
Count = Annotated[int, Field(strict=True, ge=1)]
Text = Annotated[str, Field(strict=True)]
_AUTO_OR_NUMBER = Discriminator(
    lambda value: word_or_number(value),
    custom_error_type="choice",
    custom_error_message="must be auto or a number",
)
AutoOrPositive = Annotated[
    Annotated[Literal["auto"], Tag("<word>")] | Annotated[Positive, Tag("<number>")], _AUTO_OR_NUMBER
]
AutoOrNonNegative = Annotated[
    Annotated[Literal["auto"], Tag("<word>")] | Annotated[NonNegative, Tag("<number>")], _AUTO_OR_NUMBER
]
Vector = tuple[Real, Real, Real]
Interval = tuple[Real, Real]


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
        found = [key for key in models if isinstance(value, dict) and key in value]
        return tag_of(models[found[0]]) if found else None

    return pick


def by_kind(models: dict[str, type[BaseModel]]) -> Callable[[Any], str | None]:
    """Choose the model of a mapping by the word at its key `kind`."""

    def pick(value: Any) -> str | None:
        if isinstance(value, BaseModel):
            return tag_of(type(value))
        kind = value.get("kind") if isinstance(value, dict) else None
        return tag_of(models[kind]) if isinstance(kind, str) and kind in models else None

    return pick
