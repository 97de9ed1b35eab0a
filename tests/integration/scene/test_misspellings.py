"""Misspelt keys, found by chance, are told with the key that was meant."""

from __future__ import annotations

import string
from collections.abc import Iterator
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from riser_soil.errors import SceneError
from riser_soil.scene.document import parse
from riser_soil.scene.explain import spot
from riser_soil.scene.reader import scene_from_mapping

ROOT = Path(__file__).parents[3]
TEXT = (ROOT / "demos/touchdown_clay/scene.yaml").read_text(encoding="utf-8")


def keys_in(data: Any, path: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:
    """Paths of the keys that the language fixes; names of line types are free."""
    entries = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in entries:
        if isinstance(key, str) and len(key) > 3 and path != ("line_types",):
            yield (*path, key)
        yield from keys_in(value, (*path, key))


DATA = parse(TEXT, "scene").data
PATHS = list(keys_in(DATA))


@st.composite
def misspelt(draw: st.DrawFn, word: str) -> str:
    """The word with one letter changed, left out, doubled or swapped with the next."""
    n = draw(st.integers(1, len(word) - 2))
    letter = draw(st.sampled_from(string.ascii_lowercase))
    return draw(
        st.sampled_from(
            [
                word[:n] + letter + word[n + 1 :],
                word[:n] + word[n + 1 :],
                word[:n] + word[n] + word[n:],
                word[:n] + word[n + 1] + word[n] + word[n + 2 :],
            ]
        )
    )


def renamed(data: Any, path: tuple[str | int, ...], new: str) -> Any:
    """The data with the key at the end of the path renamed."""
    if len(path) == 1:
        return {new if key == path[0] else key: value for key, value in data.items()}
    if isinstance(data, list):
        return [renamed(value, path[1:], new) if n == path[0] else value for n, value in enumerate(data)]
    return {key: renamed(value, path[1:], new) if key == path[0] else value for key, value in data.items()}


@settings(max_examples=300, deadline=None)
@given(data=st.data())
def test_the_nearest_key_is_named(data: st.DataObject) -> None:
    path = data.draw(st.sampled_from(PATHS))
    word = str(path[-1])
    wrong = data.draw(misspelt(word).filter(lambda new: new not in (word, *spot(path[:-1]).keys)))
    with pytest.raises(SceneError) as caught:
        scene_from_mapping(renamed(DATA, path, wrong))
    lines = str(caught.value).splitlines()
    assert any(wrong in line and word in line for line in lines), lines
    assert all("; " in line for line in lines)


SCALARS = st.one_of(
    st.none(), st.booleans(), st.integers(-10, 10), st.floats(), st.text(max_size=5),
    st.lists(st.integers(0, 3), max_size=4), st.dictionaries(st.text(max_size=3), st.integers(), max_size=2),
)  # fmt: skip


@settings(max_examples=300, deadline=None)
@given(data=st.data(), value=SCALARS)
def test_no_value_causes_anything_but_a_reported_problem(data: st.DataObject, value: Any) -> None:
    path = data.draw(st.sampled_from(PATHS))
    scene = deepcopy(DATA)
    holder = scene
    for item in path[:-1]:
        holder = holder[item]
    holder[path[-1]] = value
    for line in problems_of(scene):  # what to do about it, or a likely unit
        assert line.startswith("scene: ")
        assert "; " in line or line.endswith("?")


def problems_of(scene: Any) -> list[str]:
    """The lines told about a scene; none when it is right."""
    try:
        scene_from_mapping(scene)
    except SceneError as err:
        return str(err).splitlines()
    return []
