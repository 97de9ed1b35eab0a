"""Lost buoyancy of the partly submerged pipe, integrated finely so that Archimedes' law holds at any inclination."""

from __future__ import annotations

import math

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import fixed
from riser_soil.core.part import Weights
from riser_soil.riser.trial import Trial
from riser_soil.sea import waterline
from riser_soil.sea.buoyancy_kernels import DryPipeNumbers
from riser_soil.sea.pipe import Pipe
from riser_soil.sea.waterline import WetElements
from riser_soil.sea.wetting import WaterSurface

# Fine points that a section's width holds at least, so that an upright pipe gets wet evenly; an element has no more
# than MOST of them, and the width of its sections follows where its diameter is too small for that.
WITHIN_WIDTH, MOST = 6, 200


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
        F[..., -1] = self._displaced[:, None] * waterline.dry_lengths(tuple(self._points), tuple(self._wet(trial)))
        return F

    def add_tangent(self, K: Array, trial: Trial, weights: Weights) -> None:
        gradient, weight = self._surface.immersion(trial)[1], weights.force * self._displaced
        waterline.add_tangent(K, self._points, self._wet(trial), self._pipe.at.N, gradient, weight, trial.turn.P)

    def potential(self, trial: Trial) -> float:
        return float(self._displaced @ waterline.dry_potentials(tuple(self._points), tuple(self._wet(trial))))

    def numbers(self, flat: bool) -> DryPipeNumbers:
        pipe, water, ng = self._pipe, self._surface.in_loop, self._pipe.share.shape[1]
        return DryPipeNumbers(
            stream=water.stream,
            seen=water.seen,
            points=self._points,
            at=pipe.at,
            length=self._length,
            width=self._width,
            displaced=self._displaced,
            flat=flat,
            room=waterline.tangent_room(ng, 2 * pipe.line.ndof, fixed(pipe.line.dimension)),
            z=np.zeros(4),
            heights=np.zeros(ng),
            dry=np.zeros(4),
            before=np.zeros(4),
        )

    def _wet(self, trial: Trial) -> WetElements:
        h, _ = self._surface.immersion(trial)
        z, stations = (np.ascontiguousarray(x[..., -1]) for x in (trial.q, self._pipe.position(trial)))
        return WetElements(z, h, stations, self._length, self._width)
