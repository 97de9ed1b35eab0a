"""Matplotlib plot of resistance by penetration: measured points and a model's curve."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from riser_soil.core.arrays import Array
from riser_soil.plots.curves import save, sheet

Curve = tuple[Array, Array]
"""Penetration w (n,) [m] and resistance V (n,) [N/m]."""


def draw_resistance(png: Path, measured: Curve, model: Curve, told: Sequence[str], diameter: float) -> Path:
    """Measured points, the model's curve, and what was found above them; diameter [m]: of the pipe."""
    figure, (axes,) = sheet(1, 1, width=7.0, height=5.0)
    axes.plot(measured[0] / diameter, 1e-3 * measured[1], "o", color="0.45", markersize=3.5, label="measured")
    axes.plot(model[0] / diameter, 1e-3 * model[1], color="C3", linewidth=1.4, label="fitted")
    axes.set(xlabel="penetration w/D [-]", ylabel="resistance V [kN/m], + pushes the pipe up")
    axes.set_title("\n".join(told), fontsize=8, loc="left")
    axes.legend()
    return save(figure, png)
