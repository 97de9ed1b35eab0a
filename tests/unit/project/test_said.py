"""Tell-tales of messages: found in any order on one line, and not within a longer word, path or number."""

from __future__ import annotations

import pytest

from tests.support.said import line_with, lines_with

TEXT = "soil.law.su: value -1250.5 m, too long\nelements of 250 m at arc 875 m are too long\n"


def test_one_line_has_all() -> None:
    assert line_with(TEXT, "too long", "arc 875 m", "250 m").startswith("elements")
    assert line_with(TEXT.splitlines(), "soil.law.su:", "-1250.5 m").startswith("soil")


@pytest.mark.parametrize("part", ["50 m", "1250.5 m", "-1250", "law.su", "soil.law", "su", "long\nelements", "short"])
def test_part_of_a_number_or_a_path_is_none(part: str) -> None:
    assert lines_with(TEXT, part) == []


def test_no_line_or_several_are_an_error() -> None:
    for words in (("too long",), ("soil.law.su", "250 m")):
        with pytest.raises(AssertionError, match="lines, not 1"):
            line_with(TEXT, *words)
