"""Settings of Newton's method, and when it stops by them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

from riser_soil.solve.convergence import StopLimits

MOST_JOINTS = 32  # beyond it a sparse matrix of lines and bodies, which PETSc solves, is cheaper than bands
REUSE = 0.1
BESIDE_CLAY = 0.02  # the same of the tangent of all else beside clay, whose curves take most of the iterations


@dataclass(frozen=True)
class NewtonSettings:
    """tolerance: of the residual's norm, relative to the norm of the forces in play, moments over the
    system's lever.

    floor [N]: the norm that counts as zero, for round-off of a scene whose forces all vanish.
    reuse: an iteration that leaves less than this share of the residual leaves its factorised tangent to the next of
    the same step (Shamanskii's method), as long as each leaves less than this share: two or three such iterations cost
    less than one with its own tangent. Only in time steps without contact, which start near their end: contact has
    corners, and an equilibrium may be far away. Beside clay the line solver reuses the tangent of all else, see
    `convergence.StopLimits`. least_iterations: before a residual counts as small.
    line_search: shorten steps that lead far beyond the least energy, see `line_search`. linear_start: begin a step
    with the linear response to it, instead of the guess. linear: "direct" factorises each tangent, "kept" keeps
    factors as preconditioners, see `kept_factors`, "iterative" does without those of the soil, see `iterative_solver`,
    "auto" keeps factors in large systems. snes: let PETSc's SNES solve a riser alone, too. petsc_options: names without
    prefix and values, see `petsc_options`. has_soil: whether the scene has soil, be it in systems after this one.
    """

    tolerance: float
    max_iterations: int
    floor: float
    reuse: float = REUSE
    least_iterations: int = 0
    line_search: bool = False
    linear_start: bool = False
    linear: Literal["auto", "kept", "direct", "iterative"] = "auto"
    snes: bool = False
    petsc_options: tuple[tuple[str, bool | int | float | str | None], ...] = ()
    has_soil: bool = False


@lru_cache(maxsize=8)
def limits_of(
    settings: NewtonSettings, starts_near: bool, gradual: bool, floor_at_start: bool, step_over_trial: float = 1.0
) -> StopLimits:
    """The settings are of the balance by the increments of the whole step, the limits by those to the trial.

    starts_near: whether the guess continues a smooth motion, as in time steps without contact. The tangent can be
    reused, and one iteration is a must: a motion that continues by its first guess alone would keep its errors.
    gradual: see `System`; step_over_trial: see `Scheme`.
    """
    beside = BESIDE_CLAY if gradual else 0.0
    return StopLimits(
        settings.tolerance / step_over_trial,
        settings.floor / step_over_trial,
        settings.reuse if starts_near else beside,
        settings.max_iterations,
        max(settings.least_iterations, int(starts_near)),
        floor_at_start,
    )
