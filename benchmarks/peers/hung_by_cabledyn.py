"""Moorings with bodies by CableDyn, in its own environment, at rest: beside bodies it moves no end from a file, and it
hangs no line that bends on a free point.
"""

from __future__ import annotations

import subprocess
import tempfile
from pathlib import Path

import numpy as np
from cabledyn import CableDynDriver

from benchmarks.peers.hung_decks import CASES, Hung
from riser_soil.core.arrays import Array

DECK = """---
CableDyn
--------------------- LINE TYPES ---------------------
TypeName Diam MassDenInAir EA BA EI Cd_n Cd_t Ca_n Ca_t
(-) (m) (kg/m) (N) (-) (N-m2) (-) (-) (-) (-)
{types}
--------------------- BODIES ---------------------
ID Attachment X0 Y0 Z0 r0 p0 y0 Mass CG I Volume CdA Ca
(-) (-) (m) (m) (m) (deg) (deg) (deg) (kg) (m) (kg-m2) (m3) (m2) (-)
{bodies}
--------------------- POINTS ---------------------
ID Type X Y Z Mass Vol CdA Ca
(-) (-) (m) (m) (m) (kg) (m3) (m2) (-)
{points}
--------------------- LINES ---------------------
ID NodeA NodeB Outputs
(-) (-) (-) (-)
{lines}
--------------------- SECTIONS ---------------------
LineID LineType Length NumSegs
(-) (-) (m) (-)
{sections}
--------------------- OPTIONS ---------------------
9.81 g
1025.0 rhoW
{depth} WtrDpth
1.0e5 kBot
0.0 cBot
0.05 dtM
0.05 TMax
--------------------- OUTPUTS ---------------------
{outputs}
--------------------- need this line ---------------------
"""


def _deck(case: Hung, parts: int) -> str:
    """Deck of a case without free points; drag and added mass of the body do nothing at rest, and are alike in all
    axes.
    """
    types = (" ".join([*row[:4], "0.0", row[5], row[6], row[8], row[7], row[9]]) for row in _rows(case.types))
    lines = [row[:6] for row in _rows(case.lines.format(parts, 2 * parts))]
    return DECK.format(
        types="\n".join(types),
        bodies=" ".join([*case.bodies.split()[:12], "0.0", "0.0"]),
        points=case.points.replace("Coupled", "Fixed"),
        lines="\n".join(f"{n} {a} {b} -" for n, _, a, b, *_ in lines),
        sections="\n".join(f"{n} {kind} {length} {count}" for n, kind, _, _, length, count in lines),
        depth=case.depth,
        outputs="\n".join(f'"{end}{n}"' for n, *_ in lines for end in ("FairTen", "AnchTen")),
    )


def _rows(text: str) -> list[list[str]]:
    return [line.split() for line in text.splitlines()]


def at_rest(name: str, parts: int) -> Array:
    """Tensions (3, 2) at the lines' ends, the smaller one first [N]; it calls the end at a body the fairlead."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "deck.dat").write_text(_deck(CASES[name], parts), encoding="utf-8")
        command = [str(CableDynDriver().executable), "deck.dat", "out"]
        subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)
        rows = np.loadtxt(Path(folder) / "out.out", skiprows=2)
    return np.sort(rows[0, 1:7].reshape(3, 2))


def save(name: str, parts: int, to: str) -> None:
    """Save the results to a file of numpy's."""
    np.save(to, at_rest(name, parts))
