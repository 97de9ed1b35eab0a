"""The riser at rest: reactions and angles beside the published ones, and the same state by another path."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from ruamel.yaml import YAML

from demos.compute import compute
from demos.page import table
from riser_soil.results import Run
from riser_soil.results.stage_records import reactions

HERE = Path(__file__).parent
SCENE, THREE_STAGES = HERE / "scene.yaml", HERE / "three_stages.yaml"
COLUMNS = ("V1", "V2", "H1", "H2", "theta1", "theta2")
# The weights in question [N/m], and what makes the scene take them: the stated data give the second.
WEIGHTS: Mapping[str, tuple[str, ...]] = {
    "364.2": ("line_types.flexible.submerged_weight=364.2",),
    "346.1": (),
}
COARSE, FINE, FINEST = 35, 560, 1120
# One step of the surge is all that is wanted here; balance to round-off asks for more than the default tolerance.
STATIC = ("stages.1.duration=0.1", "solver.tolerance=1e-10")


@dataclass(frozen=True)
class Published:
    """A row of the published table: values and tolerances by column [kN, deg], the latter for the implied weight."""

    name: str
    values: Mapping[str, float]
    tolerance: Mapping[str, float]


def published() -> list[Published]:
    rows = YAML(typ="safe").load((HERE / "reference.yaml").read_text(encoding="utf-8"))["rows"]
    return [Published(row["name"], row["values"], row["tolerance"]) for row in rows]


def hanging(folder: Path, elements: int, weight: str) -> Run:
    """The scene at rest; `weight` is a key of WEIGHTS."""
    overrides = (*STATIC, *WEIGHTS[weight], f"riser.segments.0.elements={elements}")
    return compute(SCENE, folder / f"static_{elements}_{weight}", *overrides)


def table1(run: Run) -> dict[str, float]:
    """The published table's quantities at the end of the first stage [kN, deg]."""
    computed, final = reactions(run), run.summary["stages"][0]["final"]
    forces = {name: 1e-3 * float(getattr(computed, name)[0]) for name in COLUMNS[:4]}
    return forces | {"theta1": abs(final["start"]["angle_deg"]), "theta2": abs(final["end"]["angle_deg"])}


def table1_page(folder: Path) -> str:
    """Table 1 as Markdown: the published rows, and ours for both weights, coarse and fine."""
    head = ["", "weight N/m", *(f"{c} {'deg' if c.startswith('theta') else 'kN'}" for c in COLUMNS), "H2/H1 − 1"]
    rows = []
    for row in published():
        rows.append([row.name, "not given", *(f"{row.values[c]:.2f}" for c in COLUMNS), _unbalance(row.values)])
    for weight in WEIGHTS:
        for elements in (COARSE, FINE):
            computed = table1(hanging(folder, elements, weight))
            values = [f"{computed[c]:.4f}" for c in COLUMNS]
            rows.append([f"riser_soil, {elements} elements", weight, *values, _unbalance(computed)])
    return table(head, rows)


def _unbalance(values: Mapping[str, float]) -> str:
    share = abs(values["H2"] / values["H1"] - 1.0)
    return "0" if share == 0.0 else f"{share:.0e}" if share < 1e-3 else f"{100.0 * share:.1f} %"


def largest_change(folder: Path, weight: str) -> float:
    """Largest relative change of a quantity of Table 1 from the fine mesh to one twice as fine."""
    fine, finest = (table1(hanging(folder, n, weight)) for n in (FINE, FINEST))
    return max(abs(finest[c] / fine[c] - 1.0) for c in COLUMNS)


def path_differences(folder: Path) -> dict[str, float]:
    """Largest differences between the two paths' final states, over the largest value of each quantity."""
    direct = compute(SCENE, folder / "direct", *STATIC)
    by_stages = compute(THREE_STAGES, folder / "three_stages", "solver.tolerance=1e-10")
    names = ("position", "effective_tension", "bending_moment")
    pairs = {name: (direct[name][0], by_stages[name][-1]) for name in names}
    return {name: float(np.abs(b - a).max() / np.abs(a).max()) for name, (a, b) in pairs.items()}


def paths_page(folder: Path) -> str:
    """The differences of the paths as Markdown."""
    rows = [[name.replace("_", " "), f"{value:.0e}"] for name, value in path_differences(folder).items()]
    return table(["along the riser", "largest difference / largest value"], rows)
