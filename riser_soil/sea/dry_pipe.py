"""Lost buoyancy of the partly submerged pipe, integrated finely so that Archimedes' law holds at any inclination."""

from __future__ import annotations

import math

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import fixed
from riser_soil.sea import waterline
from riser_soil.sea.buoyancy import Dry
from riser_soil.sea.buoyancy_kernels import DryPipeData
from riser_soil.sea.moving_water import FlowAtStations

# Fine points that a section's width holds at least, so that an upright pipe gets wet evenly; an element has no more
# than MOST of them, and the width of its sections follows where its diameter is too small for that.
WITHIN_WIDTH, MOST = 6, 200


def dry_pipe(displaced: Array) -> Dry:
    """Sections of the pipe at many points of each element, under the surface as its stations see it.

    displaced: weight of the water in the pipe's place [N/m] (ne,).
    """

    def numbers(water: FlowAtStations, flat: bool) -> DryPipeData:
        pipe, seen, ng = water.pipe, water.in_loop, water.pipe.share.shape[1]
        L, D = pipe.line.length, pipe.line.outer_diameter
        apart = 0.5 * np.pi * L  # times n, at most, between neighbours of n Gauss-Legendre points
        n = min(MOST, max(4, math.ceil(WITHIN_WIDTH * float(np.max(apart / np.maximum(D, 1e-9 * apart))))))
        return DryPipeData(
            stream=seen.stream,
            seen=seen.seen,
            points=waterline.fine_points(n),
            at=pipe.at,
            length=L,
            width=np.maximum(D, WITHIN_WIDTH * apart / n),
            displaced=displaced,
            flat=flat,
            workspace=waterline.tangent_workspace(ng, 2 * pipe.line.ndof, fixed(pipe.line.dimension)),
            z=np.zeros(4),
            heights=np.zeros(ng),
            dry=np.zeros(4),
            before=np.zeros(4),
        )

    return numbers
