"""Hydrodynamic loads on buoyancy modules and clump weights: drag and added mass alike in all directions.

At velocity v and acceleration a, a module of drag area Cd A and volume V with added mass coefficient Ca resists with

    1/2 rho Cd A |v| v + Ca rho V a,

and in accelerating water it feels rho V (1 + Ca) u', as a pipe does (`moving_water`): its loads are those of a pipe
without a direction, given per module instead of per length, at one station each. In section forces, the water's force
on a module at the riser's very end counts with the last element.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.riser import stations
from riser_soil.riser.attachments import PointAttachment, places
from riser_soil.riser.line import Line
from riser_soil.sea.pipe import Pipe, PointsOnLine


def pipe_at(line: Line, modules: Sequence[PointAttachment]) -> Pipe:
    """The pipe seen at the modules (m,) alone: ne = m, ng = 1, forces in N instead of N/m."""
    element, xi = places(line, modules)
    return Pipe(line, PointsOnLine(element, stations.points(line.length[element], xi)))


def alike(coefficient: Array) -> Array:
    """Coefficients (m, 2) of `morison_law`, which are one (m,) in all directions."""
    return np.stack([coefficient, coefficient], axis=-1)


def diameters(modules: Sequence[PointAttachment]) -> Array:
    """Diameters (m,) [m] of spheres of the same volume, or of discs of the drag area where those are larger."""
    volume, area = (np.array([getattr(module, name) for module in modules]) for name in ("volume", "drag_area"))
    return np.asarray(np.maximum(np.cbrt(6.0 * volume / np.pi), np.sqrt(4.0 * area / np.pi)))
