"""Folders of load cases, fatigue and modes as commands leave them, made from a recorded run without a solver."""

from __future__ import annotations

import csv
import json
import shutil
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

Changed = Callable[[dict[str, Any]], None]


def write_cases(
    folder: Path, run: Path, axes: Sequence[str], rows: Mapping[str, tuple[Mapping[str, str], Changed]]
) -> None:
    """A folder of riser-soil cases: a copy of the run for each, its summary changed.

    axes: heads of the columns behind the name. rows: values by these heads, and what is done to the summary.
    """
    (folder / "cases").mkdir(parents=True)
    with (folder / "cases.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["case", *axes, "status", "reason", "seconds [s]", "machine"])
        for name, (values, changed) in rows.items():
            writer.writerow([name, *(values.get(axis, "") for axis in axes), "0", "", "1", "here"])
            place = folder / "cases" / name
            shutil.copytree(run, place)
            summary = json.loads((place / "summary.json").read_text(encoding="utf-8"))
            changed(summary)
            (place / "summary.json").write_text(json.dumps(summary), encoding="utf-8")


def scaled(figure: str, factor: float, stage: int = 1) -> Changed:
    """Multiplies a figure's extremes in a stage of a summary."""

    def change(summary: dict[str, Any]) -> None:
        extremes = summary["stages"][stage]["extremes"][figure]
        for side in ("min", "max"):
            extremes[side] *= factor

    return change


def write_fatigue(folder: Path, arc: Sequence[float], damage: Sequence[float], **design: Any) -> None:
    """A folder of riser-soil fatigue with two points around each section, of which the second has a tenth."""
    folder.mkdir()
    with (folder / "fatigue.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["arc_m", "angle_deg", "diameter_m", "thickness_m", "damage_per_year", "life_years"])
        for s, largest in zip(arc, damage, strict=True):
            for angle, share in ((90.0, 1.0), (270.0, 0.1)):
                life = 1.0 / (share * largest) if largest else float("inf")
                writer.writerow([s, angle, 0.3, 0.02, share * largest, life])
    worst = max(damage)
    sea = {"height": 3.0, "period": 9.0, "direction_deg": 180.0}
    each = {"seconds": 600.0, "standard_error": 0.1, "touchdown_arc": [28.0, 33.0], "sea": sea}
    numbers = {
        "curve": {"name": "DNV D, air", "source": "DNVGL-RP-C203 (April 2016), Table 2-1"},
        "stress_concentration": 1.2, "factor_on_ranges": 1.25, "surface": "outer", "points": 2, "share": 0.9,
        "largest": {"damage_per_year": worst, "standard_error": 0.079},
        "design": {"life_years": None, "fatigue_factor": 1.0, "utilisation": None} | design,
        "cases": [
            {"run": "../results/sea_states/calm", "share": 0.7, "damage_per_year": 0.25 * worst} | each,
            {"run": "/home/someone/storm", "share": 0.2, "damage_per_year": 0.75 * worst} | each,
        ],
        "warnings": [],
    }  # fmt: skip
    (folder / "fatigue.json").write_text(json.dumps(numbers), encoding="utf-8")
