"""Consistency checks of water, current and waves with the rest of a scene."""

import math
from collections.abc import Iterator
from typing import assert_never

from riser_soil.scene.problem import Problem
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage
from riser_soil.scene.water import Waves
from riser_soil.scene.wave_kinds import Airy, GivenSpectrum, Jonswap, PiersonMoskowitz, Record, Regular, WaveKind

# A wave breaks at the latest at this height over its length, times tanh kh (Miche 1944).
_BREAKING = 0.142
_LOWER = "lower the waves or lengthen their period"
_LATE = 1e-9  # part of a record's duration by which the stages may be longer


def water_conflicts(scene: Scene) -> Iterator[Problem]:
    """Conflicts of surface and waves with seabed and gravity."""
    if scene.water is None or scene.water.surface_level is None:
        return
    if scene.has_ground and scene.water.surface_level <= scene.seabed_level:
        allowed = f"must lie above the seabed (z = {scene.seabed_level:g} m)"
        yield Problem(("water", "surface_level"), allowed, "raise it, lower the seabed, or leave out water")
    elif scene.water.waves is not None:
        yield from _possible(scene, scene.water.waves)


def _possible(scene: Scene, waves: Waves) -> Iterator[Problem]:
    """Waves that can't exist are no sea at all; steep ones are a doubt."""
    if scene.gravity == 0.0:
        yield Problem(("water", "waves"), "there are no waves without gravity", "give gravity, or leave out waves")
        return
    for path, train in waves.each:
        if isinstance(train, Regular):  # solved for as it is; where there is none, that is told
            continue
        if train.height > (highest := _highest(scene.gravity, scene.water_depth, train.period)):
            which = f"waves of {train.period:.4g} s{_where(scene.water_depth)}"
            allowed = f"must not exceed {highest:.4g} m: higher {which} break"
            yield Problem(("water", "waves", *path, *_height_key(train)), allowed, _LOWER)
        if isinstance(train, Record) and train.record.duration * (1.0 + _LATE) < (acting := _acting(scene)):
            allowed = f"{train.file} lasts {train.record.duration:.6g} s, but waves act for {acting:.6g} s in all"
            yield Problem(("water", "waves", *path, "file"), allowed, "shorten the stages, or take a longer record")


def _height_key(train: WaveKind) -> tuple[str, ...]:
    match train:
        case Airy() | Regular():
            return ("height",)
        case Jonswap() | PiersonMoskowitz():
            return ("Hs",)
        case GivenSpectrum() | Record():
            return ("file",)
    assert_never(train)


def _acting(scene: Scene) -> float:
    """Duration of all dynamic stages [s]."""
    return math.fsum(stage.duration for stage in scene.stages if isinstance(stage, DynamicStage))


def _highest(g: float, h: float, period: float) -> float:
    """A bound of Miche's limit that needs no wave length L: L tanh kh = g T^2/2 pi tanh^2 kh, and is below 2 pi h."""
    return _BREAKING * min(g * period**2 / (2.0 * math.pi), 2.0 * math.pi * h)


def _where(h: float) -> str:
    return f" in {h:g} m of water" if math.isfinite(h) else ""
