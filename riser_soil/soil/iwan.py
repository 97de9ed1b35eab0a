"""Cyclic clay by Iwan's overlay of elastic, perfectly plastic elements in parallel: exact Masing loops.

The backbone τ(γ) in simple shear is a polygon through points of a curve of G/G0 by shear strain, up to su, where it
stays. Its slopes fall, k1 > k2 > …; element i has the modulus Gi = ki - k(i+1) and the strength Gi γi, γi being the
strain at the polygon's corner. Each is a von Mises element with radial return (see `von_mises`), the bulk modulus is
elastic. W. D. Iwan, On a class of models for the yielding behavior of continuous and composite systems, J. Appl. Mech.
34 (1967).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal, Self

from pydantic import Field, model_validator

from riser_soil.core.lazy import LazyModule
from riser_soil.core.quantities import Positive, Share, wrong
from riser_soil.soil.clay import UndrainedClay
from riser_soil.soil.law import PLASTIC_STRAIN, STRESS, StressUpdate
from riser_soil.soil.rate import Rate, gain_of

if TYPE_CHECKING:
    import numpy as np

    from riser_soil.core.arrays import Array
    from riser_soil.soil import kernels, mandel
else:
    np, kernels = LazyModule("numpy"), LazyModule("riser_soil.soil.kernels")
    mandel = LazyModule("riser_soil.soil.mandel")

SMALLEST, LARGEST = 0.05, 200.0  # corners of the hyperbola, over su/G0
STRAIGHT = 1e-12  # change of slope over G0 that is none


class IwanOverlay(UndrainedClay):
    """Undrained clay under cyclic load: Masing loops from a curve of G/G0 by shear strain, up to su."""

    kind: Literal["iwan"] = Field(description="the law's name")
    elements: Annotated[int, Field(strict=True, ge=2, le=100)] = Field(
        default=12,
        description="without curve: elements in parallel, as many as corners of a hyperbola with the asymptote su",
    )
    curve: tuple[tuple[Positive, Share], ...] | None = Field(
        default=None,
        description="secant modulus over its initial value by shear strain, [[γ, G/G0], ...], γ growing; its last side "
        "goes on up to su",
    )

    @model_validator(mode="after")
    def _is_a_backbone(self) -> Self:
        points = [(0.0, 0.0), *((strain, strain * ratio) for strain, ratio in self.curve or ())]
        sides = [(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(points)]
        slopes = [1.0, *(rise / run if run > 0.0 else math.inf for run, rise in sides)]
        if slopes[-1] <= 0.0 or any(after > before + STRAIGHT for before, after in pairwise(slopes)):
            raise wrong(
                "curve",
                "stress, γ times G/G0, must rise with γ, ever less steeply from the slope 1 on",
                "correct the points, or leave curve out for a hyperbola",
            )
        return self

    def intact(self, depth: Array, initial: Array) -> Overlay:
        bulk, shear, limit = self._constants(depth)
        strain, slope = self._backbone()
        share = slope - np.append(slope[1:], 0.0)
        bends = share > STRAIGHT  # points in one line with their neighbours are no corners
        first, corners = share[bends].sum(), strain[bends] / np.sqrt(3.0)
        return Overlay(bulk, first * shear, share[bends] / first, corners, limit, initial, self.rate)

    def _backbone(self) -> tuple[Array, Array]:
        """Shear strains of the corners, the last one where the stress is su, and slopes before them over G0, (N,)."""
        strength = 2.0 * (1.0 + self.nu) / self.E_over_su  # over G0
        if self.curve is None:
            x = np.append(0.0, np.geomspace(SMALLEST, LARGEST, self.elements))
            strain, stress = strength * x, strength * x / (1.0 + x)
            stress[-1] = strength
        else:
            strain, ratio = np.array([(0.0, 1.0), *self.curve]).T
            stress = strain * ratio
        slope = np.diff(stress) / np.diff(strain)
        last = min(int(np.searchsorted(stress[1:], strength)), len(slope) - 1)
        corners = strain[1 : last + 2].copy()
        corners[last] = strain[last] + (strength - stress[last]) / slope[last]
        return corners, slope[: last + 1]


@dataclass(frozen=True, eq=False)
class Overlay:
    """Bulk modulus (n,), shear modulus of the backbone's first side (n,), largest equivalent stress in slow shear (n,)
    and initial stress (n, 6) [Pa]. Of each element its share of the shear modulus and the equivalent strain at which it
    yields (N,).

    History (n, 7 + 6 N): stress, equivalent plastic strain, deviators of the elements.
    """

    bulk: Array
    shear: Array
    shares: Array
    corners: Array
    limit: Array
    initial: Array
    rate: Rate | None = None
    symmetric: ClassVar[bool] = True

    @property
    def by_rate(self) -> bool:
        return self.rate is not None

    @cached_property
    def moduli(self) -> Array:
        """Shear moduli of the elements (n, N) [Pa]."""
        return self.shear[:, None] * self.shares

    @cached_property
    def limits(self) -> Array:
        """Largest equivalent stresses of the elements (n, N) in slow shear [Pa]."""
        return 3.0 * self.moduli * self.corners

    @property
    def columns(self) -> tuple[str, ...]:
        own = (f"element_{i + 1}{name[6:]}" for i in range(len(self.shares)) for name in STRESS)
        return (*STRESS, PLASTIC_STRAIN, *own)

    def start(self) -> Array:
        of_elements = self._first.reshape(len(self.limit), 6 * len(self.shares))
        return np.column_stack((self.initial, np.zeros(len(self.limit)), of_elements))

    @cached_property
    def _first(self) -> Array:
        """Deviators (n, N, 6) of elements as loaded in proportion to the initial stress: the backbone at its q."""
        s = mandel.deviator(self.initial)
        q = np.sqrt(1.5 * mandel.product(s, s))
        backbone = np.minimum(self.corners[:, None], self.corners) @ (3.0 * self.shares)  # q over the shear modulus
        strain = np.interp(q / self.shear, np.append(0.0, backbone), np.append(0.0, self.corners))
        of_each = 3.0 * self.moduli * np.minimum(strain[:, None], self.corners)
        return of_each[:, :, None] * (s / np.where(q > 0.0, q, 1.0)[:, None])[:, None, :]

    def update(
        self, strain_increment: Array, history: Array, dt: float = math.inf, strength: Array | float = 1.0
    ) -> StressUpdate:
        e, before = mandel.deviator(strain_increment), history[:, :6]
        after = history.copy()
        q, elements = np.empty(self.moduli.shape), after[:, 7:]
        kernels.stretch_elements(self.moduli, e, elements, q)
        limits = np.reshape(strength, (-1, 1)) * self.limits
        shrink, slope = gain_of(self.rate, dt).radial_return(q, limits, 3.0 * self.moduli)
        s, stored, tangent = self._returned(elements, q, shrink, slope)
        change = s - mandel.deviator(before)
        stress = before + change + 3.0 * (self.bulk * mandel.mean(strain_increment))[:, None] * mandel.UNIT
        plastic = e - change / (2.0 * self.shear)[:, None]
        after[:, :6] = stress
        after[:, 6] += np.sqrt(2.0 / 3.0 * mandel.product(plastic, plastic))
        elastic = mandel.elastic_strain(self.bulk, self.shear, stress - self.initial)
        stored += self._volumetric(stress) - self._stored_first - mandel.product(self.initial, elastic)
        return StressUpdate(stress, tangent, after, stored, elastic)

    def _returned(self, elements: Array, q: Array, shrink: Array, slope: Array) -> tuple[Array, Array, Array]:
        """Deviator (n, 6) [Pa], elastic energy (n,) [J/m3] and tangent (n, 6, 6) [Pa] after the return of trials (n,
        6N), which are written over.

        The tangent is K 1⊗1 + Σ 2 Gi (θi P - (θi - slope) n⊗n where it yields).
        """
        tangent = mandel.stiffness(self.bulk, np.einsum("nk,nk->n", self.moduli, shrink))
        yields = shrink < 1.0
        weight = np.where(yields, 3.0 * self.moduli * (shrink - slope) / np.where(yields, q, 1.0) ** 2, 0.0)
        s, stored = np.zeros((len(q), 6)), np.zeros(len(q))
        kernels.return_elements(shrink, weight, self.moduli, elements, s, stored, tangent)
        return s, stored, tangent

    @cached_property
    def _stored_first(self) -> Array:
        """Elastic energy (n,) [J/m3] of elements and volume at the start."""
        of_elements = np.einsum("nki,nki,nk->n", self._first, self._first, 0.25 / self.moduli)
        return of_elements + self._volumetric(self.initial)

    def _volumetric(self, stress: Array) -> Array:
        """Elastic energy of the volume (n,) [J/m3]."""
        return 0.5 * mandel.mean(stress) ** 2 / self.bulk

    def overstress(self, stress: Array) -> Array:
        return mandel.von_mises(stress) / self.limit
