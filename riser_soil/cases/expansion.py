"""Expansion of a case file: all combinations of points of its axes, each a checked variant of the base scene."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import product
from pathlib import Path

from riser_soil.cases.axes import CaseAxis, Point, axes_of, is_seed
from riser_soil.cases.case_file import MOST_LETTERS, Cases, is_name, read_case_file
from riser_soil.errors import SceneError
from riser_soil.variants.variant import BaseScene, Overrides, Variant, variant_of

MOST_CASES = 100_000
MOST_LINES = 20
_NONE = Variant("", "")  # variant of a case whose scene is not made yet
_PLACE = "<case>"  # place of a mistake before it is known which cases have it


@dataclass(frozen=True)
class Case:
    """A case. values: by paths, that differ from the base scene. labels: of its points, by axes. variant: its scene.

    group: name of the group of cases that differ from it in their seed alone.
    """

    name: str
    values: Overrides
    labels: Mapping[str, str] = field(default_factory=dict)
    group: str = ""
    variant: Variant = _NONE

    @property
    def group_labels(self) -> tuple[str, ...]:
        """Labels on all axes but that of the seeds."""
        return tuple(label for axis, label in self.labels.items() if not is_seed(axis))


def read_cases(file: Path, overrides: Sequence[str] = ()) -> tuple[Cases, list[Case]]:
    """The cases of a file, all scenes checked; overrides: of the base scene. SceneError has one line per problem."""
    case_file = read_case_file(file)
    base = BaseScene.read(case_file.base, overrides, case_file.values, f"{file}: set")
    cases, problems = [], dict[str, list[str]]()  # problems, with the cases that have them
    for case in named_cases(file, axes_of(file, case_file, base.document)):
        try:
            cases.append(replace(case, variant=variant_of(base.with_values(case.values, _PLACE))))
        except SceneError as err:
            for line in str(err).splitlines():
                problems.setdefault(line, []).append(case.name)
    if problems:
        lines = [_problem(file, line, names) for line, names in problems.items()]
        more = len(problems) - MOST_LINES
        raise SceneError("\n".join([*lines[:MOST_LINES], *([f"… and {more} more"] if more > 0 else [])]))
    return case_file, cases


def _problem(file: Path, line: str, names: Sequence[str]) -> str:
    """One line for a mistake, however many cases have it; one of the base scene has its own place."""
    others = f" and {len(names) - 1} more" if len(names) > 1 else ""
    return line.replace(_PLACE, f"{file}: case {names[0]}{others}:", 1)


def named_cases(file: Path, axes: Sequence[CaseAxis]) -> list[Case]:
    """All combinations in their order, the last axis changing first; SceneError where names coincide."""
    count = math.prod(len(axis.points) for axis in axes)
    if count > MOST_CASES:
        raise SceneError(f"{file}: {count} cases, more than {MOST_CASES}; divide them over several files")
    names = [axis.name for axis in axes]
    cases = [_together(names, points) for points in product(*(axis.points for axis in axes))]
    for name, times in Counter(case.name for case in cases).items():
        if times > 1:
            raise SceneError(f"{file}: {times} cases would be named {name}; give rows and groups names of their own")
        if not is_name(name):
            raise SceneError(f"{file}: case {name}: more than {MOST_LETTERS} letters; give rows and groups short names")
    return cases


def _together(axes: Sequence[str], points: Sequence[Point]) -> Case:
    values = {path: value for point in points for path, value in point.values.items()}
    labels = {axis: point.label for axis, point in zip(axes, points, strict=True)}
    group = "-".join(part for point in points if (part := point.group))
    return Case("-".join(point.name for point in points), values, labels, group or "all seeds")
