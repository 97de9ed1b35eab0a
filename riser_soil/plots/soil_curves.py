"""Pictures of a soil's curves: resistance by penetration, and a material point's stress, modulus and damping."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from riser_soil.core.arrays import Array
from riser_soil.plots.curves import save, sheet

Curve = tuple[Array, Array]


"""Penetration w (n,) [m] and resistance V (n,) [N/m]."""


def draw_resistance(png: Path, measured: Curve, model: Curve, title_lines: Sequence[str], diameter: float) -> Path:
    """Measured points, the model's curve, and what was found above them; diameter [m]: of the pipe."""
    figure, (axes,) = sheet(1, 1, width=7.0, height=5.0)
    axes.plot(measured[0] / diameter, 1e-3 * measured[1], "o", color="0.45", markersize=3.5, label="measured")
    axes.plot(model[0] / diameter, 1e-3 * model[1], color="C3", linewidth=1.4, label="fitted")
    axes.set(xlabel="penetration w/D [-]", ylabel="resistance V [kN/m], + pushes the pipe up")
    axes.set_title("\n".join(title_lines), fontsize=8, loc="left")
    axes.legend()
    return save(figure, png)


def draw(curve: Path, cycles: Path, png: Path) -> None:
    """Draw the files of `riser-soil material`; what their first line says is the title."""
    table, heading = _read(curve)
    loops, _ = _read(cycles)
    title, _, shown = heading.rpartition("; ")
    x, y = shown.split()[0], shown.split()[2]
    closed = len(loops["strain_amplitude"]) > 0
    figure, panels = sheet(2 if closed else 1, 2, width=10.0, height=3.8)
    figure.suptitle(title.lstrip("# "))
    _line(panels[0], table[x], 1e-3 * table[y], f"{x} [-]", f"{y} [kPa]")
    pressure, q = -1e-3 * table["mean_stress"], 1e-3 * table["von_mises_stress"]
    _line(panels[1], pressure, q, "mean pressure [kPa], compression positive", "von Mises stress q [kPa]")
    if closed:
        order = np.argsort(loops["strain_amplitude"], kind="stable")
        amplitude = loops["strain_amplitude"][order]
        _by_amplitude(panels[2], amplitude, 1e-3 * loops["secant_modulus"][order], f"secant modulus {y}/{x} [kPa]")
        _by_amplitude(panels[3], amplitude, 100.0 * loops["damping_ratio"][order], "damping ratio [%]")
    figure.savefig(png, dpi=120, metadata={"Software": "riser_soil material: "})


def _read(file: Path) -> tuple[dict[str, Array], str]:
    """Columns by name without unit, and the first line."""
    heading, header, *rows = file.read_text(encoding="utf-8").splitlines()
    names = [name.split(" [")[0] for name in header.split(", ")]
    values = np.array([row.split(", ") for row in rows], dtype=float).reshape(-1, len(names))
    return dict(zip(names, values.T, strict=True)), heading


def _line(axes: Axes, x: Array, y: Array, across: str, up: str) -> None:
    axes.plot(x, y, linewidth=1.0)
    axes.plot(x[:1], y[:1], "o", markersize=4.0, label="start")
    axes.set_xlabel(across)
    axes.set_ylabel(up)
    axes.legend()


def _by_amplitude(axes: Axes, amplitude: Array, values: Array, up: str) -> None:
    axes.semilogx(amplitude, values, "o-", markersize=4.0, linewidth=1.0)
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("strain amplitude [-]")
    axes.set_ylabel(up)
