"""Hysteretic seabed of Randolph & Quiggin: hyperbolic penetration, uplift with suction, softened repenetration.

Source: M. Randolph & P. Quiggin, Non-linear hysteretic seabed model for catenary pipeline contact, OMAE2009-79236.
With z the penetration, D the diameter, zeta = z Kmax/D, x = |z - z0| Kmax/D since the last turn at (z0, P0):

    ultimate resistance   Pu(z) = Nc su(z) D,  Nc = a (z/D)^b, below z/D = 0.1 Nc(0.1) sqrt(10 z/D)          (1)
    first penetration     P1(z) = Pu(z) zeta/(1 + zeta)                                                      (2)
    uplift                P = Ps + S^2/(S + Pu(z0) x),  S = P0 - Ps,  Ps = -f_suc s d Pu(z)                  (3)
    repenetration         P = Pu(z) - T^2/(T + Pu(z) x),  T = Pu(z) - P0                                     (4)
    bound, both ways      P <= e^min(0, -lambda_rep (1 - c d) + max(0, z - zm)/zm) P1(z)                     (5)
    decay in uplift       d = e^-((z0 - z)/(lambda_suc zm))                                                  (6)

zm is the largest penetration of all; s and c, 0 to 1, are the share of suction available at the next uplift and the
intactness of the clay. Both are 1 at first touch, decay by (6) and are 0 after the pipe has left the ground; s recovers
to P/P1 where the pipe is pressed again, c by penetrating beyond zm. (3) with P0 + f_suc Pu in place of S is the usual
form P0 - x/(S/Pu(z0) + x) S, and (4) from the origin is (2). The soil's buoyancy adds f_b gamma' A(z), A the area
displaced.

Certainty. Read in an extract of the manual of a program with the model (OrcaFlex): su(z), Nc with its square root (1),
f_suc as the ratio of suction to Pu, zeta, the start (z0, P0) of an episode, the order of the modes, no force out of
contact; in the abstract of the paper: hyperbolae for the three ways whose parameters change at each reversal, stiffness
Kmax. From memory: (2), (3) without s and d, the hyperbolic form of (4), and all default numbers. Own choices, where
these sources leave a gap: the reference Pu(z) in (4), the exponential (5, 6) with s and c, and the bound (5) in uplift
as well, which makes P vanish continuously at the surface and keeps the first half millimetre, where (2) is steeper than
Pu Kmax/D, from giving back more energy than it took. c does not recover by small movements, for else a pipe that
trembles could climb from a soft return back to the first curve and gain work in a cycle.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from pydantic import Field

from riser_soil.core.quantities import Coefficient, NonNegative, PositiveStrengthGradient, Ratio, Stress, UnitWeight
from riser_soil.seabed.bearing import Strength
from riser_soil.seabed.law import SeabedLaw

if TYPE_CHECKING:
    from riser_soil.seabed.randolph_quiggin_formula import RandolphQuigginFormula

SHALLOW = 0.1  # z/D below which the bearing factor follows the square root


class RandolphQuiggin(SeabedLaw):
    """Hysteretic law of Randolph & Quiggin (2009); `riser_soil.seabed.randolph_quiggin` says what is certain of it."""

    kind: Literal["randolph-quiggin"] = Field(description="the law's name")
    su: Stress = Field(description="undrained shear strength at the surface [Pa]")
    su_gradient: PositiveStrengthGradient = Field(default=0.0, description="its growth with depth [Pa/m]")
    unit_weight: UnitWeight = Field(default=0.0, description="submerged unit weight, for the soil's buoyancy [N/m3]")
    a: Ratio = Field(default=6.0, description="factor of the bearing capacity a (z/D)^b [-]")
    b: NonNegative = Field(default=0.25, lt=1.0, description="power of the bearing capacity a (z/D)^b [-]")
    K_max: Ratio = Field(default=200.0, description="greatest stiffness, over the ultimate pressure [-]")
    f_suc: NonNegative = Field(default=0.6, lt=1.0, description="suction over the ultimate resistance [-]")
    lambda_suc: Ratio = Field(default=1.0, description="decay length of suction over the greatest penetration [-]")
    lambda_rep: Coefficient = Field(default=0.3, description="softening of repenetration [-]")
    f_b: Coefficient = Field(default=1.5, description="factor of the soil's buoyancy [-]")

    @property
    def undrained_strength(self) -> Strength:
        return Strength(self.su, self.su_gradient)

    def of_pipe(self, diameter: float) -> RandolphQuigginFormula:
        from riser_soil.seabed.pipe_bearing import PowerLaw
        from riser_soil.seabed.randolph_quiggin_formula import RandolphQuigginData, RandolphQuigginFormula

        ultimate = PowerLaw(diameter, self.undrained_strength, self.a, self.b, SHALLOW)
        per_metre, weight = self.K_max / diameter, self.f_b * self.unit_weight
        return RandolphQuigginFormula(
            RandolphQuigginData(ultimate, per_metre, self.f_suc, self.lambda_suc, self.lambda_rep, weight)
        )
