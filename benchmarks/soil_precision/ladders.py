"""Which methods take which scene, on cells of D/n with which n, and what all of a scene are judged against."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from benchmarks.soil_precision.scenes import Mapping, elastic, laid, pushed


@dataclass(frozen=True)
class Ladder:
    """A scene's methods as the keys that they change, each with its n. The first one makes the reference, at the finer
    n of `reference`; the coarser one tells its uncertainty.
    """

    scene: Callable[[int, Mapping], Mapping]
    methods: dict[str, tuple[Mapping, tuple[int, ...]]]
    reference: tuple[int, int]

    @property
    def best(self) -> str:
        return next(iter(self.methods))


def _soil(**keys: str) -> Mapping:
    return {"soil": keys}


def _solver(**keys: str) -> Mapping:
    return {"solver": keys}


SMALL, WHOLE, SECTIONS = _soil(strain="small"), _soil(symmetry="whole"), _soil(model="sections")
NODES: Mapping = {"contact": "node"}
TETRAHEDRA: Mapping = {"kind": "tet"}

#: Contact is on the surface, of half by symmetry at large strain on hexahedra, where a method does not say else.
LADDERS = {
    "pushed": Ladder(
        pushed,
        {
            "large strain": ({}, (4, 6, 8, 12, 16)),
            "whole": (WHOLE, (4, 8, 12)),
            "small strain": (SMALL, (4, 6, 8, 12, 16)),
            "nodes": (NODES, (3, 4, 6, 8)),
            "tetrahedra": (TETRAHEDRA, (2, 3, 4)),
        },
        (24, 16),
    ),
    "laid": Ladder(
        laid,
        {
            "large strain": ({}, (4, 6, 8, 12)),
            "sections": (SECTIONS, (4, 6, 8, 12, 16)),
            "small strain": (SMALL, (4, 6, 8, 12)),
            "nodes": (NODES, (4, 6, 8)),
            "whole": (WHOLE, (4, 6)),
            "direct": (_solver(linear="direct"), (4, 6, 12)),
            "iterative": (_solver(linear="iterative"), (4, 6, 12)),
            "tetrahedra": (TETRAHEDRA, (2, 3)),
        },
        (16, 12),
    ),
    "elastic": Ladder(
        elastic,
        {
            "condensed": (_solver(soil="condensed"), (4, 6, 8, 12, 16)),
            "kept": (_solver(soil="whole", linear="kept"), (4, 6, 8)),
            "direct": (_solver(soil="whole", linear="direct"), (4, 6, 8)),
            "iterative": (_solver(soil="whole", linear="iterative"), (4, 6, 8)),
        },
        (24, 16),
    ),
}
