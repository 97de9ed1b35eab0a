"""Mutations of scenes: numbers, keys, sections, text and bytes, at random but the same for the same seed."""

from __future__ import annotations

import json
import random
from collections.abc import Callable, Iterator
from copy import deepcopy
from dataclasses import dataclass
from typing import Any

from tests.robustness.fuzz.scenes import Mapping, bases

SCENE = "scene.yaml"
EXTREMES: tuple[Any, ...] = (
    0, -1, 1, 1e-300, 1e-30, 1e-9, 1e-3, 1e3, 1e6, 1e9, 1e30, 1e200, 1e300, -1e-9, -1e30, 10**9, 10**19, -(10**19),
    float("nan"), float("inf"), float("-inf"), "text", "", None, True, [], {}, [1, 2, 3], "auto", "free", "1.0e5 N",
)  # fmt: skip
FACTORS = (-1.0, 0.1, 0.5, 0.9, 1.1, 2.0, 10.0, 1e2, 1e-2, 1e4, 1e-4, 1e6, 1e-6)
GARBAGE = ("{", "}", "[", "]", ":", "- ", "&a ", "*a", "<<: ", "!!python/object:x ", "\t", "\n", "\x00", "é", "'")

Place = tuple[Any, Any]
"""A mapping or list, and the key or index of a value in it."""


@dataclass(frozen=True)
class Case:
    """Files of one mutated scene, by name; the scene itself is SCENE. changes: what was done to it."""

    files: dict[str, bytes]
    changes: str


def cases(count: int, seed: int) -> Iterator[Case]:
    """Mutated scenes: the n-th is the same for the same seed, whatever the count."""
    for n in range(count):
        yield _case(random.Random(f"{seed} {n}"))


def _case(rng: random.Random) -> Case:
    base = rng.choice(bases())
    data, changes = deepcopy(base.data), [str(base.data["title"])]
    for _ in range(rng.choice((1, 1, 1, 2, 3))):
        changes.append(rng.choices(*zip(*IN_DATA, strict=True))[0](data, rng))
    files = {**base.files, SCENE: _written(data).encode("utf-8", "surrogatepass")}
    if rng.random() < 0.2:
        name = rng.choice(sorted(files))
        how = rng.choice(IN_TEXT)
        files[name] = how(files[name], rng)
        changes.append(f"{name}: {how.__name__.strip('_')}")
    return Case(files, "; ".join(changes))


def _places(data: Any, numbers: bool = False) -> list[Place]:
    """Every value of the scene, or every number."""
    items = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    places: list[Place] = []
    for key, value in items:
        if not numbers or (isinstance(value, int | float) and not isinstance(value, bool)):
            places.append((data, key))
        places += _places(value, numbers)
    return places


def _number_replaced(data: Mapping, rng: random.Random) -> str:
    inner, key = rng.choice(_places(data, numbers=True))
    inner[key] = rng.choice(EXTREMES)
    return f"{key} = {inner[key]!r}"


def _number_scaled(data: Mapping, rng: random.Random) -> str:
    inner, key = rng.choice(_places(data, numbers=True))
    inner[key] = type(inner[key])(inner[key] * rng.choice(FACTORS))
    return f"{key} = {inner[key]!r}"


def _value_replaced(data: Mapping, rng: random.Random) -> str:
    inner, key = rng.choice(_places(data))
    inner[key] = rng.choice(EXTREMES)
    return f"{key} = {inner[key]!r}"


def _dropped(data: Mapping, rng: random.Random) -> str:
    inner, key = rng.choice(_places(data))
    del inner[key]
    return f"{key} dropped"


def _misspelt(data: Mapping, rng: random.Random) -> str:
    inner, key = rng.choice([place for place in _places(data) if isinstance(place[0], dict)])
    letters = list(str(key))
    letters[rng.randrange(len(letters))] = rng.choice("aeiouxyz_ ")
    inner["".join(letters)] = inner.pop(key)
    return f"{key} misspelt"


def _moved(data: Mapping, rng: random.Random) -> str:
    """A key from one mapping to another."""
    (inner, key), (other, _) = rng.sample([place for place in _places(data) if isinstance(place[0], dict)], 2)
    other[key] = deepcopy(inner.pop(key))
    return f"{key} moved"


def _repeated(data: Mapping, rng: random.Random) -> str:
    lists = [value for inner, key in _places(data) if isinstance(value := inner[key], list) and value]
    if lists:
        items = rng.choice(lists)
        items.insert(rng.randrange(len(items)), deepcopy(rng.choice(items)))
    return "item repeated"


def _swapped(data: Mapping, rng: random.Random) -> str:
    """A section of another scene in place of the scene's own."""
    other = rng.choice(bases()).data
    key = rng.choice(sorted(other))
    data[key] = deepcopy(other[key])
    return f"{key} of {other['title']}"


def _value_of_another(data: Mapping, rng: random.Random) -> str:
    inner, key = rng.choice(_places(data))
    there, other = rng.choice(_places(rng.choice(bases()).data))
    inner[key] = deepcopy(there[other])
    return f"{key} = another's {other}"


def _without_bytes(text: bytes, rng: random.Random) -> bytes:
    first = rng.randrange(len(text))
    return text[:first] + text[first + rng.randrange(1, 200) :]


def _truncated(text: bytes, rng: random.Random) -> bytes:
    return text[: rng.randrange(len(text))]


def _garbage(text: bytes, rng: random.Random) -> bytes:
    at = rng.randrange(len(text))
    return text[:at] + (rng.choice(GARBAGE) * rng.choice((1, 1, 2, 3000))).encode() + text[at:]


def _flipped(text: bytes, rng: random.Random) -> bytes:
    flipped = bytearray(text)
    for _ in range(rng.randrange(1, 9)):
        flipped[rng.randrange(len(text))] ^= 1 << rng.randrange(8)
    return bytes(flipped)


def _lines_doubled(text: bytes, rng: random.Random) -> bytes:
    lines = text.splitlines(keepends=True)
    at = rng.randrange(len(lines))
    return b"".join([*lines[:at], lines[at], *lines[at:]])


def _digits_changed(text: bytes, rng: random.Random) -> bytes:
    """One digit of a number becomes another, or an exponent is added."""
    digits = [n for n, byte in enumerate(text) if chr(byte).isdigit()]
    if not digits:
        return text
    at = rng.choice(digits)
    return text[:at] + rng.choice((b"0", b"9", b"-", b"1e300", b"e-300", b"99999999")) + text[at + 1 :]


Change = Callable[[Mapping, random.Random], str]
IN_DATA: tuple[tuple[Change, int], ...] = (
    (_number_replaced, 6),
    (_number_scaled, 14),
    (_value_replaced, 3),
    (_dropped, 3),
    (_misspelt, 1),
    (_moved, 1),
    (_repeated, 2),
    (_swapped, 4),
    (_value_of_another, 2),
)
IN_TEXT: tuple[Callable[[bytes, random.Random], bytes], ...] = (
    _without_bytes, _truncated, _garbage, _flipped, _lines_doubled, _digits_changed, _digits_changed,
)  # fmt: skip


def _written(data: Mapping) -> str:
    """A scene in YAML, a section a line."""
    return "".join(f"{key}: {_flow(value)}\n" for key, value in data.items())


def _flow(value: Any) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_flow(str(key))}: {_flow(inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_flow, value)) + "]"
    if isinstance(value, str):
        return "'" + value.replace("'", "''") + "'"
    return json.dumps(value) if value is None or isinstance(value, bool) else _number(value)


def _number(value: float) -> str:
    """A number as YAML 1.2 writes it: a float has a point, or is .nan or .inf."""
    text = repr(value).replace("inf", ".inf").replace("nan", ".nan")
    return text.replace("e", ".0e") if "e" in text and "." not in text else text
