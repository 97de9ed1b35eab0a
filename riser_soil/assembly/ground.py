"""Assembly of the ground: the soil under a line, and the seabed beside it."""

from __future__ import annotations

from collections.abc import Iterable

from riser_soil.assembly.contact_laws import seabed_law, stiffnesses
from riser_soil.assembly.line_assembly import LineAssembly
from riser_soil.core.communicator import Communicator
from riser_soil.interruption import restoring_signal_handlers
from riser_soil.scene.contact import Contact as ContactScene
from riser_soil.scene.seabed import Seabed
from riser_soil.scene.soil import SoilScene


def add_ground(lines: Iterable[LineAssembly], laid: bool, comm: Communicator) -> None:
    """Give lines the soil and the seabed that their scenes have; collective. Raises SceneError or MeshError.

    laid: whether they are laid in a static stage.
    """
    for own in lines:
        scene = own.scene
        if scene.contact is None:
            continue
        own.contact_stiffness |= stiffnesses(scene, scene.contact, own.scales)
        if scene.soil is not None:
            _add_soil(own, scene.soil, scene.contact, laid, comm)
        if scene.seabed is not None:
            _add_seabed(own, scene.seabed, scene.contact)


def _add_soil(own: LineAssembly, given: SoilScene, settings: ContactScene, laid: bool, comm: Communicator) -> None:
    with restoring_signal_handlers():  # imports gmsh
        from riser_soil.assembly.soil_assembly import soil_assembly

    stiffness = own.contact_stiffness["soil"]
    own.soil = soil_assembly(own.scene, given, settings, own.line, own.elements, stiffness, laid, comm)


def _add_seabed(own: LineAssembly, given: Seabed, settings: ContactScene) -> None:
    """The seabed acts outside the soil that the line has."""
    from riser_soil.assembly.seabed import mean_diameter, seabed_contact_of

    scene, line, elements = own.scene, own.line, own.elements
    diameter = mean_diameter(elements)
    law = seabed_law(given, settings, own.scales, diameter, own.contact_stiffness)
    beside = None if own.soil is None else own.soil.contact
    own.seabed = seabed_contact_of(scene, settings, line, elements, law, beside)
    if settings.friction is not None:
        from riser_soil.assembly.friction import friction_of

        own.friction = friction_of(given, settings.friction, own.seabed, elements, diameter)
