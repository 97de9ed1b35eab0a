"""What messages tell: place, value and kind, by short tell-tales on one line, whatever its other words."""

from __future__ import annotations

import re
from collections.abc import Iterable


def telling(*words: str) -> str:
    """A pattern for a line in which all of these stand, in any order, none as part of a longer word, path or number."""
    return "(?m)^" + "".join(f"(?=.*{_whole(word)})" for word in words)


def lines_with(text: str | Iterable[str], *words: str) -> list[str]:
    """Lines of a text, or of several, in which all of these stand so."""
    lines = text.splitlines() if isinstance(text, str) else text
    return [line for line in lines if re.search(telling(*words), line)]


def line_with(text: str | Iterable[str], *words: str) -> str:
    """The only one of them."""
    lines = text.splitlines() if isinstance(text, str) else [*text]
    matches = lines_with(lines, *words)
    assert len(matches) == 1, f"{len(matches)} lines, not 1, with {words} in {lines}"
    return matches[0]


def _whole(word: str) -> str:
    before = r"(?<![\w.+-])" if re.match(r"[\w+-]", word) else ""
    after = r"(?!\w|[.,]\w)" if re.search(r"\w$", word) else ""
    return before + re.escape(word) + after
