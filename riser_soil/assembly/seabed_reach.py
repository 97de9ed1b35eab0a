"""Whether a body of a scene can get to the seabed; else it has no contact there, and none is built."""

from __future__ import annotations

import math

import numpy as np

from riser_soil.assembly.riser import attachments_of, elements_of
from riser_soil.core.sphere import radius_of
from riser_soil.scene.bathymetry import ground_height
from riser_soil.scene.bodies import Body, BodyTouch
from riser_soil.scene.lines import by_line
from riser_soil.scene.riser import Support
from riser_soil.scene.scene import Scene

STRETCHED = 1.2  # times the length of the lines: how far below their supports a body may hang


def why_apart(scene: Scene, name: str) -> str:
    """Why a body can't get to the seabed, empty where it can: it floats whatever hangs on it, or the lines are too
    short.
    """
    body, views, reach = scene.bodies[name], [*by_line(scene).values()], _farthest(scene.bodies[name])
    hanging = sum(_wet_weight(view) for view in views)
    hanging += sum(max(_net(scene, other), 0.0) for key, other in scene.bodies.items() if key != name)
    if -_net(scene, body) > hanging and body.position[2] - reach > ground_height(views[0], body.position):
        return f"it floats with all that hangs on it ({-_net(scene, body):.4g} N over {hanging:.4g} N)"
    ends = (end for view in views for end in (view.line.start, view.line.end))
    supports = [end.position[2] for end in ends if isinstance(end, Support) and not end.jointed]
    lowest = min([body.position[2], *supports]) - STRETCHED * sum(view.line.length for view in views) - reach
    return f"the lines are too short, it hangs above z = {lowest:.4g} m" if lowest > _highest(scene) else ""


def _highest(scene: Scene) -> float:
    """No point of the seabed is higher [m]; inf where that is not known."""
    seabed = scene.seabed
    if seabed is None or seabed.profile is not None or seabed.slope_deg:
        return math.inf
    return seabed.level if seabed.grid is None else max(max(row) for row in seabed.grid.heights.z)


def _farthest(body: Body) -> float:
    """Distance from a body's place to its farthest side that may touch, at most [m]."""
    given, radius = body.contact or BodyTouch(), radius_of(body.volume)
    points = given.points or (getattr(body, "centre_of_buoyancy", (0.0, 0.0, 0.0)),)
    return max(math.hypot(*point) for point in points) + (radius if given.radius is None else given.radius)


def _net(scene: Scene, body: Body) -> float:
    """Weight less buoyancy of the whole volume [N]."""
    return scene.gravity * (body.mass - (0.0 if scene.water is None else scene.water.density * body.volume))


def _wet_weight(view: Scene) -> float:
    """Weight in water [N] of a line and what is attached to it, without what floats."""
    elements, attachments = elements_of(view), attachments_of(view)
    of_line = float(np.maximum(elements.weight, 0.0) @ elements.length)
    return of_line + sum(max(attachment.net_weight, 0.0) for attachment in attachments)
