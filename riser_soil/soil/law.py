"""Interface of constitutive laws of the soil: stress update, consistent tangent and history at n quadrature points.

Strains and stresses (n, 6) in the components of mandel.py, tension positive. The formula holds constants and the
initial stress and no state: the caller keeps the history and decides when a trial becomes the start of the next step.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, ClassVar, NamedTuple, Protocol

from pydantic import BaseModel

from riser_soil.core.quantities import FROZEN
from riser_soil.seabed.bearing import Number

if TYPE_CHECKING:
    from collections.abc import Sequence

    from riser_soil.core.arrays import Array

STRESS = ("stress_xx", "stress_yy", "stress_zz", "stress_xy", "stress_xz", "stress_yz")
PLACES = tuple(name[-2:] for name in STRESS)
PLASTIC_STRAIN = "equivalent_plastic_strain"
PORE_PRESSURE = "pore_pressure"  # beyond that at rest, positive in compression; effective stress is so much less


class StressUpdate(NamedTuple):
    """Result of a stress update, at the end of a strain increment.

    stress (n, 6) [Pa]. tangent (n, 6, 6) [Pa]: its derivative by the increment. history (n, nh). stored (n,) [J/m3]:
    free energy of the change since the start, beyond what the initial stress does on the elastic strain: it comes
    back, or stays in the soil. elastic (n, 6): elastic strain since the start. What the stress does beyond the change
    of both is dissipated.
    """

    stress: Array
    tangent: Array
    history: Array
    stored: Array
    elastic: Array


class Formula(Protocol):
    """A law at n points. columns: names of what the history holds; PLASTIC_STRAIN goes to the
    results, and effective stress goes by PORE_PRESSURE, other names are the law's own.
    """

    @property
    def columns(self) -> tuple[str, ...]: ...

    @property
    def symmetric(self) -> bool:
        """Whether the tangent is symmetric."""
        ...

    @property
    def by_rate(self) -> bool:
        """Whether the stress depends on the time that an increment takes."""
        ...

    @property
    def bulk(self) -> Array:
        """Elastic bulk modulus (n,) [Pa], with `shear` that of soil that is unloaded."""
        ...

    @property
    def shear(self) -> Array:
        """Elastic shear modulus (n,) [Pa]."""
        ...

    def start(self) -> Array:
        """History (n, nh) of undisturbed soil, under its initial stress."""
        ...

    def update(self, strain_increment: Array, history: Array, dt: float = math.inf) -> StressUpdate:
        """The answer to a strain increment (n, 6) from a history, within dt [s]: inf for slow, 0 for at once."""
        ...

    def overstress(self, stress: Array) -> Array:
        """Equivalent stress over its limit (n,): impossible above 1 in slow flow; 0 where there is no limit."""
        ...


class Bearing(NamedTuple):
    """Bearing capacity per length [N/m], and its meaning in words."""

    capacity: float
    meaning: str


class SoilLaw(BaseModel, ABC):
    """The model of a soil law in the scene: `kind`, a Literal of one word, and its constants.

    path_dependent: whether its history keeps more than the stress, so that it matters in what steps soil is strained.
    linear: whether stress is linear in strain, so that the soil can be condensed to its surface.
    """

    model_config = FROZEN
    path_dependent: ClassVar[bool] = True
    linear: ClassVar[bool] = False
    kind: str

    @property
    def reference_rate(self) -> float | None:
        """Rate of shear [1/s] beyond which the soil is stronger; None where no rate counts."""
        return None

    def lies(self, key: str, unit_weight: float, K0: float) -> None:
        """What a law that is asked for more than its constants may note: its key in the scene, and of the soil at the
        seabed the submerged unit weight [N/m3] and K0.
        """

    def knows_effective_stress(self, columns: Sequence[str]) -> bool:
        """Whether effective stress is known of soil whose histories are named so: it is the law's stress, or pore
        pressure is one of the histories.
        """
        return False

    @abstractmethod
    def surface_modulus(self, width: float) -> float:
        """Young's modulus at the soil's surface [Pa], above 0, as a pipe of this width [m] meets it: contact is so much
        stiffer.
        """

    @abstractmethod
    def at_points(self, depth: Array, initial: Array) -> Formula:
        """The formula at depths (n,) below the seabed [m], of soil under an initial stress (n, 6) [Pa]."""

    def undrained_strength(self, depth: Number) -> Number | None:
        """Shear strength su of undisturbed soil at a depth below the seabed [m], or (n,) of them [Pa]; None of soil
        that has no such strength.
        """
        return None

    def wrong_within(self, depth: float) -> tuple[str, str] | None:
        """Problem of soil of this depth [m]: what is allowed, and what to do."""
        return None

    @property
    def forgets_at(self) -> float | None:
        """Amplitude of shear strain of which a cycle takes half of a small mean stress; None of a law whose loops
        close.
        """
        return None

    def bearing(self, width: float) -> Bearing | None:
        """Bearing capacity of the soil's surface under a strip of this width [m]; None without a limit."""
        return None
