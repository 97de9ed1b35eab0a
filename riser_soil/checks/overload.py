"""Bearing capacity check: where the riser's load exceeds what the ground bears, after a failed solve or a stage."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from riser_soil.assembly import Assembly, LineAssembly
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.riser.line import Line

if TYPE_CHECKING:
    from riser_soil.contact.contact import RiserContact
    from riser_soil.soil.law import Bearing


class Overload(NamedTuple):
    """The deepest of the nodes that load the ground beyond its capacity: load and capacity [N/m], depth [m],
    arc length [m] and position (3,) [m]; what the capacity is.
    """

    load: float
    capacity: float
    depth: float
    arc: float
    position: Array
    meaning: str
    line: str = ""


def overload(assembly: Assembly) -> str:
    """The largest overload of the ground, as the end of a message; empty where there is none. Collective.

    A riser that sinks may yet be caught, as by firmer ground beside: this explains a failure and foretells none.
    """
    state = State.at_rest(0.0, assembly.size)
    overloads = (each for name, own in assembly.lines.items() for each in _overloads(own, name, state))
    worst = max(overloads, key=lambda each: each.load / each.capacity, default=None)
    worst = assembly.comm.bcast(worst)
    if worst is None:
        return ""
    x, y, z = worst.position
    return (
        f"; the ground's bearing capacity is exceeded: {worst.line}at arc {worst.arc:.4g} m, at ({x:.4g}, {y:.4g}, "
        f"{z:.4g}) m, the riser puts {worst.load:.4g} N/m on clay that bears about {worst.capacity:.4g} N/m, "
        f"{worst.meaning}, and has sunk in by {worst.depth:.4g} m: check su, or hold the riser up"
    )


def surface_bearing(riser: LineAssembly) -> Bearing | None:
    """What the surface of the soil bears under a strip as wide as the pipe.

    None without soil under the riser or without a limit, and where firmer soil may begin within a diameter: below a
    first layer that ends there, or anywhere among named volumes.
    """
    soil, D = riser.scene.soil, riser.scales.diameter
    if soil is None or riser.soil is None:
        return None
    first = soil.layers[0] if soil.layers and len(soil.layers) > 1 else None
    if first is not None and (first.to is None or first.to < D):
        return None
    return soil.top_law.bearing(D)


def over_a_length(force: Array, line: Line, length: float) -> Array:
    """Mean of a force per length (nn,) [N/m] over a length [m] around each node; at a node as it is, where its own
    share of the riser is longer.
    """
    share = line.tributary_length
    ends = np.append(0.0, np.cumsum(share))
    total = np.append(0.0, np.cumsum(force * share))
    middle = 0.5 * (ends[1:] + ends[:-1])
    first, last = (np.interp(middle + side * length, ends, total) for side in (-0.5, 0.5))
    return np.asarray((last - first) / length)


def _overloads(riser: LineAssembly, name: str, state: State) -> Iterator[Overload]:
    """Overloads of a line where it is now, on the rank that holds its contact: the ground bears its weight at least
    where it touches.
    """
    if not riser.line.active:
        return
    for contact, capacity, meaning in _limits(riser):
        force = contact.force_per_length(state)
        load = np.where(force > 0.0, np.maximum(force, _weight(riser)), 0.0)
        depth = np.where(load > capacity, contact.depth(state), -np.inf)
        node = int(np.argmax(depth))
        if load[node] > capacity:
            place = riser.line.arc[node], riser.line.positions3(state)[node]
            yield Overload(load[node], capacity, depth[node], *place, meaning, f"{name} " if name else "")


def _limits(riser: LineAssembly) -> Iterator[tuple[RiserContact, float, str]]:
    """Grounds that bear so much only [N/m], and what that is."""
    D, bearing = riser.scales.diameter, surface_bearing(riser)
    if riser.soil is not None and bearing is not None:
        yield riser.soil.contact, *bearing
    if riser.seabed is not None and math.isfinite(riser.seabed.law.capacity):
        yield riser.seabed, riser.seabed.law.capacity, f"by its law at a depth of one diameter, {D:.4g} m"


def _weight(riser: LineAssembly) -> Array:
    """Weight of the riser at the nodes (nn,) [N/m], downwards."""
    weight = riser.elements.weight
    return np.maximum(np.append(weight, weight[-1:]), np.append(weight[:1], weight))
