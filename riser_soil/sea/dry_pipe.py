"""Lost buoyancy of the partly submerged pipe, integrated finely so that Archimedes' law holds at any inclination."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Weights
from riser_soil.riser.trial import Trial
from riser_soil.sea import waterline
from riser_soil.sea.pipe import Pipe
from riser_soil.sea.wetting import WaterSurface

# Fine points that a section's width holds at least, so that an upright pipe gets wet evenly; an element has no more
# than MOST of them, and the width of its sections follows where its diameter is too small for that.
WITHIN_WIDTH, MOST = 6, 200


class _Sections(NamedTuple):
    """Arguments of `waterline`'s functions."""

    xi: Array
    w: Array
    lag: Array
    z: Array
    h: Array
    stations: Array
    L: Array
    b: Array


class DryPipe:
    """A `LostBuoyancy`: sections of the pipe at many points of each element, under the surface as its stations see it.

    displaced: weight of the water in the pipe's place [N/m] (ne,).
    """

    def __init__(self, pipe: Pipe, surface: WaterSurface, displaced: Array) -> None:
        self._pipe, self._surface, self._displaced = pipe, surface, displaced
        # neighbours of n Gauss-Legendre points lie at most pi L/(2 n) apart
        self._length, D = pipe.line.length, pipe.line.outer_diameter
        apart = 0.5 * np.pi * self._length
        n = min(MOST, max(4, math.ceil(WITHIN_WIDTH * float(np.max(apart / np.maximum(D, 1e-9 * apart))))))
        self._points = waterline.fine_points(n)
        self._width = np.maximum(D, WITHIN_WIDTH * apart / n)

    def residual(self, trial: Trial) -> Array:
        F = np.zeros_like(trial.q)
        F[..., -1] = self._displaced[:, None] * waterline.dry_lengths(*self._sections(trial))
        return F

    def add_tangent(self, K: Array, trial: Trial, weights: Weights) -> None:
        by_q = weights.force * self._displaced[:, None, None, None] * self._derivatives(trial)
        waterline.add_tangent(K, by_q, trial.turn.P)

    def potential(self, trial: Trial) -> float:
        return float(self._displaced @ waterline.dry_potentials(*self._sections(trial)))

    def _sections(self, trial: Trial) -> _Sections:
        h, _ = self._surface(trial)
        z, stations = (np.ascontiguousarray(x[..., -1]) for x in (trial.q, self._pipe.position(trial)))
        return _Sections(*self._points, z, h, stations, self._length, self._width)

    def _derivatives(self, trial: Trial) -> Array:
        """Derivatives of the dry lengths by q (ne, 4, 4, d): as the pipe moves, and as the surface above it changes."""
        by_height, by_surface = waterline.slopes(*self._sections(trial))
        by_q = np.zeros((*by_height.shape, self._pipe.line.dimension))
        by_q[..., -1] = by_height
        at = np.flatnonzero(by_surface.any(axis=(1, 2)))  # where the pipe comes out
        slope = self._surface(trial)[1][at]
        slope[..., -1] += 1.0
        by_q[at] += np.einsum("eag,egc,egj->eacj", by_surface[at], self._pipe.at.N[at], slope)
        return by_q
