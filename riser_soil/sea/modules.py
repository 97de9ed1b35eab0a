"""Hydrodynamic loads on buoyancy modules and clump weights: drag and added mass alike in all directions.

At velocity v and acceleration a, a module of drag area Cd A and volume V with added mass coefficient Ca resists with

    1/2 rho Cd A |v| v + Ca rho V a,

and in accelerating water it feels rho V (1 + Ca) u', as a pipe does (`moving_water`): its loads are those of a pipe,
given per module instead of per length, at one station each. In section forces, the water's force on a module at the
riser's very end counts with the last element.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Weights
from riser_soil.riser import stations
from riser_soil.riser.attachments import PointAttachment, places
from riser_soil.riser.line import Line
from riser_soil.riser.stations import Derivatives
from riser_soil.riser.trial import Trial
from riser_soil.sea.pipe import Pipe, PointsOnLine, StationFlow
from riser_soil.sea.still_water import Resistance


def pipe_at(line: Line, modules: Sequence[PointAttachment]) -> Pipe:
    """The pipe seen at the modules (m,) alone: ne = m, ng = 1, forces in N instead of N/m."""
    element, xi = places(line, modules)
    return Pipe(line, PointsOnLine(element, stations.points(line.length[element], xi)))


def diameters(modules: Sequence[PointAttachment]) -> Array:
    """Diameters (m,) [m] of spheres of the same volume, or of discs of the drag area where those are larger."""
    volume, area = (np.array([getattr(module, name) for module in modules]) for name in ("volume", "drag_area"))
    return np.asarray(np.maximum(np.cbrt(6.0 * volume / np.pi), np.sqrt(4.0 * area / np.pi)))


class StillWaterOnModules(Resistance):
    """Drag (group F) and added mass (group I). drag: rho Cd A/2 [kg/m], mass: Ca rho V [kg], each (m,)."""

    def __init__(self, pipe: Pipe, drag: Array, mass: Array) -> None:
        super().__init__(pipe)
        self._drag, self._mass = drag[:, None, None], mass[:, None, None]

    def momentum(self, trial: Trial, v: Array) -> Array:
        return np.asarray(self._mass * v)

    def resist(self, flow: StationFlow) -> tuple[Array, Array]:
        return self._mass * flow.a, self._drag * np.linalg.norm(flow.v, axis=-1, keepdims=True) * flow.v

    def linearise(self, flow: StationFlow, weights: Weights) -> Derivatives:
        speed, one = np.linalg.norm(flow.v, axis=-1)[..., None, None], np.eye(flow.v.shape[-1])
        dyad = flow.v[..., :, None] * flow.v[..., None, :] / np.where(speed > 0.0, speed, 1.0)
        by_v = weights.force * self._drag[..., None] * (speed * one + dyad)
        by_a = np.ones_like(speed) * weights.inertia * self._mass[..., None] * one
        return Derivatives(np.zeros_like(by_v), np.zeros_like(by_v), by_v, by_a)
