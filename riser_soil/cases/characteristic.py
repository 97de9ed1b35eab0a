"""Characteristic extremes: Gumbel's distribution fitted to those of cases that differ in their waves' seed alone.

The extremes of n seeds, each over a time T, follow Gumbel's distribution of location μ and scale β, fitted by maximum
likelihood. Over a duration D the largest value is below μ + β (ln(D/T) − ln(−ln p)) with the probability p; p = 1/e
gives the most probable one, μ + β ln(D/T). Of least values it is that of their negatives.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from rich.markup import escape
from rich.table import Table

from riser_soil.cases.axes import is_seed
from riser_soil.cases.case_file import WantedExtremes
from riser_soil.cases.case_table import CaseTable
from riser_soil.cases.case_values import Sample
from riser_soil.cases.expansion import Case
from riser_soil.core.arrays import Array
from riser_soil.plots.scales import shown
from riser_soil.statistics.extremes import FEWEST, Interval, LocationScale, fit_gumbel


@dataclass(frozen=True, eq=False)
class Group:
    """Cases that differ in the seed of their waves alone. labels: those that they have in common, by axes."""

    name: str
    labels: Mapping[str, str]
    cases: Sequence[Case]


def groups_of(cases: Sequence[Case]) -> list[Group]:
    """Groups of cases, in the cases' order."""
    by_name: dict[str, list[Case]] = {}
    for case in cases:
        by_name.setdefault(case.group, []).append(case)
    return [Group(name, _in_common(own), own) for name, own in by_name.items()]


def _in_common(cases: Sequence[Case]) -> dict[str, str]:
    first, *others = (case.labels for case in cases)
    return {axis: label for axis, label in first.items() if all(other[axis] == label for other in others)}


@dataclass(frozen=True, eq=False)
class CharacteristicExtreme:
    """Characteristic extreme of a quantity of a group. samples: extremes of its seeds (n,) in SI, each over `simulated`
    [s].
    """

    group: Group
    stage: str
    name: str
    unit: str
    least: bool
    samples: Array
    simulated: float
    wanted: WantedExtremes

    @property
    def key(self) -> str:
        """The quantity's key in the table of cases."""
        return f"{self.stage}: {self.name}"

    @property
    def of_seeds(self) -> float:
        """Extreme of all seeds."""
        return float(self.samples.min() if self.least else self.samples.max())

    def worse_than(self, other: CharacteristicExtreme) -> bool:
        """Whether this extreme is worse than another of the same quantity: by the characteristic values, or by those of
        all seeds where there is none.
        """
        mine, others = (
            each.of_seeds if math.isnan(each.characteristic.value) else each.characteristic.value
            for each in (self, other)
        )
        return mine < others if self.least else mine > others

    @property
    def most_probable(self) -> float:
        return self._at(self._longer).value

    @cached_property
    def characteristic(self) -> Interval:
        """Value at the wanted fractile, with its limits of confidence, the lower one first."""
        at = self._at(self._longer - math.log(-math.log(self.wanted.fractile)))
        return Interval(at.value, *sorted((at.low, at.high)))

    @property
    def location(self) -> float:
        return self._sign * self._fit.location

    @property
    def scale(self) -> float:
        return self._fit.scale

    @cached_property
    def _fit(self) -> LocationScale:
        return fit_gumbel(self._sign * self.samples)

    @property
    def _sign(self) -> float:
        return -1.0 if self.least else 1.0

    @property
    def _longer(self) -> float:
        """ln(D/T)."""
        return math.log(self.wanted.duration / self.simulated)

    def _at(self, k: float) -> Interval:
        return Interval(*(self._sign * value for value in self._fit.at(k, self.wanted.confidence)))


def characteristic_extremes(table: CaseTable, wanted: WantedExtremes) -> list[CharacteristicExtreme]:
    """Characteristic extremes of each group with extremes in a dynamic stage, quantities in the table's order."""
    return [each for group in groups_of(table.cases) for each in _of_group(table, group, wanted)]


def _of_group(table: CaseTable, group: Group, wanted: WantedExtremes) -> Iterator[CharacteristicExtreme]:
    for key, value in table.quantities.items():
        samples = [sample for case in group.cases if (sample := _sample(table, case, key)) is not None]
        if samples:
            values = np.array([sample.value for sample in samples])
            simulated = min(sample.duration for sample in samples)
            least = samples[0].least
            yield CharacteristicExtreme(group, value.stage, value.name, value.unit, least, values, simulated, wanted)


def _sample(table: CaseTable, case: Case, key: str) -> Sample | None:
    value = table.values.get(case.name, {}).get(key)
    return None if value is None or value.sample is None or not math.isfinite(value.sample.value) else value.sample


def row_of(extreme: CharacteristicExtreme, axes: Sequence[str]) -> dict[str, Any]:
    """A row of characteristic.csv; nan where seeds are too few."""
    interval = extreme.characteristic
    return {
        "group": extreme.group.name,
        **{axis: extreme.group.labels.get(axis, "") for axis in axes},
        "quantity": extreme.key,
        "unit": extreme.unit,
        "extreme": "least" if extreme.least else "largest",
        "seeds": len(extreme.samples),
        "simulated [s]": extreme.simulated,
        "mean": float(extreme.samples.mean()),
        "standard deviation": float(extreme.samples.std(ddof=1)) if len(extreme.samples) > 1 else math.nan,
        "of seeds": extreme.of_seeds,
        "duration [s]": extreme.wanted.duration,
        "most probable": extreme.most_probable,
        "fractile": extreme.wanted.fractile,
        "characteristic": interval.value,
        "low": interval.low,
        "high": interval.high,
        "confidence": extreme.wanted.confidence,
        "location": extreme.location,
        "scale": extreme.scale,
    }


def governing(extremes: Sequence[CharacteristicExtreme]) -> list[CharacteristicExtreme]:
    """Worst extreme of each quantity, by the characteristic value where there is one."""
    worst: dict[str, CharacteristicExtreme] = {}
    for each in extremes:
        if each.key not in worst or each.worse_than(worst[each.key]):
            worst[each.key] = each
    return list(worst.values())


def governing_table(extremes: Sequence[CharacteristicExtreme]) -> Table:
    """Table for the screen: the worst group of each quantity, in engineering units."""
    wanted, fitted = extremes[0].wanted, any(math.isfinite(each.scale) for each in extremes)
    over = f" in {wanted.duration:g} s" if fitted else ""
    table = Table(title=f"{extremes[0].stage}: extremes{over}, each under what governs", title_justify="left")
    table.add_column("quantity")
    heads = ["extreme"]
    if fitted:
        percent = [f"{100.0 * share:g} %" for share in (wanted.fractile, wanted.confidence)]
        heads = ["of seeds", "most probable", f"{percent[0]} fractile", f"{percent[1]} interval"]
    for head in heads:
        table.add_column(head, justify="right", no_wrap=head.endswith("interval"))
    by_group: dict[str, list[CharacteristicExtreme]] = {}
    for each in governing(extremes):
        by_group.setdefault(each.group.name, []).append(each)
    for name, worst in by_group.items():
        table.add_section()
        table.add_row(f"[bold]{escape(name)}")
        for each in worst:
            table.add_row(*_cells(each)[: len(heads) + 1])
    return table


def _cells(extreme: CharacteristicExtreme) -> list[str]:
    unit, scale = shown(extreme.unit.replace(".", " "))
    numbers = (extreme.of_seeds, extreme.most_probable, *extreme.characteristic)
    of_seeds, most_probable, characteristic, low, high = (_figures(scale * value) for value in numbers)
    interval = f"{low} to {high}" if low and high else ""
    return [escape(f"{extreme.name} [{unit}]"), of_seeds, most_probable, characteristic, interval]


def _figures(value: float) -> str:
    return f"{value:.4g}" if math.isfinite(value) else ""


def warnings_of(extremes: Sequence[CharacteristicExtreme], cases: Sequence[Case]) -> Iterator[str]:
    """Warnings where seeds are too few for a fit."""
    few = {each.group.name for each in extremes if len(each.samples) < FEWEST}
    seeded = any(is_seed(path) for case in cases for path in case.values)
    if few and seeded:
        yield (
            f"warning: {len(few)} of {len({each.group.name for each in extremes})} groups have fewer than {FEWEST} "
            f"seeds, as {min(few)}, and no characteristic extreme; give seeds: {FEWEST} or more"
        )
