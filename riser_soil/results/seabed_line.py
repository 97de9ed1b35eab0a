"""Height of the ground under points of a run, by its scene."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.errors import RiserSoilError
from riser_soil.results import folder as run_folder
from riser_soil.results.read import Run
from riser_soil.scene.bathymetry import ground_height
from riser_soil.scene.reader import read_scene


def seabed_under(run: Run, points: Array) -> Array | None:
    """Height (n,) [m] of the undeformed seabed or soil under points (n, 3) [m]; None where there is none, or the scene
    can't be read.
    """
    try:
        scene = read_scene(str(run.folder / run_folder.SCENE))
    except (RiserSoilError, OSError):
        return None
    if not scene.has_ground:
        return None
    return np.array([ground_height(scene, (float(x), float(y), float(z))) for x, y, z in points])
