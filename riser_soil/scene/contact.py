"""Contact between the riser and the seabed or the soil."""

from typing import Annotated, Literal

from pydantic import BaseModel, Discriminator, Field, Tag

from riser_soil.scene.quantities import FROZEN, NonNegative, Positive, word_or_number

Stiffness = Annotated[
    Annotated[Literal["auto"], Tag("<word>")] | Annotated[Positive, Tag("<number>")],
    Discriminator(
        word_or_number, custom_error_type="choice", custom_error_message="must be auto or a number"
    ),
]


class Contact(BaseModel):
    """Penalty contact."""

    model_config = FROZEN

    method: Literal["line", "node"] = Field(
        default="line",
        description="where contact with the seabed is evaluated: line (along the elements, five Gauss points each) or "
        "node (at the riser's nodes); contact with soil is evaluated at nodes",
    )
    stiffness: Stiffness = Field(
        default="auto",
        description="force per length of pipe and penetration [N/m2], or auto: the larger of 10 times the "
        "soil's Young's modulus at the surface and (submerged weight)/(0.001 outer diameter); a spring "
        "seabed has its own",
    )
    smoothing: NonNegative = Field(
        default=1.0e-3, description="contact sets in smoothly between this gap and this penetration [m]"
    )
