"""Assembly of friction on seabed and soil."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from riser_soil.assembly.ground import SHALLOWEST, contact_width, mean_diameter
from riser_soil.assembly.scales import Scales, scales_of
from riser_soil.core.arrays import IntArray
from riser_soil.riser.sections import Elements
from riser_soil.scene.contact import Contact, Friction
from riser_soil.scene.scene import Scene
from riser_soil.scene.seabed import Seabed
from riser_soil.scene.soil import SoilScene
from riser_soil.scene.soil_law import strength_of

if TYPE_CHECKING:
    from riser_soil.contact.coulomb import Adhesion
    from riser_soil.contact.friction import CoulombFriction
    from riser_soil.contact.seabed_contact import SeabedContact
    from riser_soil.contact.soil_contact import SoilContact
    from riser_soil.contact.soil_friction import SoilAdhesion, SoilFriction

MOBILISATION = 1.0 / 30.0  # of the outer diameter: the slide that mobilises friction
FULL_AT = 0.1  # of su: the pressure from which on adhesion is full where no coefficient is given


def friction_of(
    scene: Scene, settings: Contact, seabed: SeabedContact, elements: Elements
) -> CoulombFriction | None:
    """Friction on the seabed, where the scene asks for it."""
    if settings.friction is None:
        return None
    from riser_soil.contact.coulomb import adhesion_at
    from riser_soil.contact.friction import CoulombFriction, mobilised_within

    given, scales = settings.friction, scales_of(elements)
    mu, slide = coefficients(given, scales)
    adhesion = seabed_adhesion(scene.seabed, given.adhesion, mean_diameter(elements))
    most, _ = adhesion_at(adhesion, 0.5 * adhesion.diameter)
    stiffness = mobilised_within(slide, *mu, np.abs(elements.weight), most)
    return CoulombFriction(seabed, *mu, stiffness, adhesion)


def seabed_adhesion(seabed: Seabed | None, share: float | None, diameter: float) -> Adhesion:
    """Adhesion of clay to a pipe of a diameter [m]; without a limit on ground that has no strength."""
    from riser_soil.contact.coulomb import Adhesion

    strength = seabed.undrained_strength if seabed is not None else None
    if share is None or strength is None:
        return Adhesion()
    return Adhesion(share, strength, diameter)


def soil_friction_of(
    scene: Scene, settings: Contact, contact: SoilContact, elements: Elements, volume: IntArray
) -> SoilFriction | None:
    """Friction on the soil, where the scene asks for it and the pipe's surface touches. volume (nf,): of the surface's
    facets, see `SoilTop`.
    """
    given, soil = settings.friction, scene.soil
    if given is None or settings.at_nodes:
        return None
    from riser_soil.contact.friction import mobilised_within
    from riser_soil.contact.soil_friction import SoilFriction
    from riser_soil.contact.surface_contact import SurfaceContact

    assert isinstance(contact, SurfaceContact)
    assert soil is not None
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
    """What clay holds the pipe by at most; None where nothing yields."""
    if share is None or soil.is_linear:
        return None
    level, strength = scene.seabed_level, strength_of(soil, SHALLOWEST * scales.diameter)
    return lambda facet, z: share * strength(volume[facet], np.maximum(level - z, 0.0))


def coefficients(given: Friction, scales: Scales) -> tuple[tuple[float, float], float]:
    """Axial and lateral coefficient of friction, and the slide that mobilises it [m]."""
    axial = given.axial if given.axial is not None else (given.adhesion or 0.0) / FULL_AT
    mu = axial, axial if given.lateral is None else given.lateral
    return mu, MOBILISATION * scales.diameter if given.mobilisation == "auto" else float(given.mobilisation)
