"""Assembly of the seabed: its shape, and a line's contact with it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from riser_soil.assembly.scales import contact_radius
from riser_soil.contact.seabed_contact import SeabedContact
from riser_soil.core.arrays import Array
from riser_soil.riser.line import Line
from riser_soil.riser.sections import Elements
from riser_soil.riser.stations import ENDS, gauss
from riser_soil.scene.bathymetry import seabed_axis
from riser_soil.scene.contact import Contact as ContactScene
from riser_soil.scene.plane import resolved_dimension
from riser_soil.scene.scene import Scene
from riser_soil.scene.seabed import Seabed
from riser_soil.seabed.grounds import Ground, Plane
from riser_soil.seabed.law import NormalLaw

if TYPE_CHECKING:
    from riser_soil.contact.soil_contact import SoilContact

GAUSS_POINTS = 5  # of an element on the seabed: where the force sets in within it, three leave ten times the error


def seabed_contact_of(
    scene: Scene, settings: ContactScene, line: Line, elements: Elements, law: NormalLaw, beside: SoilContact | None
) -> SeabedContact:
    """Contact of the riser with the seabed, beside the soil where there is one."""
    assert scene.seabed is not None
    return SeabedContact(
        line,
        contact_radius(scene, elements),
        ground_of(scene, scene.seabed),
        law,
        ENDS if settings.at_nodes else gauss(GAUSS_POINTS),
        covering=None if beside is None else beside.covering,
    )


def ground_of(scene: Scene, seabed: Seabed) -> Ground:
    """The seabed's shape."""
    origin, direction = (np.asarray(vector) for vector in seabed_axis(scene))
    if seabed.profile is not None or seabed.grid is not None:
        return _by_heights(scene, seabed, origin, direction)
    if seabed.slope_deg == 0.0:
        return Plane.level(seabed.level)
    towards = float(np.arctan2(direction[1], direction[0]))
    return Plane.sloping(np.array([*origin[:2], seabed.level]), np.radians(seabed.slope_deg), towards)


def _by_heights(scene: Scene, seabed: Seabed, origin: Array, direction: Array) -> Ground:
    """A seabed given by its heights, along a line or over a grid."""
    from riser_soil.seabed.height_field import HeightField, Profile

    if seabed.profile is not None:
        return Profile(origin[:2], direction[:2], *np.array(seabed.profile).T)
    assert seabed.grid is not None
    heights, section = seabed.grid.heights, direction[:2] if resolved_dimension(scene) == 2 else None
    return HeightField(np.array(heights.x), np.array(heights.y), np.array(heights.z), section)


def mean_diameter(elements: Elements) -> float:
    """That along the line [m]: of laws for a line of several diameters."""
    return float(np.average(elements.outer_diameter, weights=elements.length))
