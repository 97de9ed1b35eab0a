"""Records of states: rows of the time series and of the step table, frames of the XDMF files."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from functools import cache
from typing import Any

import numpy as np

from riser_soil.core import outputs
from riser_soil.core.snapshot import Instant, Ledger, SoilSnapshot, StepRecord
from riser_soil.core.step_outputs import OF_STEP
from riser_soil.results.xdmf import Frame


def series_rows(stamps: Sequence[float], seen: Instant, fields: Collection[str]) -> dict[str, Any]:
    """Of many instants, by the names of netcdf.SERIES, but for choices that are not among the fields."""
    return {"time": np.array(stamps)} | {name: get(seen) for name, get in _wanted(tuple(fields))}


@cache
def _wanted(fields: tuple[str, ...]) -> list[tuple[str, Callable[[Instant], Any]]]:
    """Names of what is recorded, and how each follows from what is seen."""
    recorded = (output for output in outputs.of_instant() if output.where != "summary")
    return [(output.name, output.get) for output in recorded if output.name in fields or not output.chosen]


def step_rows(steps: Sequence[StepRecord], accounts: Collection[str]) -> dict[str, list[float]]:
    """By the names of netcdf.HEALTH and the ledger's accounts; what a step has not booked is 0."""
    booked = [_booked(step.ledger) for step in steps]
    return {
        **{output.name: [output.get(step) for step in steps] for output in OF_STEP},
        **{name: [each.get(name, 0.0) for each in booked] for name in accounts},
    }


def _booked(ledger: Ledger) -> dict[str, float]:
    lost = {f"dissipated_{name}": value for name, value in ledger.dissipated_by.items()}
    return lost | {f"work_{name}": value for name, value in ledger.work_by.items()}


def soil_frame(stamp: float, soil: SoilSnapshot, fields: Collection[str]) -> Frame:
    wanted = [output for output in outputs.OF_SOIL if output.name in fields]
    return Frame(
        stamp,
        {output.name: output.get(soil) for output in wanted if output.where == "soil points"},
        {output.name: output.get(soil) for output in wanted if output.where == "soil cells"},
    )
