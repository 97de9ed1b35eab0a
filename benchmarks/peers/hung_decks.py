"""A buoy on three chains, and a lazy S over an arch: decks of MoorDyn, and how an end of theirs moves.

MoorDyn runs the deck, riser_soil the scene that it imports from it: lengths, segments, masses and coefficients are one.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from riser_soil.core.arrays import Array

DURATION, RECORDS = 30.0, 0.1  # s
AT = (0, 1, -2, -1)  # nodes of a line: its ends, and those beside them


class Moved(NamedTuple):
    """Tension (nt, 3, 4) of the lines at AT [N], at rest and every RECORDS s from there; processor seconds to rest, and
    of the motion.
    """

    tension: Array
    seconds_to_rest: float
    seconds: float


HEAD = """---------------------- LINE TYPES ----------------------
TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx
(-) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)
{types}
"""
BODIES = """---------------------- BODIES ----------------------
ID Attachment X0 Y0 Z0 r0 p0 y0 Mass CG I Volume CdA Ca
(#) (-) (m) (m) (m) (deg) (deg) (deg) (kg) (m) (kg-m^2) (m^3) (m^2) (-)
{bodies}
"""
REST = """---------------------- POINTS ----------------------
ID Attachment X Y Z Mass Volume CdA Ca
(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)
{points}
---------------------- LINES ----------------------
ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs
(#) (-) (#) (#) (m) (-) (-)
{lines}
---------------------- OPTIONS ----------------------
9.81 g
1025.0 rho
{depth} WtrDpth
1.0e5 kBot
0.0 cBot
{time_step!r} dtM
RK2 tScheme
0 writeLog
1.0 dtIC
400.0 TmaxIC
1e-7 threshIC
1 ICgenDynamic
1 disableOutput
1 disableOutTime
---------------------- need this line ----------------------
"""


class Hung(NamedTuple):
    """A case. lines: with their segments per part, {0} of one or {1} of two. moved: place [m] of the coupled point,
    which swings by the amplitude [m] in a period [s], ramped over the first.
    """

    types: str
    bodies: str
    points: str
    lines: str
    depth: float
    moved: tuple[float, float, float]
    amplitude: tuple[float, float, float]
    period: float

    def deck(self, parts: int, time_step: float) -> str:
        head = HEAD.format(types=self.types) + (BODIES.format(bodies=self.bodies) if self.bodies else "")
        lines = self.lines.format(parts, 2 * parts)
        return head + REST.format(points=self.points, lines=lines, depth=self.depth, time_step=time_step)

    def place(self, t: float) -> list[float]:
        """Place of the moved end [m], t seconds after it began; the ramp is riser_soil's."""
        x = min(t / self.period, 1.0)
        swing = x**3 * (10.0 - 15.0 * x + 6.0 * x * x) * math.sin(2.0 * math.pi * t / self.period)
        return [x + a * swing for x, a in zip(self.moved, self.amplitude, strict=True)]


CASES = {
    "a buoy on three chains": Hung(
        "chain 0.05 8.0 1.0e8 -0.8 1.0e3 1.2 1.0 0.05 0.0",
        "",
        """1 Coupled 100.0 0.0 -100.0 0 0 0 0
2 Fixed -50.0 86.602540378 -100.0 0 0 0 0
3 Fixed -50.0 -86.602540378 -100.0 0 0 0 0
4 Free 0.0 0.0 -20.0 2000.0 6.0 3.0 0.5""",
        """1 chain 1 4 130.0 {1} -
2 chain 2 4 130.0 {1} -
3 chain 3 4 130.0 {1} -""",
        150.0,
        (100.0, 0.0, -100.0),
        (2.0, 0.0, 0.0),
        10.0,
    ),
    "a lazy S over an arch": Hung(
        """pipe 0.2 60.0 3.0e8 -0.8 2.0e3 1.1 1.0 0.05 0.0
rope 0.1 12.0 4.0e7 -0.8 10.0 1.2 1.0 0.05 0.0""",
        "1 Free -60.0 0.0 -70.0 0 0 0 12.0e3 0|0|-0.5 4.0e4|4.0e4|4.0e4 24.0 20|30|20 0.6|0.8|0.6",
        """1 Coupled 0.0 0.0 -5.0 0 0 0 0
2 Fixed -115.0 0.0 -140.0 0 0 0 0
3 Fixed -60.0 0.0 -150.0 0 0 0 0
4 Body1 2.5 0.0 0.0 0 0 0 0
5 Body1 -2.5 0.0 0.0 0 0 0 0
6 Body1 0.0 0.0 -2.0 0 0 0 0""",
        """1 pipe 4 1 115.0 {1} -
2 pipe 2 5 105.0 {1} -
3 rope 3 6 76.0 {0} -""",
        170.0,
        (0.0, 0.0, -5.0),
        (1.0, 0.0, 1.5),
        9.0,
    ),
}
