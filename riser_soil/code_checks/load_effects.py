"""Load effects on sections: functional, environmental and accidental apart, and their design values.

A load effect is what loads bring about in a section: effective tension, and the bending moments about its two axes.
Functional ones are those at rest, environmental ones what motion, waves and current add, accidental ones what an
accident adds. Factors weigh each before the effects are summed (DNV-OS-F201 (2010) table 5-2).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array


class LoadFactors(NamedTuple):
    """Factors on functional, environmental and accidental load effects."""

    functional: float
    environmental: float
    accidental: float


class SectionEffects(NamedTuple):
    """Effective tension [N] and moments about the section's y and z axis [N m], each (..., n)."""

    tension: Array
    moment_y: Array
    moment_z: Array


class LoadEffects(NamedTuple):
    """Load effects of one kind each."""

    functional: SectionEffects
    environmental: SectionEffects
    accidental: SectionEffects

    @property
    def all(self) -> SectionEffects:
        """Sum of the effects without factors."""
        return SectionEffects(*(F + E + A for F, E, A in zip(*self, strict=True)))


def design_effects(effects: LoadEffects, factors: LoadFactors) -> tuple[Array, Array]:
    """Design values of the bending moment, its size [N m], and of the effective tension, its size [N].

    An effect that reduces the sum counts with one over its factor: the largest of all four sums is the design value,
    of moment and tension apart. Source: DNV-OS-F201 (2010) table 5-2, notes 1 and 2; the same in DNV-OS-C501 (2013)
    table 8-4.
    """
    moment = tension = np.zeros(())
    for functional in {factors.functional, 1.0 / factors.functional}:
        for environmental in {factors.environmental, 1.0 / factors.environmental}:
            T, My, Mz = (
                functional * F + environmental * E + factors.accidental * A for F, E, A in zip(*effects, strict=True)
            )
            moment, tension = np.maximum(moment, np.hypot(My, Mz)), np.maximum(tension, np.abs(T))
    return moment, tension
