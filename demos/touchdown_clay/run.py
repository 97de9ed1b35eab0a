"""A riser comes down on soft clay while the floater moves: compute the scene beside this file, then draw it.

Usage, in the project's folder: python -m demos.touchdown_clay.run [FOLDER] [--page]
FOLDER is by default `results` beside this file; the run's files, tables and touchdown.png are left there. --page writes
tables and figures into README.md and all pages that tell of this run, and the picture where README.md shows it.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from demos.compute import compute
from demos.figures import Texts, matched, shown
from demos.page import fill_pages, publish, table
from riser_soil.accuracy.chosen_run import run_as_asked
from riser_soil.checks.check import describe
from riser_soil.plots import picture
from riser_soil.results import Run
from riser_soil.results.cycles import secant_stiffness
from riser_soil.scene.reader import read_scene

HERE = Path(__file__).parent
SCENE = HERE / "scene.yaml"
PAGE, PICTURES = HERE / "README.md", HERE.parents[1] / "docs"
ARCS = (22.0, 24.0, 26.0)  # m, of the stiffness
COARSER = "soil.mesh={kind: hex, size_at_riser: {along: 1.0, across: 0.075, strip: 0.15}, size_far: 0.75}"
AT_REST = "stages.1={name: rest, kind: static}"


def main(folder: Path, page: bool) -> None:
    run_as_asked(read_scene(SCENE), folder, force=True, error_bars=True)
    pictures, done = PICTURES if page else folder, Run(folder)
    tables = {"figures": figures(done), "bars": bars(done), "stiffness": stiffness(done)}
    publish(tables, folder, PAGE if page else None)
    texts = sentences(done, compute(SCENE, folder / "coarser", COARSER, AT_REST))
    print(shown(texts))
    if page:
        fill_pages(texts)
    picture(folder, pictures / "touchdown.png")
    print(f"\nresults are in {folder}, touchdown.png in {pictures}; open riser.vtkhdf and soil.vtkhdf in ParaView")


def figures(done: Run) -> str:
    """Figures of the stages: at the end of the static one, the range over the dynamic one."""
    static, motion = done.summary["stages"]
    ranges, rows = motion["extremes"], []
    for name, key, scale, digits in (
        ("touchdown arc length [m]", "touchdown_arc", 1.0, 2),
        ("largest bending moment [kN m]", "max_bending_moment", 1e-3, 3),
    ):
        rest = static["final"][key]
        rest = rest["value"] if isinstance(rest, dict) else rest
        low, high = (ranges[key][end] * scale for end in ("min", "max"))
        rows.append([name, f"{rest * scale:.{digits}f}", f"{low:.{digits}f} to {high:.{digits}f}"])
    for name, key, scale, digits in (
        ("deepest settlement of the clay [mm]", "max_settlement", 1e3, 2),
        ("largest von Mises stress [kPa]", "max_von_mises_stress", 1e-3, 2),
        ("most of the strength used [-]", "max_strength_used", 1.0, 2),
        ("largest plastic strain [%]", "max_equivalent_plastic_strain", 1e2, 2),
    ):
        rest, most = (stage["soil"][key]["value"] * scale for stage in (static, motion))
        rows.append([name, f"{rest:.{digits}f}", f"up to {most:.{digits}f}"])
    lost = motion["energy"]["dissipated_by"]["soil_plasticity"]
    rows.append(["dissipated by the clay's plasticity [J]", "", f"{lost:.1f}"])
    return table(["", "laid", "in heave and surge"], rows)


def sentences(done: Run, coarser: Run) -> Texts:
    """Figures that pages tell of the run, of what `check` says before it, and of one at rest on coarser cells."""
    static, motion = done.summary["stages"]
    energy, checked = motion["energy"], describe(read_scene(SCENE))
    along, across = matched(r"cells of ([\d.]+) m along and ([\d.]+) m across", checked)
    return {
        "demo laid": f"{1e3 * static['soil']['max_settlement']['value']:.1f}",
        "demo deepest": f"{1e3 * motion['soil']['max_settlement']['value']:.1f}",
        "demo coarser": f"{1e3 * coarser.summary['stages'][0]['soil']['max_settlement']['value']:.1f}",
        "demo strength": f"{motion['soil']['max_strength_used']['value']:.2f}",
        "demo iterations": f"{motion['newton_iterations'] / motion['steps']:.1f}",
        "demo cuts": f"{motion['step_cuts']:g}",
        "demo residual": f"{100.0 * abs(energy['residual']) / energy['turned_over']:.1g}",
        "demo load steps": f"{static['steps']}",
        "demo load iterations": f"{static['newton_iterations'] / static['steps']:.1f}",
        "demo unknowns": f"{done.summary['dofs']['soil']:,}",
        "demo along": f"{float(along):.2g}",
        "demo across": f"{1e3 * float(across):.2g}",
        "demo foretold": matched(r"(it settles by about .* on these cells)", checked)[0],
    }


def bars(done: Run) -> str:
    """How far key results may be off, by runs with other steps, elements and cells."""
    by_name = {(each["stage"], each["name"]): each for each in done.summary["error_bars"]["quantities"]}
    rows = []
    for stage, name, unit, scale, digits in (
        ("lay", "touchdown arc", "m", 1.0, 2),
        ("lay", "largest bending moment", "kN m", 1e-3, 4),
        ("lay", "soil settlement", "mm", 1e3, 1),
        ("heave", "least touchdown arc", "m", 1.0, 2),
        ("heave", "largest touchdown arc", "m", 1.0, 2),
        ("heave", "largest bending moment", "kN m", 1e-3, 3),
        ("heave", "soil settlement", "mm", 1e3, 1),
    ):
        each = by_name[stage, name]
        value, bar = (f"{scale * each[key]:.{digits}f}" for key in ("value", "bar"))
        rows.append([f"{stage}: {name} [{unit}]", f"{value} ± {bar}"])
    seconds = done.summary["error_bars"]["seconds"]
    rows.append(["time of the other runs, over that of the run", f"{seconds['comparison_runs'] / seconds['run']:.2f}"])
    return table(["key result", "with its error bar"], rows)


def stiffness(done: Run) -> str:
    """Secant stiffness over su, cycle by cycle."""
    stiffnesses = secant_stiffness(done, ARCS)
    rows = ([f"{n}", *(f"{k:.0f}" for k in ks)] for n, ks in enumerate(stiffnesses.over_su, 1))
    return table(["cycle, k/su at arc length", *(f"{arc:g} m" for arc in ARCS)], rows)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, nargs="?", default=HERE / "results", help="folder for the results")
    parser.add_argument("--page", action="store_true", help="write figures and picture into the demo's page, too")
    given = parser.parse_args()
    main(given.folder, given.page)
