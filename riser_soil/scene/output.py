"""What a run writes."""

from typing import Literal, get_args

from pydantic import BaseModel, Field

from riser_soil.core.quantities import FROZEN, Text, Time

FieldName = Literal[
    "effective_tension",
    "wall_tension",
    "bending_moment",
    "curvature",
    "bend_utilisation",
    "contact_force",
    "penetration",
    "embedment",
    "slip",
    "moment_vector",
    "displacement",
    "von_mises_stress",
    "equivalent_plastic_strain",
]
ALL_FIELDS: tuple[FieldName, ...] = get_args(FieldName)


class Output(BaseModel):
    """Intervals and fields of the result files."""

    model_config = FROZEN

    interval: Time | None = Field(
        default=None, description="time between records in results.nc [s]; every accepted step by default"
    )
    xdmf_interval: Time | None = Field(
        default=None,
        description="time between records in riser.xdmf and soil.xdmf [s]; as interval by default",
    )
    fields: tuple[FieldName, ...] = Field(
        default=ALL_FIELDS, description="fields to record beside the positions; all by default"
    )
    directory: Text | None = Field(
        default=None,
        description="result folder; by default named after the scene file, in the current folder",
    )
