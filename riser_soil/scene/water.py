"""The water around the riser."""

from pydantic import BaseModel, Field

from riser_soil.scene.quantities import FROZEN, Positive


class Water(BaseModel):
    """Still water without a surface: everything is submerged."""

    model_config = FROZEN

    density: Positive = Field(default=1025.0, description="density of the water [kg/m3]")
