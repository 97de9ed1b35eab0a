"""Rate of shear: clay is the stronger the faster it flows.

    r = 1 + µ lg(max(1, rate/reference))

is the strength over that of slow shear, the rate that of plastic shear strain, √3 times that of the equivalent plastic
strain Δp/Δt: once the stress stays, all of the rate of shear. Its logarithm as in I. Einav & M. F. Randolph (see
`remoulding`), who take the rate of all strain; here clay at constant strain relaxes with time, and stress does not jump
where a motion stops. At rates below the reference strength is that of slow shear.

With Δp0 = reference Δt/√3, the plastic strain of a step at the reference rate, backward Euler brings an elastic trial q
back by 3G Δp to q - 3G Δp = L r. Above Δp0 and with a = L µ/ln 10, x = 3G Δp/a solves

    x + ln x = (q - L)/a + ln(3G Δp0/a):

Wright's omega function. The derivative of the stress by its trial is 1/(1 + x): the tangent stays symmetric.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from pydantic import BaseModel, Field

from riser_soil.core.lazy import LazyModule
from riser_soil.core.quantities import FROZEN, RateGain, StrainRate

if TYPE_CHECKING:
    import numpy as np
    from scipy import special

    from riser_soil.core.arrays import Array
else:
    np, special = LazyModule("numpy"), LazyModule("scipy.special")


class Rate(BaseModel):
    """Gain of strength with the rate of shear."""

    model_config = FROZEN

    mu: RateGain = Field(description="gain of strength by each tenfold rate, over su, usually 0.05 to 0.2 [-]")
    reference: StrainRate = Field(
        description="rate of plastic shear strain at which su holds, and below which it does not fall; 1 % an hour is "
        "2.8e-6, the laboratory's usual 1e-5 [1/s]"
    )

    def over(self, dt: float) -> Gain:
        """Gain of strength in a step of dt [s]."""
        return Gain(self.mu / math.log(10.0), self.reference * dt / math.sqrt(3.0)) if self.mu > 0.0 else STEADY


def gain_of(rate: Rate | None, dt: float) -> Gain:
    """Gain of strength by the rate in a step of dt [s]; STEADY without a rate."""
    return STEADY if rate is None else rate.over(dt)


class Return(NamedTuple):
    """Radial return: share of the elastic trial's deviator that stays, and slope of the stress by its trial. Both have
    the trial's shape, and are 1 where nothing yields.
    """

    shrink: Array
    slope: Array


class Gain(NamedTuple):
    """Gain of a step: strength by the factor 1 + by_e ln(max(1, Δp/slow)).

    slow: its Δp at the reference rate; inf where nothing is gained, 0 in an instant, in which nothing flows.
    """

    by_e: float
    slow: float

    @property
    def gains(self) -> bool:
        return self.slow < math.inf

    def slip(self, q: Array, limit: Array, stiff: Array) -> Array:
        """Δp of elastic trials q beyond a limit of slow shear L, with stiff = 3G [Pa]; all of one shape."""
        slip = (q - limit) / stiff
        fast = slip > self.slow
        scale = self.by_e * limit[fast] / stiff[fast]
        with np.errstate(divide="ignore"):
            slip[fast] = scale * special.wrightomega(slip[fast] / scale + np.log(self.slow / scale))
        return slip

    def radial_return(self, q: Array, limit: Array, stiff: Array) -> Return:
        """Return of elastic trials q [Pa] to a limit of slow shear [Pa], with stiff = 3G [Pa]; all of one shape."""
        shrink = limit / np.maximum(q, limit)
        slope = np.where(shrink < 1.0, 0.0, 1.0)
        fast = q - limit > stiff * self.slow
        if fast.any():
            trial, most, resistance = q[fast], limit[fast], stiff[fast]
            fall = resistance * self.slip(trial, most, resistance)
            shrink[fast], slope[fast] = 1.0 - fall / trial, self.by_e * most / (self.by_e * most + fall)
        return Return(shrink, slope)


STEADY = Gain(0.0, math.inf)
