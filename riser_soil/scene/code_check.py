"""Scene language: code checks, each of one code on the line types that it names."""

from collections.abc import Iterable
from itertools import pairwise
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, Discriminator, Field, Tag, model_validator

from riser_soil.core.quantities import (
    FROZEN,
    Length,
    LengthOrNone,
    NonNegative,
    OneOf,
    Part,
    PoissonRatio,
    PositiveWeightPerLength,
    Pressure,
    Ratio,
    Real,
    Stress,
    StressOrNone,
    Tension,
    Text,
    registry,
    word_or_number,
    wrong,
)
from riser_soil.scene.files import NamedFolder

LEAST_OVALITY = 0.005  # DNV-OS-F201 (2010) sec. 5
LEAST_SLENDER, MOST_SLENDER = 15.0, 45.0  # D/t for which formulas of collapse and propagation were fitted
_OF_ACCIDENTS = ("SLS", "ALS")

OrContents = Annotated[
    Annotated[Literal["contents"], Tag("<word>")] | Annotated[Pressure, Tag("<number>")],
    Discriminator(
        word_or_number, custom_error_type="choice", custom_error_message="must be contents or a number"
    ),
]


DesignCase = Literal["operating", "extreme", "survival"]


class Check(BaseModel):
    """What all checks have: the line types to which they belong."""

    model_config = FROZEN

    kind: str
    line_types: Annotated[tuple[Text, ...], Field(min_length=1)] | None = Field(
        default=None, description="names of the line types that are checked; all by default"
    )

    def applies_to(self, line_type: str) -> bool:
        """Whether a line type is checked."""
        return self.line_types is None or line_type in self.line_types


class SteelCheck(Check):
    """A check of a steel pipe: its material, its wall and the pressures that it is designed for."""

    yield_stress: Stress = Field(description="specified minimum yield strength, SMYS [Pa]")
    yield_derating: StressOrNone = Field(default=0.0, description="loss of yield strength by temperature [Pa]")
    corrosion_allowance: LengthOrNone = Field(description="corrosion allowance: loss of wall thickness [m]")
    design_pressure: Pressure | None = Field(
        default=None,
        description="design pressure inside at contents.pressure_level [Pa]; by default the pressure of the run",
    )
    minimum_pressure: OrContents = Field(
        default=0.0,
        description="minimum pressure inside, against pressure outside [Pa]: 0 of an empty pipe, or contents: that of "
        "the run",
    )

    @property
    def thinning(self) -> float:
        """Amount by which the wall may be thinner than nominal [m]."""
        return self.corrosion_allowance

    @model_validator(mode="after")
    def _yields(self) -> Self:
        _require_below("yield_derating", self.yield_derating, self.yield_stress)
        return self


def _require_below(key: str, loss: float, strength: float) -> None:
    if loss >= strength:
        raise wrong(key, f"must be below the strength ({strength:g} Pa)", "lower it")


class ResistanceCheck(SteelCheck):
    """A check of pressures and combined loads against resistances of the pipe, by bursting and collapse among them."""

    tensile_strength: Stress = Field(description="specified minimum tensile strength, SMTS [Pa]")
    tensile_derating: StressOrNone = Field(default=0.0, description="loss of tensile strength by temperature [Pa]")
    E: Stress = Field(default=2.07e11, description="Young's modulus of the wall [Pa]")
    nu: PoissonRatio = Field(default=0.3, description="Poisson's ratio of the wall [-]")

    @model_validator(mode="after")
    def _tensile_above_yield(self) -> Self:
        if self.tensile_strength < self.yield_stress:
            allowed = f"must not be below yield_stress ({self.yield_stress:g} Pa)"
            raise wrong("tensile_strength", allowed, "correct one of the two")
        _require_below("tensile_derating", self.tensile_derating, self.tensile_strength)
        return self


class DnvCheck(ResistanceCheck):
    """DNV-ST-F201, load and resistance factor design."""

    kind: Literal["dnv-st-f201"] = Field(description="the code")
    limit_state: Literal["SLS", "ULS", "ALS", "FLS"] = Field(
        default="ULS", description="limit state, by which load effect and material factors go"
    )
    safety_class: Literal["low", "normal", "high"] = Field(description="safety class")
    material_factor: Ratio | None = Field(
        default=None, ge=1.0, description="material resistance factor [-]; by limit_state by default, needed for SLS"
    )
    material_strength_factor: Part = Field(
        default=0.96, description="alpha_U, on yield and tensile strength; 1 with supplementary requirement U [-]"
    )
    fabrication_factor: Part = Field(
        default=0.85, description="alpha_fab, on the yield strength in hoop compression: 1 of seamless pipe [-]"
    )
    fabrication_tolerance: LengthOrNone = Field(
        description="fabrication tolerance: by how much the wall may be thinner than nominal [m]"
    )
    ovality: Annotated[float, Field(strict=True, ge=LEAST_OVALITY, le=0.03)] = Field(
        default=LEAST_OVALITY, description="initial (D_max - D_min)/D, 0.005 to 0.03 [-]"
    )
    incidental_ratio: Annotated[Ratio, Field(ge=1.0)] = Field(
        default=1.1, description="incidental over design pressure [-]"
    )
    functional_stage: Text | None = Field(
        default=None,
        description="stage at whose end load effects are functional; what later stages add is environmental; the last "
        "static stage by default",
    )
    functional_run: NamedFolder | None = Field(
        default=None,
        description="run with the functional load effects at its end; the result folder of the same line without "
        "current and offset, in place of functional_stage; sought beside the scene file",
    )
    accidental_stage: Text | None = Field(
        default=None,
        description="stage of which what it adds to the functional load effects is accidental; in SLS and ALS; none by "
        "default",
    )

    @property
    def thinning(self) -> float:
        return self.corrosion_allowance + self.fabrication_tolerance

    @model_validator(mode="after")
    def _factors_known(self) -> Self:
        if self.limit_state == "SLS" and self.material_factor is None:
            raise wrong("material_factor", "is not built in for SLS", "give it, or take another limit_state")
        if self.accidental_stage is not None and self.limit_state not in _OF_ACCIDENTS:
            allowed = f"there is no factor for accidental load effects in {self.limit_state}"
            raise wrong("accidental_stage", allowed, "take limit_state ALS or SLS, or leave it out")
        if self.functional_stage is not None and self.functional_run is not None:
            raise wrong("functional_run", "is given beside functional_stage", "give one of the two")
        if self.accidental_stage is not None and self.functional_stage is None and self.functional_run is None:
            allowed = "needs to know which load effects are functional"
            raise wrong("accidental_stage", allowed, "give functional_stage, a stage before it, or functional_run")
        return self


class ApiCheck(ResistanceCheck):
    """API STD 2RD: burst, collapse, and combined loads by one of two methods."""

    kind: Literal["api-std-2rd"] = Field(description="the code")
    case: DesignCase = Field(description="design case")
    method: Literal[1, 2] = Field(default=1, description="method for combined loads")
    design_factor: Part | None = Field(
        default=None,
        description="design factor of combined loads [-]; by case by default: 0.8, 0.8 and 1, and 0.9 in survival "
        "under an external overpressure above half of the collapse pressure",
    )
    burst_factor: Part = Field(description="design factor of bursting, for the case [-]")
    collapse_factor: Part = Field(description="design factor of collapse, for the case [-]")
    wall_variability: Part = Field(default=0.45, description="k of the burst pressure: 0.45 of pipe by API 5L [-]")


class ApiStressCheck(SteelCheck):
    """API RP 2RD: von Mises' stress of the wall against two thirds of the yield stress, times the case factor."""

    kind: Literal["api-rp-2rd"] = Field(description="the code")
    case: DesignCase = Field(description="design case, with a case factor of 1, 1.2 or 1.5")
    fabrication_tolerance: LengthOrNone = Field(
        description="fabrication tolerance: by how much the wall may be thinner than nominal, for the hoop stress [m]"
    )

    @property
    def thinning(self) -> float:
        return self.corrosion_allowance + self.fabrication_tolerance


class FlexiblePipeCheck(Check):
    """Limits of a flexible pipe, as its maker states them."""

    kind: Literal["flexible-pipe"] = Field(description="the code")
    storage_radius: Length | None = Field(default=None, description="least bend radius in storage [m]")
    static_radius: Length | None = Field(default=None, description="least bend radius in static service [m]")
    dynamic_radius: Length | None = Field(default=None, description="least bend radius in motion [m]")
    max_tension: Tension | None = Field(default=None, description="largest effective tension allowed [N]")
    max_compression: Tension | None = Field(default=None, description="largest effective compression allowed [N]")
    max_contact_force: PositiveWeightPerLength | None = Field(
        default=None, description="largest force of the ground per length of pipe, against crushing [N/m]"
    )

    @model_validator(mode="after")
    def _limits_in_order(self) -> Self:
        names = ("storage_radius", "static_radius", "dynamic_radius")
        radii = [(name, radius) for name in names if (radius := getattr(self, name)) is not None]
        for (before, less), (name, more) in pairwise(radii):
            if more < less:
                raise wrong(name, f"must not be below {before} ({less:g} m)", "correct one of the two")
        if not (radii or self.max_tension or self.max_compression or self.max_contact_force):
            limits = "storage_radius, static_radius, dynamic_radius, max_tension, max_compression or max_contact_force"
            raise wrong("kind", "checks nothing without a limit", f"give {limits}")
        return self

    @property
    def bends(self) -> bool:
        """Whether the bend radius is limited."""
        return self.radius(moving=True) is not None

    def radius(self, moving: bool) -> float | None:
        """Least bend radius [m] in a dynamic stage or another one; the largest that is given where that is not."""
        own = self.dynamic_radius if moving else self.static_radius
        given = [each for each in (self.storage_radius, self.static_radius, self.dynamic_radius) if each is not None]
        return own if own is not None else max(given, default=None)


class CapacityCurveCheck(Check):
    """Tension and curvature that an umbilical or cable bears together."""

    kind: Literal["capacity-curve"] = Field(description="the code")
    curve: Annotated[tuple[tuple[Real, NonNegative], ...], Field(min_length=2)] = Field(
        description="[[tension [N], curvature [1/m]], ...], tensions growing from 0, or from the largest compression, "
        "negative"
    )

    @model_validator(mode="after")
    def _curve_closed(self) -> Self:
        tensions = [tension for tension, _ in self.curve]
        if any(b <= a for a, b in pairwise(tensions)):
            raise wrong("curve", "tensions must increase", "sort the points by tension")
        if tensions[0] > 0.0 or tensions[-1] <= 0.0:
            raise wrong("curve", "must reach from tension 0 or less to a tension above 0", "add the missing point")
        corners = [*([(tensions[0], 0.0)] if tensions[0] < 0.0 else []), *self.curve, (tensions[-1], 0.0)]
        if any(a != b and a[1] * b[0] - a[0] * b[1] <= 0.0 for a, b in pairwise(corners)):
            allowed = "each ray from no tension and no curvature must meet it once"
            raise wrong("curve", allowed, "give curvatures above 0, but for the ends, and no deep notches")
        return self


CHECKS: dict[str, type[Check]] = registry(DnvCheck, ApiCheck, ApiStressCheck, FlexiblePipeCheck, CapacityCurveCheck)
CHECK = OneOf(CHECKS)
CodeChecks = tuple[Annotated[Any, CHECK], ...]


def checks_steel(checks: CodeChecks, line_types: Iterable[str]) -> bool:
    """Whether any of the line types is checked as steel pipe."""
    steel = [check for check in checks if isinstance(check, SteelCheck)]
    return any(check.applies_to(name) for check in steel for name in line_types)


def checks_of(checks: CodeChecks, line_type: str) -> list[int]:
    """Numbers of the checks of a line type."""
    return [n for n, check in enumerate(checks) if check.applies_to(line_type)]
