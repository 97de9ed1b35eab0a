"""Scene language: the state that a run begins with, where it is the end of another run."""

from pydantic import BaseModel, Field

from riser_soil.core.quantities import FROZEN
from riser_soil.scene.files import NamedFolder


class Initial(BaseModel):
    """The end of a finished run, in the place of the riser's initial shape and its laying."""

    model_config = FROZEN

    from_run: NamedFolder = Field(
        alias="from",
        description="result folder of a finished run of the same riser, seabed and soil whose last stage is static and "
        "whose output.checkpoint.keep is true; sought beside the scene file",
    )
