"""Chapter on fatigue: life along the arc, hotspots, required life and factor, share of each sea state."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.plots.curves import Curves
from riser_soil.plots.fatigue_life import Damage, life_sheet
from riser_soil.report.document import Block, Paragraph, PictureBlock, Points, ReportSection, TableBlock, ref
from riser_soil.report.sources import Sources
from riser_soil.report.tables import ReportTable, number, without_paths

MOST_HOTSPOTS, MOST_ROWS = 5, 20
_LONGEST = 1e6  # years: a life beyond it is told as more than that
_LEAST = 1e-3  # of the largest damage: a hotspot has at least this
_APART = 0.02  # of the line's length: hotspots that are nearer are one


@dataclass(frozen=True, eq=False)
class FatigueResults:
    """An assessment with the life that is required: what the report file gives, else what the fatigue file does."""

    numbers: Mapping[str, Any]
    damage: Damage
    required_life: float | None
    factor: float

    @property
    def life(self) -> Array:
        """Years (ns,), the shortest around each section; inf without damage."""
        with np.errstate(divide="ignore"):
            return np.asarray(1.0 / self.damage.largest)

    @property
    def utilisation(self) -> float | None:
        """Required life times DFF over the shortest life; None where no life is required."""
        if self.required_life is None:
            return None
        return float(self.required_life * self.factor * self.damage.per_year.max())

    @cached_property
    def hotspots(self) -> list[int]:
        """Sections of the largest damages: each is more than its neighbours', and apart from the others."""
        arc, damage, spots = self.damage.arc, self.damage.largest, list[int]()
        apart = _APART * float(np.ptp(arc))
        beside = np.maximum(np.append(damage[1:], 0.0), np.append(0.0, damage[:-1]))
        for n in np.argsort(-damage):
            peak = damage[n] > _LEAST * damage.max() and damage[n] >= beside[n]
            if peak and all(abs(arc[n] - arc[other]) > apart for other in spots):
                spots.append(int(n))
            if len(spots) == MOST_HOTSPOTS:
                break
        return spots


def fatigue_of(sources: Sources) -> FatigueResults | None:
    """The assessment that the report names; None without one."""
    numbers, rows = sources.fatigue, sources.damage
    if numbers is None:
        return None
    arc, angle = (np.array(list(dict.fromkeys(rows[name]))) for name in ("arc_m", "angle_deg"))
    per_year = np.array(rows["damage_per_year"]).reshape(len(arc), len(angle))
    design, given = numbers["design"], sources.given
    life = design["life_years"] if given.required_life is None else given.required_life
    factor = design["fatigue_factor"] if given.design_fatigue_factor is None else given.design_fatigue_factor
    zones = [each["touchdown_arc"] for each in numbers["cases"] if None not in each["touchdown_arc"]]
    reach = (min(low for low, _ in zones), max(high for _, high in zones)) if zones else None
    damage = Damage(arc, angle, per_year, reach, None if life is None else life * factor)
    return FatigueResults(numbers, damage, life, factor)


def chapter(sources: Sources) -> ReportSection:
    results = fatigue_of(sources)
    return ReportSection("Fatigue", [] if results is None else [*_blocks(results)])


def years(life: float) -> str:
    return f"> {_LONGEST:.0e}".replace("e+0", "e") if life > _LONGEST else number(life, 3)


def _blocks(results: FatigueResults) -> Iterator[Block]:
    curve, numbers = results.numbers["curve"], results.numbers
    yield Paragraph(
        f"Rainflow cycles of the stress along the pipe, S-N curve {curve['name']} ({curve['source']}), Miner's sum, at "
        f"{numbers['points']} points around the {numbers['surface']} surface. Stress concentration factor "
        f"{number(numbers['stress_concentration'])}; with the thickness correction ranges are multiplied by "
        f"{number(numbers['factor_on_ranges'], 4)} at the hotspot. Mean stress has no influence."
    )
    yield Paragraph(_verdict(results), "warning" if (results.utilisation or 0.0) > 1.0 else "")
    yield TableBlock("Fatigue hotspots", _hotspots(results), words=0, key="hotspots")
    yield TableBlock("Fatigue life along the line", _life_table(results), words=0, key="life")
    yield TableBlock("Share of each sea state in the damage at the hotspot", _shares(results), key="shares")
    yield PictureBlock(
        f"Fatigue life along the line, and damage in a year near the TDP and around the hotspot ({ref('hotspots')})",
        Curves(partial(life_sheet, results.damage)),
    )
    warnings = [without_paths(text) for text in numbers["warnings"]]
    if warnings:
        yield Points(warnings, "warning")


def _verdict(results: FatigueResults) -> str:
    n = results.damage.hotspot
    life = float(results.life[n])
    if not math.isfinite(life):
        return "There is no damage."
    error = results.numbers["largest"].get("standard_error")
    by = "by those of the sea states"
    uncertain = "" if error is None else f" The damage's standard error is {100.0 * error:.0f} %, {by}."
    where = f"at arc length {number(results.damage.arc[n], 5)} m"
    if results.required_life is None:
        return f"The shortest life is {years(life)} years, {where}. No required life is given.{uncertain}"
    needed = results.required_life * results.factor
    enough = "fulfilled" if life >= needed else "not fulfilled"
    return (
        f"The shortest life is {years(life)} years, {where}. Required are {number(results.required_life)} years with a "
        f"design fatigue factor (DFF) of {number(results.factor)}, that is {number(needed)} years: {enough}, "
        f"utilisation {number(results.utilisation, 3)}.{uncertain}"
    )


def _hotspots(results: FatigueResults) -> ReportTable:
    rows = []
    for rank, n in enumerate(results.hotspots, 1):
        angle = results.damage.angles[int(results.damage.per_year[n].argmax())]
        damage = float(results.damage.largest[n])
        row = [str(rank), number(results.damage.arc[n], 5), number(angle, 4), number(damage, 3), years(1.0 / damage)]
        rows.append([*row, *_use(results, damage)])
    return ReportTable(_head(results, ("hotspot", "arc length [m]", "angle [°]")), rows, _use_note(results))


def _head(results: FatigueResults, first: tuple[str, ...]) -> tuple[str, ...]:
    use = ("utilisation [-]",) if results.required_life else ()
    return (*first, "damage in a year [1/year]", "life [years]", *use)


def _use(results: FatigueResults, damage: float) -> list[str]:
    return [number(results.required_life * results.factor * damage, 3)] if results.required_life else []


def _use_note(results: FatigueResults) -> str:
    use = "Utilisation: required life times DFF over life. " if results.required_life else ""
    return f"{use}Angles count around the section: 0° left, 90° up, 270° down."


def _life_table(results: FatigueResults) -> ReportTable:
    """Table of life at even steps along the line, and at the hotspots."""
    count = len(results.damage.arc)
    even = np.unique(np.linspace(0, count - 1, min(MOST_ROWS, count)).round().astype(int))
    chosen = sorted({*even.tolist(), *results.hotspots})
    rows = []
    for n in chosen:
        damage = float(results.damage.largest[n])
        life = math.inf if damage == 0.0 else 1.0 / damage
        mark = "hotspot" if n in results.hotspots else ""
        rows.append([number(results.damage.arc[n], 5), number(damage, 3), years(life), *_use(results, damage), mark])
    return ReportTable((*_head(results, ("arc length [m]",)), ""), rows, "The shortest life around each section.")


def _shares(results: FatigueResults) -> ReportTable:
    cases = results.numbers["cases"]
    whole = sum(case["damage_per_year"] for case in cases) or math.nan
    rows = []
    for case in sorted(cases, key=lambda each: -each["damage_per_year"]):
        scatter = f"{100.0 * case['standard_error']:.0f}"
        damage, share = case["damage_per_year"], 100.0 * case["damage_per_year"] / whole
        row = [case["run"], number(100.0 * case["share"], 4), number(damage, 3), number(share, 3)]
        rows.append([*row, scatter])
    head = ("sea state", "share of the year [%]", "damage in a year [1/year]", "share of the damage [%]",
            "standard error [%]")  # fmt: skip
    return ReportTable(head, rows, "The standard error is that by the four quarters of each simulation.")
