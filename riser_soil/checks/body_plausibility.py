"""Plausibility warnings of bodies that may touch the seabed."""

from __future__ import annotations

from collections.abc import Iterator

from riser_soil.assembly.bodies_and_joints import BodiesAndJoints
from riser_soil.core.part import State

SUNK = 0.5  # of a body's width, by which its own weight may press it in


def body_warnings(bodies_and_joints: BodiesAndJoints) -> Iterator[str]:
    """Warnings of bodies that begin below the seabed, and of those that it hardly bears."""
    for name, contact in bodies_and_joints.contacts.items():
        body, net = bodies_and_joints.bodies[name], bodies_and_joints.weights[name].net
        sunk = contact.sunk_by(net)
        begun = contact.penetration(State.at_rest(0.0, body.offset + body.size))
        if begun > sunk + SUNK * contact.length:
            yield (
                f"bodies.{name}.position: begins {begun:.4g} m below the seabed, which its weight less buoyancy of "
                f"{net:.4g} N presses in by {sunk:.4g} m; raise it, or lower the seabed"
            )
        if sunk > SUNK * contact.length:
            yield (
                f"bodies.{name}.contact: the seabed lets it sink in by {sunk:.4g} m under its weight less buoyancy of "
                f"{net:.4g} N, and it is assumed to be {contact.length:.4g} m wide; give its width, or its stiffness"
            )
