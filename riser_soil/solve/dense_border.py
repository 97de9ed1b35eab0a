"""What couples lines and bodies beside their bands in the line solver: a dense border.

Each line has a band, which is factorised on its own; all share the border, see `core.bordered`. Its first unknowns are
the soil's reached dofs, see `soil_border`. Behind them are dofs of the lines that joints couple, see `joint_border`:
their rows and columns are moved out of the bands, which have ones on the diagonal there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from riser_soil.core import bordered, dense
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.bound import Bound, Packed
from riser_soil.core.compiled import njit
from riser_soil.core.dense import PIVOT
from riser_soil.riser.part_kernels import Border
from riser_soil.solve.packed_line import PackedLine
from riser_soil.solve.step_kernels import NONE, SINGULAR, Dofs, MatrixWorkspace

IN_BAND = -1  # in place of an unknown of the border: of dofs that stay in their line's band


class Factors(NamedTuple):
    """Workspace for the factors: the Schur complement (nb, nb) and its pivots; of a line, its dofs `moved` (nm,) to the
    border and the border's unknown that each dof is, `place` (n,), or IN_BAND; rows (n,) of the band that are coupled
    with the border, as many as `filled` (1,) says.
    """

    schur: Array
    pivots: IntArray
    moved: IntArray
    place: IntArray
    rows: IntArray
    filled: IntArray


@njit
def clear_moved(border: Border) -> None:
    """Write zeros to the tangent's entries in rows and columns of moved dofs."""
    first, size, ndof = border.u.size, border.residual.size, border.right.shape[0] // border.coupled.size
    for i in range(first, size):
        for j in range(size):
            border.corner[i, j] = border.corner[j, i] = 0.0
    for n in range(border.coupled.size):
        if border.coupled[n]:
            for i in range(n * ndof, (n + 1) * ndof):
                for j in range(first, size):
                    border.right[i, j] = border.below[i, j] = 0.0


@njit
def move_rows(workspace: MatrixWorkspace, border: Border, factors: Factors) -> None:
    """Move rows and columns of a line's tangent to the border: those in its band, and what couples them with soil."""
    ab, b, place, n = workspace.ab, len(workspace.band), factors.place, factors.place.size
    ndof = n // border.coupled.size
    for k in factors.moved:
        own = place[k]
        for i in range(max(0, k - b), min(n, k + b + 1)):
            row, column = ab[k, b + i - k], ab[i, b + k - i]
            if place[i] != IN_BAND:
                border.corner[own, place[i]] += row
            elif row != 0.0 or column != 0.0:
                border.right[i, own] += column
                border.below[i, own] += row
                border.coupled[i // ndof] = True
        for j in range(border.u.size):
            border.corner[own, j] += border.right[k, j]
            border.corner[j, own] += border.below[k, j]
    for k in factors.moved:
        for i in range(max(0, k - b), min(n, k + b + 1)):
            ab[k, b + i - k] = ab[i, b + k - i] = 0.0
        ab[k, b] = 1.0


@njit
def begin_schur(border: Border, factors: Factors) -> None:
    """Write the border's own matrix."""
    for i in range(border.corner.shape[0]):
        for j in range(border.corner.shape[1]):
            factors.schur[i, j] = border.corner[i, j]


@njit
def condense(
    workspace: MatrixWorkspace, dofs: Dofs, border: Border, factors: Factors, failure: IntArray
) -> None:
    """Condense a line, whose band is factorised, onto the border."""
    if failure[0] != NONE:
        return
    fixed, count, ndof = dofs.fixed, 0, dofs.fixed.shape[1]
    for n in range(fixed.shape[0]):
        for i in range(ndof):
            if border.coupled[n] and not fixed[n, i] and factors.place[n * ndof + i] == IN_BAND:
                factors.rows[count] = n * ndof + i
                count += 1
    factors.filled[0] = count
    if count > 0:
        ab, pivots, band = workspace.ab, workspace.pivots, workspace.band
        bordered.condense(ab, pivots, band, factors.rows[:count], border.right, border.below, factors.schur)


@njit
def factorise_schur(factors: Factors, failure: IntArray) -> None:
    """Factorise the Schur complement."""
    if failure[0] == NONE and not dense.factorise(factors.schur, factors.pivots):
        failure[0] = SINGULAR


@njit
def load_moved(dofs: Dofs, border: Border, factors: Factors) -> None:
    """Write the residual of a line's moved dofs to that of the border."""
    residual = dofs.residual.reshape(dofs.residual.size)
    for k in factors.moved:
        border.residual[factors.place[k]] = residual[k]


@njit
def forward_eliminate(workspace: MatrixWorkspace, dofs: Dofs, border: Border, factors: Factors) -> None:
    """Condense a line's residual onto that of the border."""
    rows = factors.rows[: factors.filled[0]]
    if rows.size > 0:
        load = dofs.residual.reshape(dofs.residual.size)
        ab, pivots, band = workspace.ab, workspace.pivots, workspace.band
        bordered.forward_eliminate(ab, pivots, band, rows, border.below, load, border.residual)


@njit
def solve_border(border: Border, factors: Factors) -> None:
    """Solve the Schur complement for the border's residual, in place, and subtract the solution from the soil's
    increments.
    """
    dense.solve(factors.schur, factors.pivots, border.residual)
    for j in range(border.u.size):
        border.u[j] -= border.residual[j]


@njit
def back_substitute(dofs: Dofs, border: Border, factors: Factors) -> None:
    """Subtract coupling times the border's solution from a line's residual; put the solution of moved dofs there."""
    rows, load = factors.rows[: factors.filled[0]], dofs.residual.reshape(dofs.residual.size)
    bordered.back_substitute(rows, border.right, border.residual, load)
    for k in factors.moved:
        load[k] = border.residual[factors.place[k]]


class DenseBorder:
    """The border of lines and bodies, and its elimination. Methods return kernels for the phases of an iteration.

    of: the `Border` of each line, packed.
    """

    def __init__(self, lines: Sequence[PackedLine]) -> None:
        self._soil = 0
        self._places = {line: np.full(line.line.size, IN_BAND) for line in lines}
        made = list(zip(lines, self._made(), strict=True))
        self.of = {line: Packed(border) for line, (border, _) in made}
        self._factors = {line: Packed(factors) for line, (_, factors) in made}

    def make_room(self, soil: int) -> None:
        """For so many dofs of soil; what was written is lost."""
        self._soil = soil
        self._renew()

    def move(self, places: Mapping[PackedLine, IntArray]) -> None:
        """Move dofs of lines to the border: number (n,) of each of a line's dofs among them, IN_BAND of the others."""
        self._places |= places
        self._renew()

    def _renew(self) -> None:
        for line, (border, factors) in zip(self.of, self._made(), strict=True):
            self.of[line].renew(border)
            self._factors[line].renew(factors)

    def _made(self) -> list[tuple[Border, Factors]]:
        """Border and factors of each line, all zero, with what is the border's own shared by all."""
        moved = {line: np.flatnonzero(place != IN_BAND) for line, place in self._places.items()}
        nb = self._soil + sum(map(len, moved.values()))
        own = np.zeros(self._soil), np.zeros(nb), np.zeros((nb, nb))
        schur, made = (np.zeros((nb, nb)), np.zeros(nb, PIVOT)), []
        for line, place in self._places.items():
            n, nodes = line.line.size, line.line.nodes
            coupling = np.zeros((n, nb)), np.zeros((n, nb)), np.zeros(nodes, dtype=np.bool_)
            rows = np.zeros(n, np.int64), np.zeros(1, np.int64)
            of_line = moved[line], np.where(place == IN_BAND, IN_BAND, self._soil + place)
            made.append((Border(*own, *coupling), Factors(*schur, *of_line, *rows)))
        return made

    def move_rows(self) -> list[Bound]:
        """Kernels that move what the bands have of moved dofs to the border."""
        return [Bound(move_rows, line.packed_workspace, self.of[line], self._factors[line]) for line in self.of]

    def factorise(self, failure: Packed) -> list[Bound]:
        """Kernels that factorise the Schur complement of the bands, which are factorised."""
        first, *_ = zip(self.of.values(), self._factors.values(), strict=True)
        return [
            Bound(begin_schur, *first),
            *(Bound(condense, line.packed_workspace, *self._of(line), failure) for line in self.of),
            Bound(factorise_schur, first[1], failure),
        ]

    def solve(self) -> list[Bound]:
        """Kernels that solve for the border's increments, and take what they move off the lines' residuals."""
        first, *_ = zip(self.of.values(), self._factors.values(), strict=True)
        return [
            *(Bound(load_moved, *self._of(line)) for line in self.of),
            *(Bound(forward_eliminate, line.packed_workspace, *self._of(line)) for line in self.of),
            Bound(solve_border, *first),
            *(Bound(back_substitute, *self._of(line)) for line in self.of),
        ]

    def _of(self, line: PackedLine) -> tuple[Packed, Packed, Packed]:
        """A line's dofs, border and factors."""
        return line.packed_dofs, self.of[line], self._factors[line]
