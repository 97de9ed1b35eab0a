"""Largest utilisation of bend radius, tension and stress allowed in a stage, and the warnings where one is above 1."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from riser_soil.core.arrays import Array


@dataclass(frozen=True)
class TightestBend:
    """The tightest bend relative to the allowable radius: radius m, arc m, t s or load factor."""

    utilisation: float = 0.0
    radius: float = math.inf
    arc: float = math.nan
    t: float = math.nan

    def warnings(self, unit: str) -> Iterator[str]:
        if self.utilisation > 1.0:
            yield (
                f"the pipe is bent beyond its min_bend_radius: {self.utilisation:.4g} times what is allowed at arc "
                f"{self.arc:.5g} m and {self.t:.5g} {unit}, where the bend radius is {self.radius:.4g} m"
            )


@dataclass(frozen=True)
class MostUsed:
    """The largest utilisation of a tension or stress allowed, what it was, arc m, t s or load factor."""

    utilisation: float = 0.0
    actual: float = math.nan
    arc: float = math.nan
    t: float = math.nan

    def or_more(self, used: Array | None, actual: Array, arc: Array, times: Array) -> MostUsed:
        """At times (nt,); used (nt, nn): utilisation at the nodes, nan where there is none; actual: tension [N] or
        stress [Pa] there.
        """
        if used is None:
            return self
        k, n = np.unravel_index(np.nanargmax(used), used.shape)
        if not used[k, n] > self.utilisation:
            return self
        return MostUsed(float(used[k, n]), float(actual[k, n]), float(arc[n]), float(times[k]))

    def warnings(self, unit: str, what: str, actual: str) -> Iterator[str]:
        if self.utilisation > 1.0:
            yield (
                f"{what}: {self.utilisation:.4g} times what is allowed at arc {self.arc:.5g} m and {self.t:.5g} "
                f"{unit}, where {actual.format(self.actual)}"
            )
