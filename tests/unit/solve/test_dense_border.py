"""The border of lines' bands, of soil's dofs and of dofs that are moved out of the bands, against a dense solve."""

from __future__ import annotations

from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np

from riser_soil.core import banded
from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.bound import Packed, in_turn
from riser_soil.solve.dense_border import IN_BAND, DenseBorder
from riser_soil.solve.step_kernels import NONE, Dofs, matrix_workspace

NODES, NDOF, SOIL = (5, 1, 4), 6, 7  # two lines with a body between them
MOVED = {0: [24, 25, 27, 28], 1: [0, 1, 2, 3, 4, 5], 2: [6, 9]}  # dofs of each; neighbours and others
FIXED = {0: [0, 1, 2, 26], 1: [], 2: [23]}
ON_SOIL = {0: [18, 24, 25, 26], 1: [], 2: [6, 7, 12]}  # some of them moved, one fixed


class Line:
    """What the border knows of a line or body."""

    def __init__(self, nodes: int, fixed: list[int]) -> None:
        self.line = SimpleNamespace(nodes=nodes, size=nodes * NDOF)
        self.workspace = matrix_workspace(nodes, NDOF)
        self.dofs = Dofs(np.zeros((nodes, NDOF), dtype=bool), np.ones((nodes, NDOF)), *np.zeros((3, nodes, NDOF)))
        self.dofs.fixed.ravel()[fixed] = True
        self.packed_workspace, self.packed_dofs = Packed(self.workspace), Packed(self.dofs)


def whole_matrix(starts: IntArray, moved: BoolArray) -> Array:
    """Random: entries in the bands, between a moved dof and any other line, and of soil with what touches it."""
    n = int(starts[-1]) + SOIL
    out, (i, j) = np.random.default_rng(5).normal(size=(n, n)), np.indices((n, n))
    line = np.searchsorted(starts, np.arange(n), side="right")
    beyond = np.array([2 * NDOF if nodes > 1 else NDOF for nodes in NODES])[np.minimum(line, len(NODES)) - 1]
    within = (line[i] == line[j]) & ((np.abs(i - j) < beyond[i]) | (i >= starts[-1]))
    touching = np.zeros(n, dtype=bool)
    for start, dofs in zip(starts, ON_SOIL.values(), strict=False):
        touching[start + np.array(dofs, dtype=int)] = True
    between = (line[i] != line[j]) & (moved[i] | moved[j]) & (i < starts[-1]) & (j < starts[-1])
    on_soil = (touching[i] & (j >= starts[-1])) | (touching[j] & (i >= starts[-1]))
    return np.where(within | between | on_soil, out, 0.0)


def test_bands_with_moved_dofs_and_soil_are_solved_as_the_whole_matrix() -> None:
    lines: Any = [Line(nodes, fixed) for nodes, fixed in zip(NODES, FIXED.values(), strict=True)]
    starts = np.cumsum([0, *(line.line.size for line in lines)])
    number, soil = np.full(starts[-1], IN_BAND), np.arange(starts[-1], starts[-1] + SOIL)
    moved = np.concatenate([start + np.array(dofs) for start, dofs in zip(starts, MOVED.values(), strict=False)])
    number[moved] = np.arange(len(moved))
    fixed = np.pad(np.concatenate([line.dofs.fixed.ravel() for line in lines]), (0, SOIL))
    A = whole_matrix(starts, np.isin(np.arange(len(fixed)), moved))
    load = np.random.default_rng(6).normal(size=len(A))
    A[fixed] = A[:, fixed] = load[fixed] = 0.0
    A[fixed, fixed] = 1.0

    border = DenseBorder(lines)
    ranges = list(zip(lines, pairwise(starts), strict=True))
    border.move({line: number[a:b] for line, (a, b) in ranges})
    border.make_room(SOIL)
    for line, (a, b) in ranges:
        own, at, band = border.of[line].value, np.arange(a, b), len(line.workspace.band)
        for i in range(line.line.size):
            for j in range(max(0, i - band), min(line.line.size, i + band + 1)):
                line.workspace.ab[i, band + j - i] = A[a + i, a + j]
        own.right[:, :SOIL], own.below[:, :SOIL] = A[np.ix_(at, soil)], A[np.ix_(soil, at)].T
        others = moved[(moved < a) | (moved >= b)]
        for i, row in zip(at, number[a:b], strict=True):
            if row == IN_BAND:
                own.right[i - a, SOIL + number[others]] = A[i, others]
                own.below[i - a, SOIL + number[others]] = A[others, i]
            else:
                own.corner[SOIL + row, SOIL + number[others]] = A[i, others]
        own.corner[:SOIL, :SOIL], own.coupled[:], own.residual[:SOIL] = A[np.ix_(soil, soil)], True, load[soil]
        line.dofs.residual[...] = load[a:b].reshape(-1, NDOF)

    failure = np.zeros(1, dtype=np.int64)
    in_turn(*border.move_rows())()
    for line in lines:
        assert banded.factorise(line.workspace.ab, line.workspace.pivots, line.workspace.band)
    in_turn(*border.factorise(Packed(failure)), *border.solve())()
    assert failure[0] == NONE
    solution = -np.concatenate([np.zeros(starts[-1]), border.of[lines[0]].value.u])
    for line, (a, b) in ranges:
        solution[a:b] = line.dofs.residual.ravel()
        banded.solve(line.workspace.ab, line.workspace.pivots, solution[a:b], line.workspace.band)
    expected = np.linalg.solve(A, load)
    assert np.abs(solution - expected).max() < 1e-9 * np.abs(expected).max()
