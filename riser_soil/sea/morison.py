"""Hydrodynamic loads on the riser by Morison's formula: the part "morison"."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from riser_soil.core.part import Traits
from riser_soil.riser.compiled_part import CompiledPart
from riser_soil.sea.moving_water import WaterLoads
from riser_soil.sea.moving_water_kernels import MovingWaterData
from riser_soil.sea.stream_kernels import update


class Morison(CompiledPart):
    """Loads of the water at the pipe's stations, brought to the line: group I is the added mass, F all the rest.

    formed: what becomes of the loads' kernel data, where they have kernels of their own.

    Drag of still water dissipates; all that moving water does is external work, of either sign. So a riser at rest in a
    current neither gains nor loses energy, whatever supports it. External, too, is the change of kinetic energy by a
    change dm of the added mass, as it turns or gets wet, beyond the work of its force. That force is m a, so the
    remainder is 1/2 v.dm v per length. Written in rates alone it does not depend on the accelerations, which are of
    first order only in generalised-alpha.
    """

    name = "morison"
    traits = Traits("IF", symmetric=False, follows=True)

    def __init__(self, loads: WaterLoads, formed: Callable[[MovingWaterData], tuple[Any, ...]] | None = None) -> None:
        super().__init__(loads.pipe.line)
        self._loads, self._formed = loads, formed

    def make_kernel_data(self) -> tuple[Any, ...]:
        found = self._loads.kernel_data()
        self._seen = found.seen if isinstance(found, MovingWaterData) else None
        if self._formed is None:
            return found
        assert isinstance(found, MovingWaterData)
        return self._formed(found)

    def renew_kernel_data(self, start: float, end: float) -> None:
        if self._seen is not None:
            update(self._seen, start, end)
