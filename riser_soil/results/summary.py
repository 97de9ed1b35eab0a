"""summary.json: what a run was, how each stage ended, and the extremes on the way."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.saved_state import Saved, gathered, give_back, packed, under, unpacked, values_of, within
from riser_soil.core.snapshot import Ledger, RiserSnapshot, RunFacts, StepHealth, Touch
from riser_soil.results.folder import write_atomically

_END = (("position", 3), ("force", 3), ("moment", 3), ("effective_tension", 1), ("angle_deg", 1))
_WHOLE = (
    ("touchdown_arc", 1),
    ("touchdown_position", 3),
    ("touchdown_points", 1),
    ("max_bending_moment", 1),
    ("max_curvature", 1),
    ("min_bend_radius", 1),
    ("max_bend_utilisation", 1),
    ("min_effective_tension", 1),
    ("min_wall_tension", 1),
    ("max_wall_tension", 1),
    ("max_penetration", 1),
    ("max_embedment", 1),
    ("contact_force", 1),
)
# Left out where the pressures are unknown, no bend radius is given, and embedment is not wanted.
_SOMETIMES = ("min_wall_tension", "max_wall_tension", "max_bend_utilisation", "max_embedment")
# Where each number of the packed vector of observables belongs in the nested summary.
_PLACES: tuple[tuple[tuple[str, ...], int], ...] = (
    *((("start", name), size) for name, size in _END),
    *((("end", name), size) for name, size in _END),
    *(((name,), size) for name, size in _WHOLE),
)
_NOT_PLAIN = ("extremes", "energy", "worst_residual", "tightest", "doubts")
DOUBTFUL = 0.01  # share of the energy turned over above which what is wrong in its balance is a warning


def angle_deg(tangent: Array) -> float:
    """Angle of a tangent (3,) from the horizontal [deg]; positive where the riser rises with its arc."""
    return math.degrees(math.atan2(tangent[2], math.hypot(tangent[0], tangent[1])))


def pack(riser: RiserSnapshot, touch: Touch) -> Array:
    """All observables of one instant as one vector, in the order of the summary."""
    tension, wall, position = riser.effective_tension, riser.wall_tension, riser.position
    start_angle, end_angle = angle_deg(riser.start_tangent), angle_deg(riser.end_tangent)
    return np.concatenate([
        position[0], riser.start_force, riser.start_moment, [tension[0], start_angle],
        position[-1], riser.end_force, riser.end_moment, [tension[-1], end_angle],
        [touch.touchdown_arc, *touch.touchdown_position, touch.touchdown_points],
        [riser.bending_moment.max(), riser.curvature.max(), bend_radius(riser.curvature.max())],
        [riser.bend_utilisation.max(), tension.min(), wall.min(), wall.max(), touch.max_penetration],
        [math.nan if touch.embedment is None else touch.embedment.max(), touch.contact_force[2]],
    ])  # fmt: skip


def bend_radius(curvature: float) -> float:
    """Radius [m] of a curvature [1/m]; infinite for a straight pipe."""
    return float(1.0 / curvature) if curvature > 0.0 else math.inf


def unpack(vector: Array) -> dict[str, Any]:
    """The nested form of a packed vector: scalars as numbers, vectors as lists."""
    nested: dict[str, Any] = {}
    first = 0
    for path, size in _PLACES:
        values = [float(x) for x in vector[first : first + size]]
        _put(nested, path, values if size > 1 else values[0])
        first += size
    return nested


def final_state(arc: Array, riser: RiserSnapshot, touch: Touch) -> dict[str, Any]:
    """The summary's `final`: the observables, with the arc length [m] of those that sit on one node."""
    final = unpack(pack(riser, touch))
    for name, where in (
        ("max_bending_moment", riser.bending_moment.argmax()),
        ("max_curvature", riser.curvature.argmax()),
        ("min_bend_radius", riser.curvature.argmax()),
        ("max_bend_utilisation", riser.bend_utilisation.argmax()),
        ("min_effective_tension", riser.effective_tension.argmin()),
        ("min_wall_tension", riser.wall_tension.argmin()),
        ("max_wall_tension", riser.wall_tension.argmax()),
    ):
        final[name] = {"value": final[name], "arc": float(arc[where])}
    if touch.embedment is not None:
        final["max_embedment"] = {"value": final["max_embedment"], "arc": float(arc[touch.embedment.argmax()])}
    return {name: value for name, value in final.items() if name not in _SOMETIMES or _known(value)}


def _known(value: Any) -> bool:
    return math.isfinite(value["value"] if isinstance(value, dict) else value)


def energy_warnings(ledger: Ledger, worst: float, t: float) -> Iterator[str]:
    """worst: largest residual on the way [J], at time t [s]."""
    allowed = DOUBTFUL * ledger.turned_over
    if abs(worst) > allowed:
        yield (
            f"the energy balance is {worst:.3g} J off at {t:.5g} s, {abs(worst) / ledger.turned_over:.2%} of the "
            f"{ledger.turned_over:.3g} J turned over, and {ledger.residual:.3g} J at the end: take a smaller time_step"
        )
    if abs(ledger.numerical) > allowed:
        done, own = ("took out" if ledger.numerical > 0.0 else "put in"), abs(ledger.numerical)
        yield (
            f"the time scheme {done} {own:.3g} J, {own / ledger.turned_over:.2%} of the {ledger.turned_over:.3g} J "
            "turned over: take a smaller time_step"
        )


class Extremes:
    """Smallest and largest of every observable, with their times; nan does not count."""

    def __init__(self) -> None:
        size = sum(n for _, n in _PLACES)
        self._least, self._most = np.full(size, np.inf), np.full(size, -np.inf)
        self._t_least, self._t_most = np.full(size, np.nan), np.full(size, np.nan)

    def update(self, t: float, vector: Array) -> None:
        """t: s (static stages: load factor); vector: from `pack`."""
        less, more = vector < self._least, vector > self._most
        self._least[less], self._most[more] = vector[less], vector[more]
        self._t_least[less], self._t_most[more] = t, t

    def nested(self) -> dict[str, Any]:
        """{min, max, t_min, t_max} at each observable's place; vectors by component."""
        columns = {"min": self._least, "max": self._most, "t_min": self._t_least, "t_max": self._t_most}
        parts = {key: unpack(values) for key, values in columns.items()}
        nested: dict[str, Any] = {}
        for path, _ in _PLACES:
            if path[0] not in _SOMETIMES or math.isfinite(parts["min"][path[0]]):
                _put(nested, path, {key: _get(part, path) for key, part in parts.items()})
        return nested

    def state(self) -> Saved:
        return values_of(self)

    def restore(self, saved: Saved) -> None:
        vars(self).update({name: value.copy() for name, value in saved.items()})


@dataclass(frozen=True)
class Bend:
    """Where and when the pipe is bent most for what is allowed: radius m, arc m, t s or load factor."""

    utilisation: float = 0.0
    radius: float = math.inf
    arc: float = math.nan
    t: float = math.nan

    def warnings(self, unit: str) -> Iterator[str]:
        if self.utilisation > 1.0:
            yield (
                f"the pipe is bent beyond its min_bend_radius: {self.utilisation:.4g} times what is allowed at arc "
                f"{self.arc:.5g} m and {self.t:.5g} {unit}, where the bend radius is {self.radius:.4g} m"
            )


@dataclass
class StageTally:
    """What is gathered of one stage while it runs. time: s simulated in it (0 in statics)."""

    name: str
    kind: str
    time: float = 0.0
    steps: int = 0
    newton_iterations: int = 0
    most_newton_iterations: int = 0
    step_cuts: int = 0
    relaxations: int = 0
    branch_switches: int = 0
    final: dict[str, Any] | None = None
    extremes: Extremes = field(default_factory=Extremes)
    energy: Ledger = field(default_factory=Ledger)
    tightest: Bend = Bend()
    worst_residual: tuple[float, float] = (0.0, math.nan)  # of the energy balance [J], and its time [s]
    doubts: tuple[str, ...] = ()  # what is not plausible about the riser's shape, forces and surroundings

    def balance(self, t: float, ledger: Ledger) -> None:
        """t: s, total simulated time."""
        self.energy = ledger
        if abs(ledger.residual) > abs(self.worst_residual[0]):
            self.worst_residual = ledger.residual, t

    def bend(self, t: float, arc: Array, riser: RiserSnapshot) -> None:
        """t: s (static stages: load factor)."""
        at = int(riser.bend_utilisation.argmax())
        used = float(riser.bend_utilisation[at])
        if used > self.tightest.utilisation:
            self.tightest = Bend(used, bend_radius(riser.curvature[at]), float(arc[at]), t)

    def count(self, health: StepHealth) -> None:
        self.steps += 1
        self.newton_iterations += health.newton_iterations
        self.most_newton_iterations = max(self.most_newton_iterations, health.newton_iterations)
        self.step_cuts += health.step_cuts

    @property
    def method(self) -> str | None:
        """What it took to find the equilibria of a static stage."""
        if self.kind != "static":
            return None
        if self.relaxations:
            return "relaxation"
        return "load steps" if self.step_cuts else "newton"

    def as_dict(self) -> dict[str, Any]:
        plain = {k: v for k, v in vars(self).items() if k not in _NOT_PLAIN}
        extremes = self.extremes.nested() if self.steps else None
        return plain | {"method": self.method, "extremes": extremes, "energy": self._energy, "warnings": self.warnings}

    @property
    def _energy(self) -> dict[str, Any]:
        worst, t = self.worst_residual
        worst_residual = {"value": worst if self.kind == "dynamic" else math.nan, "time": t}
        relative = self.energy.relative_residual
        return asdict(self.energy) | {"relative_residual": relative, "worst_residual": worst_residual}

    @property
    def warnings(self) -> list[str]:
        """What is doubtful about the stage's results, with numbers and a remedy."""
        off = energy_warnings(self.energy, *self.worst_residual) if self.kind == "dynamic" else ()
        return [*self.tightest.warnings("s" if self.kind == "dynamic" else "of the load"), *self.doubts, *off]

    def state(self) -> Saved:
        plain = {name: value for name, value in vars(self).items() if name != "extremes"}
        told = plain | {"energy": asdict(self.energy), "tightest": asdict(self.tightest)}
        return gathered({"extremes": self.extremes}) | {"told": packed(told)}

    def restore(self, saved: Saved) -> None:
        vars(self).update(unpacked(saved["told"]))
        give_back({"extremes": self.extremes}, saved)
        self.energy, self.tightest = Ledger(**vars(self)["energy"]), Bend(**vars(self)["tightest"])
        worst, t = self.worst_residual
        self.worst_residual, self.doubts = (worst, t), tuple(self.doubts)


class Summary:
    """Keeps the whole summary and writes it."""

    def __init__(self, facts: RunFacts) -> None:
        self.finished = False
        self.laying: dict[str, float] | None = None  # how a slack riser was laid before the stages
        self.stages: list[StageTally] = []
        self.seconds: Counter[str] = Counter()
        self._facts = facts

    def as_dict(self) -> dict[str, Any]:
        """The summary as it goes into the file, before nan becomes null."""
        facts = self._facts
        return {
            "title": facts.title,
            "finished": self.finished,
            "version": facts.version,
            "ranks": facts.ranks,
            "parts": {"built": list(facts.built), "left_out": dict(facts.left_out)},
            "dofs": {"riser": facts.riser_dofs, "soil": facts.soil_dofs},
            "stages": [stage.as_dict() for stage in self.stages],
            "seconds": dict(self.seconds),
            **({"laying": self.laying} if self.laying is not None else {}),
        }

    def write(self, path: Path) -> None:
        write_atomically(path, json.dumps(plain_json(self.as_dict()), indent=2, allow_nan=False) + "\n")

    def state(self) -> Saved:
        stages = gathered({str(n): stage for n, stage in enumerate(self.stages)})
        return under("stages", stages) | {"laying": packed(self.laying), "seconds": packed(self.seconds)}

    def restore(self, saved: Saved) -> None:
        self.laying, self.seconds = unpacked(saved["laying"]), Counter(unpacked(saved["seconds"]))
        stages = within(saved, "stages")
        self.stages = [StageTally("", "") for name in stages if name.endswith("/told")]
        give_back({str(n): stage for n, stage in enumerate(self.stages)}, stages)


def plain_json(value: Any) -> Any:
    """The same value in JSON's terms: plain numbers; null for nan and infinities, which JSON lacks."""
    if isinstance(value, Mapping):
        return {str(key): plain_json(v) for key, v in value.items()}
    if isinstance(value, list | tuple | np.ndarray):
        return [plain_json(v) for v in value]
    if isinstance(value, np.generic):
        return plain_json(value.item())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def _put(nested: dict[str, Any], path: tuple[str, ...], value: Any) -> None:
    *outer, last = path
    for key in outer:
        nested = nested.setdefault(key, {})
    nested[last] = value


def _get(nested: dict[str, Any], path: tuple[str, ...]) -> Any:
    value: Any = nested
    for key in path:
        value = value[key]
    return value
