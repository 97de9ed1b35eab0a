"""What a draft is asked for: kinds of drafts with their defaults, questions, and what can't be."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from riser_soil.drafts.pipes import CrossSection, chain, flexible, steel
from riser_soil.errors import SceneError
from riser_soil.scene.pipe_sizes import DIAMETER
from riser_soil.scene.size import Size, number_of
from riser_soil.scene.sizes import KEYS

WALL = Size(1e-4, 0.25, "m", DIAMETER.others)
GROUNDS = ("spring", "rigid", "hysteretic")
CLAY = GROUNDS[2]
VERTICAL = 80.0  # deg: the largest angle at the top; a line that hangs flatter is pulled taut
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

    angle: at the top, from the vertical [deg]. su [Pa], gradient [Pa/m]: of clay. contents: their density [kg/m3], 0
    for none. yield_stress [Pa], min_bend_radius [m], max_tension [N]: what the pipe may bear. rao: the file of the
    vessel's RAOs, as the scene names it. None: by rule, or by the kind.
    """

    depth: float | None = None
    diameter: float | None = None
    wall: float | None = None
    mass: float | None = None
    Hs: float | None = None
    Tp: float | None = None
    current: float = 0.0
    ground: str | None = None
    angle: float | None = None
    su: float | None = None
    gradient: float | None = None
    contents: float | None = None
    yield_stress: float | None = None
    min_bend_radius: float | None = None
    max_tension: float | None = None
    rao: str | None = None

    @property
    def bed(self) -> str:
        """The kind of ground: clay where its strength is given."""
        return self.ground or (GROUNDS[0] if self.su is None and self.gradient is None else CLAY)


class SeaState(NamedTuple):
    """depth [m], significant height [m] (0: no waves), peak period [s], current at the surface [m/s]."""

    depth: float
    Hs: float
    Tp: float
    current: float


def refuse(wishes: Wishes, kind: Kind) -> None:
    """SceneError for numbers that are none, for two that contradict each other, and for words that are unknown."""
    for name, value in _positive(wishes).items():
        if value is not None and not 0.0 < value < math.inf:
            raise SceneError(f"--{name} {value:g}: must be greater than 0")
    or_none = {"hs": (wishes.Hs, "waves"), "contents": (wishes.contents, "contents")}
    for name, (value, what) in or_none.items():
        if value is not None and not 0.0 <= value < math.inf:
            raise SceneError(f"--{name} {value:g}: must be 0, for no {what}, or more")
    if not math.isfinite(wishes.current):
        raise SceneError(f"--current {wishes.current:g}: must be a velocity [m/s]")
    if wishes.angle is not None and wishes.angle > VERTICAL:
        raise SceneError(f"--angle {wishes.angle:g}: must be at most {VERTICAL:g}: it counts from the vertical [deg]")
    if wishes.rao is not None and wishes.Hs == 0.0:
        raise SceneError("--rao: the vessel follows the waves, and --hs is 0; leave out one of the two")
    _refuse_ground(wishes, kind)


def _positive(wishes: Wishes) -> dict[str, float | None]:
    """Numbers that are greater than 0, by the names of their options."""
    of_line = {"depth": wishes.depth, "diameter": wishes.diameter, "wall": wishes.wall, "mass": wishes.mass}
    allowed = {"yield-stress": wishes.yield_stress, "max-tension": wishes.max_tension}
    allowed["min-bend-radius"] = wishes.min_bend_radius
    others = {"tp": wishes.Tp, "angle": wishes.angle, "su": wishes.su, "gradient": wishes.gradient}
    return of_line | allowed | others


def doubts_of(wishes: Wishes) -> list[str]:
    """Options whose numbers look like those of another unit, each with the likely one: a refusal may follow from it."""
    sizes = {
        "depth": (wishes.depth, KEYS["water", "depth"]),
        "diameter": (wishes.diameter, DIAMETER),
        "wall": (wishes.wall, WALL),
        "hs": (wishes.Hs, KEYS["water", "waves", "jonswap", "Hs"]),
        "tp": (wishes.Tp, KEYS["water", "waves", "jonswap", "Tp"]),
        "angle": (wishes.angle, KEYS["riser", "end", "hang_off", "angle"]),
    }
    return [f"--{name} {text}" for name, (value, size) in sizes.items() if (text := size.doubt(number_of(value)))]


def _refuse_ground(wishes: Wishes, kind: Kind) -> None:
    if wishes.ground not in (None, *GROUNDS):
        raise SceneError(f'--ground "{wishes.ground}": must be one of {", ".join(GROUNDS)}')
    clay = {"su": wishes.su, "gradient": wishes.gradient}
    for name, value in {"ground": wishes.ground, "angle": wishes.angle, **clay}.items():
        if value is not None and not kind.hangs:
            does = f"a {kind.title.lower()} stands upright and does not lie on the ground"
            raise SceneError(f"--{name} {_in_words(value)}: {does}; leave it out")
    for name, value in clay.items():
        if value is not None and wishes.bed != CLAY:
            raise SceneError(f"--{name} {value:g}: is of clay, and --ground is {wishes.ground}; take --ground {CLAY}")


def _in_words(value: float | str) -> str:
    return value if isinstance(value, str) else f"{value:g}"


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
    pipe = _allowed(kind, kind.pipe(diameter, wishes.wall, wishes.mass), wishes)
    if pipe.weight <= 0.0:
        problem = f"in water, with its contents, this weighs {pipe.weight:.4g} N/m and floats"
        raise SceneError(
            f"--diameter {diameter:g}: {problem}; give more --mass or, to a pipe of steel, a thicker --wall"
        )
    return pipe


def _allowed(kind: Kind, pipe: CrossSection, wishes: Wishes) -> CrossSection:
    """The pipe with its contents and what it may bear; SceneError where it has no such thing."""
    given = {key: getattr(wishes, key) for key in ("contents", "yield_stress", "min_bend_radius", "max_tension")}
    lacks = {
        "contents": ("no bore", pipe.inner == 0.0),
        "yield_stress": ("no metal wall", pipe.yield_stress is None),
        "min_bend_radius": ("no bending stiffness", pipe.EI == 0.0),
    }
    for key, (what, lacking) in lacks.items():
        if given[key] is not None and lacking:
            option = key.replace("_", "-")
            raise SceneError(f"--{option} {given[key]:g}: a {kind.title.lower()} has {what}; leave it out")
    return replace(pipe, **{key: value for key, value in given.items() if value is not None})


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
