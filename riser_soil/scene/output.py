"""Scene language: what a run writes, and at which intervals."""

from typing import TYPE_CHECKING, Literal

from pydantic import BaseModel, Field

from riser_soil.core import outputs
from riser_soil.core.quantities import FROZEN, Text, Time

ALL_FIELDS = outputs.choices()
if TYPE_CHECKING:
    FieldName = str
else:
    FieldName = Literal[ALL_FIELDS]


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
