"""Layered soil: a law and a unit weight for each layer, with one formula that hands every point to its layer's law."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.soil.law import Formula, SoilLaw, StressUpdate


@dataclass(frozen=True)
class LayeredWeight:
    """Submerged unit weight by layers. bottoms (nl - 1,): depths at which layers meet, increasing [m]; values (nl,)
    [N/m3].
    """

    bottoms: tuple[float, ...]
    values: tuple[float, ...]

    def at(self, depth: Array) -> Array:
        """Unit weight at depths (n,) [N/m3]."""
        return np.asarray(self.values)[layer_at(self.bottoms, depth)]

    def stress(self, depth: Array) -> Array:
        """Effective weight of the soil above depths (n,), >= 0 [Pa]."""
        tops, bottoms = np.array([0.0, *self.bottoms]), np.array([*self.bottoms, np.inf])
        above = np.clip(depth[:, None], tops, bottoms) - tops
        return np.asarray(above @ np.array(self.values))


def layer_at(bottoms: Sequence[float], depth: Array) -> IntArray:
    """Number of the layer (n,) that holds a depth (n,); at a boundary the upper one."""
    return np.searchsorted(np.asarray(bottoms), depth, side="left").astype(np.int64)


def law_by_depth(
    laws: Sequence[SoilLaw], bottoms: Sequence[float], depth: Array, initial: Array, shallowest: float = 0.0
) -> Formula:
    """The formula at depths (n,) below the seabed [m]; each law counts depth from the top of its layer, and at least
    `shallowest`.
    """
    return of_layers(laws, *in_layers(bottoms, depth, shallowest), initial)


def in_layers(bottoms: Sequence[float], depth: Array, shallowest: float) -> tuple[IntArray, Array]:
    """Layer (n,) that holds a depth (n,) [m], and the depth below its top, at least `shallowest`."""
    layer = layer_at(bottoms, depth)
    return layer, np.maximum(depth - np.array([0.0, *bottoms])[layer], shallowest)


def of_layers(laws: Sequence[SoilLaw], layer: IntArray, depth: Array, initial: Array) -> Formula:
    """The formula at points that lie in layers (n,), at depths (n,) as the laws count them, under a stress (n, 6)."""
    places = [np.flatnonzero(layer == k) for k in range(len(laws))]
    made = [law.at_points(depth[at], initial[at]) for law, at in zip(laws, places, strict=True)]
    return LayeredFormula(tuple(places), tuple(made), len(depth))


@dataclass(frozen=True, eq=False)
class LayeredFormula:
    """Formulas of layers, each at its own points: places, (n_k,) each, of n points.

    History (n, nh): the columns of all formulas, those of the same name in common; a point leaves those that its
    formula does not know at zero.
    """

    places: tuple[IntArray, ...]
    formulas: tuple[Formula, ...]
    size: int

    @cached_property
    def columns(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(name for formula in self.formulas for name in formula.columns))

    @property
    def symmetric(self) -> bool:
        return all(formula.symmetric for formula in self.formulas)

    @property
    def by_rate(self) -> bool:
        return any(formula.by_rate for formula in self.formulas)

    @property
    def bulk(self) -> Array:
        return self._at_points([formula.bulk for formula in self.formulas])

    @property
    def shear(self) -> Array:
        return self._at_points([formula.shear for formula in self.formulas])

    @cached_property
    def _own(self) -> list[IntArray]:
        """Columns of each formula."""
        return [np.array([self.columns.index(name) for name in formula.columns]) for formula in self.formulas]

    def start(self) -> Array:
        history = np.zeros((self.size, len(self.columns)))
        for at, own, formula in zip(self.places, self._own, self.formulas, strict=True):
            history[np.ix_(at, own)] = formula.start()
        return history

    def update(self, strain_increment: Array, history: Array, dt: float = math.inf) -> StressUpdate:
        n, out = self.size, np.zeros_like(history)
        update = StressUpdate(np.empty((n, 6)), np.empty((n, 6, 6)), out, np.empty(n), np.empty((n, 6)))
        for at, own, formula in zip(self.places, self._own, self.formulas, strict=True):
            part = formula.update(strain_increment[at], history[np.ix_(at, own)], dt)
            out[np.ix_(at, own)] = part.history
            update.stress[at], update.tangent[at] = part.stress, part.tangent
            update.stored[at], update.elastic[at] = part.stored, part.elastic
        return update

    def overstress(self, stress: Array) -> Array:
        layers = zip(self.places, self.formulas, strict=True)
        return self._at_points([formula.overstress(stress[at]) for at, formula in layers])

    def _at_points(self, of_layers: list[Array]) -> Array:
        """Numbers of each layer's points, at all points (n,)."""
        out = np.empty(self.size)
        for at, values in zip(self.places, of_layers, strict=True):
            out[at] = values
        return out
