"""Places at which mutants are made: each is in the package once, and the tests that must notice are there."""

from __future__ import annotations

import pytest

from tests.mutants.run import ENOUGH, REPOSITORY, Place, places
from tests.support.said import telling


def test_there_are_enough_of_them() -> None:
    found = list(places())
    assert len(found) >= 40
    assert len(set(found)) == len(found)
    assert ENOUGH >= 0.95


@pytest.mark.parametrize("place", list(places()), ids=lambda place: f"{place.module}: {place.new}")
def test_the_package_has_the_place_once(place: Place) -> None:
    text = (REPOSITORY / place.path).read_text(encoding="utf-8")
    assert place.mutated(text) != text
    assert all((REPOSITORY / file).exists() for file in place.files)


def test_text_that_is_not_there_once_is_refused() -> None:
    with pytest.raises(ValueError, match=telling("2 times", "not once:", "a b")):
        Place("core/arrays", "a b", "c", "").mutated("a b a b")
