"""Stress cases: scenes with what is known of their answers, registered by their functions' names."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from riser_soil.results import Run
from tests.robustness.stress.bounds import Answer

Runs = Mapping[str, Run]


@dataclass(frozen=True)
class Trial:
    """Scenes by name, and the answers of their runs. may_tell: pattern of a message that counts as an answer, too.

    files: content of other files by name, beside the scenes.
    """

    scenes: dict[str, dict[str, Any]]
    answers: Callable[[Runs], Iterable[Answer]]
    may_tell: str | None = None
    files: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class StressCase:
    """about: what is extreme and what is known of it, the docstring. quick: among those of the normal suite. cpu: s."""

    name: str
    about: str
    make: Callable[[], Trial]
    quick: bool
    cpu: int


CASES: dict[str, StressCase] = {}


def stress_case(
    *, name: str = "", quick: bool = False, cpu: int = 60
) -> Callable[[Callable[[], Trial]], Callable[[], Trial]]:
    """Register a function that makes a trial; its docstring tells what is extreme and derives the answer."""

    def registered(make: Callable[[], Trial]) -> Callable[[], Trial]:
        title = (name or make.__name__).replace("_", " ")
        assert title not in CASES, f"two cases {title}"
        CASES[title] = StressCase(title, inspect.getdoc(make) or "", make, quick, cpu)
        return make

    return registered


def one(scene: dict[str, Any], answers: Callable[[Run], Iterable[Answer]], may_tell: str | None = None) -> Trial:
    """A trial of one scene."""

    def of_all(runs: Runs) -> Iterator[Answer]:
        (run,) = runs.values()
        yield from answers(run)

    return Trial({"scene": scene}, of_all, may_tell)
