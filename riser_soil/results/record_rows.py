"""What is written of one state: rows of the series and of the energy ledger, frames of the pictures."""

from __future__ import annotations

from typing import Any

from riser_soil.core.arrays import Array
from riser_soil.core.snapshot import Ledger, RiserSnapshot, SoilSnapshot, Touch
from riser_soil.results.summary import bend_radius
from riser_soil.results.xdmf import Frame


def series_row(stamp: float, arc: Array, riser: RiserSnapshot, touch: Touch) -> dict[str, Any]:
    """By the names of netcdf.SERIES."""
    slack, bent = riser.effective_tension.argmin(), riser.curvature.argmax()
    return {
        **vars(touch),
        **vars(riser),
        "time": stamp,
        "contact_force_sum": touch.contact_force,
        "min_effective_tension": riser.effective_tension[slack],
        "min_effective_tension_arc": arc[slack],
        "min_bend_radius": bend_radius(riser.curvature[bent]),
        "min_bend_radius_arc": arc[bent],
    }


def ledger_row(ledger: Ledger) -> dict[str, float]:
    return {
        "kinetic_energy": ledger.kinetic,
        "strain_energy": ledger.strain,
        "potential_energy": ledger.potential,
        "dissipated": ledger.dissipated,
        "dissipated_time_scheme": ledger.numerical,
        "work": ledger.work,
        "relative_energy_residual": ledger.relative_residual,
        **{f"dissipated_{name}": value for name, value in ledger.dissipated_by.items()},
        **{f"work_{name}": value for name, value in ledger.work_by.items()},
    }


def soil_frame(stamp: float, soil: SoilSnapshot, fields: tuple[str, ...]) -> Frame:
    on_cells = {"von_mises_stress": soil.von_mises, "equivalent_plastic_strain": soil.plastic_strain}
    return Frame(
        stamp,
        {"displacement": soil.displacement} if "displacement" in fields else {},
        {name: values for name, values in on_cells.items() if name in fields},
    )
