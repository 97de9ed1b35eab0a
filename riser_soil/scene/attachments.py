"""Scene language: point masses, clump weights and buoyancy modules on the riser."""

import math
from typing import Annotated, Any, Self

from pydantic import BaseModel, Discriminator, Field, Tag, model_validator

from riser_soil.core.quantities import FROZEN, ArcLength, Area, Coefficient, Length, Mass, Volume, wrong

MOST_IN_ROW = 10_000
ROUND_OFF = 1e-9  # of a row's spacings


def _one_or_more(value: Any) -> str:
    return "<list>" if isinstance(value, list | tuple) else "<number>"


Arcs = Annotated[
    Annotated[tuple[ArcLength, ...], Field(min_length=1), Tag("<list>")] | Annotated[ArcLength, Tag("<number>")],
    Discriminator(_one_or_more),
]


class Attachment(BaseModel):
    """One kind of attachment, at one place or at several."""

    model_config = FROZEN

    at: Arcs | None = Field(
        default=None, description="arc length [m], or a list of them; anywhere, not only at nodes; or give from and to"
    )
    from_: ArcLength | None = Field(default=None, alias="from", description="arc length of the first of a row [m]")
    to: ArcLength | None = Field(
        default=None, description="arc length [m] beyond which the row does not go: its last one is there or before"
    )
    spacing: Length | None = Field(default=None, description="arc length between two neighbours of the row [m]")
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

    @model_validator(mode="after")
    def _somewhere_once(self) -> Self:
        row = {"from": self.from_, "to": self.to, "spacing": self.spacing}
        missing = [key for key, value in row.items() if value is None]
        if self.at is not None and len(missing) < len(row):
            raise wrong("at", "the places are given twice", "give either at, or from, to and spacing")
        if self.at is None and missing:
            problem = "the place is missing" if len(missing) == len(row) else f"a row lacks {' and '.join(missing)}"
            raise wrong("at", problem, "give at: an arc length [m] or a list of them, or from, to and spacing [m]")
        return self

    @model_validator(mode="after")
    def _row_runs_forward(self) -> Self:
        if self.from_ is None or self.to is None or self.spacing is None:
            return self
        if self.to < self.from_:
            raise wrong("to", f"must not be less than from ({self.from_:g} m)", "swap the two")
        if self.to - self.from_ > MOST_IN_ROW * self.spacing:
            raise wrong("spacing", f"puts more than {MOST_IN_ROW} of them in a row", "take a larger spacing [m]")
        return self

    @property
    def arcs(self) -> tuple[float, ...]:
        """All places [m]."""
        if self.from_ is not None and self.to is not None and self.spacing is not None:
            last = math.floor((self.to - self.from_) / self.spacing * (1.0 + ROUND_OFF))
            return tuple(min(self.from_ + n * self.spacing, self.to) for n in range(last + 1))
        assert self.at is not None  # the validator has seen to it
        return self.at if isinstance(self.at, tuple) else (self.at,)
