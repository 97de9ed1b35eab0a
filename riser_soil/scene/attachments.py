"""Scene language: point masses, clump weights and buoyancy modules on the riser."""

from typing import Annotated, Any, Self

from pydantic import BaseModel, Discriminator, Field, Tag, model_validator

from riser_soil.core.quantities import FROZEN, ArcLength, Area, Coefficient, Mass, Volume, wrong


def _one_or_more(value: Any) -> str:
    return "<list>" if isinstance(value, list | tuple) else "<number>"


Arcs = Annotated[
    Annotated[tuple[ArcLength, ...], Field(min_length=1), Tag("<list>")] | Annotated[ArcLength, Tag("<number>")],
    Discriminator(_one_or_more),
]


class Attachment(BaseModel):
    """One kind of attachment, at one place or at several."""

    model_config = FROZEN

    at: Arcs = Field(description="arc length [m], or a list of them; anywhere, not only at nodes")
    mass: Mass = Field(default=0.0, description="mass of each in air [kg]")
    volume: Volume = Field(default=0.0, description="volume of water that each displaces [m3]")
    drag_area: Area = Field(
        default=0.0, description="drag coefficient times area of each, in all directions [m2]"
    )
    added_mass: Coefficient = Field(
        default=0.0, description="added mass coefficient, on the mass of the water displaced, in all directions [-]"
    )

    @model_validator(mode="after")
    def _is_something(self) -> Self:
        if self.mass == 0.0 and self.volume == 0.0 and self.drag_area == 0.0:
            raise wrong("mass", "the attachment has no mass, volume or drag_area", "give mass [kg] or volume [m3]")
        if self.added_mass > 0.0 and self.volume == 0.0:
            raise wrong("added_mass", "refers to the water displaced, but volume is 0", "give volume [m3]")
        return self

    @property
    def arcs(self) -> tuple[float, ...]:
        """All places [m]."""
        return self.at if isinstance(self.at, tuple) else (self.at,)
