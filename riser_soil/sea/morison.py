"""Morison's loads in water that may move and need not cover all: drag, Froude-Krylov force, added mass; part "morison".

The pipe's velocity v and acceleration a meet those of the undisturbed water at its axis, u and u'. With the cross-
section A = pi D^2/4 and the added mass m of `morison_law`,

    force = drag of (v - u) - m a + m u' + rho A u'.

The last term, that of Froude and Krylov, is what the pressure of the undisturbed water does to a piece of the pipe of
length ds closed at both ends: minus its gradient rho u' times the volume A ds, in all directions. A piece within the
line is open; the dynamic pressure on its ends is part of the effective tension, as the static one is (Sparks, Journal
of Energy Resources Technology 106, 1984, on closed pressure fields; DNV-RP-C205, 6.2, for the whole formula). All terms
with u' are known from where the pipe is; as external forces they belong to group F, so that the time scheme stays of
second order, while m a is inertia.
Where a surface leaves some of the pipe dry, all act on its wet share S alone. The added mass is what is wet at the
time, at rest as it gets wet: force = S m (u' - a), without a term for entry into the water (slamming).
Source: Morison et al., Petroleum Transactions 189 (1950), in its relative form.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Traits
from riser_soil.riser.line_part import CompiledPart
from riser_soil.sea.morison_kernels import StillWaterData, still_water
from riser_soil.sea.moving_water_kernels import MovingWaterData, moving_water
from riser_soil.sea.pipe import Pipe
from riser_soil.sea.stream_kernels import FlowAtStations, update


@dataclass(frozen=True, eq=False)
class WaterLoads:
    """Resistance of the water per length [N/m], the negative of its force on a pipe.

    drag, mass: coefficients (ne, 2), normal and tangential, of `morison_law.drag_coefficients` [kg/m2] and
    `morison_law.added_masses` [kg/m]. water: around the pipe, where it moves or has a surface. pushed: masses (ne, 2)
    [kg/m] on which its acceleration acts, see `pushed_masses`. span: widths (ne, ng) [m] of the sections, where they
    may get dry. dissipative: whether all work of the group F is lost, as in still water, and none can be put in.
    """

    pipe: Pipe
    drag: Array
    mass: Array
    water: FlowAtStations | None = None
    pushed: Array | None = None
    span: Array | None = None
    dissipative: bool = True

    def kernel_data(self) -> StillWaterData | MovingWaterData:
        """See `LinePart.kernel_data`."""
        if self.water is None and not self.pipe.points_alone:
            return still_water(self.pipe, self.drag, self.mass)
        stream = (self.water or FlowAtStations(self.pipe)).stream
        found = moving_water(stream, self.pipe, self.drag, self.mass)._replace(dissipative=self.dissipative)
        if self.pushed is not None:
            found = found._replace(pushed=self.pushed)
        return found if self.span is None else found._replace(partly=True, span=self.span)


def through(water: FlowAtStations, span: Array | None = None, dissipative: bool = False) -> WaterLoads:
    """Of what moves through the water without drag and added mass of its own, see `through_kernels`."""
    nothing = np.zeros((len(water.pipe.share), 2))
    return WaterLoads(water.pipe, nothing, nothing, water, None, span, dissipative)


def pushed_masses(mass: Array, displaced: Array) -> Array:
    """m and rho A (ne, 2) of an added mass (ne, 2) and the mass of the displaced water (ne,) [kg/m], which is the same
    across and along the pipe.
    """
    return np.asarray(mass + displaced[:, None])


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
        self._seen = found.stream.seen if isinstance(found, MovingWaterData) else None
        if self._formed is None:
            return found
        assert isinstance(found, MovingWaterData)
        return self._formed(found)

    def renew_kernel_data(self, start: float, end: float) -> None:
        if self._seen is not None:
            update(self._seen, start, end)
