"""Keys, words and descriptions of the scene language, looked up in its models."""

from collections.abc import Iterable
from dataclasses import dataclass
from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from riser_soil.core.kinds import OneOf
from riser_soil.scene.scene import Scene


@dataclass(frozen=True)
class KeyInfo:
    """A key of the scene language: the types that fit there and the description of its key."""

    types: tuple[Any, ...]
    description: str

    @property
    def keys(self) -> list[str]:
        """Keys of the mappings that fit here."""
        return [f.alias or name for model in self._models for name, f in model.model_fields.items()]

    @property
    def words(self) -> list[str]:
        """Words that fit here."""
        words = (word for kind in self.types if get_origin(kind) is Literal for word in get_args(kind))
        return [str(word).lower() if isinstance(word, bool) else str(word) for word in words]

    @property
    def count(self) -> int | None:
        """How many items a list of fixed length has here."""
        lengths = [
            len(get_args(t)) for t in self.types if get_origin(t) is tuple and Ellipsis not in get_args(t)
        ]
        return lengths[0] if lengths else None

    @property
    def _models(self) -> list[type[BaseModel]]:
        return [kind for kind in self.types if isinstance(kind, type) and issubclass(kind, BaseModel)]

    def under(self, item: str | int) -> "KeyInfo":
        """The place below a key or index; an alternative's tag `<Model>` narrows the types."""
        if isinstance(item, str) and item.startswith("<"):
            chosen = tuple(model for model in self._models if f"<{model.__name__}>" == item)
            return KeyInfo(chosen or self.types, self.description)
        if isinstance(item, int):
            return KeyInfo(tuple(t for kind in self.types for t in _item_types(kind, item)), self.description)
        return self._key(item)

    def _key(self, key: str) -> "KeyInfo":
        for model in self._models:
            for name, field in model.model_fields.items():
                if (field.alias or name) == key:
                    return KeyInfo(_types(field), field.description or "")
        values = (get_args(kind)[1] for kind in self.types if get_origin(kind) is dict)
        return KeyInfo(tuple(t for kind in values for t in _alternatives(kind)), self.description)


def spot(location: tuple[str | int, ...], root: type[BaseModel] = Scene) -> KeyInfo:
    """The place of the language, that of scenes by default, at a location with or without tags."""
    here = KeyInfo((root,), f"the {root.__name__.lower()}")
    for item in location:
        here = here.under(item)
    return here


def _types(field: FieldInfo) -> tuple[Any, ...]:
    """The types that fit at a key."""
    return _registered(field.metadata) or _alternatives(field.annotation)


def _registered(marks: Iterable[Any]) -> tuple[Any, ...]:
    """The models that an annotation chooses from by their kind."""
    return tuple(model for mark in marks if isinstance(mark, OneOf) for model in mark.models.values())


def _alternatives(kind: Any) -> tuple[Any, ...]:
    """The types that an annotation allows."""
    if get_origin(kind) is Annotated:
        return _registered(get_args(kind)[1:]) or _alternatives(get_args(kind)[0])
    if get_origin(kind) in (Union, UnionType):
        return tuple(t for arg in get_args(kind) for t in _alternatives(arg))
    return (kind,)


def _item_types(kind: Any, index: int) -> tuple[Any, ...]:
    """The types of one item of a list."""
    args = get_args(kind) if get_origin(kind) is tuple else ()
    if not args:
        return ()
    fixed = Ellipsis not in args
    return _alternatives(args[min(index, len(args) - 1)] if fixed else args[0])
