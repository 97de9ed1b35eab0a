"""Questions for a draft's kind and numbers, with their defaults."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from riser_soil.drafts.kinds import KINDS, kind_of
from riser_soil.drafts.wishes import GROUNDS, Wishes

Prompt = Callable[..., Any]


def ask(given: Wishes, prompt: Prompt) -> tuple[str, Wishes]:
    """The kind, and the wishes with answers to what is not given.

    prompt: text, default -> answer, of the default's type.
    """
    name = prompt(f"kind ({', '.join(KINDS)})", default=next(iter(KINDS)))
    kind = kind_of(name)
    questions: dict[str, tuple[str, float | str]] = {
        "depth": ("depth of the water [m]", kind.depth),
        "diameter": ("outer diameter, of chain that of its bar [m]", kind.diameter),
        "Hs": ("significant wave height, 0 for none [m]", kind.Hs),
    }
    if kind.hangs:
        questions["ground"] = (f"ground ({', '.join(GROUNDS)})", GROUNDS[0])
    open_ones = {key: question for key, question in questions.items() if getattr(given, key) is None}
    return name, replace(given, **{key: prompt(text, default=value) for key, (text, value) in open_ones.items()})
