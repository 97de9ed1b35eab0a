"""Wave components: a sea state as a sum of long-crested linear waves, and their dispersion relation."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array


def wave_number(w: Array, g: float, h: float) -> Array:
    """Wave numbers k [rad/m] of angular frequencies w [rad/s] in water of depth h [m], which may be inf.

    Root of w^2 = g k tanh k h: Guo's explicit formula (Coastal Engineering 45, 2002, 71-74), wrong by 0.75 % at most,
    and Newton's method from there to round-off.
    """
    deep = w * w / g
    if np.isinf(h):
        return deep
    y = deep * h
    x = y * (-np.expm1(-(y**1.245))) ** (-1.0 / 2.490)
    for _ in range(3):
        tanh = np.tanh(x)
        x = x - (x * tanh - y) / (tanh + x * (1.0 - tanh * tanh))
    return x / h


class Components(NamedTuple):
    """Waves (n,): amplitude a [m], angular frequency w [rad/s], wave number k [rad/m], direction towards which they
    travel [rad] from x towards y, and phase [rad].

    The surface rises by the sum of a cos(k (x cos direction + y sin direction) - w t + phase); x, y from the global
    origin, t from the beginning of the run's first dynamic stage.
    """

    amplitude: Array
    frequency: Array
    wave_number: Array
    direction: Array
    phase: Array


def joined(seas: Sequence[Components]) -> Components:
    """Several seas that add up."""
    return Components(*(np.concatenate(parts) for parts in zip(*seas, strict=True)))


def drawn(draw: np.random.Generator, variance: float, w: Array, toward: Array, g: float, h: float) -> Components:
    """Waves of the same amplitude with increasing frequencies w (n,) [rad/s], and phases drawn evenly; the sum of a^2/2
    is the variance [m2].

    toward: directions (m,) [rad], n being a multiple of m: each m neighbours get one each, in an order that is drawn.
    """
    phase = 2.0 * np.pi * draw.random(w.size)
    direction = np.full(w.size, toward[0])
    if toward.size > 1:
        direction = np.concatenate([draw.permutation(toward) for _ in range(w.size // toward.size)])
    return alike(variance, w, direction, phase, g, h)


def alike(variance: float, w: Array, direction: Array, phase: Array, g: float, h: float) -> Components:
    """Waves of the same amplitude; the sum of a^2/2 is the variance [m2]."""
    return Components(np.sqrt(2.0 * variance / w.size) * np.ones(w.size), w, wave_number(w, g, h), direction, phase)


def regular(height: float, period: float, direction: float, phase: float, g: float, h: float) -> Components:
    """A single wave from trough to crest of `height` [m], with `period` [s], in water of depth h [m]; angles in rad."""
    w = np.array([2.0 * np.pi / period])
    return Components(np.array([0.5 * height]), w, wave_number(w, g, h), np.array([direction]), np.array([phase]))
