"""Modified Cam clay, undrained by the stiffness of its pore water: a law of one's own for riser_soil.

Yield: (q/M)² + p (p - pc) = 0, p the mean effective stress plus `attraction`, both positive in compression. Elastic:
dp = p (1 + e0)/kappa dεv, and a shear modulus in proportion to p at first. Plastic: associated flow, and
dpc = pc (1 + e0)/(lam - kappa) dεvp. Backward Euler: Borja & Lee, Comput. Methods Appl. Mech. Eng. 78, 1990.
"""

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.soil import mandel
from riser_soil.soil.law import PLASTIC_STRAIN, STRESS


class CamClay:
    columns = (*STRESS, "pressure", "preconsolidation", "pore_pressure", PLASTIC_STRAIN)
    symmetric = False  # of the tangent
    by_rate = False

    def __init__(
        self, initial: Array, M: float, lam: float, kappa: float, e0: float, G_over_p: float, OCR: float = 1.0,
        attraction: float = 0.0, water: float = 0.0,
    ) -> None:
        self.initial, self.M, self.attraction, self.water = initial, M, attraction, water
        self.elastic, self.plastic = (1.0 + e0) / kappa, (1.0 + e0) / (lam - kappa)
        self.p0 = attraction - mandel.mean(initial)
        self.G = G_over_p * self.p0
        self.pc0 = OCR * (self.p0 + mandel.von_mises(initial) ** 2 / (M**2 * self.p0))

    def start(self) -> Array:
        none = np.zeros(len(self.p0))
        return np.column_stack((self.initial, self.p0, self.pc0, none, none))

    def update(self, increment: Array, history: Array, dt: float) -> tuple[Array, ...]:
        before, (p, pc, _, kappa) = history[:, :6], history[:, 6:].T
        squeezed = -3.0 * mandel.mean(increment)  # loss of volume
        s = mandel.deviator(before) + 2.0 * self.G[:, None] * mandel.deviator(increment)
        q = np.sqrt(1.5 * mandel.product(s, s))
        lost, multiplier, slopes = self.returned(p / pc, q / pc, 6.0 * self.G / (self.M**2 * pc), squeezed)
        share = 1.0 / (1.0 + multiplier)  # of the trial's shear stress
        pore = self.attraction - mandel.mean(before) - p + self.water * squeezed
        n = 3.0 * self.G[:, None] * s / np.where(q > 0.0, q * pc, np.inf)[:, None]  # of q/pc, by strain
        p, pc = p * np.exp(self.elastic * (squeezed - lost)), pc * np.exp(self.plastic * lost)
        stress = mandel.plus_mean(share[:, None] * s, self.attraction - p - pore)
        after = np.column_stack((stress, p, pc, pore, kappa + q * (1.0 - share) / (3.0 * self.G)))
        # derivatives of `lost` and `multiplier` by strain, by way of `squeezed` and q/pc
        lost_by, multiplier_by = (-slopes[:, i, :1] * mandel.UNIT + slopes[:, i, 1:] * n for i in (0, 1))
        K = self.elastic * p
        tangent = mandel.stiffness(K + self.water, share * self.G)
        tangent += mandel.UNIT[:, None] * (K[:, None] * lost_by)[:, None, :]
        tangent -= s[:, :, None] * (share[:, None] ** 2 * multiplier_by)[:, None, :]
        return stress, tangent, after, *self.energy(stress, p, pore)

    def returned(self, p: Array, q: Array, stiff: Array, squeezed: Array) -> tuple[Array, Array, Array]:
        """Plastic loss of volume, multiplier, and their slopes (n, 2, 2) by `squeezed` and q, of trials over pc.

        Unknowns: x the loss, y the multiplier over `stiff`, with x = y (2p - 1) and the yield surface met.
        """
        values, slopes = np.zeros((len(p), 2)), np.zeros((len(p), 2, 2))
        trial = p * np.exp(self.elastic * squeezed)
        at = np.flatnonzero((q / self.M) ** 2 + trial * (trial - 1.0) > 1e-12)
        p, q, stiff, squeezed, J = p[at], q[at], stiff[at], squeezed[at], np.empty((len(at), 2, 2))
        x, y = np.zeros((2, len(at)))
        for _ in range(50):
            now, limit = p * np.exp(self.elastic * (squeezed - x)), np.exp(self.plastic * x)
            shear, steep = (q / self.M / (1.0 + stiff * y)) ** 2, 2.0 * now - limit
            wrong = np.column_stack((x - y * steep, shear + now * (now - limit)))
            J[:, 0, 0] = 1.0 + y * (2.0 * self.elastic * now + self.plastic * limit)
            J[:, 0, 1] = -steep
            J[:, 1, 0] = -now * (self.elastic * steep + self.plastic * limit)
            J[:, 1, 1] = -2.0 * shear * stiff / (1.0 + stiff * y)
            if np.abs(wrong).max(initial=0.0) < 1e-13:
                break
            step = np.linalg.solve(J, wrong[:, :, None])[:, :, 0]
            x, y = x - step[:, 0], np.maximum(y - step[:, 1], 0.0)
        else:
            raise ArithmeticError("no convergence of the return to the yield surface")
        by = np.zeros_like(J)  # what moves the two equations by `squeezed` and q, turned about
        by[:, 0, 0], by[:, 1, 0] = 2.0 * y * self.elastic * now, -self.elastic * now * steep
        by[:, 1, 1] = -2.0 * q / (self.M * (1.0 + stiff * y)) ** 2
        values[at], slopes[at] = np.column_stack((x, stiff * y)), np.linalg.solve(J, by)
        slopes[at, 1] *= stiff[:, None]
        return values[:, 0], values[:, 1], slopes

    def energy(self, stress: Array, p: Array, pore: Array) -> tuple[Array, Array]:
        """Stored (n,) and elastic strain (n, 6) since the start."""
        volume = np.log(p / self.p0) / self.elastic
        shear = mandel.deviator(stress - self.initial) / (2.0 * self.G[:, None])
        stored = (p - self.p0) / self.elastic - self.p0 * volume + self.G * mandel.product(shear, shear)
        if self.water > 0.0:
            stored += pore**2 / (2.0 * self.water)
        return stored, mandel.plus_mean(shear, -volume / 3.0)
