"""Registry of the hysteretic seabed laws: one entry each."""

from riser_soil.core.quantities import registry
from riser_soil.seabed.aubeny_biscontin import AubenyBiscontin
from riser_soil.seabed.law import SeabedLaw
from riser_soil.seabed.randolph_quiggin import RandolphQuiggin

LAWS: dict[str, type[SeabedLaw]] = registry(
    RandolphQuiggin,
    AubenyBiscontin,
)
