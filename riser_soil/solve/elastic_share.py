"""A share of the elastic tangent, by which Newton's method takes steps of bounded length where soil flows.

Where soil flows its tangent all but vanishes, and increments are of any length, metres or kilometres. After such an
iteration, in which the residual has grown or the line search allowed only a short step, the tangent gets a share of the
elastic one, ten times as much each time, which bounds the increments as the damping of Levenberg and Marquardt does. As
the residual falls that share is reduced, so that Newton's method ends with its own tangent. Where the residual crawls
under the elastic tangent alone, the step is given up: hundreds of iterations would not do.
"""

from __future__ import annotations

from collections.abc import Sequence

from riser_soil.core.roles import Yielding

FIRST_SHARE, MORE = 1e-4, 10.0  # of the elastic tangent, and how much more or less of it the next iteration has
SHORT, FALLEN = 0.3, 0.7  # part of a step that is short; share to which the residual falls as it converges
CRAWLS, IN_A_ROW = 0.9, 4  # share to which it falls where that is in vain; so many times


class ElasticShare:
    """The share of the elastic tangent in that of parts that yield; see the module's text.

    length: part of the last step that the line search allowed; stagnant: consecutive iterations with the whole elastic
    tangent that reduced the residual by less than a tenth.
    """

    def __init__(self, parts: Sequence[Yielding]) -> None:
        self._parts, self._share, self.length, self.stagnant = parts, 0.0, 1.0, 0

    def reset(self) -> None:
        """None, as where a step begins."""
        self.length, self.stagnant = 1.0, 0
        self._set(0.0)

    def adapt(self, norm: float, before: float) -> None:
        """For the tangent after an iteration, by the norms of the residual then and before."""
        if not self._parts:
            return
        self.stagnant = self.stagnant + 1 if self._share == 1.0 and CRAWLS * before < norm <= before else 0
        if self.length < SHORT or norm > before:
            self._set(min(1.0, max(MORE * self._share, FIRST_SHARE)))
        elif norm < FALLEN * before:
            self._set(self._share / MORE if self._share > FIRST_SHARE else 0.0)

    @property
    def in_vain(self) -> bool:
        """Whether the residual stagnates under the whole elastic tangent, so that more iterations are in vain."""
        return self.stagnant >= IN_A_ROW

    def _set(self, share: float) -> None:
        if share != self._share:
            self._share = share
            for part in self._parts:
                part.mix_elastic(share)
