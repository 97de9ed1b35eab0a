"""What a draft is asked for, and what of it can't be."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from riser_soil.drafts.kinds import Kind
from riser_soil.drafts.pipes import CrossSection
from riser_soil.errors import SceneError

GROUNDS = ("spring", "rigid", "hysteretic")
STEEPNESS = 4.3  # default Tp/sqrt(Hs) [s/m^0.5], between DNV-RP-C205's 3.6 and 5


@dataclass(frozen=True)
class Wishes:
    """What a draft is asked for: depth, diameter, wall [m], mass [kg/m], Hs [m], Tp [s], current [m/s], kind of ground.

    None: by rule, or by the kind.
    """

    depth: float | None = None
    diameter: float | None = None
    wall: float | None = None
    mass: float | None = None
    Hs: float | None = None
    Tp: float | None = None
    current: float = 0.0
    ground: str | None = None


class SeaState(NamedTuple):
    """depth [m], significant height [m] (0: no waves), peak period [s], current at the surface [m/s]."""

    depth: float
    Hs: float
    Tp: float
    current: float


def refuse(wishes: Wishes, kind: Kind) -> None:
    """SceneError for numbers that are none, for two that contradict each other, and for words that are unknown."""
    positive = {"depth": wishes.depth, "diameter": wishes.diameter, "wall": wishes.wall, "mass": wishes.mass}
    for name, value in (positive | {"tp": wishes.Tp}).items():
        if value is not None and not 0.0 < value < math.inf:
            raise SceneError(f"--{name} {value:g}: must be greater than 0")
    if wishes.Hs is not None and not 0.0 <= wishes.Hs < math.inf:
        raise SceneError(f"--hs {wishes.Hs:g}: must be 0, for no waves, or more")
    if not math.isfinite(wishes.current):
        raise SceneError(f"--current {wishes.current:g}: must be a velocity [m/s]")
    _refuse_ground(wishes.ground, kind)


def _refuse_ground(ground: str | None, kind: Kind) -> None:
    if ground is None:
        return
    if ground not in GROUNDS:
        raise SceneError(f'--ground "{ground}": must be one of {", ".join(GROUNDS)}')
    if not kind.hangs:
        raise SceneError(f"--ground {ground}: a {kind.title.lower()} does not lie on the ground; leave it out")


def sea_of(kind: Kind, wishes: Wishes) -> SeaState:
    """The sea, as far as it is asked for."""
    Hs = kind.Hs if wishes.Hs is None else wishes.Hs
    Tp = round(STEEPNESS * math.sqrt(Hs), 1) if wishes.Tp is None else wishes.Tp
    return SeaState(kind.depth if wishes.depth is None else wishes.depth, Hs, Tp, wishes.current)


def pipe_of(kind: Kind, wishes: Wishes) -> CrossSection:
    """The cross-section, as far as it is asked for; SceneError where it floats or can't be made."""
    diameter = kind.diameter if wishes.diameter is None else wishes.diameter
    if wishes.wall is not None and 2.0 * wishes.wall >= diameter:
        raise SceneError(f"--wall {wishes.wall:g}: must be less than half the diameter, {diameter:g} m")
    pipe = kind.pipe(diameter, wishes.wall, wishes.mass)
    if pipe.weight <= 0.0:
        told = f"in water, with its contents, this weighs {pipe.weight:.4g} N/m and floats"
        raise SceneError(f"--diameter {diameter:g}: {told}; give more --mass or, to a pipe of steel, a thicker --wall")
    return pipe
