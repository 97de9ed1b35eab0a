"""Error messages: from the models' validation errors to problems in the words of the scene."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails

from riser_soil.core.quantities import OneOf
from riser_soil.scene.aliases import meant_by
from riser_soil.scene.document import UNSPACED
from riser_soil.scene.problem import NOTHING, Path, Problem, did_you_mean, hint, value_at
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
        """Number of items of a list of fixed length."""
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


@dataclass(frozen=True)
class Failure:
    """One error of the models, seen from the scene."""

    location: Path  # path as the models give it, with alternatives' tags
    data: Any
    context: dict[str, Any]
    root: type[BaseModel] = Scene

    @property
    def path(self) -> Path:
        """The location without tags: the path in the scene."""
        return tuple(item for item in self.location if not (isinstance(item, str) and item.startswith("<")))

    @property
    def value(self) -> Any:
        """The value in the scene, or NOTHING."""
        return value_at(self.data, self.path)

    @property
    def here(self) -> KeyInfo:
        """The scene language's text about the place."""
        return spot(self.location, self.root)

    @property
    def around(self) -> KeyInfo:
        """The scene language's text about the mapping or list around the place."""
        return spot(self.location[:-1], self.root)

    @property
    def correct(self) -> str:
        """The remedy when only the right value is wanted."""
        return f"correct it: {self.here.description}"

    def problem(self, allowed: str, remedy: str | None = None) -> Problem:
        return Problem(self.path, allowed, remedy or self.correct)


_Explain = Callable[[Failure], Problem]


def problems_in(error: ValidationError, data: Any, root: type[BaseModel] = Scene) -> list[Problem]:
    """One problem per error; follow-up errors of another one are left out. root: the model that was to be read."""
    details = [d for d in error.errors(include_url=False) if not _follows_from_items(d)]
    failures = [
        Failure(d["loc"], data, {"type": d["type"], "text": d["msg"], **d.get("ctx", {})}, root) for d in details
    ]
    meant = {_meant(f) for f in failures if f.context["type"] == "extra_forbidden"}
    explained = [f for f in failures if f.context["type"] != "missing" or f.path not in meant]
    return [_EXPLAIN.get(f.context["type"], _as_it_is)(f) for f in explained]


def _follows_from_items(detail: ErrorDetails) -> bool:
    """A list counts as too short as well when its items are wrong: only the items need telling."""
    return detail["type"] == "too_short" and len(detail["input"]) >= detail["ctx"]["min_length"]


def _meant(failure: Failure) -> Path:
    """The key that an unknown one was probably meant to be."""
    key, keys = str(failure.path[-1]), failure.around.keys
    joined = UNSPACED.match(key)
    meant = joined[1] if joined else meant_by(key, keys).partition(":")[0]
    return (*failure.path[:-1], meant or did_you_mean(key, keys) or "")


def _as_it_is(failure: Failure) -> Problem:
    text = str(failure.context["text"])
    return failure.problem(text[:1].lower() + text[1:])


def _missing(failure: Failure) -> Problem:
    if isinstance(failure.path[-1], int):
        return _wrong_count(replace(failure, location=failure.location[:-1]))
    return failure.problem("the key is required here", f"add it: {failure.here.description}")


def _wrong_count(failure: Failure) -> Problem:
    return failure.problem(f"must be a list of {failure.here.count} values")


def _too_short(failure: Failure) -> Problem:
    return failure.problem(f"must have at least {failure.context['min_length']} entries")


def _number(failure: Failure) -> Problem:
    whole = "whole " if int in failure.here.types else ""
    words = f" or one of {', '.join(failure.here.words)}" if failure.here.words else ""
    remedy = f"write it in SI units, without a unit and without quotes: {failure.here.description}"
    return failure.problem(f"must be a {whole}number{words}", remedy)


def _finite(failure: Failure) -> Problem:
    return failure.problem("must be a finite number")


def _text(failure: Failure) -> Problem:
    return failure.problem("must be a text", f"put it in quotes: {failure.here.description}")


def _mapping(failure: Failure) -> Problem:
    keys = failure.here.keys
    if isinstance(failure.value, str) and (joined := UNSPACED.match(failure.value)):
        return replace(failure.problem(*_unspaced(joined[1])), shows_line=True)
    return failure.problem(
        f"must be a mapping with the keys {', '.join(keys)}" if keys else "must be a mapping"
    )


def _list(failure: Failure) -> Problem:
    count = f" of {failure.here.count} values" if failure.here.count else ""
    return failure.problem(f"must be a list{count}", f"write it in [brackets]: {failure.here.description}")


def _word(failure: Failure) -> Problem:
    words = failure.here.words
    allowed = f"must be one of {', '.join(words)}" if len(words) > 1 else f"must be {''.join(words)}"
    return failure.problem(allowed, failure.correct + hint(failure.value, words))


def _unknown_key(failure: Failure) -> Problem:
    keys, key = failure.around.keys, failure.path[-1]
    if joined := UNSPACED.match(str(key)):
        return replace(failure.problem(*_unspaced(joined[1])), shows_line=True)
    if written := meant_by(str(key), keys):
        return replace(failure.problem("no such key here", f'did you mean "{written}"?'), shows_line=True)
    return failure.problem(f"no such key here, known are {', '.join(keys)}", "correct or remove it" + hint(key, keys))


def _unspaced(key: str) -> tuple[str, str]:
    return f"a blank is missing after the colon of {key}", f"write {key}: and the value after a blank"


def _choice(failure: Failure) -> Problem:
    return failure.problem(failure.context["text"], failure.correct + hint(failure.value, failure.here.words))


def _kind(failure: Failure) -> Problem:
    words, value = failure.context["text"], failure.value
    if not isinstance(value, dict):
        return failure.problem(f"must be a mapping with kind: {words}")
    if joined := next((joined for key in value if (joined := UNSPACED.match(str(key)))), None):
        return replace(failure.problem(*_unspaced(joined[1])), shows_line=True)
    near = hint(value["kind"], words.split(", ")) if "kind" in value else _misspelt_kind(failure)
    return Problem((*failure.path, "kind"), f"must be one of {words}", f"choose one{near}")


def _misspelt_kind(failure: Failure) -> str:
    """Without its kind a mapping can't be read: tell an unknown key that may have been meant for it."""
    unknown = [key for key in failure.value if key not in failure.here.keys]
    meant = [key for key in unknown if did_you_mean(key, ["kind"])]
    return f' ("{meant[0]}" is no key: did you mean "kind"?)' if meant else ""


def _said_by_a_check(failure: Failure) -> Problem:
    allowed, _, remedy = failure.context["text"].partition("; ")
    key = failure.context.get("key")
    return Problem((*failure.path, key) if key else failure.path, allowed, remedy)


def _about_a_file(failure: Failure) -> Problem:
    """A file may be named without the key that holds its name."""
    allowed, _, remedy = failure.context["text"].partition("; ")
    named = failure.path if failure.value is not NOTHING else failure.path[:-1]
    return Problem(named, allowed, remedy)


def _bound(relation: str, name: str) -> _Explain:
    def explain(failure: Failure) -> Problem:
        return failure.problem(f"must be {relation} {failure.context[name]:g}")

    return explain


def _size(failure: Failure) -> Problem:
    """Problem of a value beyond the physical range of its quantity."""
    remedy = f"a riser of any scale keeps within; check unit and power of ten: {failure.here.description}"
    return failure.problem(failure.context["text"], remedy)


_EXPLAIN: dict[str, _Explain] = {
    "size": _size,
    "missing": _missing,
    "extra_forbidden": _unknown_key,
    "float_type": _number,
    "int_type": _number,
    "finite_number": _finite,
    "string_type": _text,
    "model_type": _mapping,
    "model_attributes_type": _mapping,
    "dict_type": _mapping,
    "tuple_type": _list,
    "too_short": _too_short,
    "too_long": _wrong_count,
    "literal_error": _word,
    "choice": _choice,
    "kind": _kind,
    "conflict": _said_by_a_check,
    "wrong_file": _about_a_file,
    "greater_than": _bound("greater than", "gt"),
    "greater_than_equal": _bound("at least", "ge"),
    "less_than": _bound("less than", "lt"),
    "less_than_equal": _bound("at most", "le"),
}
