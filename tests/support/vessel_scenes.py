"""Scenes of a pipe that hangs from a vessel in waves, with its table of RAOs."""

from __future__ import annotations

from typing import Any

import numpy as np

from riser_soil.assembly.sea import water_of
from riser_soil.scene.scene import Scene
from tests.support.coupled_scenes import Mapping
from tests.support.riser_scenes import prescribed, riser_scene

PIPE = {"EA": 1.0e7, "EI": 1.0e5, "GJ": 1.0e5, "mass": 50.0, "submerged_weight": 200.0, "outer_diameter": 0.2}
END, REFERENCE = [40.0, 0.0, 3.0], [55.0, 4.0, -2.0]
AIRY = {"airy": {"height": 3.0, "period": 9.0, "direction_deg": 35.0, "phase_deg": 70.0}}
JONSWAP = {"jonswap": {"Hs": 3.0, "Tp": 9.0, "components": 40, "direction_deg": 180.0}}
W = 2.0 * np.pi / 9.0
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


def mapping(*stages: Mapping, rotation: Any = "free", waves: Mapping = AIRY, **more: Any) -> Mapping:
    """A hanging pipe under the sea's surface; its end moves in the stages as they say."""
    return riser_scene(
        *stages,
        pipe=PIPE,
        length=60.0,
        elements=6,
        start=prescribed(0.0, 0.0, -30.0),
        end=prescribed(*END, rotation=rotation),
        gravity=9.81,
        water={"surface_level": 10.0, "waves": waves},
        **more,
    )


def surface(scene: Scene, t: float) -> float:
    """Rise of the surface at the reference."""
    water = water_of(scene, scene.stages[0])
    assert water is not None
    return float(water(t, np.array([[*REFERENCE[:2], 10.0]])).immersion[0])
