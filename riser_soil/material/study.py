"""The story of `riser-soil material`: a point of the scene's soil along a path, its curve, cycles and picture."""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.errors import SceneError
from riser_soil.material.memory import in_words, memory, table_columns
from riser_soil.material.path import STRAINS, STRESS_FACTOR, STRESSES, MaterialPath, read_path, shear_cycles
from riser_soil.material.point import MaterialCurve, drive, law_at, point_at
from riser_soil.results.whole_file import refuse_file, written_together
from riser_soil.scene.scene import Scene
from riser_soil.scene.soil import SoilScene
from riser_soil.soil import mandel

FILES = CURVE, CYCLES, MEMORY, PICTURE = "material.csv", "material_cycles.csv", "material_memory.csv", "material.png"
USUAL_DEPTH = 1.0  # m, at most half of the block's depth
_NAMES = f"{CURVE}, {CYCLES}, {MEMORY} and {PICTURE}"
SIGNED = "# riser_soil material: "  # the first line's beginning, by which the program knows its files
CLOSED = 1e-9  # how far a cycle may end from its beginning, over its width


def study(scene: Scene, folder: Path, path: Path | None = None, depth: float | None = None, force: bool = False) -> str:
    """Drive a point and write curve, cycles and picture to a folder; a summary to print.

    path: CSV file, or None for growing cycles of shear. depth: below the seabed [m]. force: replace files that this
    program has written. Raises SceneError or SolveError before anything is written.
    """
    soil = _soil_of(scene)
    z = _depth(soil, depth)
    _refuse(folder, force)
    strain_path = read_path(path) if path is not None else shear_cycles()
    point = point_at(soil, z)
    curve = drive(point, strain_path)
    k = strain_path.driven
    driven = curve.stress if strain_path.stress[k] else curve.strain
    cycles = closed_cycles(driven[:, k], curve.strain[:, k], curve.stress[:, k])
    kind = law_at(soil, z)[0].kind
    heading = f"{SIGNED}{kind} at a depth of {z:g} m, {strain_path.source}; {STRAINS[k]} and {STRESSES[k]} are drawn"
    remembered = memory(point)
    tables = {CURVE: _curve_columns(curve), CYCLES: _cycle_columns(cycles), MEMORY: table_columns(remembered)}
    _write_files(folder, heading, tables)
    return "\n".join(
        [*_summary_lines(soil, z, strain_path, curve, cycles), *in_words(remembered), f"written: {_NAMES} in {folder}"]
    )


def _soil_of(scene: Scene) -> SoilScene:
    if scene.soil is None:
        raise SceneError("soil: the scene has none, so there is no material to drive; add soil: {block, mesh, law}")
    return scene.soil


def _depth(soil: SoilScene, wanted: float | None) -> float:
    block = soil.given_block.depth if soil.given_block else np.inf
    if wanted is None:
        return min(USUAL_DEPTH, 0.5 * block)
    if not 0.0 <= wanted <= block:
        raise SceneError(f"--depth {wanted:g}: must lie in the soil, from 0 to {block:g} m below the seabed")
    return wanted


def _refuse(folder: Path, force: bool) -> None:
    """Raises SceneError where files would be replaced that may not be."""
    refuse_file(folder)
    for name in FILES:
        if not os.path.lexists(folder / name):
            continue
        if not force:
            raise SceneError(f"{folder / name}: is there already; choose another folder (-o) or add --force")
        if not _own(folder / name):
            raise SceneError(f"{folder / name}: was not written by riser_soil; move it away, or choose another folder")


def _own(file: Path) -> bool:
    if file.is_symlink() or not file.is_file():
        return False
    with file.open("rb") as opened:
        return SIGNED.strip("# ").encode() in opened.read(2000)


def _write_files(folder: Path, heading: str, tables: dict[str, dict[str, Array]]) -> None:
    """Write all files, none of them by halves."""
    from riser_soil.plots.soil_curves import draw

    with written_together(folder, FILES) as drafts:
        for name, columns_of in tables.items():
            _write(drafts / name, heading, columns_of)
        draw(drafts / CURVE, drafts / CYCLES, drafts / PICTURE)


def _write(file: Path, heading: str, columns: dict[str, Array]) -> None:
    rows = np.column_stack(list(columns.values()))
    lines = [heading, ", ".join(columns), *(", ".join(f"{value:.12g}" for value in row) for row in rows)]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _curve_columns(curve: MaterialCurve) -> dict[str, Array]:
    return {
        "row [-]": np.arange(len(curve.strain), dtype=float),
        **{f"{name} [-]": curve.strain[:, k] for k, name in enumerate(STRAINS)},
        **{f"{name} [Pa]": curve.stress[:, k] for k, name in enumerate(STRESSES)},
        "mean_stress [Pa]": mandel.mean(curve.stress),
        "von_mises_stress [Pa]": mandel.von_mises(curve.stress * STRESS_FACTOR),
        "equivalent_plastic_strain [-]": curve.plastic_strain,
        "dissipated [J/m3]": curve.dissipated,
    }


def _cycle_columns(cycles: list[ClosedCycle]) -> dict[str, Array]:
    names = "first_row [-]", "last_row [-]", "strain_amplitude [-]", "mean_strain [-]", "secant_modulus [Pa]"
    columns = np.array(cycles, dtype=float).reshape(-1, 6).T
    return dict(zip((*names, "damping_ratio [-]"), columns, strict=True))


def _summary_lines(
    soil: SoilScene, z: float, path: MaterialPath, curve: MaterialCurve, cycles: list[ClosedCycle]
) -> list[str]:
    k = path.driven
    stress = np.abs(curve.stress[:, k] - curve.stress[0, k]).max()
    lines = [
        f"{law_at(soil, z)[0].kind} at a depth of {z:g} m, {len(path.values)} rows of {', '.join(path.names)} from "
        f"{path.source}",
        f"largest change of {STRESSES[k]} {1e-3 * stress:.4g} kPa; dissipated {curve.dissipated[-1]:.4g} J/m3",
    ]
    if cycles:
        lines.append(f"{'amplitude [-]':>15} {'secant [kPa]':>14} {'damping [%]':>12}")
        last = {f"{c.amplitude:.6g}": c for c in cycles}.values()
        lines += [f"{c.amplitude:15.4g} {1e-3 * c.secant_modulus:14.5g} {100.0 * c.damping_ratio:12.3f}" for c in last]
    return lines


class ClosedCycle(NamedTuple):
    """Rows from first to last; strain amplitude and mean strain [-]; secant modulus [Pa]: stress over strain, from turn
    to turn; damping ratio [-]: area of the loop over 4π times the elastic energy ½ stress amplitude × strain amplitude.
    """

    first: int
    last: int
    amplitude: float
    mean: float
    secant_modulus: float
    damping_ratio: float


def turns(x: Array) -> IntArray:
    """Rows where x (n,) turns back, the first and last row among them; of rows that stand still the last."""
    moves = np.flatnonzero(np.diff(x))
    sense = np.sign(np.diff(x)[moves])
    back = moves[1:][sense[1:] != sense[:-1]]
    return np.unique([0, *back, len(x) - 1]).astype(np.int64)


def closed_cycles(driven: Array, strain: Array, stress: Array) -> list[ClosedCycle]:
    """Cycles between a turn and the next but one that is at the same `driven` value (n,), strain or stress; strain (n,)
    and stress (n,) [Pa] make the loop.
    """
    at = turns(driven)
    out = []
    for a, b, c in zip(at, at[1:], at[2:], strict=False):
        if abs(driven[c] - driven[a]) <= CLOSED * abs(driven[b] - driven[a]):
            out.append(_cycle(a, b, c, strain, stress))
    return out


def _cycle(a: int, b: int, c: int, strain: Array, stress: Array) -> ClosedCycle:
    gamma, tau = strain[a : c + 1], stress[a : c + 1]
    area = abs(float(np.sum(0.5 * (tau[1:] + tau[:-1]) * np.diff(gamma))))
    width, height = abs(float(strain[b] - strain[a])), abs(float(stress[b] - stress[a]))
    elastic = 0.125 * width * height
    mean = 0.5 * float(strain[a] + strain[b])
    damping = area / (4.0 * np.pi * elastic) if elastic > 0.0 else 0.0
    return ClosedCycle(int(a), int(c), 0.5 * width, mean, height / width if width > 0.0 else np.inf, float(damping))
