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

    def in_stage(self, stage: Stage) -> StageWater:
        """The water in a stage."""
        return StageWater(self, stage)


@dataclass(frozen=True, eq=False)
class StageWater:
    """The water of a scene in a stage: whether and how it moves, its surface, its flow."""

    sea: SeaAssembly
    stage: Stage

    @property
    def given(self) -> Water:
        """The scene's water."""
        return self.sea.water

    @property
    def is_dynamic(self) -> bool:
        """Whether lines and bodies may move through it."""
        return isinstance(self.stage, DynamicStage)

    @property
    def acts(self) -> bool:
        """Whether it may do more than carry what is submerged: by a surface, or by motion."""
        return self.is_dynamic or self.moves or self.has_surface

    @property
    def moves(self) -> bool:
        """Whether it moves."""
        return self.given.current is not None or self.has_waves

    @property
    def has_waves(self) -> bool:
        """Whether it has waves: dynamic stages have those of the scene."""
        return self.given.waves is not None and self.is_dynamic

    @property
    def accelerates(self) -> bool:
        """Whether it accelerates, by waves or a current that changes."""
        changes = self.given.current is not None and self.given.current.history is not None
        return self.has_waves or (changes and self.is_dynamic)

    @property
    def has_surface(self) -> bool:
        """Whether it has a surface; without one all is submerged."""
        return self.given.surface_level is not None

    @property
    def flow(self) -> Sea | None:
        """Current, in dynamic stages waves, and the surface, made anew for each who asks.

        None where nothing moves and there is no surface: still water around what is submerged.
        """
        if not self.moves and not self.has_surface:
            return None
        from riser_soil.sea.flows import Sea

        return Sea(self.given.surface_level, list(self._flows()))

    def _flows(self) -> Iterator[SteadyCurrent | ChangingCurrent | WaveField | SteadyFlow]:
        scene, stage = self.sea.scene, self.stage
        if self.given.current is not None:
            yield _current(scene, self.given.current, stage)
        if self.sea.waves is not None and self.has_waves:
            assert self.given.surface_level is not None
            yield self.sea.waves.flow(self.given.surface_level, wave_clock(scene, stage), wave_age(scene, stage))


def _current(scene: Scene, given: Current, stage: Stage) -> SteadyCurrent | ChangingCurrent:
    """The current of a stage. It grows with the load factor in a first static stage, but where a scene begins with the
    end of another run; else it is there in full.
    """
    from riser_soil.sea.current import SteadyCurrent, changing_current

    first = stage.name == scene.stages[0].name
    grows = isinstance(stage, StaticStage) and first and scene.initial is None
    level = np.unique([z for _, profile in given.each for z, _, _ in profile])
    velocity = np.array([_at_levels(np.array(profile), level) for _, profile in given.each])
    if given.history is None:
        return SteadyCurrent(level, velocity[0], grows)
    time, runs = np.array([each.time for each in given.history]), isinstance(stage, DynamicStage)
    return changing_current(level, time, velocity, wave_clock(scene, stage), runs, grows)


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
