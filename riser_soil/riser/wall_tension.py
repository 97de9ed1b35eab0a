"""Wall tension of the pipe from effective tension, internal and external pressure.

    T_w = T + p_i A_i - p_o A_o,    p_i = p + rho_i g (z_p - z),    p_o = rho_o g (z_s - z), at least 0.

The effective tension T is what carries, bends and stretches the line here: its elements strain by T/EA, to which
neither the pressures' action on closed ends nor Poisson's ratio add. Gauge pressures of fluids at rest: what waves and
the contents' acceleration add is left out. Source: Sparks, Journal of Energy Resources Technology 106 (1984).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from riser_soil.core.arrays import Array


@dataclass(frozen=True)
class HydrostaticPressure:
    """A fluid at rest: gauge pressure [Pa] at a level z [m], and its increase per depth [Pa/m]."""

    level: float
    per_depth: float
    pressure: float = 0.0

    def at(self, z: Array) -> Array:
        """Pressure [Pa]."""
        return self.pressure + self.per_depth * (self.level - z)


@dataclass(frozen=True, eq=False)
class Pressures:
    """Fluids inside and outside a pipe, None where there is none.

    inner_diameter, outer_diameter: (ne,) m, of the pipe without a bend stiffener. At a joint the areas are the means of
    both sides, as section forces are.
    """

    inside: HydrostaticPressure | None
    outside: HydrostaticPressure | None
    inner_diameter: Array
    outer_diameter: Array

    def at(self, z: Array) -> tuple[Array, Array]:
        """Pressure inside and outside [Pa] at heights [m]; 0 where there is no fluid."""
        inside, outside = (np.zeros_like(z) if fluid is None else fluid.at(z) for fluid in (self.inside, self.outside))
        return inside, np.maximum(outside, 0.0)

    def wall_tension(self, effective: Array, z: Array) -> Array:
        """N, positive in tension, from the effective tension [N] and the heights [m] of the nodes, each (..., nn)."""
        wall, (bore, around) = effective, self._areas
        if self.inside is not None:
            wall = wall + self.inside.at(z) * bore
        if self.outside is not None:
            wall = wall - np.maximum(self.outside.at(z), 0.0) * around
        return wall

    @cached_property
    def _areas(self) -> tuple[Array, Array]:
        return _areas_at_nodes(self.inner_diameter), _areas_at_nodes(self.outer_diameter)


def _areas_at_nodes(diameter: Array) -> Array:
    area = 0.25 * np.pi * diameter**2
    return np.asarray(0.5 * (np.append(area[0], area) + np.append(area, area[-1])))
