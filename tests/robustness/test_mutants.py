"""Places at which mutants are made are in the package once, and the tests that must notice are there."""

from __future__ import annotations

from tests.robustness.mutants.run import REPOSITORY, places


def test_the_package_has_each_place_once() -> None:
    for place in places():
        place.mutated((REPOSITORY / place.path).read_text(encoding="utf-8"))
        assert [file for file in place.files if not (REPOSITORY / file).exists()] == []
