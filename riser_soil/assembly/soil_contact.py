"""Assembly of what acts between a riser and the soil: contact, and the cushion that a riser is laid on."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from riser_soil.assembly.contact_laws import contact_width, smoothing, with_suction
from riser_soil.assembly.scales import contact_radius, scales_of
from riser_soil.contact.law import Penalty
from riser_soil.contact.node_contact import FOOTPRINT, NodeContact
from riser_soil.contact.seabed_contact import Cushion
from riser_soil.contact.soil_contact import SoilContact
from riser_soil.contact.surface_contact import SurfaceContact
from riser_soil.core.arrays import Array
from riser_soil.core.communicator import Communicator
from riser_soil.riser.line import Line
from riser_soil.riser.sections import Elements, larger_beside
from riser_soil.scene.contact import Contact as ContactScene
from riser_soil.scene.scene import Scene

if TYPE_CHECKING:
    from riser_soil.soil.condensed import SoilSurface

# Integration points across the width that touches at rest, as parts of the diameter, and how much farther apart along.
POINTS_ACROSS, FINEST, COARSEST, ALONG = 4.0, 1.0 / 200.0, 1.0 / 16.0, 4.0
CUSHION, LEVEL = 0.01, 0.01  # of the diameter: how far it gives under the riser's weight; unevenness of a level top


def soil_contact_of(
    scene: Scene, settings: ContactScene, line: Line, elements: Elements, surface: SoilSurface, stiffness: float
) -> SoilContact:
    """Contact of the riser with the soil; evaluated on the first rank. stiffness: of the penalty [N/m2]."""
    if not settings.at_nodes:
        return _surface_contact_of(scene, settings, line, elements, surface, stiffness)
    scales = scales_of(elements)
    outer_radius = float(larger_beside(0.5 * elements.outer_diameter).mean()) or 0.5 * scales.diameter
    return NodeContact(
        line,
        larger_beside(contact_radius(scene, elements)),
        surface,
        Penalty(stiffness, smoothing(settings, scales, "soil", stiffness)),
        footprint=FOOTPRINT * outer_radius,  # also where the axis touches: a single point finds no balance on a kink
        along=line.direction[:2],
    )


def _surface_contact_of(
    scene: Scene, settings: ContactScene, line: Line, elements: Elements, surface: SoilSurface, stiffness: float
) -> SurfaceContact:
    """Contact of the pipe's cylinder: the penalty's stiffness [N/m2] is spread over the width that touches at rest."""
    assert scene.soil is not None
    scales = scales_of(elements)
    width = contact_width(scales, scene.soil.top_law.surface_modulus(scales.diameter))
    penalty = Penalty(stiffness / width, smoothing(settings, scales, "soil", stiffness))
    suction = settings.suction
    across = float(np.clip(width / POINTS_ACROSS, FINEST * scales.diameter, COARSEST * scales.diameter))
    return SurfaceContact(
        line,
        contact_radius(scene, elements),
        surface,
        penalty if suction is None else with_suction(penalty, suction, "soil", scales.diameter),
        (ALONG * across, across),
        along=line.direction[:2],
    )


def cushion_of(
    scene: Scene, contact: SoilContact, elements: Elements, top: Array, comm: Communicator
) -> Cushion | None:
    """What holds the riser at first that is to lie on a level soil; collective.

    top (np, 3): points of the soil's surface [m], all of it on the first rank.
    """
    scales = scales_of(elements)
    level = bool(np.ptp(top[:, 2]) < LEVEL * scales.diameter) if len(top) else True
    if not comm.bcast(level):
        return None
    return Cushion(
        contact.line,
        contact_radius(scene, elements),
        scene.seabed_level,
        scales.weight,
        CUSHION * scales.diameter,
        contact.covering,
    )
