"""Scene language: static, quasi-static and dynamic stages with their moves, motions, loads and time schemes."""

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Annotated, Literal, Self, TypeVar

from pydantic import BaseModel, Discriminator, Field, Tag, model_validator

from riser_soil.core.quantities import (
    FROZEN,
    NEAREST,
    ArcLength,
    AutoOrTime,
    Factor,
    Force,
    ForcePerLength,
    Instant,
    Length,
    Moment,
    NonNegative,
    OneOf,
    Position,
    Pressure,
    Ratio,
    Real,
    Text,
    Time,
    by_key,
    registry,
    word_or_number,
    wrong,
)
from riser_soil.scene.motions import Motion

Place = Annotated[
    Annotated[Literal["start", "end"], Tag("<word>")] | Annotated[ArcLength, Tag("<number>")],
    Discriminator(
        word_or_number, custom_error_type="choice", custom_error_message="must be start, end or an arc [m]"
    ),
]


class VaryingLoad(BaseModel):
    """What loads have in common: how they vary, and whether they stay."""

    model_config = FROZEN

    force: Force | None = Field(default=None, description="point force [Fx, Fy, Fz] [N]")
    moment: Moment | None = Field(
        default=None, description="point moment about fixed axes [Mx, My, Mz] [N.m]"
    )
    history: tuple[tuple[Instant, Factor], ...] | None = Field(
        default=None,
        description="factor on the load, linear between [[t, factor], ...]: t in seconds since the stage "
        "began (in a static stage the part of the stage, 0 to 1); by default static loads grow linearly "
        "from 0 to 1, and quasi-static and dynamic loads have the factor 1 throughout",
    )
    keep: Literal[True, False] = Field(
        default=False,
        description="whether the load stays, as large as at its stage's end, in all stages that follow",
    )

    @model_validator(mode="after")
    def _history_runs_forward(self) -> Self:
        times = [t for t, _ in self.history or ()]
        if self.history is not None and len(times) < 2:
            raise wrong("history", "must have at least two points", "write [[t, factor], [t, factor]]")
        if any(b - a < NEAREST for a, b in pairwise(times)):
            allowed = f"times must increase, by {NEAREST:g} at least"
            raise wrong("history", allowed, "sort the points [t, factor] by t")
        return self

    def kept_after(self, stage_end: float) -> Self:
        """The load as it stays after a stage that ended at a time [s] (static: 1)."""
        factor = 1.0 if self.history is None else _between(self.history, stage_end)
        return self.model_copy(update={"history": ((0.0, factor), (1.0, factor))})


class Load(VaryingLoad):
    """A load on the riser in global axes; it acts during its stage."""

    at: Place | None = Field(
        default=None,
        description="where force and moment act: start, end or arc length [m]; not for distributed",
    )
    distributed: ForcePerLength | None = Field(
        default=None, description="force per unstressed length along the whole riser [qx, qy, qz] [N/m]"
    )

    @model_validator(mode="after")
    def _acts_somewhere(self) -> Self:
        at_a_point = self.force is not None or self.moment is not None
        if not at_a_point and self.distributed is None:
            raise wrong("force", "the load is missing", "give force [N], moment [N.m] or distributed [N/m]")
        if at_a_point and self.at is None:
            raise wrong("at", "force and moment need a place", "give at: start, end or an arc length [m]")
        if self.distributed is not None and self.at is not None:
            remedy = "write it as a load of its own" if at_a_point else "leave out at"
            raise wrong("at", "a distributed load acts along the whole riser, not at a place", remedy)
        return self


class BodyLoad(VaryingLoad):
    """A load on a body at the origin of its axes, in global axes; it acts during its stage."""

    @model_validator(mode="after")
    def _is_there(self) -> Self:
        if self.force is None and self.moment is None:
            raise wrong("force", "the load is missing", "give force [N] or moment [N.m]")
        return self


class OfBody(BaseModel):
    """What happens to a body in a stage."""

    model_config = FROZEN

    loads: tuple[BodyLoad, ...] = Field(default=(), description="loads on it during this stage")


def _between(points: tuple[tuple[float, float], ...], t: float) -> float:
    """Linear between points (t, value), constant beyond them."""
    if t <= points[0][0]:
        return points[0][1]
    for (a, before), (b, after) in pairwise(points):
        if t <= b:
            return before + (after - before) * (t - a) / (b - a)
    return points[-1][1]


class MovedEnds(BaseModel):
    """New prescribed positions of ends, reached linearly with the stage's load factor."""

    model_config = FROZEN

    start: Position | None = Field(default=None, description="new position of the start, [x, y, z] [m]")
    end: Position | None = Field(default=None, description="new position of the end, [x, y, z] [m]")


class OfLine(BaseModel):
    """What happens to one of several lines in a stage."""

    model_config = FROZEN

    move: MovedEnds | None = Field(
        default=None, description="new prescribed positions of its ends in a static stage, {start, end}"
    )
    motion: Motion | None = Field(default=None, description="prescribed motions of its ends, {start, end}")
    loads: tuple[Load, ...] = Field(default=(), description="loads on it during this stage")


class NewmarkParameters(BaseModel):
    """Newmark's parameters."""

    model_config = FROZEN

    beta: Ratio = Field(default=0.25, le=1.0, description="Newmark's beta [-]")
    gamma: Real = Field(default=0.5, ge=0.5, le=1.0, description="Newmark's gamma [-]")


class NewmarkScheme(BaseModel):
    """Newmark's scheme."""

    model_config = FROZEN

    newmark: NewmarkParameters = Field(description="beta and gamma")


class GeneralizedAlphaParameters(BaseModel):
    """Parameter of the generalised-alpha scheme."""

    model_config = FROZEN

    rho_inf: NonNegative = Field(default=0.8, le=1.0, description="spectral radius at infinite frequency [-]")


class GeneralizedAlphaScheme(BaseModel):
    """The generalised-alpha scheme of Chung and Hulbert (1993)."""

    model_config = FROZEN

    generalized_alpha: GeneralizedAlphaParameters = Field(description="rho_inf")


class MidpointParameters(BaseModel):
    """The midpoint rule has no parameters."""

    model_config = FROZEN


class MidpointScheme(BaseModel):
    """The implicit midpoint rule, which keeps linear and angular momentum."""

    model_config = FROZEN

    midpoint: MidpointParameters = Field(description="no parameters: {}")


Scheme = Annotated[
    Annotated[NewmarkScheme, Tag("<NewmarkScheme>")]
    | Annotated[GeneralizedAlphaScheme, Tag("<GeneralizedAlphaScheme>")]
    | Annotated[MidpointScheme, Tag("<MidpointScheme>")],
    Discriminator(
        by_key(
            {"newmark": NewmarkScheme, "generalized_alpha": GeneralizedAlphaScheme, "midpoint": MidpointScheme}
        ),
        custom_error_type="choice",
        custom_error_message="must be {newmark: {beta, gamma}}, {generalized_alpha: {rho_inf}} or {midpoint: {}}",
    ),
]


_KIND = "static, quasi-static or dynamic"
_LOADS = "loads on the riser during this stage"
_OF_LINES = "what happens to each of several lines, {name: {move, motion, loads}}"
_OF_BODIES = "what happens to each body, {name: {loads}}"
_PRESSURE = "gauge pressure of the contents at pressure_level from this stage on [Pa]; by default as it was before"


class StaticStage(BaseModel):
    """Equilibrium without inertia or drag."""

    model_config = FROZEN

    name: Text = Field(min_length=1, description="name of the stage, different from the others")
    kind: Literal["static"] = Field(description=_KIND)
    move: MovedEnds | None = Field(default=None, description="new prescribed positions of ends, {start, end}")
    loads: tuple[Load, ...] = Field(default=(), description=_LOADS)
    lines: dict[str, OfLine] = Field(default={}, description=_OF_LINES)
    bodies: dict[str, OfBody] = Field(default={}, description=_OF_BODIES)
    pressure: Pressure | None = Field(
        default=None, description=f"{_PRESSURE}; it changes linearly over a static stage"
    )

    @property
    def end(self) -> float:
        """Load factor at the stage's end."""
        return 1.0


class QuasiStaticStage(BaseModel):
    """Equilibria one after another along motions and loads, without inertia, damping or rates.

    t, in which motions and loads are given, only tells their order: seconds, or a count such as that of cycles.
    """

    model_config = FROZEN

    name: Text = Field(min_length=1, description="name of the stage, different from the others")
    kind: Literal["quasi-static"] = Field(description=_KIND)
    duration: Time = Field(description="t at the stage's end, as its tables count: in seconds or otherwise")
    time_step: AutoOrTime = Field(
        default="auto",
        description="longest step of t, or auto: from row to row of tables and load histories and 24 to a period, in "
        "as many steps as a static stage would take, on soil that yields none that presses by more than 1/160 of the "
        "diameter; either way rows are hit",
    )
    motion: Motion | None = Field(
        default=None, description="prescribed motions of ends, {start, end}; tables are straight between their rows"
    )
    loads: tuple[Load, ...] = Field(default=(), description=_LOADS)
    lines: dict[str, OfLine] = Field(default={}, description=_OF_LINES)
    bodies: dict[str, OfBody] = Field(default={}, description=_OF_BODIES)
    pressure: Pressure | None = Field(default=None, description=_PRESSURE)

    @model_validator(mode="after")
    def _lasts_a_step(self) -> Self:
        _at_most(self.time_step, self.duration)
        return self

    @property
    def end(self) -> float:
        """t at the stage's end."""
        return self.duration


def _at_most(time_step: float | Literal["auto"], duration: float) -> None:
    """A step within its stage, or an error."""
    if time_step != "auto" and time_step > duration:
        allowed = f"must not exceed the stage's duration ({duration:g} s)"
        raise wrong("time_step", allowed, "take a smaller time_step or a longer duration")


class DynamicStage(BaseModel):
    """Motion in time with inertia."""

    model_config = FROZEN

    name: Text = Field(min_length=1, description="name of the stage, different from the others")
    kind: Literal["dynamic"] = Field(description=_KIND)
    duration: Time = Field(description="duration [s]")
    time_step: AutoOrTime = Field(
        description="time step [s], or auto: as long as each step's local error stays within tolerance; such steps "
        "hit the output times, the ends of ramps and the bends of load histories"
    )
    tolerance: Length | None = Field(
        default=None,
        description="with time_step: auto, the largest local error of a step: an estimate of how far any node of the "
        "riser is off its path after this one step [m]; by default 0.02 of its outer diameter",
    )
    motion: Motion | None = Field(default=None, description="prescribed motions of ends, {start, end}")
    loads: tuple[Load, ...] = Field(default=(), description=_LOADS)
    lines: dict[str, OfLine] = Field(default={}, description=_OF_LINES)
    bodies: dict[str, OfBody] = Field(default={}, description=_OF_BODIES)
    pressure: Pressure | None = Field(default=None, description=_PRESSURE)
    scheme: Scheme = Field(
        default=GeneralizedAlphaScheme(generalized_alpha=GeneralizedAlphaParameters()),
        description="{newmark: {beta, gamma}}, {generalized_alpha: {rho_inf}} or {midpoint: {}}",
    )

    @model_validator(mode="after")
    def _lasts_a_step(self) -> Self:
        _at_most(self.time_step, self.duration)
        return self

    @model_validator(mode="after")
    def _tolerates_only_when_it_chooses(self) -> Self:
        if self.tolerance is not None and self.time_step != "auto":
            remedy = "write time_step: auto, or leave tolerance out"
            raise wrong("tolerance", "steps of a given size have no tolerance", remedy)
        return self

    @property
    def end(self) -> float:
        """Time at the stage's end [s]."""
        return self.duration


KINDS = registry(StaticStage, QuasiStaticStage, DynamicStage)
TimedStage = QuasiStaticStage | DynamicStage
"""Stages along t, with motions of the ends."""
Stage = Annotated[StaticStage | QuasiStaticStage | DynamicStage, OneOf(KINDS)]


Given = TypeVar("Given", bound=VaryingLoad)


def loads_in(stages: Sequence[Stage], stage: Stage) -> tuple[Load, ...]:
    """The loads of a stage, with those that earlier stages keep."""
    return _with_kept(stages, stage, lambda each: each.loads)


def loads_on_body(stages: Sequence[Stage], stage: Stage, name: str) -> tuple[BodyLoad, ...]:
    """The loads on a body in a stage, with those that earlier stages keep."""
    return _with_kept(stages, stage, lambda each: each.bodies[name].loads if name in each.bodies else ())


def _with_kept(stages: Sequence[Stage], stage: Stage, of: Callable[[Stage], tuple[Given, ...]]) -> tuple[Given, ...]:
    names = [each.name for each in stages]
    before = stages[: names.index(stage.name)] if stage.name in names else ()
    kept = (load.kept_after(each.end) for each in before for load in of(each) if load.keep)
    return (*kept, *of(stage))


def varying_in(stage: Stage) -> list[VaryingLoad]:
    """All loads that a stage itself has: on its riser, or one of its lines, and on bodies."""
    return [*stage.loads, *(load for body in stage.bodies.values() for load in body.loads)]


def pressure_in(stages: Sequence[Stage], stage: Stage, t: float, first: float) -> float:
    """Pressure inside [Pa] at a time of a stage, t, by that of the contents at first: it changes with a static stage's
    load factor, and at once where another one begins.
    """
    names = [each.name for each in stages]
    before = stages[: names.index(stage.name)] if stage.name in names else ()
    given = [first, *(each.pressure for each in before if each.pressure is not None)][-1]
    if stage.pressure is None:
        return given
    return given + (t if isinstance(stage, StaticStage) else 1.0) * (stage.pressure - given)
