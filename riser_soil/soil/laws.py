"""Registry of the constitutive laws of the soil: one entry each."""

from riser_soil.core.quantities import registry
from riser_soil.soil.drucker_prager import DruckerPrager
from riser_soil.soil.imported_law import ImportedLaw
from riser_soil.soil.iwan import IwanOverlay
from riser_soil.soil.kinematic_hardening import KinematicHardening
from riser_soil.soil.law import SoilLaw
from riser_soil.soil.linear_elastic import LinearElastic
from riser_soil.soil.von_mises import VonMises

LAWS: dict[str, type[SoilLaw]] = registry(
    LinearElastic,
    VonMises,
    KinematicHardening,
    IwanOverlay,
    DruckerPrager,
    ImportedLaw,
)
