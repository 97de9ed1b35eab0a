"""Ladders of a study: how fine its points are, knob by knob around the scene's own settings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from riser_soil.accuracy.knobs import Knob, settings_told, varied
from riser_soil.accuracy.study_points import Factors
from riser_soil.scene.scene import Scene

RATIOS = {"elements": 2.0, "time_step": 2.0, "soil_mesh": 2.0 ** (1.0 / 3.0), "penalty": 10.0**0.5}
"""From rung to rung: the soil's cells grow in number by the cube, so that each rung about doubles a run's cost; the
penalty costs little and its error falls with its inverse."""
SAME = 0.01  # two rungs closer than that, by rounding, are one


@dataclass(frozen=True, eq=False)
class Ladders:
    """The knobs of a study and how fine their rungs are; the scene is the point (1, 1, ...).

    rungs: of each knob, of which half (rounded down) are finer than the scene.
    """

    scene: Scene
    knobs: tuple[Knob, ...]
    rungs: int = 5

    @property
    def base(self) -> Factors:
        """The scene as it is."""
        return (1.0,) * len(self.knobs)

    @cached_property
    def factors(self) -> tuple[tuple[float, ...], ...]:
        """Of each knob, from coarse to fine; those that rounding makes equal are there once."""
        finer = self.rungs // 2
        exponents = range(finer + 1 - self.rungs, finer + 1)
        powers = ([RATIOS[knob.name] ** n for n in exponents] for knob in self.knobs)
        return tuple(self._distinct(number, factors) for number, factors in enumerate(powers))

    @property
    def corner(self) -> Factors | None:
        """All knobs one rung finer at once, which tells whether their errors add up; None of a single knob."""
        return tuple(RATIOS[knob.name] for knob in self.knobs) if len(self.knobs) > 1 else None

    def along(self, number: int) -> list[Factors]:
        """Points of one knob's ladder, from coarse to fine; the others are as in the scene."""
        return [self.turned(number, factor) for factor in self.factors[number]]

    def turned(self, number: int, factor: float) -> Factors:
        return tuple(factor if n == number else 1.0 for n in range(len(self.knobs)))

    def scene_at(self, point: Factors) -> Scene:
        """SceneError where a knob can't be turned so far."""
        scene = self.scene
        for knob, factor in zip(self.knobs, point, strict=True):
            scene = varied(scene, knob, factor)
        return scene

    def told(self, point: Factors) -> str:
        """The settings in words."""
        return settings_told(self.scene_at(point), self.knobs)

    def fineness(self, number: int, factor: float) -> float:
        """Of a rung over the scene's, after counts are rounded."""
        knob = self.knobs[number]
        return knob.fineness(varied(self.scene, knob, factor)) / knob.fineness(self.scene)

    def _distinct(self, number: int, factors: Sequence[float]) -> tuple[float, ...]:
        """The scene's own rung stays, of the others the first of those that are equal."""
        kept = {1.0: 1.0}
        for factor in sorted(factors, key=lambda f: max(f, 1.0 / f)):
            fine = self.fineness(number, factor)
            if all(abs(fine - other) > SAME * other for other in kept.values()):
                kept[factor] = fine
        return tuple(sorted(kept))
