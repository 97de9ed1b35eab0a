"""Laws of one shear stress, to be compared: a fading backstress, and two surfaces after Dafalias & Popov.

Y. F. Dafalias, E. P. Popov, A model of nonlinearly hardening materials for complex loading, Acta Mech. 21 (1975): the
plastic modulus is h δ/(δ_in - δ), δ being the distance to a bounding surface, here fixed at the strength, and δ_in that
where yielding began. Stresses over su; strains over su/G.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

SHARE, STEP = 0.1, 1e-2  # elastic share of su; strain of a step, over su/G
Modulus = Callable[[float, float], float]
"""By the distance to the bound and that at which yielding began: plastic modulus over G."""


class YieldRange:
    """A range of 2 SHARE about a backstress, which moves by a plastic modulus."""

    def __init__(self, modulus: Modulus) -> None:
        self._modulus, self.stress = modulus, 0.0
        self._back, self._way, self._began = 0.0, 0.0, 0.0

    def strain(self, by: float) -> float:
        """The stress after a strain."""
        steps = max(1, round(abs(by) / STEP))
        for _ in range(steps):
            self._step(by / steps)
        return self.stress

    def _step(self, by: float) -> None:
        trial = self.stress + by
        beyond = abs(trial - self._back) - SHARE
        if beyond <= 0.0:
            self.stress, self._way = trial, 0.0
            return
        way = float(np.sign(trial - self._back))
        distance = max(1.0 - way * self.stress, 1e-12)
        if way != self._way:
            self._way, self._began = way, distance + 1e-9
        modulus = self._modulus(distance, self._began)
        self._back += way * modulus * beyond / (1.0 + modulus)
        self.stress = self._back + way * SHARE


def two_surfaces(h: float) -> YieldRange:
    return YieldRange(lambda distance, began: h * distance / max(began - distance, 1e-12))


def fading_backstress(h: float) -> YieldRange:
    """Armstrong & Frederick's: the modulus falls with the distance itself."""
    return YieldRange(lambda distance, began: h * distance / (1.0 - SHARE))


def lost_a_cycle(law: YieldRange, mean_strain: float, amplitude: float, cycles: int = 14) -> float:
    """Share of the mean stress that a cycle of strain takes, down by twice the amplitude from what is held."""
    law.strain(mean_strain)
    turns = [(law.strain(-2.0 * amplitude), law.strain(2.0 * amplitude)) for _ in range(cycles)]
    first, last = (sum(turns[n]) for n in (0, -1))
    return float(1.0 - (last / first) ** (1.0 / (cycles - 1)))


def added_by_the_last_cycle(law: YieldRange, low: float, high: float, cycles: int = 14) -> float:
    """Strain that the last of some cycles of stress adds."""
    tops, strain = [], 0.0
    for _ in range(cycles + 1):
        for level, way in ((high, 1.0), (low, -1.0)):
            while way * (level - law.stress) > 0.0:
                law.strain(way * STEP)
                strain += way * STEP
            if way > 0.0:
                tops.append(strain)
    return tops[-1] - tops[-2]
