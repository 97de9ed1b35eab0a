"""A pipe segment pressed into clay and lifted: beside formulas and seabed laws; numbers found from noisy curves.

Usage, in the project's folder: python -m demos.pipe_segment.run [--results FOLDER] [--page]
Leaves tables (*.md), calibrations and pictures in `results` beside this file; --page writes them where README.md shows
them.
"""

from __future__ import annotations

from contextlib import redirect_stdout
from pathlib import Path

import numpy as np

from demos.page import publish, script, table
from demos.pipe_segment.curves import (
    AMPLITUDES,
    CYCLES,
    DEEPEST,
    FORMULAS,
    HERE,
    LAWS,
    PAUSE,
    SCENE,
    SU,
    D,
    at_the_pause,
    cyclic_path,
    demo_path,
    monotonic,
    of_law,
    resistance,
    secant_stiffnesses,
)
from riser_soil.calibration.calibrate import calibrate
from riser_soil.calibration.least_squares import Fit
from riser_soil.calibration.path import path_through
from riser_soil.core.arrays import Array
from riser_soil.plots.curves import save, sheet

PAGE, PICTURES = HERE / "README.md", HERE.parents[1] / "docs"
DEPTHS = (0.02, 0.05, 0.1, 0.15, 0.2)  # of the table, over D
FINER = "soil.mesh.size_at_riser.across=0.009375"
SMALL = "soil.strain=small"
CLAYS = {kind: f"soil.law={{kind: {kind}, su: {SU}, E_over_su: 300.0}}" for kind in ("kinematic-hardening", "iwan")}
NOISE, SEED, POINTS = 0.05, 1, 30
TRUTH = {"soil.law.su": SU, "soil.law.E_over_su": 300.0}  # the scene's
CLOSED_FORM_SU = 4.0e3  # Pa
FIRST_GUESS = ("soil.law.su=7.0e3", "soil.law.E_over_su=200.0")
WANTED = ("soil.law.su=1e3:20e3", "soil.law.E_over_su=50:1500")


def main(results: Path, page: bool) -> None:
    results.mkdir(parents=True, exist_ok=True)
    path, down = demo_path(), monotonic()
    V = resistance(path)
    curves = {"cells of D/16": (down.w / D, resistance(down)), "cells of D/32": (down.w / D, resistance(down, FINER))}
    curves["D/16, small strain"] = (down.w / D, resistance(down, SMALL))
    cycles = cyclic_path()
    loads = {clay: at_the_pause(cycles.w, resistance(cycles, law)) for clay, law in CLAYS.items()}
    fits = {"the model's own": of_own_curve(results), "closed form, smooth": of_closed_form(results)}
    blocks = {"capacity": capacity_page(curves), "stiffness": stiffness_page(path.w, V)}
    blocks |= {"memory": memory_page(loads), "fits": fits_page(fits)}
    publish(blocks, results, PAGE if page else None)
    pictures = PICTURES if page else results
    draw(pictures / "pipe_segment.png", path.w, V, curves)
    draw_stiffness(pictures / "pipe_segment_stiffness.png", path.w, V)
    (pictures / "pipe_segment_fit.png").write_bytes((results / "own" / "fit.png").read_bytes())
    print(f"\ntables and calibrations are in {results}, the pictures in {pictures}")


def capacity_page(curves: dict[str, tuple[Array, Array]]) -> str:
    """V/(su D) at some depths: of the segment and by formulas."""
    rows = [[f"segment, {name}", *(f"{np.interp(z, *curve):.2f}" for z in DEPTHS)] for name, curve in curves.items()]
    rows += [[name, *(f"{formula(np.array(z)):.2f}" for z in DEPTHS)] for name, formula in FORMULAS.items()]
    return table(["V/(su D) at w/D", *(f"{z:g}" for z in DEPTHS)], rows)


def stiffness_page(w: Array, V: Array) -> str:
    """Secant stiffness of uplift by its amplitude."""
    of_laws = {name: secant_stiffnesses(w, of_law(law, w)) for name, law in LAWS.items()}
    values = {"segment": secant_stiffnesses(w, V)} | of_laws
    rows = ([name, *(f"{k:.0f}" for k in stiffnesses)] for name, stiffnesses in values.items())
    return table(["uplift over D", *(f"{a:g}" for a in AMPLITUDES)], rows)


def memory_page(loads: dict[str, Array]) -> str:
    """V/(su D) at D/10 before cycles, after the first and after all: of the segment's clays and of seabed laws."""
    w = cyclic_path().w
    curves = {f"segment, {clay}": V for clay, V in loads.items()}
    curves |= {name: at_the_pause(w, of_law(law, w)) for name, law in LAWS.items()}
    rows = ([name, *(f"{V[n]:.2f}" for n in (0, 1, CYCLES))] for name, V in curves.items())
    return table(["V/(su D) at D/10", "first", "after a cycle", f"after {CYCLES}"], rows)


def of_own_curve(results: Path) -> Fit:
    """Down to D/10, up by D/100 and down again: the segment's own curve with noise; what is true is known."""
    part = POINTS // 3
    down, up, again = (np.linspace(a, b, part) for a, b in ((0.0, 0.1), (0.099, 0.09), (0.091, 0.11)))
    w = D * np.concatenate((down, up, again))
    path = path_through(w, 0.0, 0.01 * D)
    return calibrated(results, "own", w, SU * D * path.at_points(resistance(path)))


def of_closed_form(results: Path) -> Fit:
    """Aubeny et al.'s formula for a smooth pipe with noise; strength alone is looked for."""
    ratio = np.linspace(0.02, DEEPEST, POINTS)
    V = CLOSED_FORM_SU * D * FORMULAS["Aubeny et al., smooth"](ratio)
    return calibrated(results, "closed_form", D * ratio, V, WANTED[:1])


def calibrated(results: Path, name: str, w: Array, V: Array, wanted: tuple[str, ...] = WANTED) -> Fit:
    """Numbers found from a curve with noise on each value."""
    noisy = V * (1.0 + NOISE * np.random.default_rng(SEED).normal(size=len(V)))
    data, guess = results / f"{name}.csv", FIRST_GUESS[: len(wanted)]
    np.savetxt(data, np.column_stack((w, noisy)), "%.8g", ",", header="w [m],V [N/m]", comments="")
    with (results / f"{name}.txt").open("w", encoding="utf-8") as said, redirect_stdout(said):
        return calibrate(data, SCENE, wanted, results / name, overrides=guess, relative=True, force=True)


def fits_page(fits: dict[str, Fit]) -> str:
    """Table of fitted constants beside those that made the curves."""
    truths = {"the model's own": TRUTH, "closed form, smooth": {"soil.law.su": CLOSED_FORM_SU}}
    rows = []
    for curve, fit in fits.items():
        for each in fit.parameters:
            low, high = each.interval
            name = each.parameter.name
            numbers = [f"{truths[curve][name]:.0f}", f"{each.value:.0f}", f"{low:.0f} to {high:.0f}", str(fit.runs)]
            rows.append([f"{curve}, `{name}`", *numbers])
    return table(["curve, number", "behind it", "found", "95 % within", "runs"], rows)


def draw(png: Path, w: Array, V: Array, curves: dict[str, tuple[Array, Array]]) -> None:
    """Resistance by penetration: the segment beside formulas, and seabed laws on the same path."""
    figure, (left, right) = sheet(1, 2, width=11.0, height=4.6)
    for name, curve in curves.items():
        left.plot(*curve, label=f"segment, {name}")
    ratio = np.linspace(1e-3, DEEPEST, 200)
    for name, formula in FORMULAS.items():
        left.plot(ratio, formula(ratio), "--", linewidth=1.0, label=name)
    right.plot(w / D, V, label="segment, cells of D/16")
    for name, law in LAWS.items():
        right.plot(w / D, of_law(law, w), linewidth=1.0, label=name)
    for axes in (left, right):
        axes.set(xlabel="penetration w/D [-]", ylabel="resistance V/(su D) [-], + pushes the pipe up")
        axes.legend(fontsize=8)
    save(figure, png)


def draw_stiffness(png: Path, w: Array, V: Array) -> None:
    """Secant stiffness of uplift by its amplitude."""
    figure, (axes,) = sheet(1, 1, width=6.5, height=4.2)
    axes.loglog(AMPLITUDES, secant_stiffnesses(w, V), "o-", label="segment")
    for name, law in LAWS.items():
        axes.loglog(AMPLITUDES, secant_stiffnesses(w, of_law(law, w)), "s--", label=name)
    axes.set(xlabel=f"uplift from w = {PAUSE:g} D, over D [-]", ylabel="secant stiffness (ΔV/V)/(Δw/D) [-]")
    axes.legend()
    save(figure, png)


if __name__ == "__main__":
    script(main, __doc__, HERE)
