"""Hysteretic seabed of Aubeny & Biscontin: backbone, bounding loop with suction, and reversals within.

Source: C. Aubeny & G. Biscontin, Seafloor-riser interaction model, International Journal of Geomechanics 9 (2009).
With y the penetration and (y1, P1) the deepest point so far, which lies on the backbone:

    backbone             Pb(y) = a (y/D)^b su(y) D                                                         (1)
    rebound, 1 to 2      P = P1 - d/(1/k + d/((1 + omega) P1)),  d = y1 - y,  to P2 = -phi P1              (2)
    separation, 2 to 3   P = P2/2 + P2/4 (3 t - t^3),  t from 1 at y2 to -1 at y3;  y2 - y3 = psi (y1 - y2)  (3)
    no contact           P = 0 above y3
    reloading, 3 to 1    P = P1/2 + P1/4 (3 t - t^3),  t from -1 at y3 to 1 at y1                          (4)
    turn at (yr, Pr)     P = Pr + d/(1/k + |d|/((1 + omega) P1)),  d = y - yr                              (5)

(2) and (3) are the loop's lower edge, (4) the upper one; (5) holds between them, and (1) beyond y1: from the lower
edge, (5) meets (y1, P1) and would rise above (1).

Certainty: of its make-up (backbone, bounding loop of four parameters, turns from and within the loop, partial and full
separation) the contents of the report that it grew from (C. Aubeny, G. Biscontin & J. Zhang, Seafloor interaction with
steel catenary risers, OTRC 9/06A173) and the abstract of a thesis (Y. Jiao, Texas A&M University, 2007) were read, not
the paper. The formulas and numbers are from memory: a = 6.73, b = 0.29 for a rough pipe in a trench up to half a
diameter deep, k/su = 660, omega = 0.433, phi = 0.203, psi = 0.661. Own choices: the backbone begins with the slope k,
as (1) is upright at the surface; where the loop would reach above the surface (y3 < 0, at small penetrations), phi,
psi and 1/(1 + omega) shrink together until y3 = 0, so that a pipe that rests on the first slope feels elastic ground;
the upper edge is nowhere below the lower.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from pydantic import Field

from riser_soil.core.quantities import NonNegative, PositiveStrengthGradient, Ratio, Stress
from riser_soil.seabed.bearing import Strength
from riser_soil.seabed.law import SeabedLaw

if TYPE_CHECKING:
    from riser_soil.seabed.aubeny_biscontin_formula import AubenyBiscontinFormula


class AubenyBiscontin(SeabedLaw):
    """Hysteretic law of Aubeny & Biscontin (2009); `riser_soil.seabed.aubeny_biscontin` says what is certain of it."""

    kind: Literal["aubeny-biscontin"] = Field(description="the law's name")
    su: Stress = Field(description="undrained shear strength at the surface [Pa]")
    su_gradient: PositiveStrengthGradient = Field(default=0.0, description="its growth with depth [Pa/m]")
    a: Ratio = Field(default=6.73, description="factor of the backbone a (y/D)^b [-]")
    b: NonNegative = Field(default=0.29, lt=1.0, description="power of the backbone a (y/D)^b [-]")
    k_over_su: Ratio = Field(default=660.0, description="initial stiffness over the shear strength [-]")
    omega: Ratio = Field(default=0.433, description="asymptote of the rebound [-]")
    phi: NonNegative = Field(default=0.203, lt=1.0, description="suction over the resistance before the uplift [-]")
    psi: Ratio = Field(default=0.661, description="length of the separation over that of the rebound [-]")

    @property
    def undrained_strength(self) -> Strength:
        return Strength(self.su, self.su_gradient)

    def of_pipe(self, diameter: float) -> AubenyBiscontinFormula:
        from riser_soil.seabed.aubeny_biscontin_formula import AubenyBiscontinData, AubenyBiscontinFormula
        from riser_soil.seabed.pipe_bearing import PowerLaw

        power_law = PowerLaw(diameter, self.undrained_strength, self.a, self.b)
        return AubenyBiscontinFormula(
            AubenyBiscontinData(power_law, self.k_over_su, self.omega, self.phi, self.psi)
        )
