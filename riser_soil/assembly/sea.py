"""Assembly of the sea, once for all stages: water surface, current and waves, and the clock of the waves."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import takewhile
from typing import TYPE_CHECKING

import numpy as np

from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage, Stage, StaticStage
from riser_soil.scene.water import Current, Water

if TYPE_CHECKING:
    from riser_soil.assembly.waves import DrawnWaves
    from riser_soil.core.arrays import Array
    from riser_soil.sea.current import ChangingCurrent, SteadyCurrent
    from riser_soil.sea.flows import Sea
    from riser_soil.sea.steady_flow import SteadyFlow
    from riser_soil.sea.waves import WaveField


@dataclass(eq=False)
class SeaAssembly:
    """The water of a scene, as lines, bodies and vessels share it. Its waves are drawn once."""

    scene: Scene
    water: Water

    @cached_property
    def waves(self) -> DrawnWaves | None:
        """The waves of dynamic stages; None where the scene has none. Those that move a vessel are these very waves."""
        if self.water.waves is None:
            return None
        from riser_soil.assembly.waves import DrawnWaves

        return DrawnWaves(self.water.waves, self.scene.gravity, self.scene.water_depth)

    def acts_in(self, stage: Stage) -> bool:
        """Whether the water may do more in a stage than carry what is submerged: by a surface, or by motion."""
        return isinstance(stage, DynamicStage) or self.moves_in(stage) or self.water.surface_level is not None

    def moves_in(self, stage: Stage) -> bool:
        """Whether the water moves in a stage."""
        return self.water.current is not None or self.has_waves_in(stage)

    def has_waves_in(self, stage: Stage) -> bool:
        """Whether a stage has waves: dynamic ones have those of the scene."""
        return self.water.waves is not None and isinstance(stage, DynamicStage)

    def accelerates_in(self, stage: Stage) -> bool:
        """Whether the water accelerates in a stage, by waves or a current that changes."""
        changes = self.water.current is not None and self.water.current.history is not None
        return self.has_waves_in(stage) or (changes and isinstance(stage, DynamicStage))

    def in_stage(self, stage: Stage) -> Sea | None:
        """The water in a stage: current, in dynamic stages waves, and the surface.

        None where nothing moves and there is no surface: still water around what is submerged.
        """
        if not self.moves_in(stage) and self.water.surface_level is None:
            return None
        from riser_soil.sea.flows import Sea

        return Sea(self.water.surface_level, list(self._flows(stage)))

    def _flows(self, stage: Stage) -> Iterator[SteadyCurrent | ChangingCurrent | WaveField | SteadyFlow]:
        if self.water.current is not None:
            yield self._current(self.water.current, stage)
        if self.waves is not None and self.has_waves_in(stage):
            assert self.water.surface_level is not None
            yield self.waves.flow(self.water.surface_level, wave_clock(self.scene, stage), wave_age(self.scene, stage))

    def _current(self, given: Current, stage: Stage) -> SteadyCurrent | ChangingCurrent:
        """It grows with the load factor in a first static stage, but where a scene begins with the end of another run;
        else it is there in full.
        """
        from riser_soil.sea.current import SteadyCurrent, changing_current

        first = stage.name == self.scene.stages[0].name
        grows = isinstance(stage, StaticStage) and first and self.scene.initial is None
        level = np.unique([z for _, profile in given.each for z, _, _ in profile])
        velocity = np.array([_at_levels(np.array(profile), level) for _, profile in given.each])
        if given.history is None:
            return SteadyCurrent(level, velocity[0], grows)
        time, runs = np.array([each.time for each in given.history]), isinstance(stage, DynamicStage)
        return changing_current(level, time, velocity, wave_clock(self.scene, stage), runs, grows)


def sea_of(scene: Scene) -> SeaAssembly | None:
    """The sea of a scene; None without water."""
    return None if scene.water is None else SeaAssembly(scene, scene.water)


def wave_clock(scene: Scene, stage: Stage) -> float:
    """The waves' clock at the beginning of a stage [s]: it runs through the dynamic stages."""
    before = takewhile(lambda other: other.name != stage.name, scene.stages)
    return sum(other.duration for other in before if isinstance(other, DynamicStage))


def wave_age(scene: Scene, stage: Stage) -> float:
    """How long the waves have acted without a break when a stage begins [s]: static stages have no waves, so in the
    first dynamic stage after one the riser is at rest, and the waves are ramped anew.
    """
    age = 0.0
    for before in takewhile(lambda other: other.name != stage.name, scene.stages):
        age = age + before.duration if isinstance(before, DynamicStage) else 0.0
    return age


def current_times(scene: Scene, stage: Stage) -> list[float]:
    """Times [s] in a stage at which the current's history is given; none in stages that have no time."""
    current = scene.water.current if scene.water is not None else None
    if current is None or current.history is None or not isinstance(stage, DynamicStage):
        return []
    times = (each.time - wave_clock(scene, stage) for each in current.history)
    return [t for t in times if 0.0 < t < stage.duration]


def _at_levels(profile: Array, level: Array) -> Array:
    """Velocity (m, 2) of a profile (n, 3) at the levels (m,), its own among them."""
    return np.stack([np.interp(level, profile[:, 0], profile[:, 1 + i]) for i in range(2)], axis=-1)
