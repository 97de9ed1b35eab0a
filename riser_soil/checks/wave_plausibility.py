"""Plausibility of waves: too steep for linear theory, or in a water depth that is not the scene's."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from riser_soil.scene.problem import dotted
from riser_soil.scene.scene import Scene
from riser_soil.scene.wave_kinds import Airy, Regular, WaveKind
from riser_soil.sea.components import wave_number

if TYPE_CHECKING:
    from riser_soil.assembly.waves import DrawnWaves

# Height over Miche's breaking height from which linear theory is well off: Stokes's crests are a tenth higher there.
STEEP = 0.5
# Ursell's number H L^2/h^3 from which waves in shallow water are cnoidal.
SHALLOW = 40.0
# Theories of regular waves in words.
NAMES = {"airy": "linear theory", "stokes": "Stokes's theory of fifth order", "stream-function": "stream function"}
# Part by which a given depth may differ from the height of the surface above the seabed.
OTHER_DEPTH = 0.05


def wave_warnings(scene: Scene) -> Iterator[str]:
    """Warnings about the waves, each with its numbers."""
    assert scene.water is not None
    assert scene.water.waves is not None
    waves, h = scene.water.waves, scene.water_depth
    for path, train in waves.each:
        k = float(wave_number(np.array([2.0 * np.pi / train.period]), scene.gravity, h)[0])
        place = dotted(("water", "waves", *path))
        if isinstance(train, Regular):
            continue
        if isinstance(train, Airy):
            yield from _steep(place, train, k, h)
        else:
            yield from _steep_sea(place, scene.gravity, train)
        yield from _shallow(train, k, h)
    yield from _other_depth(scene)
    if not scene.has_dynamic_stage:
        yield "water.waves: waves act in dynamic stages, and no stage is dynamic: nothing will come of them"


def regular_wave_theory(waves: DrawnWaves) -> Iterator[str]:
    """The theory and shape of a regular wave of finite height, where the waves are one."""
    wave, given = waves.regular, waves.given.regular
    if wave is None or given is None:
        return
    from riser_soil.sea.steady_wave import highest

    share = given.height / highest(wave.length, waves.depth)
    yield (
        f"waves: {NAMES[wave.theory]}: {wave.length:.4g} m long, crest {wave.crest:.4g} m above and trough "
        f"{wave.trough:.4g} m below the mean surface, {share:.0%} of the height at which it breaks"
    )


def _steep(place: str, wave: Airy, k: float, h: float) -> Iterator[str]:
    """Miche's limit (1944): H = 0.142 L tanh kh."""
    length = 2.0 * np.pi / k
    breaking = 0.142 * length * np.tanh(k * h)
    if wave.height > STEEP * breaking:
        yield (
            f"{place}: H = {wave.height:g} m over L = {length:.4g} m is steep: {wave.height / breaking:.2g} "
            f"of the height at which such waves break, {breaking:.4g} m; linear theory gives them too low crests"
        )


def _steep_sea(place: str, g: float, sea: WaveKind) -> Iterator[str]:
    """Limit of a sea's steepness in DNV-RP-C205: 1/15 up to Tp = 8 s, 1/25 from 15 s on."""
    steepness = 2.0 * np.pi * sea.height / (g * sea.period**2)
    limit = float(np.interp(sea.period, [8.0, 15.0], [1.0 / 15.0, 1.0 / 25.0]))
    if steepness > limit:
        yield (
            f"{place}: the steepness 2 pi Hs/(g Tp^2) = {steepness:.3g} is more than seas with a peak at "
            f"{sea.period:.4g} s reach, {limit:.3g}: that is Hs = {sea.height * limit / steepness:.3g} m"
        )


def _shallow(waves: WaveKind, k: float, h: float) -> Iterator[str]:
    ursell = waves.height * (2.0 * np.pi / k) ** 2 / h**3
    if ursell > SHALLOW:
        yield (
            f"water.waves: in {h:g} m of water Ursell's number H L^2/h^3 = {ursell:.3g} is above {SHALLOW:g}: such "
            "waves have sharper crests and flatter troughs than linear theory gives them"
        )


def _other_depth(scene: Scene) -> Iterator[str]:
    assert scene.water is not None
    assert scene.water.surface_level is not None
    if scene.water.depth is None or not scene.has_ground:
        return
    down = scene.water.surface_level - scene.seabed_level
    if abs(scene.water.depth - down) > OTHER_DEPTH * down:
        yield (
            f"water.depth is {scene.water.depth:g} m, but the surface lies {down:.6g} m above the seabed: leave depth "
            "out, or correct surface_level or seabed.level"
        )
