"""Height of the seabed below a point, for the checks of a scene; `riser_soil.seabed.grounds` has its shape."""

import math

from riser_soil.core.quantities import Vector
from riser_soil.scene.plane import vertical_plane
from riser_soil.scene.scene import Scene
from riser_soil.scene.seabed import profile_height
from riser_soil.scene.vectors import dot, minus


def ground_height(scene: Scene, point: Vector) -> float:
    """Height z [m] of the ground below a point; straight between the points of a profile or grid."""
    if scene.seabed is None or _over_block(scene, point):
        return scene.seabed_level + feature_height(scene, point)
    if scene.seabed.grid is not None:
        return scene.seabed.grid.heights.height(point[0], point[1])
    origin, direction = seabed_axis(scene)
    s = dot(minus(point, origin), direction)
    if scene.seabed.profile is None:
        return scene.seabed.level + math.tan(math.radians(scene.seabed.slope_deg)) * s
    return profile_height(scene.seabed.profile, s)


def feature_height(scene: Scene, point: Vector) -> float:
    """Height [m], <= 0, of a trench or groove in the soil below a point over the seabed."""
    block = scene.soil.given_block if scene.soil else None
    if block is None or block.feature is None or not _over_block(scene, point):
        return 0.0
    plane = vertical_plane(scene)
    axis = int(abs(plane.direction[1]) > abs(plane.direction[0]))
    return block.feature.height(point[axis], point[1 - axis] - plane.origin[1 - axis], scene.largest_diameter)


def _over_block(scene: Scene, point: Vector) -> bool:
    block = scene.soil.given_block if scene.soil else None
    if block is None:
        return False
    return block.x[0] <= point[0] <= block.x[1] and block.y[0] <= point[1] <= block.y[1]


def seabed_axis(scene: Scene) -> tuple[Vector, Vector]:
    """Along which a seabed slopes, or has its profile: a point, and the horizontal direction."""
    if scene.seabed is not None and scene.seabed.direction_deg is not None:
        angle = math.radians(scene.seabed.direction_deg)
        return (0.0, 0.0, 0.0), (math.cos(angle), math.sin(angle), 0.0)
    plane = vertical_plane(scene)
    return plane.origin, plane.direction
