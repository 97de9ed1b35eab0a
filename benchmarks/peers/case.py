"""The cases as numbers alone, for any program: a line in still water, one end held, the other moved; perhaps a floor.

This file and those of other programs (`moordyn.py`, …) need nothing of riser_soil: they run in an environment apart.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

GRAVITY, WATER = 9.81, 1025.0  # m/s2, kg/m3


@dataclass(frozen=True)
class Surge:
    """The end goes to and fro along x by an amplitude [m]."""

    amplitude: float

    def at(self, s: float, v: float, a: float) -> tuple[tuple[float, float], ...]:
        """Displacement, velocity and acceleration (x, z) where the ramped sine is s, with its derivatives in time."""
        return tuple((self.amplitude * each, 0.0) for each in (s, v, a))


@dataclass(frozen=True)
class Swing:
    """The end hangs below a hub on an arm [m] that swings by an amplitude [rad]."""

    arm: float
    amplitude: float

    def at(self, s: float, v: float, a: float) -> tuple[tuple[float, float], ...]:
        angle, rate, change = (self.amplitude * each for each in (s, v, a))
        sine, cosine = self.arm * math.sin(angle), self.arm * math.cos(angle)
        moved = sine, self.arm - cosine
        velocity = cosine * rate, sine * rate
        return moved, velocity, (cosine * change - sine * rate**2, sine * change + cosine * rate**2)


@dataclass(frozen=True)
class Case:
    """A line from `start`, which is held, to `end`, which moves; both ends turn freely. SI units, z upwards.

    mass: with contents, in air. The drag of Morison's formula and the added mass act across the line alone.
    floor: force per length and depth [N/m2] at z = 0, without damping or friction; None for none. since: when the time
    begins in which extremes are taken [s]. clearance: height [m] over the floor at which the line counts as lifted off.
    """

    name: str
    length: float
    EA: float
    EI: float
    mass: float
    diameter: float
    drag: float
    added_mass: float
    start: tuple[float, float]
    end: tuple[float, float]
    motion: Surge | Swing
    period: float
    duration: float
    since: float
    floor: float | None = None
    clearance: float = 0.1

    @property
    def weight(self) -> float:
        """In water [N/m]."""
        return (self.mass - self.displaced) * GRAVITY

    @property
    def displaced(self) -> float:
        """Mass of the water displaced [kg/m]."""
        return WATER * math.pi / 4.0 * self.diameter**2

    def moved_end(self, t: float) -> tuple[tuple[float, float], ...]:
        """Position, velocity and acceleration (x, z) of the end; a sine that grows over its first period."""
        w = 2.0 * math.pi / self.period
        r, r1, r2 = _grown(t / self.period)
        r1, r2 = r1 / self.period, r2 / self.period**2
        sine, cosine = math.sin(w * t), math.cos(w * t)
        s = r * sine
        v = r1 * sine + r * w * cosine
        a = r2 * sine + 2.0 * r1 * w * cosine - r * w * w * sine
        (dx, dz), velocity, acceleration = self.motion.at(s, v, a)
        return (self.end[0] + dx, self.end[1] + dz), velocity, acceleration


def _grown(x: float) -> tuple[float, float, float]:
    """10 x^3 - 15 x^4 + 6 x^5 up to x = 1, then 1, with its derivatives."""
    if x >= 1.0:
        return 1.0, 0.0, 0.0
    return x**3 * (10.0 - 15.0 * x + 6.0 * x * x), 30.0 * (x - x * x) ** 2, 60.0 * (x - x * x) * (1.0 - 2.0 * x)


CATENARY = Case(
    name="catenary",
    length=350.0,
    EA=15.38e8,
    EI=20.96e3,
    mass=57.5 + WATER * math.pi / 4.0 * 0.2**2,
    diameter=0.26,
    drag=1.0,
    added_mass=1.0,
    start=(0.0, 0.0),
    end=(150.0, 150.0),
    motion=Surge(2.01),
    period=14.0,
    duration=140.0,
    since=98.0,
)
TANK = Case(
    name="tank",
    length=40.0,
    EA=1.0e6,
    EI=1.0e3,
    mass=33.113,
    diameter=0.15,
    drag=1.2,
    added_mass=1.0,
    start=(0.0, 0.0),
    end=(28.0, 15.0),
    motion=Swing(2.0, math.radians(20.0)),
    period=10.0,
    duration=60.0,
    since=20.0,
    floor=1.0e6,
)
CASES = {case.name: case for case in (CATENARY, TANK)}


@dataclass(frozen=True, eq=False)
class Record:
    """What a run tells, at its own instants (nt,) [s] and at its own stations: tension at the held and at the moved end
    (nt,) [N], magnitude of the bending moment (nt, nm) [N.m] at growing arcs (nm,) [m], node positions (nt, nn, 2) [m]
    at equal arcs. seconds: processor time of the time loop, least of its repeats.
    """

    time: np.ndarray
    held: np.ndarray
    moved: np.ndarray
    arc: np.ndarray
    moment: np.ndarray
    position: np.ndarray
    seconds: float


def catenary(case: Case, nodes: int) -> np.ndarray:
    """Points (nodes, 2) at equal arcs of an inextensible catenary through both ends, on the floor where there is one:
    a first guess for programs that want one.
    """
    (x0, z0), (x1, z1), w = case.start, case.end, case.weight
    arcs = np.linspace(0.0, case.length, nodes)
    if case.floor is not None:  # a part s0 lies on the floor: H from the height, s0 from the length

        def far(H: float) -> tuple[float, float]:
            hanging = math.sqrt((z1 - z0) * ((z1 - z0) + 2.0 * H / w))
            return case.length - hanging, case.length - hanging + H / w * math.asinh(w * hanging / H)

        low, high = 1e-6 * w, 1e6 * w
        for _ in range(200):
            middle = math.sqrt(low * high)
            low, high = (middle, high) if far(middle)[1] < x1 - x0 else (low, middle)
        lying = far(low)[0]
        s, c = np.maximum(arcs - lying, 0.0), low / w
        x = np.minimum(arcs, lying) + c * np.arcsinh(s / c)
        return np.stack([x0 + x, z0 + np.hypot(c, s) - c], axis=1)
    across, up = x1 - x0, z1 - z0
    wanted = math.sqrt(case.length**2 - up**2) / across  # sinh(u)/u
    low, high = 1e-6, 50.0
    for _ in range(200):
        u = 0.5 * (low + high)
        low, high = (u, high) if math.sinh(u) / u < wanted else (low, u)
    c = across / (2.0 * u)
    lowest = 0.5 * across - c * math.atanh(up / case.length)
    s0 = c * math.sinh(-lowest / c)
    x = lowest + c * np.arcsinh((arcs + s0) / c)
    return np.stack([x0 + x, z0 + c * np.cosh((x - lowest) / c) - c * math.cosh(lowest / c)], axis=1)
