"""Buoyancy lost by the riser where it is out of the water: the part "buoyancy"."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import fixed
from riser_soil.core.part import Traits
from riser_soil.riser.compiled_part import CompiledPart
from riser_soil.riser.stations import element_workspace
from riser_soil.sea.buoyancy_kernels import DryPipeData, DryStationData
from riser_soil.sea.moving_water import FlowAtStations
from riser_soil.sea.stream_kernels import update

Dry = Callable[[FlowAtStations, bool], DryPipeData | DryStationData]
"""Buoyancy lost where a body is dry in water with a surface, the weight of the displaced water times the dry share
1 - S; flat: see `Buoyancy`.
"""


def dry_stations(span: Array, displaced: Array) -> Dry:
    """By the dry share at the stations of a pipe, see `DryStationData`."""

    def numbers(water: FlowAtStations, flat: bool) -> DryStationData:
        pipe, seen, d = water.pipe, water.in_loop, water.pipe.line.dimension
        return DryStationData(
            stream=seen.stream,
            seen=seen.seen,
            element=pipe.element,
            at=pipe.at,
            share=pipe.share,
            span=span,
            displaced=displaced,
            flat=flat,
            f=np.zeros(d),
            by_x=np.zeros((d, d)),
            change=element_workspace(2 * pipe.line.ndof, fixed(d)),
        )

    return numbers


class Buoyancy(CompiledPart):
    """Lost buoyancy of the dry part of the riser (group F), downwards.

    flat: whether the surface is level and at rest; the force then has a potential, zero when all is submerged. Waves do
    work on it instead.
    """

    name = "buoyancy"

    def __init__(self, water: FlowAtStations, dry: Dry, flat: bool) -> None:
        super().__init__(water.pipe.line)
        self._water, self._dry, self._flat = water, dry, flat
        self.traits = Traits("F", symmetric=flat)

    def make_numbers(self) -> DryPipeData | DryStationData:
        return self._dry(self._water, self._flat)

    def renew_kernel_data(self, start: float, end: float) -> None:
        update(self._water.in_loop.seen, start, end)
