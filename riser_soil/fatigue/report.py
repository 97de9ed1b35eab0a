"""What an assessment tells: on the screen; in its folder a table of all points, numbers, and a picture."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from riser_soil import __version__
from riser_soil.fatigue.assessment import YearlyDamage
from riser_soil.results.summary import plain_json
from riser_soil.results.whole_file import written_together

FILES = TABLE, NUMBERS, PICTURE = "fatigue.csv", "fatigue.json", "fatigue.png"
COLUMNS = ("arc_m", "angle_deg", "diameter_m", "thickness_m", "damage_per_year", "life_years")


def write_folder(folder: Path, damage: YearlyDamage, plot: bool) -> None:
    """All files together, none of them by halves; an earlier picture goes where none is drawn."""
    with written_together(folder, FILES if plot else FILES[:2]) as made:
        with (made / TABLE).open("w", newline="", encoding="utf-8") as file:
            csv.writer(file, lineterminator="\n").writerows(_rows(damage))
        (made / NUMBERS).write_text(json.dumps(plain_json(as_dict(damage)), indent=2) + "\n", encoding="utf-8")
        if plot:
            _draw(made / PICTURE, damage)
    if not plot:
        (folder / PICTURE).unlink(missing_ok=True)


def life(damage: float) -> float:
    """Years; inf without damage."""
    return 1.0 / damage if damage > 0.0 else math.inf


def _rows(yearly: YearlyDamage) -> Iterator[list[str]]:
    yield [*COLUMNS]
    diameters = yearly.wall[0 if yearly.given.surface == "outer" else 1]
    for s, (arc, diameter, thickness) in enumerate(zip(yearly.arc, diameters, yearly.wall.thickness, strict=True)):
        for p, angle in enumerate(np.degrees(yearly.how.angles)):
            damage = float(yearly.per_year[s, p])
            numbers = arc, angle, diameter, thickness, damage, life(damage)
            yield [f"{number:.10g}" for number in numbers]


def as_dict(damage: YearlyDamage) -> dict[str, Any]:
    """The numbers of fatigue.json; null stands for a life without end."""
    section, point = damage.worst
    largest = float(damage.per_year[section, point])
    curve, how = damage.how.curve, damage.how
    cases = [
        {
            "run": each.case.run,
            "share": each.case.share,
            "seconds": each.seconds,
            "mean_period": each.period,
            "records_per_period": each.records,
            "standard_error": each.scatter,
            "damage_per_year": float(each.per_year[section, point]),
            "touchdown_arc": list(each.touchdown),
            "sea": dict(each.sea),
        }
        for each in damage.cases
    ]
    return {
        "version": __version__,
        "curve": {
            "name": curve.name,
            "source": curve.source,
            "log_a": list(curve.log_a),
            "m": list(curve.m),
            "change": list(curve.change),
            "thickness_exponent": curve.k,
            "reference_thickness": curve.reference,
        },
        "stress_concentration": how.stress_concentration,
        "factor_on_ranges": how.factor(float(damage.wall.thickness[section])),
        "surface": how.surface,
        "points": how.points,
        "load_classes": how.load_classes,
        "share": damage.given.total_share,
        "largest": {
            "arc": float(damage.arc[section]),
            "angle_deg": float(np.degrees(how.angles[point])),
            "damage_per_year": largest,
            "life_years": life(largest),
            "standard_error": damage.standard_error,
        },
        "design": {
            "life_years": damage.given.design_life,
            "fatigue_factor": damage.given.design_fatigue_factor,
            "utilisation": damage.utilisation,
        },
        "cases": cases,
        "warnings": [*damage.warnings()],
    }


def result_lines(damage: YearlyDamage) -> list[str]:
    """For the screen: the largest damage, each case's part of it, what to doubt."""
    section, point = damage.worst
    largest = float(damage.per_year[section, point])
    curve = damage.how.curve
    angle = np.degrees(damage.how.angles[point])
    where = f"arc {damage.arc[section]:.5g} m, {angle:g} degrees around, {damage.how.surface} surface"
    lines = [
        f"S-N curve {curve.name}: {curve.source}",
        f"stress ranges times {damage.how.factor(float(damage.wall.thickness[section])):.4g} (SCF and thickness there)",
        f"largest damage {largest:.4g} a year, life {life(largest):.4g} years, at {where}",
        f"standard error of this damage: {damage.standard_error:.0%}, by the quarters of each simulation",
    ]
    for each in damage.cases:
        part = float(each.per_year[section, point])
        lines.append(f"  {each.case.run}: {100.0 * each.case.share:.4g} % of the year, damage {part:.4g}")
    if damage.utilisation is not None:
        years, factor = damage.given.design_life, damage.given.design_fatigue_factor
        lines.append(f"damage in {years:g} years times {factor:g}: {damage.utilisation:.4g}")
    return [*lines, *(f"warning: {text}" for text in damage.warnings())]


def _draw(png: Path, yearly: YearlyDamage) -> None:
    from riser_soil.plots.fatigue_life import Damage, draw_damage

    zone, given = np.array([each.touchdown for each in yearly.cases]), yearly.given
    reach = (np.nanmin(zone), np.nanmax(zone)) if np.isfinite(zone).any() else None
    required = None if given.design_life is None else given.design_life * given.design_fatigue_factor
    damage = Damage(yearly.arc, np.degrees(yearly.how.angles), yearly.per_year, reach, required)
    draw_damage(png, damage, result_lines(yearly)[:3])
