"""Scene language: the whole scene, with the state that it begins with and the solver's settings."""

import math
import re
from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, Field, model_validator
from pydantic.fields import FieldInfo

from riser_soil.core.quantities import FROZEN, AutoOrTime, Count, Gravity, Ratio, SolverTolerance, Text, wrong
from riser_soil.errors import SceneError
from riser_soil.scene.accuracy import Accuracy, with_placeholders
from riser_soil.scene.bodies import Body
from riser_soil.scene.code_check import CHECK, CodeChecks
from riser_soil.scene.contact import Contact
from riser_soil.scene.files import NamedFolder
from riser_soil.scene.joints import Joint
from riser_soil.scene.line_types import LineType
from riser_soil.scene.output import Output
from riser_soil.scene.riser import Riser, Support
from riser_soil.scene.seabed import ContactAt, Seabed, SpringSeabed, profile_height
from riser_soil.scene.soil import SoilScene
from riser_soil.scene.stages import DynamicStage, Stage
from riser_soil.scene.vessel_offset import OffsetVessel
from riser_soil.scene.water import Water

OPTION = re.compile(r"(?!riser_soil_)[a-z][a-z0-9_]*")


class Solver(BaseModel):
    """Newton's method and the cutting of its steps."""

    model_config = FROZEN

    tolerance: SolverTolerance = Field(
        default=1.0e-7,
        lt=1.0,
        description="norm of the residual at convergence, relative to the largest of the norms of support "
        "reactions, inertia and contact forces [-]",
    )
    max_iterations: Annotated[Count, Field(le=10_000)] = Field(
        default=25,
        description="Newton iterations before a step is cut; a static one goes on, up to four times as many, while "
        "its residual halves in ten [-]",
    )
    load_steps: Count = Field(
        default=1, description="equal load steps that a static stage is divided into; a step that fails is halved [-]"
    )
    min_load_step: Ratio = Field(
        default=1.0e-4,
        le=1.0,
        description="smallest part of a static stage's load before the solve fails [-]",
    )
    min_time_step: AutoOrTime = Field(
        default="auto",
        description="smallest time step before the solve fails [s], or auto: 1e-4 of the stage's time step, with "
        "automatic steps 1e-7 of its duration",
    )
    newton: Literal["snes", "compiled"] = Field(
        default="compiled",
        description="the code that solves the steps; compiled: lines and bodies on one rank by a loop of its own, "
        "all else by PETSc's SNES; snes: SNES throughout, with the same results",
    )
    petsc_options: dict[str, Any] = Field(
        default={},
        description="options of PETSc's SNES, KSP and PC by their names, as {snes_monitor: true, snes_linesearch_type: "
        "bt}; where there are some, SNES solves all steps; those of PETSC_OPTIONS, with the prefix riser_soil_, win",
    )
    soil: Literal["auto", "condensed", "whole"] = Field(
        default="auto",
        description="how linear elastic soil is solved, with the same results; condensed: once, to the part of its "
        "surface that the riser reaches; whole: all of it in each iteration; auto: condensed where that is cheaper",
    )
    linear: Literal["auto", "kept", "direct", "iterative"] = Field(
        default="auto",
        description="how the linear systems of riser and soil are solved, with the same results to the tolerance; "
        "direct: each is factorised; kept: by iterations with the factors of an earlier one, made anew where that "
        "is cheaper; iterative: by GMRES with multigrid on the soil, for soil that is too large to be factorised; "
        "auto: kept from 4000 unknowns on, soil in sections one section after the other",
    )

    @model_validator(mode="after")
    def _options_are_petscs(self) -> Self:
        for name, value in self.petsc_options.items():
            if not OPTION.fullmatch(name):
                said = f"{name} is no name of an option without its dash and the prefix riser_soil_"
                raise wrong("petsc_options", said, "write it as snes_monitor, ksp_type, pc_type, mat_mumps_icntl_14")
            if not isinstance(value, bool | int | float | str | None):
                said = f"the value of {name} is neither a number nor a word"
                raise wrong("petsc_options", said, f"write {{{name}: true}} for an option without a value")
        return self

    @property
    def by_snes(self) -> bool:
        """Whether PETSc's SNES solves all steps."""
        return self.newton == "snes" or bool(self.petsc_options)


class Initial(BaseModel):
    """The end of a finished run, in the place of the riser's initial shape and its laying."""

    model_config = FROZEN

    from_run: NamedFolder = Field(
        alias="from",
        description="result folder of a finished run of the same riser, seabed and soil whose last stage is static and "
        "whose output.checkpoint.keep is true; sought beside the scene file",
    )


class Scene(BaseModel):
    """One scene in SI units; z points up and gravity acts along -z. A part that is absent is None."""

    model_config = FROZEN

    title: Text = Field(default="untitled", description="title of the run")
    gravity: Gravity = Field(default=9.81, description="acceleration of gravity along -z [m/s2]")
    dimension: Literal["auto", 2, 3] = Field(
        default="auto",
        description="dimension of the riser's motion: 2 (in one vertical plane), 3, or auto: "
        "2 whenever nothing leaves the vertical plane; several lines move in 3, or keep to a plane along x or y by 2",
    )
    water: Water | None = Field(default=None, description="the water; none by default")
    line_types: dict[str, LineType] = Field(min_length=1, description="the kinds of pipe by name")
    riser: Riser | None = Field(default=None, description="the riser; or give lines")
    lines: dict[str, Riser] = Field(
        default={}, description="several lines by name, each with the keys of a riser; in the place of riser"
    )
    bodies: dict[str, Body] = Field(default={}, description="bodies that lines hang on, by name")
    joints: dict[str, Joint] = Field(default={}, description="joints between lines and bodies, by name")
    vessel: OffsetVessel | None = Field(
        default=None, description="the vessel's offset, {offset, ends}, after hang-offs are found; none by default"
    )
    seabed: Seabed | None = Field(default=None, description="seabed; with soil it acts outside the block")
    soil: SoilScene | None = Field(default=None, description="continuum of soil under the touchdown zone")
    contact: Contact | None = Field(
        default=None, description="contact with seabed and soil; its defaults hold when there is one of them"
    )
    initial: Initial | None = Field(
        default=None, description="{from: RUN}: begin with the end of a finished run, not with riser.initial"
    )
    stages: tuple[Stage, ...] = Field(min_length=1, description="what happens, one stage after the other")
    solver: Solver = Field(default=Solver(), description="settings of the nonlinear solver")
    output: Output = Field(default=Output(), description="what the run writes")
    code_check: CodeChecks = Field(
        default=(),
        description=f"checks by codes, a list of {CHECK.words}; none by default, and then no code check is made",
    )
    accuracy: Accuracy | None = Field(
        default=None,
        description="accuracy of all key results, as 1 % or 0.01 (0.01 to 20 %), in place of elements, time "
        "steps, the soil's mesh and the penalty: the run chooses them",
    )
    error_bars: Literal[True, False] = Field(
        default=False,
        description="whether a run estimates by coarser runs how far its key results may be off",
    )

    @model_validator(mode="before")
    @classmethod
    def _fill_what_depends_on_other_parts(cls, data: Any) -> Any:
        if not isinstance(data, dict):
            return data
        return with_placeholders(_with_initial(_with_contact(_without_nulls(data, cls.model_fields))))

    @model_validator(mode="after")
    def _one_or_several(self) -> Self:
        if self.riser is None and not self.lines:
            raise wrong("riser", "the riser is missing", "give riser, or lines: {name: ...}")
        if self.riser is not None and self.lines:
            raise wrong("lines", "riser and lines are both given", "give the riser as one of the lines")
        for key, given in (("bodies", self.bodies), ("joints", self.joints)):
            if given and self.riser is not None:
                raise wrong(key, "belong to lines, and the scene has riser", "write lines: {riser: ...} in its place")
        return self

    @property
    def line(self) -> Riser:
        """The one line of a scene with `riser`, or of one line's view; SceneError of a scene with several."""
        if self.riser is None:
            several = ", ".join(self.lines)
            raise SceneError(f"lines: this is for one line, and the scene has several ({several}): it is not there yet")
        return self.riser

    @property
    def seabed_level(self) -> float:
        """Height z of the seabed and of the soil's top face [m]; of a profile or grid that below the riser's start."""
        if self.seabed is None:
            return 0.0
        if self.seabed.profile is not None:
            return profile_height(self.seabed.profile, 0.0)
        if self.seabed.grid is None:
            return self.seabed.level
        ends = [end.position for end in (self.line.start, self.line.end) if isinstance(end, Support)]
        x, y, _ = ends[0] if ends else (0.0, 0.0, 0.0)
        return self.seabed.grid.heights.height(x, y)

    @property
    def has_ground(self) -> bool:
        """Whether the scene has a seabed or soil."""
        return self.seabed is not None or self.soil is not None

    @property
    def has_path_dependent_soil(self) -> bool:
        """Whether the scene has soil for which it matters in what steps it is strained."""
        return self.soil is not None and self.soil.path_dependent

    @property
    def has_dynamic_stage(self) -> bool:
        return any(isinstance(stage, DynamicStage) for stage in self.stages)

    @property
    def surface_strength(self) -> float | None:
        """Undrained shear strength [Pa] at the surface of the soil, else of the seabed; None where it has none."""
        if self.soil is not None:
            value = self.soil.top_law.undrained_strength(0.0)
            return None if value is None else float(value)
        strength = None if self.seabed is None else self.seabed.undrained_strength
        return None if strength is None else strength.su

    @property
    def soil_moves(self) -> bool:
        """Whether the scene has soil at large strain, whose cells move with it."""
        return self.soil is not None and not self.why_small_strain

    @property
    def why_small_strain(self) -> str:
        """Why soil is computed at small strain; empty where it is computed at large strain, or there is none."""
        if self.soil is None:
            return ""
        if self.soil.is_linear:
            return "the soil is elastic"
        if self.soil.inertia:
            return "soil with inertia is computed at small strain"
        if self.soil.forms is not None:
            return "terms of soil.forms are added at small strain"
        if self.soil.strain == "small":
            return "soil.strain: small keeps the cells where they are"
        at_nodes = self.contact is None or self.contact.at_nodes
        return "at contact.method: node cells stay where they are" if self.soil.strain == "auto" and at_nodes else ""

    @property
    def water_depth(self) -> float:
        """Depth of the water for waves [m]; inf in a scene that has neither ground nor a depth."""
        if self.water is None or self.water.surface_level is None:
            return math.inf
        if self.water.depth:
            return self.water.depth
        return self.water.surface_level - self.seabed_level if self.has_ground else math.inf

    @property
    def contact_at(self) -> ContactAt:
        """Which line of the pipe touches the seabed and the soil."""
        return self.seabed.contact_at if self.seabed else "outer"

    @property
    def largest_diameter(self) -> float:
        """Largest outer diameter of the riser's line types [m]; 0 where none has one."""
        return max((line.outer_diameter or 0.0 for line in self.used_line_types.values()), default=0.0)

    @property
    def laid_from_below(self) -> bool:
        """Whether an end may lie below the ground: springs bear at any depth, and know no history."""
        return isinstance(self.seabed, SpringSeabed) and self.soil is None

    @property
    def used_line_types(self) -> dict[str, LineType]:
        """The line types that the riser is made of, by name."""
        names = [segment.line_type for segment in self.line.segments]
        return {name: self.line_types[name] for name in names if name in self.line_types}


def _without_nulls(data: dict[str, Any], fields: Mapping[str, FieldInfo]) -> dict[str, Any]:
    """A block that is null is an absent one: so a case takes off what its base scene has. A number or word is not."""
    blocks = [key for key, field in fields.items() if isinstance(field.default, dict | tuple | BaseModel)]
    return {key: value for key, value in data.items() if value is not None or key not in blocks}


def _with_contact(data: dict[str, Any]) -> dict[str, Any]:
    """Contact has its defaults when there is something to touch."""
    touches = data.get("seabed") is not None or data.get("soil") is not None
    return {**data, "contact": {}} if touches and data.get("contact") is None else data


def _with_initial(data: dict[str, Any]) -> dict[str, Any]:
    """A line whose both ends have a place begins under gravity as a catenary."""
    falls = data.get("gravity", 9.81) != 0
    if isinstance(data.get("riser"), dict):
        data = {**data, "riser": _with_shape(data["riser"], falls, [])}
    if isinstance(lines := data.get("lines"), dict):
        joints = data["joints"].values() if isinstance(data.get("joints"), dict) else ()
        given = [point for joint in joints if isinstance(joint, dict) for point in _points(joint.get("between"))]
        shaped = {
            name: _with_shape(line, falls, [at for other, at in given if other == name]) for name, line in lines.items()
        }
        data = {**data, "lines": shaped}
    return data


def _points(between: Any) -> list[tuple[Any, Any]]:
    """Lines and places of the points of a joint."""
    points = between if isinstance(between, list | tuple) else ()
    return [(point.get("line"), point.get("at")) for point in points if isinstance(point, dict)]


def _with_shape(line: Any, falls: bool, jointed: list[Any]) -> Any:
    """jointed: places along the line, its ends by their names."""
    if not isinstance(line, dict) or line.get("initial") is not None:
        return line
    placed = all(isinstance(line.get(end), dict) or end in jointed for end in ("start", "end"))
    return {**line, "initial": "catenary" if placed and falls else "unstressed"}
