"""The lazy S whose lower part lies on clay, with error bars, and its table.

Usage, in the project's folder: python -m demos.lines.run [--results FOLDER] [--page]
Leaves the run and the table (clay.md) in `results` beside this file; --page writes it into README.md, too.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from demos.page import publish, script, table
from riser_soil.accuracy.chosen_run import run_as_asked
from riser_soil.results import Run
from riser_soil.scene.reader import read_scene

HERE = Path(__file__).parent
SCENE, PAGE = HERE / "lazy_s_on_clay.yaml", HERE / "README.md"
Bars = dict[tuple[str, str, str], dict[str, Any]]


def main(results: Path, page: bool) -> None:
    run_as_asked(read_scene(SCENE), results / "clay", force=True, error_bars=True)
    publish({"clay": clay(Run(results / "clay"))}, results, PAGE if page else None)


def clay(run: Run) -> str:
    """Values at rest and extremes in heave of the line on clay and of the arch, with their error bars."""
    bars: Bars = {(each["stage"], each["of"], each["name"]): each for each in run.summary["error_bars"]["quantities"]}

    def value(stage: str, of: str, name: str, scale: float = 1.0, digits: int = 2) -> str:
        each = bars[stage, of, name]
        return f"{scale * each['value']:.{digits}f} ± {scale * each['bar']:.{digits}f}"

    arcs = (value("heave", "lower", f"{which} touchdown arc") for which in ("least", "largest"))
    heights = (value("heave", "arch", f"{which} z", digits=3) for which in ("least", "largest"))
    moment, settled, force = "largest bending moment", "soil settlement", "largest contact force"
    rows = [
        ["touchdown, arc length [m]", value("rest", "lower", "touchdown arc"), " to ".join(arcs)],
        ["largest moment of `lower` [N.m]", *(value(stage, "lower", moment, 1.0, 1) for stage in ("rest", "heave"))],
        ["settlement of the clay [mm]", *(value(stage, "lower", settled, 1e3, 1) for stage in ("rest", "heave"))],
        ["force on the ground [kN]", *(value(stage, "lower", force, 1e-3) for stage in ("rest", "heave"))],
        ["arch, z [m]", value("rest", "arch", "z", digits=3), " to ".join(heights)],
    ]
    return table(["", "at rest", "two cycles of heave"], rows)


if __name__ == "__main__":
    script(main, __doc__, HERE)
