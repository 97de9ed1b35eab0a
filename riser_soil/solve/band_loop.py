"""Newton's method for lines and bodies on one rank, whose matrix is a band with a border. It needs no PETSc."""

from __future__ import annotations

from riser_soil.core.arrays import Array
from riser_soil.core.banded import SingularError
from riser_soil.core.system import System
from riser_soil.solve.balance import Balance, Loop
from riser_soil.solve.bordered_band import BorderedBand, band_of
from riser_soil.solve.convergence import ITERATING, NOT_SOLVED
from riser_soil.solve.newton_loop import iterate


def band_loop(system: System, max_iterations: int, balance: Balance) -> BandLoop | None:
    """The loop of a system of lines and bodies alone; None where it has no such matrix."""
    factors = None if system.model.others else band_of(system)
    return None if factors is None else BandLoop(system, factors, max_iterations, balance)


class BandLoop(Loop):
    """Newton's iteration with banded factors."""

    def __init__(self, system: System, factors: BorderedBand, max_iterations: int, balance: Balance) -> None:
        self._system, self._factors = system, factors
        self.max_iterations, self._balance = max_iterations, balance

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
        """The lines' own pattern stays as it is, with whatever dofs are free."""
        factors = band_of(self._system)
        assert factors is not None
        self._factors = factors
