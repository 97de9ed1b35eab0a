"""A case by MoorDyn: lumped masses, explicit Runge-Kutta of second order; its own steady-state solver finds the rest.

Its step is bound by the axial waves, so that the coupling step, at which the end is moved, is the time step itself. It
needs internal damping where the line has none. Over a floor its solver for the rest ends elsewhere than at rest; there
dynamic relaxation finds it. Recorded from Python every RECORDS s.
"""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

import moordyn
import numpy as np

from benchmarks.peers.case import GRAVITY, WATER, Case, Record

DEPTH = 200.0  # of z = 0 under the surface [m]: all is submerged
UNREACHED = 1000.0  # depth of a seabed that the line doesn't reach [m]
RECORDS = 0.1  # s
DAMPING = 0.8  # of a segment's axial vibration, over the critical one; its pages recommend nearly 1

DECK = """---------------------- LINE TYPES ----------------------
TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx
(-) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)
line {case.diameter!r} {case.mass!r} {case.EA!r} -{damping!r} {case.EI!r} {case.drag!r} {case.added_mass!r} 0.0 0.0
---------------------- POINTS ----------------------
ID Attachment X Y Z Mass Volume CdA Ca
(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)
1 Coupled {start[0]!r} 0.0 {start[1]!r} 0 0 0 0
2 Coupled {end[0]!r} 0.0 {end[1]!r} 0 0 0 0
---------------------- LINES ----------------------
ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs
(#) (-) (#) (#) (m) (-) (-)
1 line 1 2 {case.length!r} {elements} -
---------------------- OPTIONS ----------------------
0 writeLog
{time_step!r} dtM
RK2 tScheme
{gravity!r} g
{water!r} rho
{depth!r} WtrDpth
{kBot!r} kBot
0.0 cBot
1.0 dtIC
200.0 TmaxIC
1e-6 threshIC
{relaxed} ICgenDynamic
1 disableOutput
1 disableOutTime
---------------------- OUTPUTS ----------------------
---------------------- need this line ----------------------
"""


def run(case: Case, elements: int, time_step: float) -> Record:
    """One run; the seconds of its time loop are those of its steps and of reading them."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "line.txt"
        path.write_text(_deck(case, elements, time_step), encoding="utf-8")
        system = moordyn.Create(str(path))
        moordyn.SetVerbosity(system, moordyn.LEVEL_ERR)
        before = _ends(case, 0.0)
        moordyn.Init(system, before, [0.0] * 6)
        line, points = moordyn.GetLine(system, 1), [moordyn.GetPoint(system, number) for number in (1, 2)]
        forces, curvatures, positions = [], [], []
        steps, often = round(case.duration / time_step), max(1, round(RECORDS / time_step))
        began = time.process_time()
        for step in range(steps + 1):
            if step % often == 0:
                nodes = range(elements + 1)
                forces.append([moordyn.GetPointForce(point)[::2] for point in points])
                curvatures.append([moordyn.GetLineNodeCurv(line, node) for node in nodes])
                positions.append([moordyn.GetLineNodePos(line, node)[::2] for node in nodes])
            after = _ends(case, (step + 1) * time_step)
            velocity = [(b - a) / time_step for a, b in zip(before, after, strict=True)]
            moordyn.Step(system, before, velocity, step * time_step, time_step)
            before = after
        seconds = time.process_time() - began
        moordyn.Close(system)
    position = np.array(positions)
    chords = (position[:, [1, -1]] - position[:, [0, -2]]) * np.array([1.0, -1.0])[:, None]
    held, moved = ((np.array(forces) * chords).sum(axis=2) / np.linalg.norm(chords, axis=2)).T
    return Record(
        time=time_step * often * np.arange(len(held)),
        held=held,
        moved=moved,
        arc=np.linspace(0.0, case.length, elements + 1),
        moment=case.EI * np.abs(curvatures),
        position=position + np.array([0.0, DEPTH]),
        seconds=seconds,
    )


def _ends(case: Case, t: float) -> list[float]:
    """Both ends, since a fixed point would not tell its force."""
    (x, z), _, _ = case.moved_end(t)
    return [case.start[0], 0.0, case.start[1] - DEPTH, x, 0.0, z - DEPTH]


def _deck(case: Case, elements: int, time_step: float) -> str:
    return DECK.format(
        case=case,
        damping=DAMPING,
        start=(case.start[0], case.start[1] - DEPTH),
        end=(case.end[0], case.end[1] - DEPTH),
        elements=elements,
        time_step=time_step,
        gravity=GRAVITY,
        water=WATER,
        depth=UNREACHED if case.floor is None else DEPTH,
        relaxed=0 if case.floor is None else 1,
        kBot=(case.floor or 1.0e5) / case.diameter,
    )
