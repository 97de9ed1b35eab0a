"""Moments about the axes of the riser's section: its tangent and the two axes across it that turn with the pipe.

In space the first section's y axis is horizontal before all motion, to the left of the tangent (of a vertical one along
the global y axis), and z completes the right-handed frame; along the riser frames follow without twist. In a plane y is
normal to it, to the left of the direction from start to end, and so z points up where the riser is level.
"""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.riser.line import Line
from riser_soil.riser.section_forces import section_frames
from riser_soil.riser.trial import Trial

_UP = np.array([0.0, 0.0, 1.0])


def about_section_axes(line: Line, trial: Trial, moment: Array) -> Array:
    """Torque and bending moments about y and z (nn, 3) [N m] of section moments (nn, 3) in global axes."""
    if line.dimension == 2:
        return np.outer(moment @ np.cross(_UP, line.direction), [0.0, 1.0, 0.0])
    at_ends = np.stack([moment[:-1], moment[1:]], axis=1)
    found = np.einsum("esij,esi->esj", np.stack(section_frames(trial), axis=1), at_ends)
    beside = np.zeros((line.nodes, 3))
    beside[:-1] += found[:, 0]
    beside[1:] += found[:, 1]
    beside[1:-1] *= 0.5
    return beside
