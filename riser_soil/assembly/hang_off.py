"""An end that hangs off at an angle or with a tension: its scene by what is solved for, and the cable that has it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from riser_soil.assembly.riser import attachments_of, elements_of
from riser_soil.assembly.shape import catenary_between
from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.scene.bathymetry import ground_height
from riser_soil.scene.line_checks import all_conflicts
from riser_soil.scene.lines import ENDS, by_line, placing, risers, with_risers
from riser_soil.scene.problem import message
from riser_soil.scene.riser import Riser, Segment, Support
from riser_soil.scene.scene import Scene
from riser_soil.scene.shapes import HangOff
from riser_soil.scene.variants import with_end_at, with_segment_as_long

NEAREST = 1e-3  # of the riser's length: the least layback or segment that is looked at
LONGEST = 1.05  # times the riser's length: ends farthest apart
LOOKS = 25  # from taut to slack, before a cable is sought between two of them
CLOSE = 1e-12  # of what is solved for: how closely the cable's is found


@dataclass(frozen=True)
class HangOffEnd:
    """The end of a line that hangs off: the line's name, "" of the only one, the end's, start or end, and what it asks
    for.

    What is solved for, `value` [m], is the horizontal distance of the ends or the length of the segment at the other
    end; the scene has a first guess.
    """

    scene: Scene
    line: str
    name: str
    asked: HangOff

    @property
    def path(self) -> str:
        """Its key in the scene."""
        return f"{f'lines.{self.line}' if self.line else 'riser'}.{self.name}.hang_off"

    @property
    def riser(self) -> Riser:
        """The line, its ends where joints hold them."""
        return _riser(self.scene, self.line)

    @property
    def other(self) -> str:
        return "end" if self.name == "start" else "start"

    @property
    def span(self) -> Array:
        """Vector from the other end to this one (3,) [m]."""
        here, there = (_position(self.riser, name) for name in (self.name, self.other))
        return here - there

    @property
    def layback(self) -> float:
        """Horizontal distance of the ends [m]."""
        return math.hypot(*self.span[:2])

    @property
    def segments(self) -> tuple[Segment, ...]:
        """Segments of the line as it is given."""
        return risers(self.scene)[self.line].segments

    @property
    def segment(self) -> int:
        """Number of the segment at the other end."""
        return 0 if self.name == "end" else len(self.segments) - 1

    @property
    def limits(self) -> tuple[float, float]:
        """Least and largest value [m] of the search by the cable, the ends where they are at first."""
        L, rise = self.riser.length, float(self.span[2])
        if self.asked.by == "length":
            rest = L - self.segments[self.segment].length
            slack = math.fsum([rise, self.layback, L])
            return max(math.hypot(rise, self.layback) / LONGEST - rest, NEAREST * L), max(slack - rest, NEAREST * slack)
        return NEAREST * L, max(math.sqrt(max((LONGEST * L) ** 2 - rise**2, 0.0)), 2.0 * NEAREST * L)

    @property
    def bounds(self) -> tuple[float, float]:
        """Least and largest value [m] of the search with the riser at rest. No upper bound where a joint holds the
        other end, which moves.
        """
        low, high = self.limits
        return (NEAREST * low, math.inf) if getattr(self.riser, self.other).jointed else (low, high)

    @property
    def request(self) -> str:
        """The request of the hang-off, in words."""
        what = "a hang-off angle" if self.asked.angle is not None else "a top tension"
        return f"{self.line + ': ' if self.line else ''}{what} of {self.asked.asked:g} {self.asked.unit}"


def in_words(end: HangOffEnd, value: float) -> str:
    """A hang-off's request, and the value [m] with its place, in words."""
    if end.asked.by == "length":
        return f"{end.request}: a length of {value:.6g} m of segments.{end.segment}"
    name = end.name if end.asked.by == "layback" else end.other
    riser = _riser(with_values([end], [value]), end.line)
    place = ", ".join(f"{x:.6g}" for x in _position(riser, name))
    return f"{end.request}: a layback of {value:.6g} m, the {name} at [{place}],"


def hang_off_ends(scene: Scene) -> list[HangOffEnd]:
    """The ends that hang off, at most one of each line."""
    ends = [(line, name, getattr(riser, name)) for line, riser in risers(scene).items() for name in ENDS]
    return [
        HangOffEnd(scene, line, name, end.hang_off)
        for line, name, end in ends
        if isinstance(end, Support) and end.hang_off is not None
    ]


def with_values(ends: Sequence[HangOffEnd], values: Sequence[float]) -> Scene:
    """The scene of the ends with values of what is solved for [m], and no hang-off asked any more."""
    scene = ends[0].scene
    for end, value in zip(ends, values, strict=True):
        scene = _with_value(scene, end, value)
    return scene


def _with_value(before: Scene, end: HangOffEnd, value: float) -> Scene:
    riser = risers(before)[end.line]
    plain = getattr(riser, end.name).model_copy(update={"hang_off": None})
    scene = with_risers(before, {**risers(before), end.line: riser.model_copy(update={end.name: plain})})
    if end.asked.by == "length":
        return with_segment_as_long(scene, end.line, end.segment, value)
    name, sign = (end.name, 1.0) if end.asked.by == "layback" else (end.other, -1.0)
    ahead = end.span * [1.0, 1.0, 0.0] * (sign * (value / end.layback - 1.0))
    x, y, z = (float(each) for each in _position(riser, name) + ahead)
    moved = with_end_at(scene, end.line, name, (x, y, z))
    return _as_high_over_the_ground(moved, scene, end.line, end.other)


def _as_high_over_the_ground(scene: Scene, before: Scene, line: str, name: str) -> Scene:
    """The line with its lower end as high over the ground as before: it moved, or the ground below it with the riser's
    start.
    """
    now, was = by_line(scene)[line], by_line(before)[line]
    x, y, z = getattr(now.riser, name).position
    rise = ground_height(now, (x, y, z)) - ground_height(was, getattr(was.riser, name).position)
    return with_end_at(scene, line, name, (x, y, z + rise)) if rise else scene


def settled(ends: Sequence[HangOffEnd], values: Sequence[float]) -> Scene:
    """The scene with the values that were solved for [m], and no hang-off asked any more; SceneError where it has
    conflicts then.
    """
    scene = with_values(ends, values)
    for problem in all_conflicts(scene):
        wrong = message(problem, scene.model_dump(by_alias=True))
        words = " and ".join(in_words(end, value) for end, value in zip(ends, values, strict=True))
        raise SceneError(f"{ends[0].path}: {words} but then {wrong}")
    return scene


def first_value(end: HangOffEnd) -> float:
    """The value [m] to begin with: a cable's; the given one where none has it and a joint lets the other end go."""
    try:
        return by_cable(end, end.asked.asked)
    except SceneError:
        if not getattr(end.riser, end.other).jointed:
            raise
        return end.segments[end.segment].length if end.asked.by == "length" else end.layback


def by_cable(end: HangOffEnd, asked: float) -> float:
    """The value [m] with which a cable without bending stiffness has an angle [deg] or tension [N].

    Of two, the tauter one's. Raises SceneError where none within the limits has it.
    """
    from scipy.optimize import brentq

    values, looks = _looked_at(end), list[float]()
    for n, value in enumerate(values):
        looks.append(_cable_value(end, value))
        if n and (looks[-1] - asked) * (looks[-2] - asked) <= 0.0:
            between, close = values[n - 1 : n + 1], CLOSE * max(values)
            return float(brentq(lambda x: _cable_value(end, x) - asked, *between, xtol=close, rtol=CLOSE))
    what = "length" if end.asked.by == "length" else "layback"
    raise SceneError(
        f"{end.path}: {end.request} is out of reach: as a cable, with a {what} from {min(values):.4g} to "
        f"{max(values):.4g} m, it has {min(looks):.4g} to {max(looks):.4g} {end.asked.unit}; ask for a value between, "
        "or change the segments or the height"
    )


def _looked_at(end: HangOffEnd) -> Array:
    """Values (LOOKS,) [m] from the tautest to the slackest, closest where the riser is taut."""
    low, high = end.limits
    taut, slack = (low, high) if end.asked.by == "length" else (high, low)
    return np.asarray(taut + (slack - taut) * np.linspace(0.0, 1.0, LOOKS) ** 2)


def _cable_value(end: HangOffEnd, value: float) -> float:
    """The cable's angle from the vertical [deg] or tension [N] at the end that hangs off."""
    scene = by_line(with_values([end], [value]))[end.line]
    start, last = (_position(scene.line, name) for name in ENDS)
    with placing(end.line):
        cable = catenary_between(scene, elements_of(scene), attachments_of(scene), start, last)
    tension = float(cable.tension[-1 if end.name == "end" else 0])
    return tension if end.asked.angle is None else math.degrees(math.asin(min(1.0, cable.H / tension)))


def _riser(scene: Scene, line: str) -> Riser:
    return by_line(scene)[line].line


def _position(riser: Riser, name: str) -> Array:
    return np.array(getattr(riser, name).position)
