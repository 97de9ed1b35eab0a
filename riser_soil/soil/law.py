"""What a constitutive law of the soil is: a formula on arrays at n quadrature points.

Strains and stresses (n, 6) in the components of mandel.py, tension positive. A law holds its constants at the
n points and no state: the caller keeps stress and history and decides when a trial becomes the start of the
next step.
"""

from __future__ import annotations

from typing import Protocol

from riser_soil.core.arrays import Array


class Law(Protocol):
    """A rate-independent law with isotropic elasticity."""

    @property
    def symmetric(self) -> bool:
        """Whether the tangent is symmetric."""
        ...

    def start(self) -> Array:
        """History (n, nh) of undisturbed soil."""
        ...

    def stress(self, strain_increment: Array, stress: Array, history: Array) -> tuple[Array, Array]:
        """New stress (n, 6) and new history (n, nh) after the strain increment from the given ones."""
        ...

    def tangent(self, strain_increment: Array, stress: Array, history: Array) -> Array:
        """Derivative (n, 6, 6) [Pa] of the new stress by the strain increment."""
        ...

    def elastic_strain(self, stress: Array) -> Array:
        """Elastic strain (n, 6) that goes with a stress."""
        ...

    def overstress(self, stress: Array) -> Array:
        """Equivalent stress over its limit (n,): impossible above 1; 0 where there is no limit."""
        ...

    def plastic_strain(self, history: Array) -> Array:
        """Equivalent plastic strain (n,)."""
        ...
