"""Predicted settlement of the riser by its weight: by bearing on the chord that touches, and by the soil below it.

Where clay yields, a pipe sinks until the chord of its circle is as wide as the strip that bears its load. The soil
below is shortened as a half space without change of volume under that strip, from its surface down to a depth z by

    (2 q/pi) int dz/(z E*),  from z = (width/4) sqrt(e) on,

for a uniform plane strain modulus E* that is q/(pi E*) (2 ln(4 z/width) - 1) (K. L. Johnson, Contact Mechanics, 1985,
from memory); of soil that yields E* is that of the secant modulus at half of the strength. Cells wider than what
touches spread the load over LIKE_CONTACT times their size. A firmer layer stops the pipe that sinks through the one
above. Where the riser comes down it lies deepest, by the overshoot of `riser.touchdown_bend` on ground as stiff as a
secant through that.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from riser_soil.assembly import LineAssembly
from riser_soil.assembly.contact_laws import contact_width
from riser_soil.assembly.scales import Scales
from riser_soil.assembly.soil_sizes import touching_width
from riser_soil.core.arrays import Array
from riser_soil.core.identity_cache import IdentityCache
from riser_soil.riser.sections import Elements
from riser_soil.riser.touchdown_bend import TouchdownBend
from riser_soil.scene.soil import SoilScene
from riser_soil.scene.soil_law import initial_stress
from riser_soil.scene.soil_layers import boundaries
from riser_soil.soil.law import SoilLaw

# Cells of this part of the width that touches bear the pipe as the width itself does. (From 10 slices of elastic soil:
# 1.4 to 2.1, see test_surface_contact.)
LIKE_CONTACT = 1.75
DEPTHS = 200  # points of the integral over the depth
# Simple shear up to half of the strength: the first increment, of the strain at which elastic soil would be there; each
# that much longer than the one before; at most so many.
FIRST, GROWTH, STEPS = 0.02, 1.05, 200
ROUNDS = 20  # in which load and settlement under the touchdown point come to agree
_SHARES: IdentityCache[SoilLaw, float] = IdentityCache(latest=8)  # of laws, see `secant_share`


class Settled(NamedTuple):
    """Settlement [m] by the weight, and by the load under the touchdown point, so many times as large."""

    by_weight: float
    deepest: float
    overshoot: float


def predicted_settlement(riser: LineAssembly, across: float = 0.0) -> Settled | None:
    """Settlement on cells of a size across the riser [m]; None without soil, and of a riser that has no weight."""
    soil, scales = riser.scene.soil, riser.scales
    if soil is None or riser.soil is None or scales.weight <= 0.0:
        return None
    grid = riser.soil.whole.grid
    depth = float(grid.high[2] - grid.low[2])
    by_weight = settlement(soil, scales, depth, across)
    touchdown, EI = riser.touchdown, _stiffness(riser.elements)
    if touchdown is None or min(touchdown.H, by_weight, EI) <= 0.0:  # a cable lies down without an overshoot
        return Settled(by_weight, by_weight, 1.0)
    deepest, overshoot = by_weight, 1.0
    for _ in range(ROUNDS):
        bend = TouchdownBend(scales.weight, touchdown.H, EI, deepest / overshoot)
        overshoot = 0.5 * (overshoot + bend.overshoot)
        deepest = settlement(soil, replace(scales, weight=overshoot * scales.weight), depth, across)
    return Settled(by_weight, deepest, overshoot)


def _stiffness(elements: Elements) -> float:
    """The largest bending stiffness [N m2]."""
    return float(np.maximum(elements.EI_y, elements.EI_z).max())


def settlement(soil: SoilScene, scales: Scales, depth: float, across: float = 0.0) -> float:
    """Settlement [m] of a pipe by its weight on soil of a depth, on cells of a size across it [m]."""
    width, spread = touching_width(scales, soil.top_law), LIKE_CONTACT * across
    yields = width > max(spread, contact_width(scales, soil.top_law.surface_modulus(scales.diameter)))
    if not yields:
        return _shortened(soil, scales, max(width, spread), depth)
    below = (top + chord_depth(touching_width(scales, law), scales.diameter) for law, top in _layers(soil)[1:])
    chord = min([chord_depth(width, scales.diameter), *below])
    width = 2.0 * np.sqrt(chord * (scales.diameter - chord))
    return chord + _shortened(soil, scales, max(width, spread), depth)


def chord_depth(width: float, diameter: float) -> float:
    """Depth [m] to which a circle sinks until a chord of that width touches."""
    return float(0.5 * (diameter - np.sqrt(max(diameter**2 - width**2, 0.0))))


def _shortened(soil: SoilScene, scales: Scales, width: float, depth: float) -> float:
    """Settlement [m] of the soil under a strip of a width that bears the weight."""
    top = 0.25 * width * np.sqrt(np.e)
    if top >= depth:
        return 0.0
    edges = np.geomspace(top, depth, DEPTHS + 1)
    z = np.sqrt(edges[1:] * edges[:-1])
    return float(2.0 * scales.weight / np.pi * np.sum(np.diff(np.log(edges)) / _moduli(soil, z)))


def _moduli(soil: SoilScene, z: Array) -> Array:
    """Plane strain moduli E* (n,) [Pa] at depths below the seabed [m]."""
    laws, tops = zip(*_layers(soil), strict=True)
    moduli, at = np.empty(z.size), np.searchsorted(tops, z, side="right") - 1
    for n, law in enumerate(laws):
        below = z[at == n]
        formula = law.at_points(below - tops[n], initial_stress(soil, below))
        G, K = formula.shear * _SHARES.made_of(law, secant_share), formula.bulk
        moduli[at == n] = 4.0 * G * (3.0 * K + G) / (3.0 * K + 4.0 * G)
    return moduli


def _layers(soil: SoilScene) -> list[tuple[SoilLaw, float]]:
    """Laws and the depths [m] at which their layers begin; the first alone of volumes of any shape."""
    layers = soil.layers or ()
    tops = [0.0, *boundaries(layers)]
    if len(layers) != len(tops):
        return [(soil.top_law, 0.0)]
    return [(layer.law, top) for layer, top in zip(layers, tops, strict=True)]


def secant_share(law: SoilLaw) -> float:
    """Secant shear modulus at half of the undrained strength, over that of unloaded soil; 1 without such strength."""
    depth = 1.0  # m; the share is the same at any
    su = law.undrained_strength(depth)
    if su is None:
        return 1.0
    formula = law.at_points(np.array([depth]), np.zeros((1, 6)))
    history, G, curve = formula.start(), float(formula.shear[0]), [(0.0, 0.0)]
    for step in FIRST * 0.5 * float(su) / G * GROWTH ** np.arange(STEPS):
        increment = np.zeros((1, 6))
        increment[0, 3] = step / np.sqrt(2.0)  # Mandel's component of an engineer's shear strain
        update = formula.update(increment, history)
        history, strain = update.history, curve[-1][1] + step
        curve.append((float(update.stress[0, 3]) / np.sqrt(2.0), strain))
        if curve[-1][0] > 0.5 * su:
            break
    stress, strain = np.array(curve).T
    return min(float(0.5 * su / (G * np.interp(0.5 * su, stress, strain))), 1.0)
