"""The water of a scene, drawn by itself, the surface at a point, and tables of a vessel's RAOs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from riser_soil.assembly.sea import sea_of
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import Stage

if TYPE_CHECKING:  # what a scene lacks is not imported
    from riser_soil.sea.components import Components
    from riser_soil.sea.flows import Sea


def water_of(scene: Scene, stage: Stage) -> Sea | None:
    """The water in a stage; None where nothing moves and there is no surface."""
    sea = sea_of(scene)
    return None if sea is None else sea.in_stage(stage).flow


def components_of(scene: Scene) -> Components | None:
    """The components of the waves; None without waves."""
    sea = sea_of(scene)
    return None if sea is None or sea.waves is None else sea.waves.components


REFERENCE = [55.0, 4.0, -2.0]
MODES = ("surge", "sway", "heave", "roll", "pitch", "yaw")


def table(frequencies: Any, directions: Any, **modes: Any) -> str:
    """A file of given responses, (amplitude, lag in degrees) or a function of frequency and direction in degrees."""
    lines = ["frequency [rad/s], direction [deg]"]
    units = {mode: "m/m" if n < 3 else "rad/m" for n, mode in enumerate(MODES)}
    lines[0] += "".join(f", {mode} [{units[mode]}], {mode} phase [deg]" for mode in modes)
    for w in frequencies:
        for direction in directions:
            pairs = [given(w, direction) if callable(given) else given for given in modes.values()]
            row = [w, direction, *(value for pair in pairs for value in pair)]
            lines.append(", ".join(repr(float(value)) for value in row))
    return "\n".join(lines) + "\n"


EVERYWHERE = ([0.2, 0.5, 1.0, 2.0, 4.0], range(0, 360, 45))


def surface(scene: Scene, t: float) -> float:
    """Rise of the surface at the reference."""
    water = water_of(scene, scene.stages[0])
    assert water is not None
    return float(water(t, np.array([[*REFERENCE[:2], 10.0]])).immersion[0])
