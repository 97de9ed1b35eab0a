"""Contact between the riser and the seabed or the soil."""

from typing import Annotated, Literal

from pydantic import BaseModel, Discriminator, Field, Tag

from riser_soil.scene.quantities import FROZEN, NonNegative, Positive


def _pick_stiffness(value: object) -> str | None:
    return "<word>" if isinstance(value, str) else "<number>"


Stiffness = Annotated[
    Annotated[Literal["auto"], Tag("<word>")] | Annotated[Positive, Tag("<number>")],
    Discriminator(
        _pick_stiffness, custom_error_type="choice", custom_error_message="must be auto or a number"
    ),
]


class Contact(BaseModel):
    """Penalty contact at the riser's nodes."""

    model_config = FROZEN

    method: Literal["node"] = Field(
        default="node", description="where contact is evaluated: at the riser's nodes"
    )
    stiffness: Stiffness = Field(
        default="auto", description="force per length of pipe and penetration [N/m2], or auto"
    )
    smoothing: NonNegative = Field(
        default=1.0e-3, description="half width of the smooth onset of contact, in penetration [m]"
    )
