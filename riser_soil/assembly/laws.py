"""Laws of soil and seabed: the only place that maps their scene models to their formulas."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, assert_never

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.riser.sections import Elements
from riser_soil.scene import seabed, soil

if TYPE_CHECKING:
    from riser_soil.contact.law import NormalLaw
    from riser_soil.soil.law import Law


def soil_law(given: soil.Law) -> Callable[[Array], Law]:
    """What makes the constitutive law of the soil from depths (n,) below its top [m]."""
    constants = given.model_dump(exclude={"kind"})
    match given:
        case soil.LinearElastic():
            from riser_soil.soil.linear_elastic import LinearElastic

            return lambda depth: LinearElastic.at_depth(depth, **constants)
        case soil.VonMises():
            from riser_soil.soil.von_mises import VonMises

            return lambda depth: VonMises.at_depth(depth, **constants)
        case _:
            assert_never(given)


def hysteretic_law(given: seabed.Law, elements: Elements) -> NormalLaw:
    """The law of a seabed that remembers, for the mean diameter of the line."""
    diameter = float(np.average(elements.outer_diameter, weights=elements.length))
    constants = given.model_dump(exclude={"kind"})
    match given:
        case seabed.RandolphQuiggin():
            from riser_soil.seabed.randolph_quiggin import RandolphQuiggin

            return RandolphQuiggin(diameter, **constants)
        case seabed.AubenyBiscontin():
            from riser_soil.seabed.aubeny_biscontin import AubenyBiscontin

            return AubenyBiscontin(diameter, **constants)
        case _:
            assert_never(given)
