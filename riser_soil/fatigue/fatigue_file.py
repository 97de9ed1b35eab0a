"""Fatigue file: runs with their shares of the year, S-N curve, and where on the pipe damage is found."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Literal, Self

from pydantic import BaseModel, Discriminator, Field, Tag, ValidationError, model_validator

from riser_soil.core.quantities import (
    FROZEN,
    ArcLength,
    Instant,
    Length,
    NonNegative,
    Positive,
    Ratio,
    Stress,
    Text,
    by_key,
    wrong,
)
from riser_soil.errors import SceneError
from riser_soil.fatigue.sn_curve import REFERENCE_THICKNESS, CurveClass, Environment, SNCurve, curve_through, dnv_curve
from riser_soil.results.read import Run
from riser_soil.scene.document import parse, read_text, refuse_others
from riser_soil.scene.explain import problems_in
from riser_soil.scene.reader import error_of

APART = 0.04  # of log10 N, 10 %, by which branches may miss each other: logarithms are printed to few decimals
_NEEDS = "the fatigue file is empty; it needs curve and cases"
_EXPONENT = Field(default=0.0, description="exponent k of walls thicker than reference_thickness [-]")
_REFERENCE = Field(default=REFERENCE_THICKNESS, description="thickness up to which the curve holds as it is [m]")


class DNVCurve(BaseModel):
    """A curve of DNVGL-RP-C203 by its class."""

    model_config = FROZEN

    dnv: CurveClass = Field(description="class of DNVGL-RP-C203, April 2016")
    environment: Environment = Field(description="what surrounds the wall")

    def curve(self) -> SNCurve:
        return dnv_curve(self.dnv, self.environment)


class GivenCurve(BaseModel):
    """A curve by its branches, log10 N = log_a - m log10 S with S in MPa."""

    model_config = FROZEN

    log_a: Annotated[tuple[Positive, ...], Field(min_length=1)] = Field(
        description="log10 of N at a stress range of 1 MPa, of each branch from few to many cycles"
    )
    m: Annotated[tuple[Positive, ...], Field(min_length=1)] = Field(description="negative inverse slopes [-]")
    change: tuple[Positive, ...] = Field(default=(), description="cycles at which a branch ends and the next begins")
    thickness_exponent: NonNegative = _EXPONENT
    reference_thickness: Length = _REFERENCE

    @model_validator(mode="after")
    def _branches_fit(self) -> Self:
        if not len(self.log_a) == len(self.m) == len(self.change) + 1:
            counts = f"{len(self.log_a)} log_a, {len(self.m)} m, {len(self.change)} change"
            raise wrong("m", f"branches do not fit: {counts}", "give as many log_a as m, and one change fewer")
        if any(not second > first for first, second in pairwise(self.change)):
            raise wrong("change", "cycles must grow", "sort the branches from few to many cycles")
        branches = pairwise(zip(self.log_a, self.m, strict=True))
        for N, ((log_a, m), (next_log_a, next_m)) in zip(self.change, branches, strict=True):
            log_N = math.log10(N)
            after = next_log_a - next_m * (log_a - log_N) / m
            if abs(after - log_N) > APART:
                gap = f"one ends with log10 N = {log_N:.4g}, there the next begins with {after:.4g}"
                raise wrong("change", f"branches do not meet: {gap}", "correct log_a, m or change")
        return self

    def curve(self) -> SNCurve:
        k, reference = self.thickness_exponent, self.reference_thickness
        return SNCurve("given", "given by log_a and m", self.log_a, self.m, self.change, k, reference)


class TableCurve(BaseModel):
    """A curve through points, straight in logarithms."""

    model_config = FROZEN

    table: Annotated[tuple[tuple[Positive, Stress], ...], Field(min_length=2)] = Field(
        description="points [cycles, stress range in Pa] of growing cycles; its first and last line go on beyond them"
    )
    thickness_exponent: NonNegative = _EXPONENT
    reference_thickness: Length = _REFERENCE

    @model_validator(mode="after")
    def _falls(self) -> Self:
        if any(not (N2 > N1 and S2 < S1) for (N1, S1), (N2, S2) in pairwise(self.table)):
            raise wrong("table", "cycles must grow and stress ranges fall from point to point", "sort the points")
        return self

    def curve(self) -> SNCurve:
        return curve_through(self.table, self.thickness_exponent, self.reference_thickness)


Curve = Annotated[
    Annotated[DNVCurve, Tag("<DNVCurve>")]
    | Annotated[GivenCurve, Tag("<GivenCurve>")]
    | Annotated[TableCurve, Tag("<TableCurve>")],
    Discriminator(
        by_key({"dnv": DNVCurve, "log_a": GivenCurve, "table": TableCurve}),
        custom_error_type="choice",
        custom_error_message="must be {dnv, environment}, {log_a, m, change} or {table: [[N, S], ...]}",
    ),
]


class FatigueCase(BaseModel):
    """One run, and for which part of the year it stands."""

    model_config = FROZEN

    run: Text = Field(description="folder of the run's results; a relative one is sought beside the fatigue file")
    share: Annotated[NonNegative, Field(le=1.0)] = Field(description="share of the year, its probability [-]")
    stage: Text | None = Field(default=None, description="a dynamic stage; by default the last one")
    skip: Instant | None = Field(default=None, description="beginning of the stage not counted [s]; by default skip")


class Fatigue(BaseModel):
    """A fatigue file: how the damage of load cases is found."""

    model_config = FROZEN

    curve: Curve = Field(description="S-N curve")
    cases: Annotated[tuple[FatigueCase, ...], Field(min_length=1)] = Field(description="runs with their shares")
    stress_concentration: Ratio = Field(default=1.0, description="factor on the stress ranges, SCF [-]")
    surface: Literal["outer", "inner"] = Field(default="outer", description="surface of the wall: outer or inner")
    points: Annotated[int, Field(strict=True, ge=4, le=360)] = Field(
        default=16, description="points around the section, at equal angles from its y axis"
    )
    thickness: Length | None = Field(
        default=None, description="thickness for the curve's correction [m]; by default the wall's own"
    )
    arcs: tuple[ArcLength, ArcLength] | None = Field(
        default=None, description="stretch of the riser, [from, to] [m]; by default all of it"
    )
    skip: Instant = Field(default=0.0, description="beginning of each stage that is not counted, its transient [s]")
    load_classes: Annotated[int, Field(strict=True, ge=16, le=1_000_000)] = Field(
        default=4096, description="classes between the least and the largest stress that turns are sorted into"
    )
    design_life: Positive | None = Field(default=None, description="years that the pipe must last [-]; none by default")
    design_fatigue_factor: Ratio = Field(default=1.0, description="factor on the damage in the design life, DFF [-]")

    @model_validator(mode="after")
    def _shares_of_one_year(self) -> Self:
        total = self.total_share
        if total > 1.0 + 1e-9:
            raise wrong("cases", f"have shares of {total:.6g} in all, more than a year", "let them add up to at most 1")
        return self

    @property
    def total_share(self) -> float:
        return math.fsum(case.share for case in self.cases)


def read_fatigue_file(file: Path) -> Fatigue:
    """The fatigue file; SceneError has one line per problem found."""
    document = refuse_others(parse(read_text(file), str(file), _NEEDS), "fatigue file")
    try:
        return Fatigue.model_validate(document.data)
    except ValidationError as err:
        raise error_of(problems_in(err, document.data, Fatigue), document) from err


def run_folder(file: Path, case: FatigueCase) -> Path:
    """A case's folder, or RUN/LINE of a run of several lines; relative ones lie beside the fatigue file."""
    folder = file.parent / case.run
    if not (folder.is_dir() or Run.is_there(folder)):
        raise SceneError(f"{file}: cases: there is no folder {folder}; run the case first, or correct its name")
    return folder
