"""Assembly of the sea: water surface, current and waves."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import takewhile
from typing import TYPE_CHECKING, assert_never

import numpy as np

from riser_soil.errors import SceneError
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage, Stage, StaticStage
from riser_soil.scene.water import Current
from riser_soil.scene.wave_kinds import Airy, GivenSpectrum, Jonswap, PiersonMoskowitz, Record, Regular, WaveKind

if TYPE_CHECKING:
    from riser_soil.core.arrays import Array
    from riser_soil.sea.components import Components
    from riser_soil.sea.current import ChangingCurrent, SteadyCurrent
    from riser_soil.sea.flows import Sea
    from riser_soil.sea.steady_flow import SteadyFlow
    from riser_soil.sea.steady_wave import SteadyWave
    from riser_soil.sea.waves import WaveField


def water_of(scene: Scene, stage: Stage) -> Sea | None:
    """The water in a stage: current, in dynamic stages waves, and the surface.

    None where nothing moves and there is no surface: still water around a submerged riser, or no water at all.
    """
    if scene.water is None:
        return None
    flows = list(_flows(scene, stage))
    if not flows and scene.water.surface_level is None:
        return None
    from riser_soil.sea.flows import Sea

    return Sea(scene.water.surface_level, flows)


def components_of(scene: Scene) -> Components | None:
    """The scene's waves, of one of finite height its first harmonic; None where it has none. Waves that move a vessel
    are these very waves.
    """
    waves = scene.water.waves if scene.water is not None else None
    if waves is None:
        return None
    from riser_soil.sea.components import joined

    g, h = scene.gravity, scene.water_depth
    return joined([_train(train, number, g, h) for number, (_, train) in enumerate(waves.each)])


def _train(train: WaveKind, number: int, g: float, h: float) -> Components:
    """Waves of one train; seas of the same seed differ by the train's number."""
    match train:
        case Regular():
            from riser_soil.sea.components import Components

            wave = steady_wave_of(train, g, h)
            parts = 0.5 * train.height, wave.w, wave.k, train.toward[0], math.radians(train.phase_deg)
            return Components(*(np.array([part]) for part in parts))
        case Airy():
            from riser_soil.sea.components import regular

            angles = math.radians(train.direction_deg), math.radians(train.phase_deg)
            return regular(train.height, train.period, *angles, g, h)
        case Record():
            from riser_soil.sea.spectra import recorded

            elevation = np.array(train.record.elevation)
            return recorded(elevation, train.record.step, train.harmonics, train.position, train.toward[0], g, h)
        case Jonswap() | PiersonMoskowitz():
            from riser_soil.sea import spectra

            gamma = train.gamma if isinstance(train, Jonswap) else 1.0
            return spectra.components(
                *(train.Hs, train.Tp, gamma, train.components, _seed(train.seed, number)), np.array(train.toward), g, h
            )
        case GivenSpectrum():
            from riser_soil.sea import spectra

            w, density = np.array(train.table.frequency), np.array(train.table.density)
            seed, toward = _seed(train.seed, number), np.array(train.toward)
            by_direction = np.array(train.table.parts) if train.table.parts else None
            return spectra.components_of_spectrum(w, density, train.components, seed, toward, g, h, by_direction)
    assert_never(train)


def steady_wave_of(train: Regular, g: float, h: float) -> SteadyWave:
    """A wave of finite height; SceneError where there is none."""
    from riser_soil.sea.steady_wave import steady_wave

    try:
        return steady_wave(train.theory, train.height, train.period, g, h)
    except SceneError as err:
        raise SceneError(f"water.waves.regular.{err}") from err


def _seed(seed: int, number: int) -> list[int]:
    return [seed, number] if number else [seed]


def wave_clock(scene: Scene, stage: Stage) -> float:
    """What the waves' clock shows when a stage begins [s]: it runs through the dynamic stages."""
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


def _flows(scene: Scene, stage: Stage) -> Iterator[SteadyCurrent | ChangingCurrent | WaveField | SteadyFlow]:
    assert scene.water is not None
    if scene.water.current is not None:
        yield _current(scene, scene.water.current, stage)
    if scene.water.waves is not None and isinstance(stage, DynamicStage):
        yield _waves(scene, stage)


def _current(scene: Scene, given: Current, stage: Stage) -> SteadyCurrent | ChangingCurrent:
    """It grows with the load factor in a first static stage, but where a scene begins with the end of another run; else
    it is there in full.
    """
    from riser_soil.sea.current import ChangingCurrent, SteadyCurrent

    grows = isinstance(stage, StaticStage) and stage.name == scene.stages[0].name and scene.initial is None
    level = np.unique([z for _, profile in given.each for z, _, _ in profile])
    velocity = np.array([_at_levels(np.array(profile), level) for _, profile in given.each])
    if given.history is None:
        return SteadyCurrent(level, velocity[0], grows)
    time, runs = np.array([each.time for each in given.history]), isinstance(stage, DynamicStage)
    return ChangingCurrent(level, time, velocity, wave_clock(scene, stage), runs, grows)


def _at_levels(profile: Array, level: Array) -> Array:
    """Velocity (m, 2) of a profile (n, 3) at the levels (m,), its own among them."""
    return np.stack([np.interp(level, profile[:, 0], profile[:, 1 + i]) for i in range(2)], axis=-1)


def _waves(scene: Scene, stage: Stage) -> WaveField | SteadyFlow:
    assert scene.water is not None
    assert scene.water.waves is not None
    assert scene.water.surface_level is not None
    waves, level = scene.water.waves, scene.water.surface_level
    times = waves.ramp, wave_clock(scene, stage), wave_age(scene, stage)
    if waves.regular is not None:
        from riser_soil.sea.steady_flow import SteadyFlow

        wave = steady_wave_of(waves.regular, scene.gravity, scene.water_depth)
        return SteadyFlow(wave, waves.regular.toward[0], math.radians(waves.regular.phase_deg), level, *times)
    from riser_soil.sea.waves import WaveField

    components = components_of(scene)
    assert components is not None
    return WaveField(components, scene.water_depth, level, waves.stretching or "wheeler", *times)
