"""The soil's law and weight of a scene, of one kind or by layers."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.scene.soil import SoilScene
from riser_soil.scene.soil_layers import boundaries
from riser_soil.soil.layered import LayeredWeight, in_layers, law_by_depth, of_layers

SEA_WATER, STANDARD_GRAVITY = 1025.0, 9.80665

if TYPE_CHECKING:
    from riser_soil.scene.scene import Scene
    from riser_soil.soil.grid import DistributedMesh
    from riser_soil.soil.law import Formula


def law_of(given: SoilScene, grid: DistributedMesh, shallowest: float = 0.0) -> Callable[[Array, Array], Formula]:
    """Maker of the formula from depths (n,) [m] and initial stress (n, 6) [Pa] of the grid's quadrature points.

    shallowest: soil that gains strength from nothing has at least that of this depth [m].
    """
    if given.layers is None:
        law = given.top_law
        return lambda depth, initial: law.at_points(np.maximum(depth, shallowest), initial)
    laws, bottoms = [layer.law for layer in given.layers], boundaries(given.layers)
    if volumes(given):
        return lambda depth, initial: of_layers(
            laws,
            np.repeat(grid.volume, len(depth) // max(1, len(grid.volume))),
            np.maximum(depth, shallowest),
            initial,
        )
    return lambda depth, initial: law_by_depth(laws, bottoms, depth, initial, shallowest)


def strength_of(given: SoilScene, shallowest: float = 0.0) -> Callable[[IntArray, Array], Array]:
    """Function for the undrained shear strength (n,) [Pa] of undisturbed soil in volumes (n,) at depths (n,) [m];
    infinite of soil that has none. shallowest: as in `law_of`.
    """
    laws, bottoms, by_volume = given.laws, boundaries(given.layers or ()), bool(volumes(given))

    def strength(volume: IntArray, depth: Array) -> Array:
        layer, below = in_layers(bottoms, depth, shallowest)
        values = np.full(len(depth), np.inf)
        for k, law in enumerate(laws):
            at = np.flatnonzero((volume if by_volume else layer) == k)
            if (su := law.undrained_strength(below[at])) is not None:
                values[at] = su
        return values

    return strength


def weight_of(given: SoilScene) -> float | LayeredWeight:
    """Submerged unit weight [N/m3]."""
    if given.layers is None or volumes(given):
        return given.submerged_unit_weight
    own = [layer.submerged_unit_weight for layer in given.layers]
    return LayeredWeight(boundaries(given.layers), tuple(given.submerged_unit_weight if w is None else w for w in own))


def initial_stress(given: SoilScene, depth: Array) -> Array:
    """Geostatic stress (n, 6) [Pa] at depths (n,) below the seabed [m]."""
    weight = weight_of(given)
    vertical = weight * depth if isinstance(weight, float) else weight.stress(depth)
    ratios = np.array([given.K0, given.K0, 1.0, 0.0, 0.0, 0.0])
    return np.asarray(-vertical[:, None] * ratios)


def density_of(given: SoilScene, scene: Scene) -> Callable[[Array], Array]:
    """Function for the density (n,) [kg/m3] of soil and pore water at depths (n,) [m]."""
    own, weight = given.density, weight_of(given)
    layers = weight if isinstance(weight, LayeredWeight) else LayeredWeight((), (weight,))
    water = SEA_WATER if scene.water is None else scene.water.density
    g = scene.gravity or STANDARD_GRAVITY
    return lambda depth: np.full_like(depth, own) if own is not None else water + layers.at(depth) / g


def volumes(given: SoilScene) -> tuple[str, ...]:
    """Names of the mesh's volumes that are layers; none of layers by depth."""
    return tuple(layer.volume for layer in given.layers or () if layer.volume is not None)
