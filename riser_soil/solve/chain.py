"""Newton's method for a riser alone on one rank, whose matrix is a band: a chain. It needs no PETSc."""

from __future__ import annotations

from riser_soil.core.arrays import Array
from riser_soil.core.banded import SingularError
from riser_soil.core.system import System
from riser_soil.solve.bordered_band import BorderedBand
from riser_soil.solve.convergence import ITERATING, NOT_SOLVED
from riser_soil.solve.newton_loop import Balance, Loop, iterate


class ChainLoop(Loop):
    """Newton's iteration with banded factors."""

    def __init__(self, system: System, max_iterations: int, balance: Balance) -> None:
        self._system, self.max_iterations, self._balance = system, max_iterations, balance
        self.renew()

    def iterate(self, x: Array) -> str:
        self._x = x
        return iterate(self)

    def judge(self) -> str:
        self._f = self._balance.residual(self._x)
        return self._balance.judge(self._x, self._f)

    def improve(self) -> str:
        self._balance.tangent(self._x)
        failure, response = self.respond(self._f)
        if failure:
            return failure
        self._x = self._x - self._balance.shortened(self._x, response)
        return ITERATING

    def respond(self, f: Array) -> tuple[str, Array]:
        try:
            return "", self._factors.solve(f)
        except SingularError:
            return NOT_SOLVED, f

    def renew(self) -> None:
        self._factors = BorderedBand(self._system.matrix, self._system.numbering.free)
