"""A client's report on a riser by one command: load cases, fatigue, modes, report.

Usage, in the project's folder: python -m demos.client_report.run [--workers N] [--folder FOLDER] [--page]
The folder has the input files, by default this one, of a steel catenary riser; its `results` get runs, tables and
report.html, .pdf and .docx. Steps whose file is not in the folder are skipped: a riser without S-N data has no
fatigue.yaml. After an interruption the same call goes on. --page begins anew, and writes the tables where the folder's
README.md shows them.
"""

from __future__ import annotations

import argparse
import csv
import json
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from demos.page import publish, table
from riser_soil.errors import RiserSoilError
from riser_soil.results.read import Run

HERE = Path(__file__).parent
MATRICES = {
    "at_rest": "at rest on both soils",
    "storms": "storms: three offsets, two soils, three seeds",
    "sea_states": "sea states for fatigue",
}
BY_TIME = ("storms", "sea_states")
FORMATS = ("html", "pdf", "docx")
EXTREMES = {  # of the storms: row of extremes.csv, side, factor to the unit of the page, digits
    "largest utilisation by the code": ("waves: code utilisation", "largest", 1.0, 3),
    "of it, bend radius": ("waves: bend radius utilisation", "largest", 1.0, 3),
    "largest bending moment [kN m]": ("waves: largest bending moment", "largest", 1e-3, 1),
    "top tension [kN]": ("waves: top tension", "largest", 1e-3, 0),
    "least effective tension [kN]": ("waves: least effective tension", "least", 1e-3, 0),
}


def main(folder: Path, workers: int, write_page: bool) -> None:
    results = folder / "results"
    if write_page:
        shutil.rmtree(results, ignore_errors=True)
    results.mkdir(exist_ok=True)
    seconds = {step: timed(command) for step, command in commands(folder, workers).items()}
    rows = [(words(results, step), f"{each:.0f}") for step, each in seconds.items()]
    rows.append(("all", f"{sum(seconds.values()):.0f}"))
    times = table(("step", f"seconds, workers: {workers}"), rows)
    texts = {"found": governing_values(results), "seconds": times}
    publish(texts, results, folder / "README.md" if write_page else None)
    print(f"\nthe report is {results / 'report.html'}, also as .pdf and .docx")


def commands(folder: Path, workers: int) -> dict[str, list[str]]:
    """Arguments of `riser-soil` by the step's name, in their order, of the steps that have a file in the folder."""
    results, jobs = folder / "results", ("--jobs", str(workers))
    steps = {  # name: kind of command, file, output, options
        **{name: ("cases", name, name, *jobs) for name in MATRICES},
        "fatigue": ("fatigue", "fatigue", "damage", "--force"),
        "modes": ("modes", "scene", "modes", "--force"),
        **{f"report, {ending}": ("report", "report", f"report.{ending}") for ending in FORMATS},
    }
    return {
        step: [kind, str(folder / f"{file}.yaml"), "-o", str(results / output), *options]
        for step, (kind, file, output, *options) in steps.items()
        if (folder / f"{file}.yaml").is_file()
    }


def timed(command: list[str]) -> float:
    """Runs `riser-soil` with these arguments; wall time [s]. RiserSoilError where it fails, after its own words."""
    print(f"\nriser-soil {' '.join(command)}", flush=True)
    began = time.perf_counter()
    status = subprocess.run([sys.executable, "-m", "riser_soil", *command], check=False).returncode
    if status:
        raise RiserSoilError(f"riser-soil {command[0]} ended with exit status {status}")
    return time.perf_counter() - began


def words(results: Path, step: str) -> str:
    """A step as the page calls it; load cases with their number and the time that each simulates."""
    if step not in MATRICES:
        return step
    runs, seconds = simulated(results, step)
    return f"{MATRICES[step]}, {runs} runs{f' of {seconds:,.0f} s' if seconds else ''}"


def simulated(results: Path, name: str) -> tuple[int, float]:
    """How many runs a folder of load cases has, and the time [s] that the last of them simulates."""
    names = [row["case"] for row in _rows(results / name / "cases.csv")]
    return len(names), float(Run(results / name / "cases" / names[-1]).time[-1])


def governing_values(results: Path) -> str:
    """What governs, as a table, after the time that its runs simulate."""
    extremes = {row["quantity"]: row for row in _rows(results / "storms" / "extremes.csv")}
    rows = []
    for quantity, (name, side, factor, digits) in EXTREMES.items():
        if name in extremes:
            case = extremes[name][f"{side} in case"]
            rows.append((f"{quantity}, {case}", f"{factor * float(extremes[name][side]):,.{digits}f}"))
    rows += _life(results / "damage" / "fatigue.json")
    by_time = [name for name in BY_TIME if (results / name).is_dir()]
    each = " and ".join(f"{name.replace('_', ' ')} of {simulated(results, name)[1]:,.0f} s" for name in by_time)
    return f"From {each}:\n\n{table(('what governs', 'value'), rows)}"


def _life(file: Path) -> Iterator[tuple[str, str]]:
    """Rows of the fatigue life; none without an assessment."""
    if not file.is_file():
        return
    fatigue = json.loads(file.read_text(encoding="utf-8"))
    worst, design = fatigue["largest"], fatigue["design"]
    yield f"least fatigue life [years], arc {worst['arc']:.0f} m", f"{worst['life_years']:,.0f}"
    required = design["life_years"] * design["fatigue_factor"]
    yield "required life and its factor [years]", f"{required:,.0f}"


def _rows(file: Path) -> list[dict[str, Any]]:
    """Rows of a CSV file by their heads; a second head "in case" belongs to the value before it."""
    with file.open(encoding="utf-8", newline="") as text:
        head, *rows = csv.reader(text)
    named = [f"{head[n - 1]} {name}" if name == "in case" else name for n, name in enumerate(head)]
    return [dict(zip(named, row, strict=True)) for row in rows]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--workers", type=int, default=2, help="load cases at a time, each a process; 2 by default")
    parser.add_argument("--folder", type=Path, default=HERE, help="folder of the input files and of their results")
    parser.add_argument("--page", action="store_true", help="begin anew, and write the tables into README.md")
    given = parser.parse_args()
    main(given.folder, given.workers, given.page)
