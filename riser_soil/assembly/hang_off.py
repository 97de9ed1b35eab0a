"""An end that hangs off at an angle or with a tension: its scene by what is solved for, and the cable that has it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from riser_soil.assembly.riser import attachments_of, elements_of
from riser_soil.assembly.shape import catenary_between
from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.scene.bathymetry import ground_height
from riser_soil.scene.cross_checks import conflicts
from riser_soil.scene.problem import message
from riser_soil.scene.riser import Riser, Support
from riser_soil.scene.scene import Scene
from riser_soil.scene.shapes import HangOff
from riser_soil.scene.variants import with_end_at, with_segment_as_long

NEAREST = 1e-3  # of the riser's length: the least layback or segment that is looked at
LONGEST = 1.05  # times the riser's length: ends farthest apart
LOOKS = 25  # from taut to slack, before a cable is sought between two of them
CLOSE = 1e-12  # of what is solved for: how closely the cable's is found


@dataclass(frozen=True)
class HungEnd:
    """The end of a scene that hangs off: its name, start or end, and what it asks for.

    What is solved for, `value` [m], is the horizontal distance of the ends or the length of the segment at the other
    end; the scene has a first guess.
    """

    scene: Scene
    name: str
    asked: HangOff

    @property
    def path(self) -> str:
        """Its key in the scene."""
        return f"riser.{self.name}.hang_off"

    @property
    def other(self) -> str:
        return "end" if self.name == "start" else "start"

    @property
    def span(self) -> Array:
        """From the other end to this one (3,) [m]."""
        here, there = (_position(self.scene.line, name) for name in (self.name, self.other))
        return here - there

    @property
    def layback(self) -> float:
        """Horizontal distance of the ends [m]."""
        return math.hypot(*self.span[:2])

    @property
    def segment(self) -> int:
        """Number of the segment at the other end."""
        return 0 if self.name == "end" else len(self.scene.line.segments) - 1

    @property
    def limits(self) -> tuple[float, float]:
        """Least and largest value that is looked at [m]."""
        L, rise = self.scene.line.length, float(self.span[2])
        if self.asked.by == "length":
            rest = L - self.scene.line.segments[self.segment].length
            slack = math.fsum([rise, self.layback, L])
            return max(math.hypot(rise, self.layback) / LONGEST - rest, NEAREST * L), max(slack - rest, NEAREST * slack)
        return NEAREST * L, max(math.sqrt(max((LONGEST * L) ** 2 - rise**2, 0.0)), 2.0 * NEAREST * L)

    @property
    def reported(self) -> str:
        """What is asked for, in words."""
        what = "a hang-off angle" if self.asked.angle is not None else "a top tension"
        return f"{what} of {self.asked.asked:g} {self.asked.unit}"


def reported(hung: HungEnd, value: float) -> str:
    """What is asked for, and the value [m] with its place, in words."""
    if hung.asked.by == "length":
        return f"{hung.reported}: a length of {value:.6g} m of segments.{hung.segment}"
    name = hung.name if hung.asked.by == "layback" else hung.other
    place = ", ".join(f"{x:.6g}" for x in _position(with_value(hung, value).line, name))
    return f"{hung.reported}: a layback of {value:.6g} m, the {name} at [{place}],"


def hung_end(scene: Scene) -> HungEnd | None:
    """The end that hangs off; None where none does."""
    for name in ("start", "end"):
        end = getattr(scene.line, name)
        if isinstance(end, Support) and end.hang_off is not None:
            return HungEnd(scene, name, end.hang_off)
    return None


def with_value(hung: HungEnd, value: float) -> Scene:
    """The scene with a value of what is solved for [m], and no hang-off asked any more."""
    plain = getattr(hung.scene.line, hung.name).model_copy(update={"hang_off": None})
    scene = hung.scene.model_copy(update={"riser": hung.scene.line.model_copy(update={hung.name: plain})})
    if hung.asked.by == "length":
        return with_segment_as_long(scene, hung.segment, value)
    name, sign = (hung.name, 1.0) if hung.asked.by == "layback" else (hung.other, -1.0)
    ahead = hung.span * [1.0, 1.0, 0.0] * (sign * (value / hung.layback - 1.0))
    x, y, z = (float(each) for each in _position(scene.line, name) + ahead)
    return _as_high_over_the_ground(with_end_at(scene, name, (x, y, z)), scene, hung.other)


def _as_high_over_the_ground(scene: Scene, before: Scene, name: str) -> Scene:
    """With the lower end as high over the ground as before: it moved, or the ground below it with the riser's start."""
    x, y, z = getattr(scene.line, name).position
    rise = ground_height(scene, (x, y, z)) - ground_height(before, getattr(before.riser, name).position)
    return with_end_at(scene, name, (x, y, z + rise)) if rise else scene


def settled(hung: HungEnd, value: float) -> Scene:
    """The same, once the value is found; SceneError where the scene can't be with it."""
    scene = with_value(hung, value)
    for problem in conflicts(scene):
        wrong = message(problem, scene.model_dump(by_alias=True))
        raise SceneError(f"{hung.path}: {reported(hung, value)} but then {wrong}")
    return scene


def by_cable(hung: HungEnd, asked: float) -> float:
    """The value [m] with which a cable without bending stiffness has an angle [deg] or tension [N].

    Of two, the tauter one's. Raises SceneError where none within the limits has it.
    """
    from scipy.optimize import brentq

    values, seen = _looked_at(hung), list[float]()
    for n, value in enumerate(values):
        seen.append(_seen(hung, value))
        if n and (seen[-1] - asked) * (seen[-2] - asked) <= 0.0:
            between, close = values[n - 1 : n + 1], CLOSE * max(values)
            return float(brentq(lambda x: _seen(hung, x) - asked, *between, xtol=close, rtol=CLOSE))
    what = "length" if hung.asked.by == "length" else "layback"
    raise SceneError(
        f"{hung.path}: {hung.reported} is out of reach: as a cable, with a {what} from {min(values):.4g} to "
        f"{max(values):.4g} m, it has {min(seen):.4g} to {max(seen):.4g} {hung.asked.unit}; ask for what lies between, "
        "or change the segments or the height"
    )


def _looked_at(hung: HungEnd) -> Array:
    """Values (LOOKS,) [m] from the tautest to the slackest, closest where the riser is taut."""
    low, high = hung.limits
    taut, slack = (low, high) if hung.asked.by == "length" else (high, low)
    return np.asarray(taut + (slack - taut) * np.linspace(0.0, 1.0, LOOKS) ** 2)


def _seen(hung: HungEnd, value: float) -> float:
    """The cable's angle from the vertical [deg] or tension [N] at the end that hangs off."""
    scene = with_value(hung, value)
    start, end = (_position(scene.line, name) for name in ("start", "end"))
    cable = catenary_between(scene, elements_of(scene), attachments_of(scene), start, end)
    tension = float(cable.tension[-1 if hung.name == "end" else 0])
    return tension if hung.asked.angle is None else math.degrees(math.asin(min(1.0, cable.H / tension)))


def _position(riser: Riser, name: str) -> Array:
    return np.array(getattr(riser, name).position)
