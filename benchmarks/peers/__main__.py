"""What the same answers cost by other programs: tables and plot of docs/peers.md, every run in docs/peers_*.csv.

    python -m benchmarks.peers [--results FOLDER] [--case NAME] [--page]

Runs that have left a file in the folder are not repeated. A program that is not in its environment is left out.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from benchmarks.peers.case import CASES, Case, Record
from benchmarks.peers.draw import draw
from benchmarks.peers.in_turn import ROOT, file_of, measure
from benchmarks.peers.judge import RANGE, TENSIONS, Judged, apart, cheapest, consensus, errors, kept_error, quantities
from benchmarks.peers.measure import read
from benchmarks.peers.refinement import FINEST, PROGRAMS
from demos.page import csv_table, publish, table

PAGE, PLOT = ROOT / "docs" / "peers.md", ROOT / "docs" / "peers.png"
TARGETS = (0.05, 0.03, 0.02, 0.01, 0.005, 0.002, 0.001)


@dataclass(frozen=True, eq=False)
class Compared:
    """One case: each program's runs by (elements, time step), and what was agreed."""

    case: Case
    found: Mapping[str, Mapping[tuple[int, float], Record]]

    @property
    def finest(self) -> dict[str, dict[str, float]]:
        """Quantities of each program's last run, but of those that are again a program before them."""
        programs = [program.name for program in PROGRAMS if program.name in self.found and not program.again]
        return {name: quantities(self.case, list(self.found[name].values())[-1]) for name in programs}

    @property
    def voices(self) -> list[dict[str, float]]:
        """Programs that have computed the finest run: explicit ones are not that patient, others fail."""
        return [values for name, values in self.finest.items() if FINEST[self.case.name] in self.found[name]]

    @property
    def agreed(self) -> dict[str, float]:
        return consensus(self.voices)

    def judged(self) -> dict[str, list[Judged]]:
        agreed = self.agreed
        return {
            name: [self._judge(size, run, agreed) for size, run in runs.items()] for name, runs in self.found.items()
        }

    def _judge(self, size: tuple[int, float], run: Record, agreed: Mapping[str, float]) -> Judged:
        error = max(errors(quantities(self.case, run), agreed).values())
        return Judged(*size, run.seconds / self.case.duration, error)


def main(results: Path, cases: Sequence[str], page: bool) -> None:
    results.mkdir(parents=True, exist_ok=True)
    measure(cases, results)
    compared = [_compared(CASES[case], results) for case in cases]
    blocks: dict[str, str] = {}
    for each in compared:
        name, judged = each.case.name, each.judged()
        blocks |= {
            f"{name} finest": finest_page(each),
            f"{name} cost": cost_page(judged, apart(each.voices)),
        }
        place = PAGE.parent if page else results
        (place / f"peers_{name}.csv").write_text(every_run(judged), encoding="utf-8")
    publish(blocks, results, PAGE if page else None)
    if len(cases) < len(CASES):
        return
    least = {each.case.name: apart(each.voices) for each in compared}
    draw({each.case.name: each.judged() for each in compared}, least, PLOT if page else results / PLOT.name)


def _compared(case: Case, results: Path) -> Compared:
    records: dict[str, dict[tuple[int, float], Record]] = {}
    for program in PROGRAMS:
        paths = {size: file_of(results, case.name, program, *size) for size in program.runs(case.name)}
        runs = {size: read(path) for size, path in paths.items() if path.exists()}
        if runs:
            records[program.name] = runs
    return Compared(case, records)


def finest_page(compared: Compared) -> str:
    """What each program's finest run gives, what is agreed, and how far the run is from it."""
    agreed = compared.agreed
    rows = [["agreed", "", *(_shown(name, value) for name, value in agreed.items()), ""]]
    for name, values in compared.finest.items():
        elements, time_step = list(compared.found[name])[-1]
        error = max(errors(values, agreed).values())
        row = [name, f"{elements}, {time_step:g} s", *(_shown(each, values[each]) for each in agreed)]
        rows.append([*row, f"{100.0 * error:.2f} %"])
    return table(["finest run", "elements, step", *(f"{name} {_unit(name)}" for name in agreed), "largest error"], rows)


def _shown(name: str, value: float) -> str:
    return f"{value:.4f}" if name == RANGE else f"{value:.2f}"


def _unit(name: str) -> str:
    return "N" if name in TENSIONS else "m" if name == RANGE else "N.m"


def cost_page(judged: Mapping[str, list[Judged]], least: float) -> str:
    """The cheapest run of each program for each accuracy that the finest runs can tell."""
    targets = [target for target in TARGETS if target >= least]
    head = ["processor seconds per simulated second", *(f"{100.0 * target:g} %" for target in targets)]
    return table(head, [[name, *(_cost(runs, target) for target in targets)] for name, runs in judged.items()])


def _cost(runs: list[Judged], target: float) -> str:
    best = cheapest(runs, target)
    return "–" if best is None else f"{best.seconds:.4f} ({best.elements}, {best.time_step:g} s)"


def every_run(judged: Mapping[str, list[Judged]]) -> str:
    """Every run as CSV: its own error, and the largest of it and of all finer ones."""
    rows = [_run_row(name, run, runs) for name, runs in judged.items() for run in runs]
    return csv_table(["program", "elements", "step s", "s per s", "error %", "error kept by finer runs %"], rows)


def _run_row(name: str, run: Judged, runs: Sequence[Judged]) -> list[str]:
    percent = [f"{100.0 * error:.2f}" for error in (run.error, kept_error(run, runs))]
    return [name, str(run.elements), f"{run.time_step:g}", f"{run.seconds:.4f}", *percent]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.peers", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--results", type=Path, default=ROOT / "results" / "peers", help="folder for runs and tables")
    parser.add_argument("--page", action="store_true", help="write tables and plot into docs/peers.md, too")
    parser.add_argument("--case", choices=CASES, help="one of the cases alone, without the plot of all")
    given = parser.parse_args()
    main(given.results, [given.case] if given.case else list(CASES), given.page)
