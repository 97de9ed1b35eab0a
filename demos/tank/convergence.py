"""Convergence of the swinging hose in elements, step and contact stiffness, with run times: tables of convergence.md.

Usage, in the project's folder: python -m demos.tank.convergence [--elements 50 100 …] [--steps 0.1 0.05 …] [--page]
The lists must double and halve from item to item. Three minutes as they stand; runs go to `results` beside this file.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from demos.page import publish, table
from demos.tank.statics import HERE
from demos.tank.swing import EXTREMES, FORCES, MOMENT, TOUCHDOWN, Swing, error, orders, swing

PAGE = HERE / "convergence.md"
ELEMENTS, STEPS, STIFFNESSES = (50, 100, 200, 400), (0.1, 0.05, 0.025, 0.0125), (1e5, 1e6, 1e7, 1e8)
# Those of one list are computed with these members of the others.
COUNT, STEP, STIFFNESS = 200, 0.025, 1e7
BEST = (400, 0.0125, 1e8)
CHEAP = ((50, 0.1, 1e6), (100, 0.1, 1e6), (100, 0.05, 1e6), (200, 0.05, 1e6))
UNITS = {"M": "N.m", "touchdown": "m"}


class Study:
    """Runs of the swinging hose, each computed once."""

    def __init__(self, results: Path) -> None:
        self._results = results
        self._known: dict[tuple[int, float, float], Swing] = {}

    def __call__(self, elements: int, time_step: float, stiffness: float) -> Swing:
        key = (elements, time_step, stiffness)
        if key not in self._known:
            done = swing(self._results / f"convergence_{elements}_{time_step:g}_{stiffness:.0e}", *key)
            self._known[key] = done
            print(f"{elements} elements, {time_step} s, {stiffness:.0e} N/m2: {done.seconds:.1f} s", flush=True)
        return self._known[key]


def main(results: Path, elements: Sequence[int], steps: Sequence[float], page: bool) -> None:
    results.mkdir(parents=True, exist_ok=True)
    study = Study(results)
    best = study(*BEST)
    by_elements = [study(n, STEP, STIFFNESS) for n in elements]
    by_steps = [study(COUNT, dt, STIFFNESS) for dt in steps]
    blocks = {
        "elements": swings_page(by_elements, best),
        "steps": swings_page(by_steps, best),
        "stiffnesses": swings_page([study(COUNT, STEP, k) for k in STIFFNESSES], best),
        "cheap": swings_page([*(study(*each) for each in CHEAP), best], best),
        "orders": orders_page(by_elements, by_steps),
    }
    publish(blocks, results, PAGE if page else None)


def swings_page(runs: Sequence[Swing], best: Swing) -> str:
    """Extremes of some runs, what they cost, how hard they were, and their largest errors against the best run."""
    values = [f"{name} {UNITS.get(name.split()[0], 'N')}" for name in EXTREMES]
    head = ["elements", "step s", "k N/m²", "run s", *values]
    errors = ["error of forces", "of M", "of touchdown m"]
    return table([*head, "iterations", "cuts", "energy", *errors], [swing_row(run, best) for run in runs])


def swing_row(run: Swing, best: Swing) -> list[str]:
    values = [f"{run.extremes[name]:.{4 if name in TOUCHDOWN else 2}f}" for name in EXTREMES]
    stage = run.stage
    hardship = [f"{stage['iterations']:.2f}", f"{stage['cuts']:.0f}", f"{stage['energy']:.0e}"]
    errors = ["reference"] * 3
    if run is not best:
        forces, moment, touchdown = (error(run, best, names) for names in (FORCES, MOMENT, TOUCHDOWN))
        errors = [f"{100.0 * forces:.2f} %", f"{100.0 * moment:.3f} %", f"{touchdown:.4f}"]
    size = [str(run.elements), f"{run.time_step:g}", f"{run.stiffness:.0e}", f"{run.seconds:.1f}"]
    return [*size, *values, *hardship, *errors]


def orders_page(by_elements: Sequence[Swing], by_steps: Sequence[Swing]) -> str:
    """Observed orders of the series over periods 3 to 6."""
    rows = []
    for runs, name in ((by_elements, "elements {}"), (by_steps, "step {} s")):
        for each in zip(runs, runs[1:], runs[2:], strict=False):
            sizes = ", ".join(f"{r.elements}" if runs is by_elements else f"{r.time_step:g}" for r in each)
            rows.append([name.format(sizes), *(f"{value:.1f}" for value in orders(*each).values())])
    return table(["runs", "top(t)", "bottom(t)", "touchdown(t)", "M(s, t)", "position(s, t)"], rows)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elements", type=int, nargs="+", default=ELEMENTS, help="numbers of elements")
    parser.add_argument("--steps", type=float, nargs="+", default=STEPS, help="time steps [s]")
    parser.add_argument("--results", type=Path, default=HERE / "results", help="folder for runs and tables")
    parser.add_argument("--page", action="store_true", help="write the tables into the demo's page, too")
    given = parser.parse_args()
    main(given.results, given.elements, given.steps, given.page)
