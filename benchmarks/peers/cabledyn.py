"""A case by CableDyn: cubic Hermite elements with bending, generalised-alpha, in Fortran; one deck, run by its driver.

It writes every step to text: end tensions, moments at all nodes, and node positions over a floor.
"""

from __future__ import annotations

import resource
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from cabledyn import CableDynDriver

from benchmarks.peers.case import GRAVITY, WATER, Case, Record

DEPTH = 200.0  # of z = 0 under the surface [m]: all is submerged
UNREACHED = 1000.0  # depth of a seabed that the line doesn't reach [m]
DEFAULT = "1e-8 1e-14 30 12"  # relative and absolute tolerance, most iterations and halvings of a step
REPEATS = 3  # of its set-up alone

DECK = """---
CableDyn
--------------------- LINE TYPES ---------------------
TypeName Diam MassDenInAir EA BA EI Cd_n Cd_t Ca_n Ca_t
(-) (m) (kg/m) (N) (-) (N-m2) (-) (-) (-) (-)
line {case.diameter!r} {case.mass!r} {case.EA!r} 0.0 {case.EI!r} {case.drag!r} 0.0 {case.added_mass!r} 0.0
--------------------- POINTS ---------------------
ID Type X Y Z
(-) (-) (m) (m) (m)
1 Coupled {end[0]!r} 0.0 {end[1]!r}
2 Fixed {start[0]!r} 0.0 {start[1]!r}
--------------------- LINES ---------------------
ID NodeA NodeB Outputs
(-) (-) (-) (-)
1 1 2 {outputs}
--------------------- SECTIONS ---------------------
LineID LineType Length NumSegs
(-) (-) (m) (-)
1 line {case.length!r} {elements}
--------------------- OPTIONS ---------------------
{gravity!r} g
{water!r} rhoW
{depth!r} WtrDpth
{kBot!r} kBot
0.0 cBot
{time_step!r} dtM
{duration!r} TMax
MOTION motionFile
dynamic_solver {tolerances}
--------------------- OUTPUTS ---------------------
{channels}
--------------------- need this line ---------------------
"""


def run(case: Case, elements: int, time_step: float, tolerances: str = DEFAULT) -> Record:
    """One run, and its time loop's seconds: those of the driver less those of its set-up and statics alone."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for duration, deck in ((0.0, "still"), (case.duration, "moving")):
            text = _deck(case, elements, time_step, duration, tolerances)
            (folder / f"{deck}.dat").write_text(text.replace("MOTION", f"{deck}.txt"), encoding="utf-8")
            _write_motion(case, time_step, duration, folder / f"{deck}.txt")
        still = min(_timed(folder, "still") for _ in range(REPEATS))
        return _read(case, elements, folder / "moving", _timed(folder, "moving") - still)


def _deck(case: Case, elements: int, time_step: float, duration: float, tolerances: str) -> str:
    channels = ["FairTen1", "AnchTen1", *(f"BendMom1N{node}" for node in range(1, elements + 2))]
    return DECK.format(
        case=case,
        end=(case.end[0], case.end[1] - DEPTH),
        start=(case.start[0], case.start[1] - DEPTH),
        outputs="-" if case.floor is None else "p",
        elements=elements,
        gravity=GRAVITY,
        water=WATER,
        depth=UNREACHED if case.floor is None else DEPTH,
        kBot=(case.floor or 1.0e5) / case.diameter,
        time_step=time_step,
        duration=duration,
        tolerances=tolerances,
        channels="\n".join(f'"{channel}"' for channel in channels),
    )


def _write_motion(case: Case, time_step: float, duration: float, path: Path) -> None:
    rows = []
    for step in range(round(duration / time_step) + 1):
        (x, z), (vx, vz), (ax, az) = case.moved_end(step * time_step)
        numbers = (x, 0.0, z - DEPTH, vx, 0.0, vz, ax, 0.0, az)
        rows.append(f"{step * time_step:.6f} 1 " + " ".join(f"{number:.12e}" for number in numbers))
    path.write_text("\n".join(rows) + "\n", encoding="utf-8")


def _timed(folder: Path, deck: str) -> float:
    """Processor seconds of the driver."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [str(CableDynDriver().executable), f"{deck}.dat", deck]
    subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def _read(case: Case, elements: int, root: Path, seconds: float) -> Record:
    """Read a record of cabledyn: its lines begin at the moved end, a record's at the held one."""
    table = np.loadtxt(root.with_suffix(".out"), skiprows=2)
    position = np.empty((table.shape[0], 0, 2))
    if case.floor is not None:
        columns = np.loadtxt(f"{root}.Line1.p.out", skiprows=2)[:, 1:]
        position = columns.reshape(len(columns), -1, 3)[:, ::-1, ::2] + np.array([0.0, DEPTH])
    return Record(
        time=table[:, 0],
        held=table[:, 2],
        moved=table[:, 1],
        arc=np.linspace(0.0, case.length, elements + 1),
        moment=np.abs(table[:, :2:-1]),
        position=position,
        seconds=seconds,
    )
