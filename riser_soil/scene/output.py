"""Scene language: what a run writes, and at which intervals."""

from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import BaseModel, Field

from riser_soil.core import outputs
from riser_soil.core.quantities import FROZEN, ArcLength, Length, LengthOrNone, Text, Time

ALL_FIELDS = outputs.choices()
if TYPE_CHECKING:
    FieldName = str
else:
    FieldName = Literal[ALL_FIELDS]


class SettlementSections(BaseModel):
    """Sections across the riser in which the settlement of the soil's surface is recorded."""

    model_config = FROZEN

    arcs: Annotated[tuple[ArcLength, ...], Field(min_length=1)] | None = Field(
        default=None,
        description="arc lengths of the riser where it lies over the sections at the end of the static stages [m]; by "
        "default one section, at the touchdown point",
    )
    half_width: Length | None = Field(
        default=None, description="length of a section to either side [m]; by default three outer diameters"
    )
    points: Annotated[int, Field(strict=True, ge=3, le=10_000)] = Field(
        default=61, description="points of a section, at equal distances"
    )


class Checkpoint(BaseModel):
    """Checkpoints, from which a run goes on after it was interrupted, killed, or cut off from power or disk space."""

    model_config = FROZEN

    every: Time = Field(default=600.0, description="wall time between checkpoints [s]")
    keep: Literal[True, False] = Field(
        default=False,
        description="whether a finished run keeps the state at its end, which another scene can begin with: "
        "initial: {from: RUN}",
    )


class Clearance(BaseModel):
    """A pair of lines whose least distance is recorded."""

    model_config = FROZEN

    between: tuple[Text, Text] = Field(description="names of the two lines")
    beyond: LengthOrNone = Field(
        default=0.0, description="arc length from the joints of a line within which it does not count [m]"
    )

    @property
    def key(self) -> str:
        """Its name in the results."""
        return "_".join(self.between)


class Output(BaseModel):
    """Intervals and fields of the result files."""

    model_config = FROZEN

    interval: Time | None = Field(
        default=None, description="time between records in results.nc [s]; every accepted step by default"
    )
    xdmf_interval: Time | None = Field(
        default=None,
        description="time between records of riser and soil for ParaView, VTKHDF and XDMF [s]; as interval by default",
    )
    fields: tuple[FieldName, ...] = Field(
        default=ALL_FIELDS, description="fields to record beside the positions; all by default"
    )
    soil_fields: tuple[Text, ...] = Field(
        default=(),
        description="further fields of the soil's cells for ParaView: the tensors stress, effective_stress, strain and "
        "plastic_strain, histories (all of the law), or single ones of these by name; none by default",
    )
    sections: SettlementSections = Field(
        default=SettlementSections(), description="where settlement_across is recorded, with soil"
    )
    clearance: tuple[Clearance, ...] = Field(
        default=(), description="pairs of lines whose least distance is recorded, {between, beyond}; none by default"
    )
    checkpoint: Checkpoint | None = Field(
        default=Checkpoint(),
        description="checkpoints, {every, keep}; every 600 s of wall time by default, none with null",
    )
    directory: Text | None = Field(
        default=None,
        description="result folder; by default named after the scene file, in the current folder",
    )
