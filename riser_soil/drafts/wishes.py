"""What a draft is asked for: kinds of drafts with their defaults, questions, and what can't be."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from riser_soil.drafts.pipes import CrossSection, chain, flexible, steel
from riser_soil.errors import SceneError

GROUNDS = ("spring", "rigid", "hysteretic")
STEEPNESS = 4.3  # default Tp/sqrt(Hs) [s/m^0.5], between DNV-RP-C205's 3.6 and 5
Prompt = Callable[..., Any]


@dataclass(frozen=True)
class Kind:
    """A kind of line.

    pipe: its cross-section from diameter, wall and mass. depth, diameter [m], Hs [m]: defaults. angle: of the line at
    its top from the vertical [rad]; 0: it stands upright. laid: length on the seabed, over the depth. floats: whether
    a stretch of it is buoyant.
    """

    title: str
    pipe: Callable[[float, float | None, float | None], CrossSection]
    depth: float
    diameter: float
    Hs: float
    angle: float = 0.0
    laid: float = 0.0
    floats: bool = False

    @property
    def hangs(self) -> bool:
        """Whether it comes down on the seabed."""
        return self.angle > 0.0


KINDS = {
    "steel-catenary": Kind("Steel catenary riser", steel, 1000.0, 0.273, 3.0, math.radians(12.0), 0.25),
    "flexible": Kind("Free-hanging flexible riser", flexible, 100.0, 0.30, 2.0, math.radians(10.0), 0.4),
    "lazy-wave": Kind("Lazy wave", flexible, 150.0, 0.26, 4.0, math.radians(12.0), 0.3, floats=True),
    "top-tensioned": Kind("Top-tensioned riser", steel, 500.0, 0.34, 4.0),
    "mooring": Kind("Mooring line", chain, 150.0, 0.10, 4.0, math.radians(45.0), 0.8),
}


def kind_of(name: str) -> Kind:
    """The kind by its name, or SceneError."""
    if name not in KINDS:
        raise SceneError(f'new "{name}": must be one of {", ".join(KINDS)}')
    return KINDS[name]


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
        reported = f"in water, with its contents, this weighs {pipe.weight:.4g} N/m and floats"
        raise SceneError(
            f"--diameter {diameter:g}: {reported}; give more --mass or, to a pipe of steel, a thicker --wall"
        )
    return pipe


def ask(given: Wishes, prompt: Prompt) -> tuple[str, Wishes]:
    """The kind, and the wishes with answers to what is not given.

    prompt: text, default -> answer, of the default's type.
    """
    name = prompt(f"kind ({', '.join(KINDS)})", default=next(iter(KINDS)))
    kind = kind_of(name)
    questions: dict[str, tuple[str, float | str]] = {
        "depth": ("depth of the water [m]", kind.depth),
        "diameter": ("outer diameter, of chain that of its bar [m]", kind.diameter),
        "Hs": ("significant wave height, 0 for none [m]", kind.Hs),
    }
    if kind.hangs:
        questions["ground"] = (f"ground ({', '.join(GROUNDS)})", GROUNDS[0])
    open_ones = {key: question for key, question in questions.items() if getattr(given, key) is None}
    return name, replace(given, **{key: prompt(text, default=value) for key, (text, value) in open_ones.items()})
