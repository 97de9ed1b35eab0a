"""Whether linear elastic soil is condensed to its surface, and its parts where it is."""

from __future__ import annotations

from typing import TYPE_CHECKING

from riser_soil.scene.scene import Scene

if TYPE_CHECKING:
    from riser_soil.contact.soil_contact import SoilContact
    from riser_soil.soil.condensed import CondensedSoil, CondensedTop
    from riser_soil.soil.soil import Soil


def why_whole(scene: Scene, ranks: int) -> str:
    """Why the soil is solved for as a whole; empty where it is condensed."""
    assert scene.soil is not None
    if scene.solver.soil == "whole":
        return "solver.soil is whole"
    laws = {law.kind for law in scene.soil.laws}
    if laws != {"linear-elastic"}:
        return f"its law is {', '.join(sorted(laws))}; condensed is linear-elastic soil alone"
    if ranks > 1:
        return f"the run is on {ranks} ranks; condensed is soil on one alone"
    return ""


def condensed_top(scene: Scene, soil: Soil) -> CondensedTop | None:
    """The soil's top where the soil is condensed to it."""
    if why_whole(scene, soil.grid.nodes.comm.size):
        return None
    from riser_soil.soil.condensed import CondensedTop

    return CondensedTop(soil)


def condensed_soil(soil: Soil, top: CondensedTop, contact: SoilContact) -> CondensedSoil:
    from riser_soil.soil.condensed import CondensedSoil

    return CondensedSoil(soil, top, contact.facets_in_reach)
