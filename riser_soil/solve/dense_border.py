"""What couples lines and bodies beside their bands in the line solver: a dense border of further unknowns.

Each line has a band, which is factorised on its own; all share the border, see `core.bordered`. The soil's reached dofs
come first among the border's unknowns, see `soil_border`, then copies of the dofs at joints, see `joint_border`; these
write the border's matrices.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from riser_soil.core import bordered, dense
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.bound import Bound, Packed
from riser_soil.core.compiled import njit
from riser_soil.core.dense import PIVOT
from riser_soil.riser.part_kernels import Border
from riser_soil.solve.line_system import Coupling
from riser_soil.solve.packed_line import PackedLine
from riser_soil.solve.step_kernels import NONE, SINGULAR, Dofs, MatrixWorkspace


class Factors(NamedTuple):
    """Workspace for the factors: the Schur complement (nb, nb) and its pivots; rows (n,) of the line that are coupled,
    as many as `filled` (1,) says.
    """

    schur: Array
    pivots: IntArray
    rows: IntArray
    filled: IntArray


@njit
def begin_schur(border: Border, factors: Factors) -> None:
    """Write the border's own matrix."""
    for i in range(border.corner.shape[0]):
        for j in range(border.corner.shape[1]):
            factors.schur[i, j] = border.corner[i, j]


@njit
def eliminate(
    workspace: MatrixWorkspace, dofs: Dofs, border: Border, factors: Factors, failure: IntArray
) -> None:
    """Condense a line, whose band is factorised, onto the border."""
    if failure[0] != NONE:
        return
    fixed, count, ndof = dofs.fixed, 0, dofs.fixed.shape[1]
    for n in range(fixed.shape[0]):
        for i in range(ndof):
            if border.coupled[n] and not fixed[n, i]:
                factors.rows[count] = n * ndof + i
                count += 1
    factors.filled[0] = count
    if count > 0:
        ab, pivots, band = workspace.ab, workspace.pivots, workspace.band
        bordered.condense(ab, pivots, band, factors.rows[:count], border.right, border.below, factors.schur)


@njit
def factorise_schur(factors: Factors, failure: IntArray) -> None:
    """Factorise what is left of the border."""
    if failure[0] == NONE and not dense.factorise(factors.schur, factors.pivots):
        failure[0] = SINGULAR


@njit
def load_border(workspace: MatrixWorkspace, dofs: Dofs, border: Border, factors: Factors) -> None:
    """Forward elimination: condense a line's residual onto that of the border."""
    rows = factors.rows[: factors.filled[0]]
    if rows.size > 0:
        load = dofs.residual.reshape(dofs.residual.size)
        ab, pivots, band = workspace.ab, workspace.pivots, workspace.band
        bordered.forward_eliminate(ab, pivots, band, rows, border.below, load, border.residual)


@njit
def improve_border(border: Border, factors: Factors) -> None:
    """Take what the factorised tangent answers, which is left in place of the residual, off the border's increments."""
    answer = border.residual
    dense.solve(factors.schur, factors.pivots, answer)
    for j in range(answer.size):
        border.u[j] -= answer[j]


@njit
def take_from_line(dofs: Dofs, border: Border, factors: Factors) -> None:
    """Back substitution: take what the border's answer does off a line's residual."""
    rows, load = factors.rows[: factors.filled[0]], dofs.residual.reshape(dofs.residual.size)
    bordered.back_substitute(rows, border.right, border.residual, load)


class DenseBorder(Coupling):
    """The border of lines and bodies, and its elimination. It stands behind those who write to it.

    of: the `Border` of each line, packed.
    """

    def __init__(self, lines: Sequence[PackedLine]) -> None:
        self._soil = self._copies = 0
        made = list(zip(lines, self._made(lines), strict=True))
        self.of = {line: Packed(border) for line, (border, _) in made}
        self._factors = {line: Packed(factors) for line, (_, factors) in made}

    def make_room(self, *, soil: int | None = None, copies: int | None = None) -> None:
        """For so many unknowns, as many as before where nothing is said; what was written is lost."""
        self._soil = self._soil if soil is None else soil
        self._copies = self._copies if copies is None else copies
        for line, (border, factors) in zip(self.of, self._made([*self.of]), strict=True):
            self.of[line].renew(border)
            self._factors[line].renew(factors)

    def _made(self, lines: Sequence[PackedLine]) -> list[tuple[Border, Factors]]:
        """Border and factors of each line, all zero, with what is the border's own shared by all."""
        nb = self._soil + self._copies
        own, factors = (np.zeros(nb), np.zeros(nb), np.zeros((nb, nb))), (np.zeros((nb, nb)), np.zeros(nb, PIVOT))
        made = []
        for packed in lines:
            n, nodes = packed.line.size, packed.line.nodes
            coupling = np.zeros((n, nb)), np.zeros((n, nb)), np.zeros(nodes, dtype=np.bool_)
            made.append((Border(*own, *coupling), Factors(*factors, np.zeros(n, np.int64), np.zeros(1, np.int64))))
        return made

    def factorise(self, failure: Packed) -> list[Bound]:
        first, *_ = zip(self.of.values(), self._factors.values(), strict=True)
        return [
            Bound(begin_schur, *first),
            *(Bound(eliminate, line.packed_workspace, *self._given(line), failure) for line in self.of),
            Bound(factorise_schur, first[1], failure),
        ]

    def couple(self) -> list[Bound]:
        first, *_ = zip(self.of.values(), self._factors.values(), strict=True)
        return [
            *(Bound(load_border, line.packed_workspace, *self._given(line)) for line in self.of),
            Bound(improve_border, *first),
            *(Bound(take_from_line, *self._given(line)) for line in self.of),
        ]

    def _given(self, line: PackedLine) -> tuple[Packed, Packed, Packed]:
        return line.packed_dofs, self.of[line], self._factors[line]


MakeBorder = Callable[[DenseBorder, Sequence[PackedLine]], Coupling]
