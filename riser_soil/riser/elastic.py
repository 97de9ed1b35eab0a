"""What the formulas of a line's elements take: their unstressed shapes and elastic stiffnesses."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.riser import beam2d, beam3d
from riser_soil.riser.directors import PlanarFrames
from riser_soil.riser.line import Line
from riser_soil.riser.sections import Elements
from riser_soil.riser.spatial_directors import SpatialFrames

Planar = tuple[beam2d.PlanarReference, beam2d.PlanarSection]
Spatial = tuple[beam3d.SpatialReference, beam3d.SpatialSection]


def in_plane(line: Line, frames: PlanarFrames, elements: Elements) -> Planar:
    """EI is EI_y, as the second section axis is normal to the plane."""
    section = beam2d.PlanarSection(elements.EA, elements.stiffness()[0])
    return beam2d.reference(line.chord0, *_ends(frames.alpha0), line.length), section


def in_space(line: Line, frames: SpatialFrames, elements: Elements) -> Spatial:
    section = beam3d.SpatialSection(elements.EA, *elements.stiffness(), elements.GJ)
    return beam3d.reference(line.chord0, *_ends(frames.T0), line.length), section


def _ends(orientation: Array) -> tuple[Array, Array]:
    """Of both ends, from (ne, 2, ...)."""
    return np.ascontiguousarray(orientation[:, 0]), np.ascontiguousarray(orientation[:, 1])
