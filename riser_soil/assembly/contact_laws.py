"""Laws of contact that a scene asks for: stiffness, rounded corner and suction of penalties, and the seabed's law."""

from __future__ import annotations

from typing import assert_never

import numpy as np

from riser_soil.assembly.scales import Scales
from riser_soil.contact.law import (
    STIFFNESS_OVER_SOIL,
    SURFACE_STIFFNESS_OVER_SOIL,
    Penalty,
    SuctionLaw,
    automatic_stiffness,
)
from riser_soil.errors import SceneError
from riser_soil.scene.contact import Contact as ContactScene
from riser_soil.scene.contact import Suction
from riser_soil.scene.scene import Scene
from riser_soil.scene.seabed import HystereticSeabed, RigidSeabed, Seabed, SpringSeabed
from riser_soil.seabed.law import NormalLaw

NARROWEST_CORNER, WIDEST_CORNER = 1.0 / 3000.0, 1.0 / 300.0  # of the outer diameter; sharper ones cost iterations


def stiffnesses(scene: Scene, settings: ContactScene, scales: Scales) -> dict[str, float]:
    """Force per length and penetration [N/m2] by ground: the scene's own, else the automatic choice."""
    over_soil = STIFFNESS_OVER_SOIL if settings.at_nodes else SURFACE_STIFFNESS_OVER_SOIL

    def penalty(E: float | None) -> float:
        """Stiffness of a penalty against penetration; E: Young's modulus [Pa], None of a rigid ground."""
        if settings.stiffness != "auto":
            return float(settings.stiffness)
        return automatic_stiffness(E, scales.weight, scales.diameter, over_soil)

    out = {"soil": penalty(scene.soil.top_law.surface_modulus(scales.diameter))} if scene.soil is not None else {}
    match scene.seabed:
        case RigidSeabed():
            out["seabed"] = penalty(None)
        case SpringSeabed():
            out["seabed"] = scene.seabed.stiffness
        case HystereticSeabed() | None:
            pass
        case _:
            assert_never(scene.seabed)
    return out


def smoothing(settings: ContactScene, scales: Scales, ground: str, stiffness: float) -> float:
    """Half width [m] of the rounded corner of a penalty of this stiffness [N/m2].

    Rounded over much more than the penetration at rest, the riser hovers: on a stiff floor that would shift the tension
    more than the penalty does.
    """
    if settings.smoothing != "auto":
        return float(settings.smoothing)
    if ground == "soil":  # integrated over a width, the force has no corner
        return WIDEST_CORNER * scales.diameter if settings.at_nodes else 0.0
    at_rest = scales.weight / stiffness
    return float(np.clip(at_rest, NARROWEST_CORNER * scales.diameter, WIDEST_CORNER * scales.diameter))


def contact_width(scales: Scales, E: float) -> float:
    """Width 2 b [m] over which the pipe touches elastic soil at rest, at most the diameter.

    Hertz's line contact of a cylinder: b² = 4 q R/(pi E*), with E* = 4/3 E of a soil without change of volume; E [Pa]
    at the surface.
    """
    plane = np.pi * max(4.0 / 3.0 * E, scales.weight / scales.diameter)  # very soft soil lets all of the pipe in
    return float(min(2.0 * np.sqrt(2.0 * scales.weight * scales.diameter / plane), scales.diameter))


def seabed_law(
    seabed: Seabed, settings: ContactScene, scales: Scales, diameter: float, stiffness: dict[str, float]
) -> NormalLaw:
    """How the seabed answers to penetration by a pipe of a diameter [m]. stiffness [N/m2]: of penalties."""
    match seabed:
        case HystereticSeabed():
            return seabed.law.of_pipe(diameter)
        case RigidSeabed() | SpringSeabed():
            return _penalty(settings, scales, stiffness["seabed"])
        case _:
            assert_never(seabed)


def _penalty(settings: ContactScene, scales: Scales, stiffness: float) -> NormalLaw:

    penalty = Penalty(stiffness, smoothing(settings, scales, "seabed", stiffness))
    return penalty if settings.suction is None else with_suction(penalty, settings.suction, "seabed")


def with_suction(penalty: Penalty, given: Suction, ground: str, width: float = 1.0) -> SuctionLaw:
    """A penalty with suction; on the soil both are pressures, the cap over that width [m]."""
    cap, reach, peak = given.cap / width, given.reach, given.cap / width / penalty.stiffness
    if reach <= peak:
        raise SceneError(
            f"contact.suction.reach = {reach:g} m: suction has its cap of {given.cap:g} N/m at {peak:g} m on the "
            f"{ground}, and must reach farther; raise reach or lower cap"
        )
    return SuctionLaw(penalty, cap, reach)
