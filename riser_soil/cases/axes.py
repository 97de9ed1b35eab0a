"""Axes of a case file: the parameters that are varied, each with its points.

Short keys of the case file become paths of the scene: `sea_states`, `directions` and `seeds` those of the base scene's
waves, `offsets` that of the vessel.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from riser_soil.cases.case_file import PERCENT, Cases
from riser_soil.core.quantities import FLATTEST
from riser_soil.errors import SceneError
from riser_soil.scene.document import Document
from riser_soil.scene.water import ALONE, KINDS
from riser_soil.variants.variant import Overrides

SEED = "seed"
_WITH_SEED = ("jonswap", "pierson_moskowitz", "spectrum")
_TRAINS = ALONE[1]


@dataclass(frozen=True)
class Point:
    """Point of an axis. name: its part of the case's name. label: its name on the axis. values: that it sets, by paths.

    in_common: its part of the name of a group of cases that differ in seeds alone; by default its name if it sets no
    seed, else nothing.
    """

    name: str
    label: str
    values: Overrides
    in_common: str | None = None

    @property
    def group(self) -> str:
        """A value's part of the name of a group of cases that differ in seeds alone."""
        if self.in_common is not None:
            return self.in_common
        return "" if any(map(is_seed, self.values)) else self.name


@dataclass(frozen=True)
class CaseAxis:
    """A parameter, or several together, that cases vary."""

    name: str
    points: Sequence[Point]

    @property
    def paths(self) -> set[str]:
        """Paths of all values that its points set."""
        return {path for point in self.points for path in point.values}


def is_seed(path: str) -> bool:
    """Whether a path of the scene is that of a seed of waves."""
    return path.rpartition(".")[2] == SEED


def axes_of(file: Path, case_file: Cases, base: Document) -> list[CaseAxis]:
    """Axes in their order, the last one's points changing first. base: the base scene, with the values of all cases.

    Raises SceneError for a key that does not suit the base scene, and for a path that two axes set.
    """
    short = _short_names([*case_file.product, *(path for row in case_file.table for path in row.values)])
    axes = [*_of_table(case_file, short), *_of_waves(file, case_file, base)]
    if case_file.offsets is not None:
        axes.append(_of_offsets(file, case_file.offsets, base))
    if case_file.soil:
        axes.append(CaseAxis("soil", [Point(name, name, values) for name, values in case_file.soil.items()]))
    axes += [CaseAxis(path, _points(path, values, short)) for path, values in case_file.product.items()]
    axes.sort(key=lambda axis: axis.name == SEED)  # it changes first
    _refuse_twice(file, axes)
    return axes


def _refuse_twice(file: Path, axes: Sequence[CaseAxis]) -> None:
    for path, times in Counter(path for axis in axes for path in axis.paths).items():
        if times > 1:
            raise SceneError(f"{file}: {path}: is set {times} times in one case; let one key alone set it")


def _of_table(case_file: Cases, short: Mapping[str, str]) -> list[CaseAxis]:
    points = []
    for row in case_file.table:
        name = row.name or _name(row.values, short)
        others = {path: value for path, value in row.values.items() if not is_seed(path)}
        in_common = name if len(others) == len(row.values) else _name(others, short)
        points.append(Point(name, name, row.values, in_common))
    return [CaseAxis("table", points)] if points else []


def _of_waves(file: Path, case_file: Cases, base: Document) -> Iterator[CaseAxis]:
    if case_file.sea_states:
        waves = _Waves(file, "sea_states", base)
        states = {name: {waves.path(key): v for key, v in own.items()} for name, own in case_file.sea_states.items()}
        yield CaseAxis("sea state", [Point(name, name, values) for name, values in states.items()])
    if case_file.directions:
        path = _Waves(file, "directions", base).path("direction_deg")
        yield CaseAxis("direction", [Point(f"direction={x:g}", f"{x:g}", {path: x}) for x in case_file.directions])
    if case_file.seeds is not None:
        path = _Waves(file, "seeds", base).path(SEED)
        numbers = range(1, case_file.seeds + 1) if isinstance(case_file.seeds, int) else case_file.seeds
        yield CaseAxis(SEED, [Point(f"seed={n}", str(n), {path: n}) for n in numbers])


@dataclass(frozen=True)
class _Waves:
    """Waves of the base scene, for a key of the case file."""

    file: Path
    key: str
    base: Document

    def path(self, key: str) -> str:
        """Path in the scene of a key of the waves; a path in the scene stays as it is."""
        return key if "." in key else f"water.waves.{self._kind}.{key}"

    @property
    def _kind(self) -> str:
        waves = _under(self.base.data, "water", "waves")
        given = [kind for kind in (*KINDS, *ALONE) if isinstance(waves, dict) and waves.get(kind) is not None]
        if len(given) != 1:
            waves = "has no waves" if not given else f"has waves of several kinds, {', '.join(given)}"
            raise SceneError(f"{self.file}: {self.key}: the base scene {waves}; give it one kind under water.waves")
        (kind,) = given
        if kind == _TRAINS:
            remedy = "set them by product, as water.waves.trains.0.jonswap.seed: [1, 2, 3]"
            raise SceneError(f"{self.file}: {self.key}: the base scene has several trains of waves; {remedy}")
        if self.key == "seeds" and kind not in _WITH_SEED:
            remedy = f"leave seeds out, or take waves of {', '.join(_WITH_SEED)}"
            raise SceneError(f"{self.file}: seeds: the base scene's waves are {kind}, which have no seed; {remedy}")
        return kind


def _of_offsets(file: Path, given: float | str | Mapping[str, Sequence[float]], base: Document) -> CaseAxis:
    if isinstance(given, Mapping):
        places = {name: [*place] for name, place in given.items()}
    else:
        distance = _of_depth(file, given, base) if isinstance(given, str) else given
        x, y = _away(file, base)
        places = {
            name: [sign * distance * x + 0.0, sign * distance * y + 0.0, 0.0]
            for name, sign in (("near", -1.0), ("mean", 0.0), ("far", 1.0))
        }
    return CaseAxis("offset", [Point(name, name, {"vessel.offset": place}) for name, place in places.items()])


def _of_depth(file: Path, share: str, base: Document) -> float:
    """Distance [m] by a share of the water depth, as `5 %`."""
    surface, level = (_under(base.data, *path) for path in (("water", "surface_level"), ("seabed", "level")))
    uneven = any(_under(base.data, "seabed", key) is not None for key in ("profile", "grid", "slope_deg"))
    depth = surface - (level or 0.0) if _is_number(surface) and not uneven else _under(base.data, "water", "depth")
    percent = PERCENT.fullmatch(share)
    if percent is None or not _is_number(depth) or depth <= 0.0:
        needs = f"{share} of the water depth needs water.depth, or water.surface_level above a level seabed"
        raise SceneError(f"{file}: offsets: {needs}; give them, or a distance [m]")
    return round(float(percent[1]) * depth / 100.0, 9)


def _away(file: Path, base: Document) -> tuple[float, float]:
    """Horizontal unit vector from the riser's other end to the one that hangs from the vessel."""
    ends = {name: _under(base.data, "riser", name, "position") for name in ("start", "end")}
    remedy = "give them by name, offsets: {near: [dx, dy], far: [dx, dy]}"
    if not all(isinstance(end, list) and len(end) == 3 and all(map(_is_number, end)) for end in ends.values()):
        needs = "as a distance they need riser.start.position and riser.end.position in the base scene"
        raise SceneError(f"{file}: offsets: {needs}; {remedy}")
    upper = _vessel_end(base.data) or max(ends, key=lambda name: ends[name][2])
    lower = "end" if upper == "start" else "start"
    dx, dy = (ends[upper][k] - ends[lower][k] for k in (0, 1))
    if (length := math.hypot(dx, dy)) < FLATTEST:
        why = "the riser's ends are above each other, so near and far are no places"
        raise SceneError(f"{file}: offsets: {why}; {remedy}")
    return round(dx / length, 12), round(dy / length, 12)


def _vessel_end(data: Any) -> str | None:
    ends = _under(data, "vessel", "ends")
    return str(ends[0]) if ends in (["start"], ["end"]) else None


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _under(data: Any, *keys: str) -> Any:
    """Value at a path of mappings; None where there is none."""
    for key in keys:
        data = data.get(key) if isinstance(data, dict) else None
    return data


def _points(path: str, values: Sequence[Any] | Mapping[str, Overrides], short: Mapping[str, str]) -> list[Point]:
    if isinstance(values, Mapping):
        return [Point(name, name, group) for name, group in values.items()]
    names = [_value_name(path, value, n, short) for n, value in enumerate(values, start=1)]
    labels = [name.removeprefix(f"{short[path]}=") for name in names]
    return [Point(name, label, {path: v}) for name, label, v in zip(names, labels, values, strict=True)]


def _name(values: Overrides, short: Mapping[str, str]) -> str:
    return "-".join(_value_name(path, value, None, short) for path, value in values.items())


def _value_name(path: str, value: Any, number: int | None, short: Mapping[str, str]) -> str:
    """Name of a value: `Hs=6.5`, `kind=rigid`; for lists and mappings by its number among the values: `position_2`."""
    if isinstance(value, list | dict) and number is not None:
        return f"{short[path]}_{number}"
    text = f"{value:g}" if isinstance(value, float) and float(f"{value:g}") == value else str(value)
    return short[path] + "=" + re.sub(r"[^\w.+-]+", "_", text, flags=re.ASCII).strip("_")


def _short_names(paths: Sequence[str]) -> dict[str, str]:
    """Short names by paths: the last keys that are unique, of which the first is no index of a list."""
    unique = list(dict.fromkeys(paths))
    names = {}
    for path in unique:
        words = path.split(".")
        endings = (words[-n:] for n in range(1, len(words) + 1))
        distinct = (e for e in endings if not e[0].isdecimal() and sum(_ends(other, e) for other in unique) == 1)
        names[path] = re.sub(r"[^\w]+", "_", "_".join(next(distinct, words)), flags=re.ASCII)
    return names


def _ends(path: str, words: list[str]) -> bool:
    return path.split(".")[-len(words) :] == words
