"""Scene language: settings of the nonlinear solver."""

from typing import Annotated, Literal

from pydantic import BaseModel, Field

from riser_soil.core.quantities import FROZEN, AutoOrTime, Count, Ratio, SolverTolerance


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
        description="the code that solves the steps; compiled: a riser alone by loops of its own, that over time steps "
        "compiled, and all else by PETSc's SNES; snes: SNES throughout, with the same results",
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
