"""Scene language: the offset of the vessel that lines hang from."""

from typing import Annotated, Any

from pydantic import BaseModel, BeforeValidator, Field

from riser_soil.core.quantities import FROZEN, Coordinate, Position, Text


def _in_space(value: Any) -> Any:
    """A horizontal offset is one at no height."""
    return [*value, 0.0] if isinstance(value, list | tuple) and len(value) == 2 else value


Offset = Annotated[
    Position, BeforeValidator(_in_space, json_schema_input_type=Position | tuple[Coordinate, Coordinate])
]


class OffsetVessel(BaseModel):
    """The vessel, platform or buoy that lines hang from, displaced as a whole from where the scene has it.

    The first stage, which is static, moves its ends by the offset, after hang-offs are found without it. Hubs and
    reference points of later motions of these ends come along.
    """

    model_config = FROZEN

    offset: Offset = Field(
        description="displacement of the vessel from its place in the scene, [dx, dy] or [dx, dy, dz] [m]"
    )
    ends: tuple[Text, ...] | None = Field(
        default=None,
        min_length=1,
        description="the ends that hang from it: start or end of the riser, of several lines NAME.start or NAME.end; "
        "by default the upper end of each line, where its position is given",
    )
