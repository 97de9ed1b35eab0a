"""The riser shaken by its vortices by MoorDyn, in its own environment: explicit Runge-Kutta of second order."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

import moordyn
import numpy as np

from benchmarks.peers import shaken_riser as case

TOP = -1.0  # z of the upper end [m], below the surface
DAMPING = 0.8  # of a segment's axial vibration, over the critical one; its pages recommend nearly 1

DECK = """---------------------- LINE TYPES ----------------------
TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx Cl dF cF
(-) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-) (-) (-) (-)
pipe {pipe} 0 0 {force} {case.WIDTH} {case.MIDDLE}
---------------------- POINTS ----------------------
ID Attachment X Y Z Mass Volume CdA Ca
(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)
1 Coupled 0.0 0.0 {bottom} 0 0 0 0
2 Coupled 0.0 0.0 {top} 0 0 0 0
---------------------- LINES ----------------------
ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs
(#) (-) (#) (#) (m) (-) (-)
1 pipe 1 2 {case.LENGTH} {elements} -
---------------------- OPTIONS ----------------------
0 writeLog
{time_step!r} dtM
RK2 tScheme
{case.GRAVITY} g
{case.WATER} rho
200.0 WtrDpth
1.0e5 kBot
0.0 cBot
1 Currents
1.0 dtIC
200.0 TmaxIC
1e-6 threshIC
0 ICgenDynamic
1 disableOutput
1 disableOutTime
---------------------- OUTPUTS ----------------------
---------------------- need this line ----------------------
"""


def run(elements: int, time_step: float, force: float) -> case.Shaken:
    bottom, slow, fast = TOP - case.CHORD, *case.CURRENT
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "line.txt"
        pipe = case.DIAMETER, case.MASS, case.EA, -DAMPING, case.EI, case.DRAG, case.ADDED_MASS
        given = {"elements": elements, "time_step": time_step, "force": force, "pipe": " ".join(map(str, pipe))}
        path.write_text(DECK.format(case=case, bottom=bottom, top=TOP, **given), encoding="utf-8")
        profile = f"current\nz ux uy uz\n(m) (m/s)\n{bottom} {slow} 0 0\n{TOP} {fast} 0 0\n"
        (path.parent / "current_profile.txt").write_text(profile, encoding="utf-8")
        system = moordyn.Create(str(path))
        moordyn.SetVerbosity(system, moordyn.LEVEL_ERR)
        ends, still = [0.0, 0.0, bottom, 0.0, 0.0, TOP], [0.0] * 6
        moordyn.Init(system, ends, still)
        line, places = moordyn.GetLine(system, 1), list[list[list[float]]]()
        count, began = round(case.DURATION / case.RECORDS), time.process_time()
        for k in range(count):
            moordyn.Step(system, ends, still, k * case.RECORDS, case.RECORDS)
            places.append([moordyn.GetLineNodePos(line, node) for node in range(elements + 1)])
        seconds = time.process_time() - began
        moordyn.Close(system)
    return case.Shaken(case.RECORDS * (1.0 + np.arange(count)), np.array(places), seconds)


def save(elements: int, time_step: float, force: float, to: str) -> None:
    """Save the results to a file of numpy's."""
    np.savez(to, **run(elements, time_step, force)._asdict())
