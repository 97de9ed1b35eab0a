"""Assembly of friction on seabed and soil."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from riser_soil.assembly.contact_laws import contact_width
from riser_soil.assembly.scales import SHALLOWEST, Scales, scales_of
from riser_soil.contact.coulomb import Adhesion, adhesion_at
from riser_soil.contact.friction import CoulombFriction, mobilised_within
from riser_soil.contact.seabed_contact import SeabedContact
from riser_soil.core.arrays import IntArray
from riser_soil.riser.sections import Elements
from riser_soil.scene.contact import Friction
from riser_soil.scene.scene import Scene
from riser_soil.scene.seabed import Seabed
from riser_soil.scene.soil import SoilScene
from riser_soil.scene.soil_law import strength_of

if TYPE_CHECKING:
    from riser_soil.contact.soil_friction import SoilAdhesion, SoilFriction
    from riser_soil.contact.surface_contact import SurfaceContact

MOBILISATION = 1.0 / 30.0  # of the outer diameter: the slide that mobilises friction
FULL_AT = 0.1  # of su: the pressure from which on adhesion is full where no coefficient is given


def friction_of(
    seabed: Seabed, given: Friction, contact: SeabedContact, elements: Elements, diameter: float
) -> CoulombFriction:
    """Friction on the seabed. diameter: of the pipe, for the law of adhesion [m]."""
    mu, slide = coefficients(given, scales_of(elements))
    adhesion = seabed_adhesion(seabed, given.adhesion, diameter)
    most, _ = adhesion_at(adhesion, 0.5 * adhesion.diameter)
    stiffness = mobilised_within(slide, *mu, np.abs(elements.weight), most)
    return CoulombFriction(contact, *mu, stiffness, adhesion)


def seabed_adhesion(seabed: Seabed, share: float | None, diameter: float) -> Adhesion:
    """Adhesion of clay to a pipe of a diameter [m]; without a limit on ground that has no strength."""
    strength = seabed.undrained_strength
    if share is None or strength is None:
        return Adhesion()
    return Adhesion(share, strength, diameter)


def soil_friction_of(
    scene: Scene, soil: SoilScene, given: Friction, contact: SurfaceContact, elements: Elements, volume: IntArray
) -> SoilFriction:
    """Friction on the soil, where the pipe's surface touches it. volume (nf,): of the surface's facets, see `SoilTop`.
    """
    from riser_soil.contact.soil_friction import SoilFriction

    scales = scales_of(elements)
    mu, slide = coefficients(given, scales)
    width = contact_width(scales, soil.top_law.surface_modulus(scales.diameter))
    strength = soil.top_law.undrained_strength(0.5 * scales.diameter)
    most = np.inf if given.adhesion is None or strength is None else given.adhesion * strength * width
    stiffness = float(mobilised_within(slide, *mu, np.array(scales.weight), most)) / width
    return SoilFriction(contact, *mu, stiffness, _soil_adhesion(scene, soil, given.adhesion, volume, scales))


def _soil_adhesion(
    scene: Scene, soil: SoilScene, share: float | None, volume: IntArray, scales: Scales
) -> SoilAdhesion | None:
    """Adhesion of clay, the limit of friction; None where nothing yields."""
    if share is None or soil.is_linear:
        return None
    level, strength = scene.seabed_level, strength_of(soil, SHALLOWEST * scales.diameter)
    return lambda facet, z: share * strength(volume[facet], np.maximum(level - z, 0.0))


def coefficients(given: Friction, scales: Scales) -> tuple[tuple[float, float], float]:
    """Axial and lateral coefficient of friction, and the slide that mobilises it [m]."""
    axial = given.axial if given.axial is not None else (given.adhesion or 0.0) / FULL_AT
    mu = axial, axial if given.lateral is None else given.lateral
    return mu, MOBILISATION * scales.diameter if given.mobilisation == "auto" else float(given.mobilisation)
