"""Where a contact with the ground begins and ends along the riser at one state, as results find it for many."""

from __future__ import annotations

from riser_soil.contact.contact import RiserContact
from riser_soil.contact.touchdown import ContactInterval, contact_intervals, touchdown_arc
from riser_soil.core.part import State


def intervals_at(contact: RiserContact, state: State) -> list[ContactInterval]:
    """From the riser's start on."""
    clearance, force = contact.contact_along_line(state)
    (intervals,) = contact_intervals(*contact.along, clearance[None], force[None])
    return intervals


def touchdown_at(contact: RiserContact, state: State) -> float:
    """Arc length [m]."""
    return touchdown_arc(intervals_at(contact, state))
