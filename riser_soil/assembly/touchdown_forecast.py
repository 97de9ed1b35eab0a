"""Touchdown forecast: where the riser touches down as a catenary between its ends, at rest and as they move."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from riser_soil.assembly.motions import EndPlaces
from riser_soil.assembly.riser import attachments_of
from riser_soil.assembly.shape import catenary_between, resting_level
from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.riser.sections import Elements
from riser_soil.scene.riser import Support
from riser_soil.scene.scene import Scene

if TYPE_CHECKING:
    from riser_soil.riser.attachments import PointAttachment
    from riser_soil.riser.catenary import Catenary

OFF_GROUND = 1e-3  # diameters above its rest from which a node hangs: a touchdown point lies sqrt(2 z H/w) before it
DIRECTIONS = np.array([[1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, -1.0]])  # (distance, height) of extreme places


@dataclass(frozen=True, eq=False)
class TouchdownForecast:
    """points (n, 2): touchdown points in plan [m], by statics without bending stiffness, the first that of the ends'
    first places, the others where they come to be; H: horizontal tension at first [N]; ahead (2,): unit vector in plan,
    at first, from what lies to what hangs.
    """

    points: Array
    H: float
    ahead: Array


def forecast(scene: Scene, elements: Elements, places: Sequence[EndPlaces]) -> TouchdownForecast | None:
    """The touchdown points nearest to the riser's end; None where no catenary between its ends comes down."""
    attachments = attachments_of(scene)
    if not all(isinstance(end, Support) for end in (scene.line.start, scene.line.end)):
        return None
    touchdowns = [_touchdown(scene, elements, attachments, *ends) for ends in extreme_places(places)]
    if not touchdowns or touchdowns[0] is None:
        return None
    return TouchdownForecast(np.array([point for point, *_ in filter(None, touchdowns)]), *touchdowns[0][1:])


def extreme_places(places: Sequence[EndPlaces]) -> Iterator[tuple[Array, Array]]:
    """First places of start and end (3,), then where they are nearest, farthest, highest and lowest to each other."""
    for n, place in enumerate(places):
        start, end = place["start"], place["end"]
        if len(start) != len(end):  # an end's table has rows of its own
            continue
        if n == 0:
            yield start[0], end[0]
        apart = np.column_stack((np.linalg.norm((end - start)[:, :2], axis=1), end[:, 2] - start[:, 2])) @ DIRECTIONS.T
        for at in sorted({*apart.argmin(axis=0).tolist(), *apart.argmax(axis=0).tolist()} - {0}):
            yield start[at], end[at]


def _touchdown(
    scene: Scene, elements: Elements, attachments: Sequence[PointAttachment], start: Array, end: Array
) -> tuple[Array, float, Array] | None:
    """Touchdown point in plan (2,), horizontal tension [N], unit vector ahead in plan (2,)."""
    try:
        cable = catenary_between(scene, elements, attachments, start, end)
    except SceneError:
        return None
    return _in_plan(scene, elements, cable)


def _in_plan(scene: Scene, elements: Elements, cable: Catenary) -> tuple[Array, float, Array] | None:
    position = cable.curve.position
    height = position[:, 2] - resting_level(scene, elements, position[[0, -1]])
    diameter = float(elements.outer_diameter.max())
    hangs = height > max(OFF_GROUND * diameter, 1e-6 * float(elements.arc[-1]))
    changes = np.flatnonzero(np.diff(hangs))
    if not changes.size:
        return None
    at = int(changes[-1])
    lies, up = (at, at + 1) if hangs[at + 1] else (at + 1, at)
    w = float(elements.weight[at])
    step = position[up, :2] - position[lies, :2]
    ahead = step / (float(np.linalg.norm(step)) or 1.0)
    before = np.sqrt(2.0 * height[up] * cable.H / w) if w > 0.0 else 0.0
    return position[up, :2] - before * ahead, cable.H, ahead
