"""Assembly of what bodies do on the seabed: contact and friction of those that can get there.

To the seabed a body is a pipe as long as it is wide, its width D. So laws, penalties and corners are those of a line
of that diameter, which has the body's weight over its length D.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from riser_soil.assembly.contact_laws import seabed_law, stiffnesses
from riser_soil.assembly.friction import coefficients, seabed_adhesion
from riser_soil.assembly.line_assembly import LineAssembly
from riser_soil.assembly.scales import Scales, contact_radius
from riser_soil.assembly.seabed import ground_of
from riser_soil.assembly.seabed_reach import why_apart
from riser_soil.bodies.body import BodyProperties, MovingBody
from riser_soil.bodies.loads import BodyWeight
from riser_soil.bodies.seabed_contact import BodyContact
from riser_soil.bodies.seabed_friction import BodyFriction
from riser_soil.contact.coulomb import adhesion_at
from riser_soil.contact.friction import mobilised_within
from riser_soil.core.arrays import Array
from riser_soil.core.sphere import radius_of
from riser_soil.scene.bodies import BodyTouch
from riser_soil.scene.contact import Contact, Friction
from riser_soil.scene.scene import Scene
from riser_soil.scene.seabed import Seabed
from riser_soil.seabed.grounds import Ground

WATER = 1000.0  # kg/m3: by which a mass that displaces nothing has a width in a scene without water
LEAST_NET = 1e-3  # of the larger of weight and buoyancy: the least net weight by which friction has a stiffness


class OnSeabed(NamedTuple):
    """Contact of bodies with the seabed, and their friction, by name; bodies that can't get there have none."""

    contacts: dict[str, BodyContact]
    frictions: dict[str, BodyFriction]


@dataclass(frozen=True)
class _Body:
    """A body as the scene has it: how it touches, where, and what it weighs."""

    given: BodyTouch
    field: MovingBody
    properties: BodyProperties
    weight: BodyWeight
    points: Array
    radius: float
    width: float

    @property
    def scales(self) -> Scales:
        """Scales of a line with the body's width and weight."""
        return Scales(self.weight.load / self.width, self.width, 0.0)


def on_seabed(
    scene: Scene,
    lines: Mapping[str, LineAssembly],
    bodies: Mapping[str, MovingBody],
    given: Mapping[str, BodyProperties],
    weights: Mapping[str, BodyWeight],
) -> OnSeabed:
    """Contact and friction of a scene's bodies; none without a seabed."""
    parts = OnSeabed({}, {})
    if scene.seabed is None or scene.contact is None:
        return parts
    any_line = next(iter(lines.values())).scene  # all see the same ground
    shape = ground_of(any_line, scene.seabed)
    for name, field in bodies.items():
        if why_apart(scene, name):
            continue
        body = _body(scene, name, field, given[name], weights[name], lines)
        parts.contacts[name] = contact = _contact(scene, scene.seabed, scene.contact, body, shape)
        if (friction := _friction(scene.seabed, scene.contact, body, contact)) is not None:
            parts.frictions[name] = friction
    return parts


def _body(
    scene: Scene,
    name: str,
    field: MovingBody,
    properties: BodyProperties,
    weight: BodyWeight,
    lines: Mapping[str, LineAssembly],
) -> _Body:
    given = scene.bodies[name].contact or BodyTouch()
    points = properties.buoyancy_centre[None] if given.points is None else np.array(given.points)
    radius = _radius(scene, name, given, properties, lines) if given.radius is None else given.radius
    width = _width(scene, properties) if given.width is None else given.width
    return _Body(given, field, properties, weight, points, radius, width)


def _radius(
    scene: Scene, name: str, given: BodyTouch, properties: BodyProperties, lines: Mapping[str, LineAssembly]
) -> float:
    """Radius [m] of a sphere of the body's volume, else of the lines that it is joined to; 0 where points are given and
    where axes touch.
    """
    if given.points is not None or scene.contact_at == "axis":
        return 0.0
    if properties.volume > 0.0:
        return properties.radius
    pairs = [joint.between for joint in scene.joints.values() if any(point.body == name for point in joint.between)]
    beside = [lines[point.line] for pair in pairs for point in pair if point.line is not None]
    return max((float(contact_radius(own.scene, own.elements).max()) for own in beside), default=0.0)


def _width(scene: Scene, properties: BodyProperties) -> float:
    """Diameter of a sphere of its volume, or of water of its mass [m]."""
    water = WATER if scene.water is None else scene.water.density
    return 2.0 * (properties.radius or radius_of(properties.mass / water))


def _contact(scene: Scene, seabed: Seabed, settings: Contact, body: _Body, shape: Ground) -> BodyContact:
    stiffness = stiffnesses(scene, settings, body.scales)
    if body.given.stiffness is not None:
        stiffness["seabed"] = body.given.stiffness / body.width
    law = seabed_law(seabed, settings, body.scales, body.width, stiffness)
    return BodyContact(body.field, body.points, body.radius, body.width, shape, law)


def _friction(seabed: Seabed, settings: Contact, body: _Body, contact: BodyContact) -> BodyFriction | None:
    """Friction of a body by its own coefficient, else by that across a pipe; None without any."""
    asked, own = settings.friction, body.given.friction
    if own is not None:
        given = {"axial": own, "lateral": own}
        asked = None if own == 0.0 else (asked or Friction.model_construct()).model_copy(update=given)
    if asked is None:
        return None
    (_, mu), slide = coefficients(asked, body.scales)
    adhesion = seabed_adhesion(seabed, asked.adhesion, body.width)
    most, _ = adhesion_at(adhesion, 0.5 * adhesion.diameter)
    weight = max(abs(body.weight.net), LEAST_NET * body.weight.load) / body.width
    return BodyFriction(contact, mu, float(mobilised_within(slide, mu, mu, np.array(weight), most)), adhesion)
