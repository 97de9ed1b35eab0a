"""First guess of a riser that is laid on a level seabed.

Its catenary lies on the surface, where clay has no stiffness yet, and knows no bending. From there Newton's method lets
what lies fall by metres, and moves the touchdown by an element at a time. The guess is the catenary with the pipe's
bend where it comes down, as deep in the ground as that needs to bear it. The search for the equilibrium begins there;
the ground's history and friction count from the catenary.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from riser_soil.assembly.scales import scales_of
from riser_soil.assembly.shape import catenary_between, resting_level
from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.part import State
from riser_soil.riser.line import UP, Line
from riser_soil.riser.touchdown_bend import TouchdownBend
from riser_soil.seabed.grounds import Plane
from riser_soil.seabed.law import NormalLaw

if TYPE_CHECKING:
    from riser_soil.contact.seabed_contact import SeabedContact
    from riser_soil.riser.attachments import PointAttachment
    from riser_soil.riser.catenary import Catenary
    from riser_soil.riser.sections import Elements
    from riser_soil.scene.scene import Scene


HANGS = 1e-6  # of the line's length: what is higher than this over its rest
LEAST_BEND = 0.01  # of an element: the length of a bend, where a chain has none


def laid_guess(
    scene: Scene,
    seabed: SeabedContact,
    elements: Elements,
    attachments: Sequence[PointAttachment],
    cable: Catenary,
) -> Array | None:
    """Increments (nn, ndof) from the catenary, in which the riser is placed, to the guess; None where it does not come
    down, or not on a level seabed that bears it.
    """
    if not isinstance(seabed.ground, Plane) or seabed.ground.normal[2] < 1.0:
        return None
    weight = np.maximum(elements.weight, 0.0)
    depth = depth_at_rest(seabed.law, weight, scales_of(elements).diameter)
    bed = LevelBed(seabed.line, elements, resting_level(scene, elements, cable.curve.position[[0, -1]]), depth)
    placed = bed.in_plane(cable)
    if cable.heaped:
        return _increments(seabed.line, placed, bed.sunk(placed))
    if (bent := bed.bent(placed, cable.H)) is None:
        return None
    start, end = bed.moved(cable, _missed(bent, placed))
    nearer = catenary_between(scene, elements, attachments, start, end, near=cable)
    bent = bed.bent(bed.in_plane(nearer), nearer.H)
    return None if bent is None else _increments(seabed.line, placed, _closed(bent, placed, elements.length))


@dataclass(frozen=True, eq=False)
class ShapeInPlane:
    """A line in its vertical plane: places along its direction and up (nn, 2) [m], angles to its direction (nn,); which
    nodes hang (nn,), the others lie.
    """

    place: Array
    angle: Array
    hangs: BoolArray


@dataclass(frozen=True, eq=False)
class Touchdown:
    """Where a cable comes down, arc length [m]; side: 1 where the line hangs after it, -1 where before it."""

    arc: float
    side: float
    bend: TouchdownBend


@dataclass(frozen=True, eq=False)
class LevelBed:
    """The seabed under a line. level: height of the axis that lies on its surface [m]; depth (ne,): at which it bears
    the elements [m].
    """

    line: Line
    elements: Elements
    level: float
    depth: Array

    def in_plane(self, cable: Catenary) -> ShapeInPlane:
        curve, direction = cable.curve, self.line.direction
        tangent = np.concatenate([curve.tangent[:, 0], curve.tangent[-1:, 1]])
        along, up = (curve.position - curve.position[0]) @ direction, curve.position[:, 2]
        hangs = up - self.level > HANGS * self.line.arc[-1]
        return ShapeInPlane(np.stack([along, up], axis=1), np.arctan2(tangent @ UP, tangent @ direction), hangs)

    def sunk(self, heap: ShapeInPlane) -> ShapeInPlane:
        """A heap that has sunk in as deep as bears it."""
        depth = np.minimum(np.append(self.depth, np.inf), np.append(np.inf, self.depth))
        lies = ~heap.hangs & np.isfinite(depth)
        lies[[0, -1]] = False
        place = heap.place - np.stack([np.zeros(depth.size), np.where(lies, depth, 0.0)], axis=1)
        return ShapeInPlane(place, heap.angle, heap.hangs)

    def bent(self, cable: ShapeInPlane, H: float) -> ShapeInPlane | None:
        """A cable's shape with the pipe's bends, its elements as long as they are; None where there are none."""
        arc, touchdowns = self.line.arc, list(self._touchdowns(cable, H))
        if not touchdowns or not all(0.0 < each.bend.depth < np.inf for each in touchdowns):
            return None
        place, slope = cable.place.copy(), np.tan(cable.angle)
        nearest = np.argmin([np.abs(arc - each.arc) for each in touchdowns], axis=0)
        for n, each in enumerate(touchdowns):
            at = nearest == n
            higher, steeper = each.bend.beyond_cable(each.side * (arc[at] - each.arc) + each.bend.lift_off)
            place[at, 1] += each.bend.rise + higher
            slope[at] += each.side * steeper
        chord = np.linalg.norm(np.diff(cable.place, axis=0), axis=1)
        place[1:, 0] = np.cumsum(np.sqrt(np.maximum(chord**2 - np.diff(place[:, 1]) ** 2, 0.0)))
        return ShapeInPlane(place, np.arctan(slope), cable.hangs)

    def _touchdowns(self, cable: ShapeInPlane, H: float) -> Iterator[Touchdown]:
        """Touchdown points of a cable; none where an end is pulled up from its place on the ground."""
        for e in np.flatnonzero(cable.hangs[1:] != cable.hangs[:-1]):
            hanging, weight = e + int(cable.hangs[e + 1]), float(self.elements.weight[e])
            if weight <= 0.0:  # it floats up from there
                continue
            at = float(self.line.arc[hanging] - H * np.tan(cable.angle[hanging]) / weight)
            if 0.0 < at < self.line.arc[-1]:
                yield Touchdown(at, 1.0 if hanging > e else -1.0, self._bend(e, weight, H))

    def _bend(self, e: int, weight: float, H: float) -> TouchdownBend:
        EI = max(float(self.elements.EI_y[e]), H * (LEAST_BEND * float(self.elements.length[e])) ** 2)
        return TouchdownBend(weight, H, EI, float(self.depth[e]))

    def moved(self, cable: Catenary, by: Array) -> Array:
        """Its ends (2, 3), moved by (2, 2) [m] in the plane, at most down to the seabed."""
        ends = cable.curve.position[[0, -1]] + by[:, :1] * self.line.direction + by[:, 1:] * UP
        ends[:, 2] = np.maximum(ends[:, 2], self.level)
        return np.asarray(ends)


def _missed(bent: ShapeInPlane, placed: ShapeInPlane) -> Array:
    """Distances by which the ends (2, 2) are off their places [m]; in height only those that hang."""
    missed: Array = (placed.place - bent.place)[[0, -1]]
    missed[:, 1] *= placed.hangs[[0, -1]]
    return missed


def _closed(bent: ShapeInPlane, placed: ShapeInPlane, length: Array) -> ShapeInPlane:
    """The shape with its ends at their places: what is left is spread over what hangs."""
    share = np.append(0.0, np.cumsum(length * (placed.hangs[1:] | placed.hangs[:-1])))[:, None]
    first, last = _missed(bent, placed)
    return ShapeInPlane(bent.place + first + share / share[-1] * (last - first), bent.angle, bent.hangs)


def _increments(line: Line, before: ShapeInPlane, after: ShapeInPlane) -> Array:
    moved, turned = after.place - before.place, (after.angle - before.angle)[:, None] * line.normal
    translation = (moved[:, :1] * line.direction + moved[:, 1:] * UP) @ line.basis
    spins = line.trial(State.at_rest(0.0, line.offset + line.size)).turn.moment_maps(line.turning_axes)
    return np.hstack([translation, np.einsum("nij,ni->nj", spins, turned)])


DEEPEST = 10.0  # diameters, beyond which nothing is taken to rest
HALVINGS = 60


def depth_at_rest(law: NormalLaw, weight: Array, diameter: float) -> Array:
    """Penetration (n,) [m] at which the law bears weights (n,) [N/m], > 0; inf where it does not."""
    low, high = np.full(weight.shape, -law.reach), np.full(weight.shape, DEEPEST * diameter)
    bears = _force(law, high) >= weight
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        holds = _force(law, middle) >= weight
        low, high = np.where(holds, low, middle), np.where(holds, middle, high)
    return np.where(bears, high, np.inf)


def _force(law: NormalLaw, penetration: Array) -> Array:
    return law.update(penetration, law.initial_history(penetration.shape)).force
