"""Assembly of waves: those of a scene, drawn once, and their flow in a stage."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, assert_never

import numpy as np

from riser_soil.errors import SceneError
from riser_soil.scene.water import Waves
from riser_soil.scene.wave_kinds import Airy, GivenSpectrum, Jonswap, PiersonMoskowitz, Record, Regular, WaveKind
from riser_soil.sea import components, spectra
from riser_soil.sea.components import Components
from riser_soil.sea.waves import WaveField, linear_waves

if TYPE_CHECKING:
    from riser_soil.sea.steady_flow import SteadyFlow
    from riser_soil.sea.steady_wave import SteadyWave


@dataclass(eq=False)
class DrawnWaves:
    """Waves under a gravity [m/s2] in water of a depth [m], inf where it has no bottom."""

    given: Waves
    gravity: float
    depth: float

    @cached_property
    def components(self) -> Components:
        """All trains together, of a wave of finite height its first harmonic."""
        return components.joined([self._train(train, number) for number, (_, train) in enumerate(self.given.each)])

    @cached_property
    def regular(self) -> SteadyWave | None:
        """The wave of finite height, where they are one; SceneError where there is no such wave."""
        if self.given.regular is None:
            return None
        from riser_soil.sea.steady_wave import steady_wave

        train = self.given.regular
        try:
            return steady_wave(train.theory, train.height, train.period, self.gravity, self.depth)
        except SceneError as err:
            raise SceneError(f"water.waves.regular.{err}") from err

    def flow(self, level: float, clock: float, age: float) -> WaveField | SteadyFlow:
        """The flow below a mean surface at z = level [m], in a stage that begins at a time of the waves' clock [s], at
        which they have acted for a while [s] without a break.
        """
        times = self.given.ramp, clock, age
        if self.given.regular is None:
            return linear_waves(self.components, self.depth, level, self.given.stretching or "wheeler", *times)
        from riser_soil.sea.steady_flow import steady_flow

        wave, train = self.regular, self.given.regular
        assert wave is not None
        return steady_flow(wave, train.toward[0], math.radians(train.phase_deg), level, *times)

    def _train(self, train: WaveKind, number: int) -> Components:
        """Waves of one train; seas of the same seed differ by the train's number."""
        g, h = self.gravity, self.depth
        match train:
            case Regular():
                wave = self.regular
                assert wave is not None
                parts = 0.5 * train.height, wave.w, wave.k, train.toward[0], math.radians(train.phase_deg)
                return Components(*(np.array([part]) for part in parts))
            case Airy():
                angles = math.radians(train.direction_deg), math.radians(train.phase_deg)
                return components.regular(train.height, train.period, *angles, g, h)
            case Record():
                elevation = np.array(train.record.elevation)
                return spectra.recorded(
                    elevation, train.record.step, train.harmonics, train.position, train.toward[0], g, h
                )
            case Jonswap() | PiersonMoskowitz():
                gamma = train.gamma if isinstance(train, Jonswap) else 1.0
                seed, toward = _seed(train.seed, number), np.array(train.toward)
                return spectra.components(train.Hs, train.Tp, gamma, train.components, seed, toward, g, h)
            case GivenSpectrum():
                w, density = np.array(train.table.frequency), np.array(train.table.density)
                seed, toward = _seed(train.seed, number), np.array(train.toward)
                by_direction = np.array(train.table.parts) if train.table.parts else None
                return spectra.components_of_spectrum(w, density, train.components, seed, toward, g, h, by_direction)
        assert_never(train)


def _seed(seed: int, number: int) -> list[int]:
    return [seed, number] if number else [seed]
