"""The pipe on clay by CalculiX (`ccx`, Debian's calculix-ccx): a deck of the same hexahedra, its run, its results.

The pipe is an arc of prescribed nodes; its facets, a degree wide, press on the faces of the soil's top (penalty, face
to face). Without NLGEOM strains are small; contact is between the moved faces all the same.
"""

from __future__ import annotations

import math
import os
import resource
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.peers.clay_case import DEPTHS, DIAMETER, E_OVER_SU, HALF_LENGTH, NU, STEPS, SU, Pressed
from riser_soil.core.arrays import Array, BoolArray, IntArray

FACES = ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0))  # S1 to S6
ARC, THICKNESS = 45, 0.02  # half of the arc [degrees], which are its facets; its wall [m]

DECK = """*NODE, NSET=SOIL
{soil_nodes}
*NODE, NSET=PIPE
{pipe_nodes}
*ELEMENT, TYPE={element}, ELSET=SOIL
{soil_cells}
*ELEMENT, TYPE=C3D8, ELSET=PIPE
{pipe_cells}
*MATERIAL, NAME=CLAY
*ELASTIC
{E!r}, {nu!r}
*PLASTIC
{limit!r}, 0.
*MATERIAL, NAME=STIFF
*ELASTIC
{E!r}, 0.
*SOLID SECTION, ELSET=SOIL, MATERIAL=CLAY
*SOLID SECTION, ELSET=PIPE, MATERIAL=STIFF
*BOUNDARY
{held}
*SURFACE, NAME=TOP, TYPE=ELEMENT
{top}
*SURFACE, NAME=UNDERSIDE, TYPE=ELEMENT
{underside}
*SURFACE INTERACTION, NAME=PENALTY
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
{stiffness!r}
*CONTACT PAIR, INTERACTION=PENALTY, TYPE=SURFACE TO SURFACE
TOP, UNDERSIDE
*STEP, INC=1000
{analysis}
*BOUNDARY
{moved}
*NODE PRINT, NSET=PIPE, TOTALS=ONLY
RF
*END STEP
"""
STATIC = f"*STATIC\n{1.0 / STEPS:.12g}, 1., {1.0 / STEPS / 64.0:.12g}, {1.0 / STEPS:.12g}"


@dataclass(frozen=True, eq=False)
class Block:
    """The soil's mesh: points (n, 3) [m], hexahedra (nc, 8) in VTK's order, held directions (n, 3)."""

    points: Array
    cells: IntArray
    held: BoolArray


def deck(block: Block, stiffness: float, element: str, analysis: str = STATIC) -> str:
    """stiffness: of the penalty [N/m3]. element: of the soil. Numbers count from 1, the pipe's after the soil's."""
    n, nc = len(block.points), len(block.cells)
    points, cells = pipe()
    where = points.reshape(-1, 3)
    top = [f"{cell + 1}, S{face + 1}" for cell, face in _top(block)]
    return DECK.format(
        element=element,
        soil_nodes=_numbered(block.points, 1),
        pipe_nodes=_numbered(where, n + 1),
        soil_cells=_numbered(block.cells + 1, 1),
        pipe_cells=_numbered(cells + n + 1, nc + 1),
        E=E_OVER_SU * SU,
        nu=NU,
        limit=math.sqrt(3.0) * SU,
        held="\n".join(f"{node + 1}, {axis + 1}" for node, axis in np.argwhere(block.held)),
        top="\n".join(top),
        underside="\n".join(f"{nc + 1 + cell}, S1" for cell in range(len(cells))),
        stiffness=stiffness,
        analysis=analysis,
        moved=_moved(where, n),
    )


def pipe() -> tuple[Array, IntArray]:
    """Points (2, 2, 2 ARC + 1, 3) by radius, end and angle, and cells (2 ARC, 8) whose first face is the underside."""
    angle = np.radians(np.arange(-ARC, ARC + 1))
    points = np.empty((2, 2, len(angle), 3))
    for layer, radius in enumerate((0.5 * DIAMETER, 0.5 * DIAMETER - THICKNESS)):
        points[layer, :, :, 0] = np.array([[-HALF_LENGTH], [HALF_LENGTH]])
        points[layer, :, :, 1] = radius * np.sin(angle)
        points[layer, :, :, 2] = 0.5 * DIAMETER - radius * np.cos(angle)
    number = np.arange(4 * len(angle)).reshape(2, 2, -1)
    outer = [number[:, 0, :-1], number[:, 1, :-1], number[:, 1, 1:], number[:, 0, 1:]]
    return points, np.concatenate([np.stack([side[layer] for side in outer], axis=1) for layer in (0, 1)], axis=1)


def _moved(points: Array, before: int) -> str:
    """The pipe's nodes as its axis tilts: each end's goes straight down, the sections turn with the axis."""
    fall = np.interp(points[:, 0], (-HALF_LENGTH, HALF_LENGTH), DEPTHS)
    tilt = math.atan((DEPTHS[0] - DEPTHS[1]) / (2.0 * HALF_LENGTH))  # about -y: the start goes deeper
    above = points[:, 2] - 0.5 * DIAMETER
    u = np.column_stack([-above * math.sin(tilt), np.zeros(len(points)), -fall - above * (1.0 - math.cos(tilt))])
    return "\n".join(
        f"{before + 1 + node}, {axis + 1}, {axis + 1}, {u[node, axis]:.12g}"
        for node in range(len(u))
        for axis in range(3)
    )


def _top(block: Block) -> list[tuple[int, int]]:
    """Cells and their faces at the soil's top that the pipe may touch."""
    high = block.points[:, 2].max()
    near = (block.points[:, 2] > high - 1e-9) & (np.abs(block.points[:, 1]) < 0.5 * DIAMETER)
    touched = near[block.cells[:, np.array(FACES)]].all(axis=2)
    return [(int(cell), int(face)) for cell, face in np.argwhere(touched)]


def _numbered(rows: Array | IntArray, first: int) -> str:
    return "\n".join(", ".join([str(first + n), *(f"{x:.12g}" for x in row)]) for n, row in enumerate(rows))


def run(block: Block, stiffness: float, element: str, folder: Path) -> Pressed:
    """One run by ccx on one core; its seconds are those beyond reading and checking the deck."""
    for name, analysis in (("checked", "*NO ANALYSIS"), ("pressed", STATIC)):
        (folder / f"{name}.inp").write_text(deck(block, stiffness, element, analysis), encoding="utf-8")
    checked, pressed = _timed(folder, "checked"), _timed(folder, "pressed")
    return read(folder / "pressed", pressed - checked)


def _timed(folder: Path, name: str) -> float:
    """Processor seconds of ccx."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with (folder / f"{name}.log").open("w", encoding="utf-8") as log:
        subprocess.run(["ccx", name], cwd=folder, check=False, stdout=log, env=os.environ | {"OMP_NUM_THREADS": "1"})
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def read(root: Path, seconds: float) -> Pressed:
    """A run's forces from its .dat, its iterations from its .sta.

    The .dat holds a line with the load factor and one of three sums for each increment, without those that were cut.
    The .sta tells step, increment, attempt, iterations, ..., of each attempt, cut ones too.
    """
    lines = root.with_suffix(".dat").read_text(encoding="utf-8").splitlines()
    factor = [0.0, *(float(line.split()[-1]) for line in lines if line.strip().startswith("total force"))]
    force = [0.0, *(-float(line.split()[2]) for line in lines if len(line.split()) == 3)]
    attempts = root.with_suffix(".sta").read_text(encoding="utf-8").splitlines()
    iterations = sum(int(line.split()[3]) for line in attempts if line.split()[:1] == ["1"])
    steps = np.arange(1, STEPS + 1) / STEPS
    return Pressed(np.interp(steps - 1e-6, factor, force, right=np.nan), iterations, seconds)
