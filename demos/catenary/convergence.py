"""Convergence of case 3.1 in element length and time step, with run times: the tables of convergence.md.

Usage, in the project's folder: python -m demos.catenary.convergence [--elements 35 70 …] [--steps 0.2 0.1 …] [--page]
The lists must double and halve from item to item. Three minutes as they stand; runs go to `results` beside this file.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from demos.catenary.statics import HERE, STATIC, table1
from demos.catenary.surge import EXTREMES, GRADED, UNIFORM, Surge, error, orders, surge
from demos.compute import compute
from demos.page import publish, table
from riser_soil.results.stage_records import peak

SCENE, PAGE = HERE / "scene.yaml", HERE / "convergence.md"
ELEMENTS, STEPS = (35, 70, 140, 280, 560), (0.2, 0.1, 0.05, 0.025, 0.0125, 0.00625)
# Those of one list are computed with this member of the other.
STEP, COUNT = 0.025, 140
BEST = (280, 0.00625)
CHEAP = ((35, 0.2), (35, 0.1), (35, 0.05), (70, 0.1), (70, 0.05))
SCHEMES = {
    "ρ∞ = 0.5": "{generalized_alpha: {rho_inf: 0.5}}",
    "ρ∞ = 0.8 (default)": "{generalized_alpha: {rho_inf: 0.8}}",
    "average acceleration": "{newmark: {beta: 0.25, gamma: 0.5}}",
}


class Study:
    """Runs of the surging riser, each computed once."""

    def __init__(self, results: Path) -> None:
        self._results = results
        self._known: dict[tuple[str, float, str], Surge] = {}

    def __call__(self, mesh: int | str, time_step: float, scheme: str = SCHEMES["ρ∞ = 0.8 (default)"]) -> Surge:
        text = UNIFORM.format(mesh) if isinstance(mesh, int) else mesh
        key = (text, time_step, scheme)
        if key not in self._known:
            folder = self._results / f"convergence_{len(self._known)}"
            self._known[key] = surge(folder, text, time_step, f"stages.1.scheme={scheme}")
            done = self._known[key]
            print(f"{done.elements} elements, {time_step} s: {done.seconds:.1f} s", flush=True)
        return self._known[key]


def main(results: Path, elements: Sequence[int], steps: Sequence[float], page: bool) -> None:
    study = Study(results)
    best = study(*BEST)
    meshes: list[int | str] = [*elements, GRADED]
    blocks = {
        "statics": statics_page(results, elements),
        "elements": surges_page([study(mesh, STEP) for mesh in meshes], best),
        "steps": surges_page([study(COUNT, dt) for dt in steps], best),
        "cheap": surges_page([*(study(*each) for each in CHEAP), study(GRADED, 0.05), best], best),
        "orders": orders_page([study(n, STEP) for n in elements], [study(COUNT, dt) for dt in steps]),
        "estimate": estimate_page(study),
        "schemes": schemes_page(study, best),
    }
    publish(blocks, results, PAGE if page else None)


def statics_page(results: Path, elements: Sequence[int]) -> str:
    """At rest: what is found on each mesh, and observed orders from three meshes that halve."""
    names = ("H2", "theta1", "theta2", "M max")
    runs = {n: at_rest(results, UNIFORM.format(n)) for n in (*elements, 2 * elements[-1])}
    rows = []
    for n, values in runs.items():
        order = [_order(*(runs[m][name] for m in (n // 4, n // 2, n))) if n // 4 in runs else "" for name in names]
        rows.append([str(n), *_shown(values, names), *order])
    graded = at_rest(results, GRADED)
    rows.append(["73, graded", *_shown(graded, names), *[""] * len(names)])
    orders_of = [f"order of {name}" for name in ("H", "θ1", "θ2", "M")]
    return table(["elements", "H kN", "θ1 deg", "θ2 deg", "largest M N.m", *orders_of], rows)


def at_rest(results: Path, mesh: str) -> dict[str, float]:
    """Table 1's quantities [kN, deg] and the largest moment [N.m], between nodes."""
    run = compute(SCENE, results / "convergence_static", *STATIC, mesh)
    return table1(run) | {"M max": float(peak(run.arc, run["bending_moment"][0]))}


def _shown(values: dict[str, float], names: Sequence[str]) -> list[str]:
    digits = {"H2": 7, "theta1": 4, "theta2": 4, "M max": 3}
    return [f"{values[name]:.{digits[name]}f}" for name in names]


def _order(a: float, b: float, c: float) -> str:
    """Order of convergence from three values on halved elements; no order can be seen where round-off is all that
    changes.
    """
    return f"{np.log2(abs((b - a) / (c - b))):.1f}" if abs(c - b) > 1e-9 * abs(c) else "–"


def surges_page(runs: Sequence[Surge], best: Surge) -> str:
    """Extremes of some runs, what they cost, and their largest errors against the best run."""
    head = ["elements", "step s", "run s", *(f"{name} {'N.m' if name == 'M max' else 'kN'}" for name in EXTREMES)]
    rows = [surge_row(run, best) for run in runs]
    return table([*head, "at arc m", "error of forces", "error of M"], rows)


def surge_row(run: Surge, best: Surge) -> list[str]:
    name = f"{run.elements}, graded" if len(set(np.round(np.diff(run.run.arc), 6))) > 1 else str(run.elements)
    values = [f"{run.extremes[each]:.{2 if each == 'M max' else 4}f}" for each in EXTREMES]
    errors = [_percent(error(run, best, names)) for names in (EXTREMES[:-1], EXTREMES[-1:])]
    return [name, f"{run.time_step:g}", f"{run.seconds:.1f}", *values, f"{run.arc:.2f}", *errors]


def _percent(share: float) -> str:
    return f"{100.0 * share:.3f} %" if share > 0.0 else "reference"


def orders_page(by_elements: Sequence[Surge], by_steps: Sequence[Surge]) -> str:
    """Observed orders of the series over periods 8 to 10."""
    rows = []
    for runs, name in ((by_elements, "elements {}"), (by_steps, "step {} s")):
        for each in zip(runs, runs[1:], runs[2:], strict=False):
            rates = orders(*each)
            sizes = ", ".join(f"{r.elements}" if runs is by_elements else f"{r.time_step:g}" for r in each)
            rows.append([name.format(sizes), *(f"{value:.1f}" for value in rates.values())])
    return table(["runs", "H1(t)", "V1(t)", "H2(t)", "V2(t)", "M(s, t)", "position(s, t)"], rows)


def estimate_page(study: Study) -> str:
    """Largest changes from the next to the finest run in each direction, and the remaining error by Richardson."""
    rows = []
    for (fine, finest), name, order in (
        ((study(280, STEP), study(560, STEP)), "elements, 280 to 560", 4),
        ((study(COUNT, 0.0125), study(COUNT, 0.00625)), "step, 0.0125 to 0.00625 s", 2),
    ):
        changes = [error(fine, finest, names) for names in (EXTREMES[:-1], EXTREMES[-1:])]
        rest = [change / (2**order - 1) for change in changes]
        rows.append([name, *(f"{share:.0e}" for share in (*changes, *rest))])
    return table(["", "change of forces", "of M", "rest of forces by Richardson", "of M"], rows)


def schemes_page(study: Study, best: Surge) -> str:
    rows = []
    for name, scheme in SCHEMES.items():
        for dt in (0.1, 0.05, 0.025):
            run = study(COUNT, dt, scheme)
            rows.append([name, f"{dt:g}", *(_percent(error(run, best, n)) for n in (EXTREMES[:-1], EXTREMES[-1:]))])
    return table(["scheme", "step s", "error of forces", "error of M"], rows)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elements", type=int, nargs="+", default=ELEMENTS, help="numbers of elements")
    parser.add_argument("--steps", type=float, nargs="+", default=STEPS, help="time steps [s]")
    parser.add_argument("--results", type=Path, default=HERE / "results", help="folder for runs and tables")
    parser.add_argument("--page", action="store_true", help="write the tables into the demo's page, too")
    given = parser.parse_args()
    main(given.results, given.elements, given.steps, given.page)
