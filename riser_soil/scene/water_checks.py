"""Consistency checks of water, current and waves with the rest of a scene."""

import math
from collections.abc import Iterator

from riser_soil.scene.problem import Problem
from riser_soil.scene.scene import Scene
from riser_soil.scene.water import Waves

# A wave breaks at the latest at this height over its length, times tanh kh (Miche 1944).
_BREAKING = 0.142


def water_conflicts(scene: Scene) -> Iterator[Problem]:
    """Conflicts of surface and waves with seabed and gravity."""
    if scene.water is None or scene.water.surface_level is None:
        return
    if scene.has_ground and scene.water.surface_level <= scene.seabed_level:
        allowed = f"must lie above the seabed (z = {scene.seabed_level:g} m)"
        yield Problem(("water", "surface_level"), allowed, "raise it, lower seabed.level, or leave out water")
    elif scene.water.waves is not None:
        yield from _possible(scene, scene.water.waves)


def _possible(scene: Scene, waves: Waves) -> Iterator[Problem]:
    """Waves that can't exist are no sea at all; steep ones are a doubt."""
    if scene.gravity == 0.0:
        yield Problem(("water", "waves"), "there are no waves without gravity", "give gravity, or leave out waves")
    elif waves.height > (highest := _highest(scene.gravity, scene.water_depth, waves.period)):
        which = f"waves of {waves.period:g} s{_where(scene.water_depth)}"
        allowed = f"must not exceed {highest:.4g} m: higher {which} break"
        yield Problem(("water", "waves", *waves.height_key), allowed, "lower the waves or lengthen their period")


def _highest(g: float, h: float, period: float) -> float:
    """A bound of Miche's limit that needs no wave length L: L tanh kh = g T^2/2 pi tanh^2 kh, and is below 2 pi h."""
    return _BREAKING * min(g * period**2 / (2.0 * math.pi), 2.0 * math.pi * h)


def _where(h: float) -> str:
    return f" in {h:g} m of water" if math.isfinite(h) else ""
