"""Scenes of a riser in water that is given: four stages, of which two are dynamic."""

from __future__ import annotations

from typing import Any

import numpy as np

from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.scene import Scene
from tests.support.riser_scenes import dynamic, prescribed, riser_scene, static

PIPE = {"outer_diameter": 0.3, "mass": 120.0, "EA": 3.0e8, "EI": 5.0e4, "GJ": 4.0e4}
CURRENT = {"profile": [[0.0, 0.2, 0.0], [100.0, 1.0, 0.0]]}
STAGES = (static("lay"), dynamic(20.0, 0.1, "calm"), static("rest"), dynamic(30.0, 0.1, "storm"))
MIDDLE = np.array([[10.0, 0.0, 50.0]])


def scene_in(water: Any, *stages: Any, **more: Any) -> Scene:
    ends = {"start": prescribed(0.0, 0.0, 1.0), "end": prescribed(80.0, 0.0, 100.0)}
    given = {"gravity": 9.81, "water": water, **more}
    return scene_from_mapping(
        riser_scene(*(stages or STAGES), pipe=PIPE, length=148.0, elements=10, **ends)
        | {key: value for key, value in given.items() if value is not None}
    )
