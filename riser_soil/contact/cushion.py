"""Cushion on which a riser is laid before the soil bears it: springs that fade in the load steps of a static stage."""

from __future__ import annotations

from riser_soil.contact.law import Penalty
from riser_soil.contact.seabed_contact import CoveredBySoil, SeabedContact, StationContact
from riser_soil.core.arrays import Array
from riser_soil.riser import stations
from riser_soil.riser.line import Line
from riser_soil.riser.trial import Trial
from riser_soil.seabed.grounds import Plane


class Cushion(SeabedContact):
    """Part "cushion": a seabed of springs over the soil, whose stiffness falls with the load factor t as (1 - t)².

    At first it holds the riser just above the soil; its last share goes over to the soil at t = 1. The soil is loaded
    gradually, and Newton's method meets a contact that grows, instead of a riser that falls from its first shape into
    soil that has not felt it yet. level: of the soil's top [m]; it bears the weight per length [N/m] at a penetration
    of `depth` [m], with which the riser's underside touches the soil.
    """

    name = "cushion"

    def __init__(
        self, line: Line, radius: Array, level: float, weight: float, depth: float, covered: CoveredBySoil
    ) -> None:
        law = Penalty(weight / depth, 0.25 * depth)
        super().__init__(line, radius, Plane.level(level + depth), law, stations.THREE_POINTS, covered)

    def _evaluate(self, trial: Trial) -> StationContact:
        found, share = super()._evaluate(trial), (1.0 - min(trial.state.t, 1.0)) ** 2
        t = found.touching
        faded = t._replace(
            force=share * t.force, slope=share * t.slope, resistance=share * t.resistance, stored=share * t.stored
        )
        return found._replace(touching=faded)
