"""Refinement series of a study: points around the scene's own settings, setting by setting."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from riser_soil.accuracy.study_points import Factors
from riser_soil.scene.scene import Scene
from riser_soil.variants.settings import Setting, refined, settings_in_words, varied

RATIOS = {"elements": 2.0, "time_step": 2.0, "soil_mesh": 2.0 ** (1.0 / 3.0), "penalty": 10.0**0.5}
"""Ratios of levels. The number of the soil's cells grows by the cube, so that each level about doubles a run's cost.
The penalty costs little, and its error falls with its inverse."""
SAME = 0.01  # relative difference of two levels that count as one, as counts are rounded


@dataclass(frozen=True, eq=False)
class Refinements:
    """Settings of a study and the fineness of their levels; the scene is the point (1, 1, ...).

    levels: of each setting, of which half (rounded down) are finer than the scene.
    """

    scene: Scene
    settings: tuple[Setting, ...]
    levels: int = 5

    @property
    def base(self) -> Factors:
        """The scene as it is."""
        return (1.0,) * len(self.settings)

    @cached_property
    def factors(self) -> tuple[tuple[float, ...], ...]:
        """Levels of each setting, from coarse to fine, each once where rounding makes some equal."""
        finer = self.levels // 2
        exponents = range(finer + 1 - self.levels, finer + 1)
        powers = ([RATIOS[setting.name] ** n for n in exponents] for setting in self.settings)
        return tuple(self._distinct(number, factors) for number, factors in enumerate(powers))

    @property
    def corner(self) -> Factors | None:
        """Point with all settings one level finer, which shows whether their errors add up; None for one setting."""
        return tuple(RATIOS[setting.name] for setting in self.settings) if len(self.settings) > 1 else None

    def along(self, number: int) -> list[Factors]:
        """Points of one setting's refinement series, from coarse to fine."""
        return [self.point(number, factor) for factor in self.factors[number]]

    def point(self, number: int, factor: float) -> Factors:
        """Point with one setting at a level and the others as in the scene."""
        return tuple(factor if n == number else 1.0 for n in range(len(self.settings)))

    def scene_at(self, point: Factors) -> Scene:
        """The scene of a point. SceneError where a setting can't be so fine."""
        names = (setting.name for setting in self.settings)
        return refined(self.scene, dict(zip(names, point, strict=True)))

    def in_words(self, point: Factors) -> str:
        """Settings of a point in words."""
        return settings_in_words(self.scene_at(point), self.settings)

    def fineness(self, number: int, factor: float) -> float:
        """Fineness of one setting at a level over that of the scene, after counts are rounded."""
        setting = self.settings[number]
        return setting.fineness(varied(self.scene, setting, factor)) / setting.fineness(self.scene)

    def _distinct(self, number: int, factors: Sequence[float]) -> tuple[float, ...]:
        """Levels that differ: the scene's own, and of others that are equal the one nearest to it."""
        kept = {1.0: 1.0}
        for factor in sorted(factors, key=lambda f: max(f, 1.0 / f)):
            fine = self.fineness(number, factor)
            if all(abs(fine - other) > SAME * other for other in kept.values()):
                kept[factor] = fine
        return tuple(sorted(kept))
