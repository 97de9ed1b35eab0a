"""The pipe on clay for CalculiX: what its deck says, and how its results are read."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from benchmarks.peers.calculix import ARC, FACES, Block, deck, pipe, read
from benchmarks.peers.clay import Run
from benchmarks.peers.clay_case import BLOCK, DEPTHS, DIAMETER, HALF_LENGTH, MESHES, STEPS
from riser_soil.core.arrays import Array, IntArray

DAT = """
 total force (fx,fy,fz) for set PIPE and time  0.8333333E-01

        5.421011E-19  6.629196E-15 -1.200000E+01

 total force (fx,fy,fz) for set PIPE and time  {last}

        5.977155E-01  2.139674E-14 -3.000000E+01
"""
STA = """SUMMARY OF JOB INFORMATION
  STEP      INC     ATT  ITRS     TOT TIME     STEP TIME      INC TIME
     1          1     1     6  0.833333E-01  0.833333E-01  0.833333E-01
     1          2     1U    7  0.833333E-01  0.833333E-01  0.833333E-01
     1          2     2     4  0.104167E+00  0.104167E+00  0.208333E-01
"""


@pytest.fixture(scope="module")
def block() -> Block:
    return Run(MESHES["coarse"]).block


def _rows(text: str, card: str) -> list[list[str]]:
    """What stands under a card, up to the next one."""
    lines = text[text.index(card) :].splitlines()[1:]
    end = next(n for n, line in enumerate(lines) if line.startswith("*"))
    return [line.split(", ") for line in lines[:end]]


def _volumes(points: Array, cells: IntArray) -> Array:
    a, b, _, d, e = (points[cells[:, corner]] for corner in range(5))
    return np.asarray(np.einsum("ci,ci->c", np.cross(b - a, d - a), e - a))


def test_hexahedra_are_the_right_way_round_and_fill_the_block(block: Block) -> None:
    volume = _volumes(block.points, block.cells)
    assert (volume > 0.0).all()
    assert volume.sum() == pytest.approx(np.ptp(BLOCK["x"]) * np.ptp(BLOCK["y"]) * BLOCK["depth"])
    points, cells = pipe()
    assert (_volumes(points.reshape(-1, 3), cells) > 0.0).all()


def test_the_deck_presses_the_pipes_underside_on_the_blocks_top(block: Block) -> None:
    text = deck(block, 2.0e9, "C3D8I")
    for cell, face in _rows(text, "*SURFACE, NAME=TOP"):
        nodes = block.cells[int(cell) - 1, FACES[int(face.removeprefix("S")) - 1]]
        assert block.points[nodes, 2] == pytest.approx(0.0, abs=1e-12)
    points, cells = (each.reshape(-1, each.shape[-1]) for each in pipe())
    outer = points[cells[:, FACES[0]]]
    assert np.hypot(outer[..., 1], outer[..., 2] - 0.5 * DIAMETER) == pytest.approx(0.5 * DIAMETER)
    assert len(_rows(text, "*SURFACE, NAME=UNDERSIDE")) == 2 * ARC
    assert len(_rows(text, "*BOUNDARY")) == block.held.sum()
    assert max(len(number) for row in _rows(text, "*NODE, NSET=SOIL") for number in row) <= 20  # else ccx refuses it


def test_the_pipe_moves_as_a_rigid_body_by_the_depths_of_its_ends(block: Block) -> None:
    text = deck(block, 2.0e9, "C3D8I")
    points = np.array([[float(x) for x in row[1:]] for row in _rows(text, "*NODE, NSET=PIPE")])
    moved = np.array([float(row[3]) for row in _rows(text[text.index("*STEP") :], "*BOUNDARY")]).reshape(-1, 3)
    before, after = (np.linalg.norm(each[:, None] - each, axis=2) for each in (points, points + moved))
    stretch = np.hypot(2.0 * HALF_LENGTH, DEPTHS[0] - DEPTHS[1]) - 2.0 * HALF_LENGTH  # ends go straight down
    assert np.abs(after - before).max() <= stretch * (1.0 + 1e-6)
    low = np.abs(points[:, 1]) + np.abs(points[:, 2]) < 1e-9
    assert moved[low, 2] == pytest.approx(-np.array(DEPTHS), rel=2e-3)


def test_results_are_read_cut_attempts_count_and_what_was_not_reached_is_nan(tmp_path: Path) -> None:
    (tmp_path / "run.sta").write_text(STA, encoding="utf-8")
    for last, reached in (("0.1041667E+00", 1), ("0.1000000E+01", STEPS)):
        (tmp_path / "run.dat").write_text(DAT.format(last=last), encoding="utf-8")
        pressed = read(tmp_path / "run", 3.0)
        assert pressed.iterations == 17
        assert pressed.force[0] == pytest.approx(12.0, rel=1e-4)
        assert np.isfinite(pressed.force).sum() == reached
    assert pressed.force[-1] == pytest.approx(30.0, rel=1e-4)
