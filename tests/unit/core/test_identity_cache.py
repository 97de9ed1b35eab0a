"""Identity cache: values of the first and the latest objects, by identity."""

import pytest

from riser_soil.core.identity_cache import IdentityCache


class Maker:
    """Makes a new list of an object, and counts."""

    def __init__(self) -> None:
        self.times = 0

    def make(self, of: list[int]) -> list[int]:
        self.times += 1
        return of.copy()


def test_the_same_object_is_asked_once() -> None:
    kept, maker, one = IdentityCache[list[int], list[int]](), Maker(), [1]
    made = kept.made_of(one, maker.make)
    assert kept.made_of(one, maker.make) is made
    assert maker.times == 1


def test_an_equal_object_is_another_one() -> None:
    kept, maker, one, other = IdentityCache[list[int], list[int]](), Maker(), [1], [1]
    made = kept.made_of(one, maker.make)
    assert kept.made_of(other, maker.make) is not made
    assert maker.times == 2


@pytest.mark.parametrize(("latest", "first"), [(1, 0), (2, 0), (1, 1), (2, 1), (3, 2), (0, 1)])
def test_first_and_latest_are_kept(latest: int, first: int) -> None:
    kept, maker = IdentityCache[list[int], list[int]](latest=latest, first=first), Maker()
    objects = [[i] for i in range(8)]
    for of in objects:
        kept.made_of(of, maker.make)
    lasting = objects[:first] + (objects[-latest:] if latest else [])
    for of in lasting:
        assert kept.made_of(of, maker.make) == of
    assert maker.times == len(objects)
    kept.made_of(objects[first], maker.make)
    assert maker.times == len(objects) + 1


def test_all_is_forgotten() -> None:
    kept, maker, one, other = IdentityCache[list[int], list[int]](latest=1, first=1), Maker(), [1], [2]
    for of in (one, other):
        kept.made_of(of, maker.make)
    kept.forget()
    for of in (other, one, other):
        kept.made_of(of, maker.make)
    assert maker.times == 4


def test_a_failure_is_not_cached() -> None:
    kept, maker, one = IdentityCache[list[int], list[int]](), Maker(), [1]

    def fail(of: list[int]) -> list[int]:
        raise ValueError("no way")

    with pytest.raises(ValueError, match="no way"):
        kept.made_of(one, fail)
    assert kept.made_of(one, maker.make) == one
