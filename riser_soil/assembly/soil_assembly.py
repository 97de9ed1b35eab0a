"""The soil under a line: the continuum, condensed or whole, and all parts between it and the line."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from riser_soil.assembly.condensation import why_whole
from riser_soil.assembly.scales import scales_of
from riser_soil.assembly.soil import own_forms_of, soil_in_motion, soil_of
from riser_soil.assembly.soil_contact import cushion_of, soil_contact_of
from riser_soil.contact.seabed_contact import Cushion
from riser_soil.contact.soil_contact import SoilContact
from riser_soil.contact.surface_contact import SurfaceContact
from riser_soil.core.communicator import Communicator
from riser_soil.core.part import Field, Part
from riser_soil.riser.line import Line
from riser_soil.riser.sections import Elements
from riser_soil.scene.contact import Contact as ContactScene
from riser_soil.scene.scene import Scene
from riser_soil.scene.soil import SoilScene
from riser_soil.soil.soil import Soil

if TYPE_CHECKING:
    from riser_soil.contact.mesh_renewal import MeshRenewal
    from riser_soil.contact.soil_friction import SoilFriction
    from riser_soil.soil.condensed import CondensedSoil


@dataclass(eq=False)
class SoilAssembly:
    """The soil that a line lies on, and its parts; what the scene lacks is None.

    whole: the continuum as it is meshed. condensed: linear soil as it is solved for, in the place of `whole`, whose
    state is then that of `recovered`. why_whole: why it is not condensed, empty where it is. own_forms: a user's terms.
    in_motion: parts of dynamic stages alone. contact, friction: between the line and the soil. cushion: what bears the
    line before the soil does.
    """

    whole: Soil
    condensed: CondensedSoil | None
    why_whole: str
    own_forms: list[Part]
    in_motion: list[Part]
    contact: SoilContact
    friction: SoilFriction | None
    mesh_renewal: MeshRenewal | None
    cushion: Cushion | None

    @property
    def fields(self) -> list[Field]:
        """Fields of the soil as it is solved for."""
        return [self.whole.field, self.whole.surface] if self.condensed is None else [self.condensed.top]

    @property
    def parts(self) -> list[Part]:
        """The soil as it is solved for, whole or condensed, and a user's terms."""
        return [self.whole if self.condensed is None else self.condensed, *self.own_forms]

    @property
    def pressed_by(self) -> list[SoilContact | SoilFriction]:
        """Parts by which the line loads the soil."""
        return [self.contact] if self.friction is None else [self.contact, self.friction]

    @property
    def renewal(self) -> list[Part]:
        """The renewal of the mesh; None where it is not renewed."""
        return [] if self.mesh_renewal is None else [self.mesh_renewal]

    def recovered(self) -> Soil:
        """The whole soil at the last accepted step, for results."""
        return self.whole if self.condensed is None else self.condensed.recover()


def soil_assembly(
    scene: Scene,
    given: SoilScene,
    settings: ContactScene,
    line: Line,
    elements: Elements,
    stiffness: float,
    laid: bool,
    comm: Communicator,
) -> SoilAssembly:
    """Build the soil of a line's scene; collective. Raises SceneError or MeshError.

    stiffness: of the penalty between line and soil [N/m2]. laid: whether the line is laid in a static stage.
    """
    diameter = scales_of(elements).diameter
    soil = soil_of(scene, given, line, diameter, comm)
    in_motion, own_forms = soil_in_motion(scene, given, soil), own_forms_of(given, soil)
    reason, condensed = why_whole(scene, soil, line, diameter), None
    if not reason:
        from riser_soil.soil.condensed import CondensedSoil, CondensedTop

        condensed = CondensedSoil(soil, CondensedTop(soil))
    surface = soil.surface if condensed is None else condensed.top
    contact = soil_contact_of(scene, settings, line, elements, surface, stiffness)
    friction = None
    if settings.friction is not None and isinstance(contact, SurfaceContact):
        from riser_soil.assembly.friction import soil_friction_of

        friction = soil_friction_of(scene, given, settings.friction, contact, elements, soil.surface.volume)
    renewal = None
    if soil.moves and isinstance(contact, SurfaceContact):
        from riser_soil.assembly.mesh_renewal import mesh_renewal_of

        renewal = mesh_renewal_of(soil, contact, friction, line)
    cushion = cushion_of(scene, contact, elements, soil.surface.points, comm) if laid else None
    return SoilAssembly(soil, condensed, reason, own_forms, in_motion, contact, friction, renewal, cushion)
