"""Laws that only tests know, each as a contributor would write it: one class for the scene, one for the formula."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import ClassVar, Literal, NamedTuple, TypeVar

import numpy as np
from pydantic import BaseModel, Field

from riser_soil.core.arrays import Array
from riser_soil.core.quantities import BedStiffness, PoissonRatio, PositiveWeightPerLength, Stress, registry
from riser_soil.scene.scene import Scene
from riser_soil.scene.seabed import HystereticSeabed
from riser_soil.scene.soil import SoilScene
from riser_soil.seabed.compiled_law import CompiledLaw, answer, may_act
from riser_soil.seabed.law import SeabedLaw
from riser_soil.soil import mandel
from riser_soil.soil.law import PLASTIC_STRAIN, STRESS, Formula, SoilLaw, StressUpdate
from riser_soil.soil.linear_elastic import LinearElastic

Model = TypeVar("Model", bound=BaseModel)


@contextmanager
def entered(laws: dict[str, type[Model]], model: type[Model]) -> Iterator[None]:
    """One more entry among the laws, for a while."""
    laws |= registry(model)
    _read_anew()
    try:
        yield
    finally:
        laws.popitem()
        _read_anew()


def _read_anew() -> None:
    """The models were made with the laws of their time."""
    for model in (SoilScene, HystereticSeabed, Scene):
        model.model_rebuild(force=True)


class OtherElastic(SoilLaw):
    """Linear elastic soil under another name."""

    kind: Literal["toy"] = Field(description="the law's name")
    E: Stress = Field(description="Young's modulus [Pa]")
    nu: PoissonRatio = Field(description="Poisson's ratio [-]")

    def surface_modulus(self, width: float) -> float:
        return self.E

    def at_points(self, depth: Array, initial: Array) -> Formula:
        return LinearElastic(kind="linear-elastic", E=self.E, nu=self.nu).at_points(depth, initial)


class Hardening(SoilLaw):
    """Von Mises soil whose limit grows and stores what that takes: q <= limit + H kappa, kappa the plastic strain."""

    kind: Literal["toy"] = Field(description="the law's name")
    E: Stress = Field(description="Young's modulus [Pa]")
    nu: PoissonRatio = Field(description="Poisson's ratio [-]")
    limit: Stress = Field(description="equivalent stress at which it yields first [Pa]")
    H: Stress = Field(description="growth of the limit by equivalent plastic strain [Pa]")

    def surface_modulus(self, width: float) -> float:
        return self.E

    def at_points(self, depth: Array, initial: Array) -> HardeningPoints:
        E = np.full_like(depth, self.E)
        moduli = mandel.bulk_modulus(E, self.nu), mandel.shear_modulus(E, self.nu)
        return HardeningPoints(*moduli, self.limit, self.H, initial)


@dataclass(frozen=True, eq=False)
class HardeningPoints:
    """Radial return; free energy (sigma - initial):elastic/2 + H kappa^2/2."""

    bulk: Array
    shear: Array
    limit: float
    H: float
    initial: Array
    columns: ClassVar[tuple[str, ...]] = (*STRESS, PLASTIC_STRAIN)
    symmetric: ClassVar[bool] = True
    by_rate: ClassVar[bool] = False

    def start(self) -> Array:
        return np.column_stack((self.initial, np.zeros(len(self.shear))))

    def update(self, strain_increment: Array, history: Array, dt: float = math.inf) -> StressUpdate:
        trial = history[:, :6] + mandel.elastic_stress(self.bulk, self.shear, strain_increment)
        s, q, G3 = mandel.deviator(trial), mandel.von_mises(trial), 3.0 * self.shear
        slip = np.maximum(q - self.limit - self.H * history[:, 6], 0.0) / (G3 + self.H)
        safe = np.where(slip > 0.0, q, 1.0)
        loss = G3 * slip / safe
        stress, kappa = trial - loss[:, None] * s, history[:, 6] + slip
        n, elastic_moduli = np.sqrt(1.5) * s / safe[:, None], mandel.stiffness(self.bulk, self.shear * (1.0 - loss))
        turn = np.where(slip > 0.0, G3 / (G3 + self.H) - loss, 0.0) * 2.0 * self.shear
        moduli = elastic_moduli - turn[:, None, None] * n[:, :, None] * n[:, None]
        elastic = mandel.elastic_strain(self.bulk, self.shear, stress - self.initial)
        stored = 0.5 * mandel.product(stress - self.initial, elastic) + 0.5 * self.H * kappa**2
        return StressUpdate(stress, moduli, np.column_stack((stress, kappa)), stored, elastic)

    def overstress(self, stress: Array) -> Array:
        return mandel.von_mises(stress) / self.limit


class PlasticSpring(SeabedLaw):
    """Springs k that give way beyond a limit, which grows by h times the plastic penetration and stores that."""

    kind: Literal["toy"] = Field(description="the law's name")
    k: BedStiffness = Field(description="stiffness [N/m2]")
    limit: PositiveWeightPerLength = Field(description="force per length at which it gives way first [N/m]")
    h: BedStiffness = Field(description="growth of the limit [N/m2]")

    def of_pipe(self, diameter: float) -> PlasticBed:
        return PlasticBed(self)


@dataclass(frozen=True)
class PlasticBed(CompiledLaw):
    """History (..., 1): plastic penetration [m]."""

    given: PlasticSpring
    columns: ClassVar[tuple[str, ...]] = ("plastic",)
    capacity: ClassVar[float] = math.inf
    start: ClassVar[float] = 0.0
    reach: ClassVar[float] = 0.0

    @property
    def kernel_data(self) -> PlasticData:
        return PlasticData(self.given.k, self.given.limit, self.given.h)

    def initial_history(self, shape: tuple[int, ...]) -> Array:
        return np.zeros((*shape, 1))


class PlasticData(NamedTuple):
    """Kernel data of `PlasticSpring`."""

    k: float
    limit: float
    h: float


@may_act.of(PlasticData)
def _may_act(law: PlasticData, penetration: float, history: Array) -> bool:
    return penetration > history[0] or history[0] > 0.0


@answer.of(PlasticData)
def _answer(law: PlasticData, penetration: float, history: Array, after: Array) -> tuple[float, float, float]:
    k, h, before = law.k, law.h, history[0]
    slip = max(k * (penetration - before) - law.limit - h * before, 0.0) / (k + h)
    plastic = after[0] = before + slip
    elastic = max(penetration - plastic, 0.0)
    slope = k * h / (k + h) if slip > 0.0 else (k if elastic > 0.0 else 0.0)
    return k * elastic, slope, 0.5 * k * elastic**2 + 0.5 * h * plastic**2
