"""Edge of the soil, where the seabed beside it takes over: steps in height and stiffness under the riser's weight."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from riser_soil.assembly import LineAssembly
from riser_soil.checks.settlement import settlement
from riser_soil.scene.seabed_features import Trench
from riser_soil.scene.soil import Block
from riser_soil.seabed.law import NormalLaw

# Of the outer diameter: step in height above which it is warned of; halvings of a penetration that is looked for.
STEP, HALVINGS = 1.0 / 20.0, 60


class SoilEdge(NamedTuple):
    """Weight per length [N/m] and what it settles in the soil and in the seabed [m]; depth of a trench or groove that
    ends at the edge [m].
    """

    weight: float
    in_soil: float
    in_seabed: float
    dug: float

    @property
    def step(self) -> float:
        """How much higher the riser lies on the seabed than on the soil [m]."""
        return self.in_soil + self.dug - self.in_seabed


def edge_report(riser: LineAssembly) -> Iterator[str]:
    """Lines of `check` about the soil's edge."""
    edge = soil_edge(riser)
    if edge is None:
        return
    in_soil, in_seabed = edge.weight / edge.in_soil, edge.weight / edge.in_seabed
    dug = f", {1000.0 * edge.dug:.3g} mm deep at its edge" if edge.dug else ""
    yield (
        f"at the soil's edge: by its weight, {edge.weight:.4g} N/m, the riser sinks about {1000.0 * edge.in_soil:.2g} "
        f"mm in the soil ({in_soil:.2g} N/m2){dug}, and {1000.0 * edge.in_seabed:.2g} mm in the seabed beside it "
        f"({in_seabed:.2g} N/m2): a step of {1000.0 * edge.step:.2g} mm up to the seabed"
    )


def edge_warnings(riser: LineAssembly) -> Iterator[str]:
    """A step that bends the riser more than its diameter lets one overlook."""
    edge = soil_edge(riser)
    if edge is None or abs(edge.step) <= STEP * riser.scales.diameter:
        return
    as_soft = f"take seabed.stiffness {edge.weight / edge.in_soil:.2g} N/m2"
    yield (
        f"the seabed beside the soil lies {1000.0 * abs(edge.step):.3g} mm {'higher' if edge.step > 0.0 else 'lower'} "
        "under the riser's weight than the soil, more than a twentieth of its diameter: the riser bends there; "
        f"{'let it end within the block' if edge.dug else as_soft}, or take a longer block"
    )


def soil_edge(riser: LineAssembly) -> SoilEdge | None:
    """The edge of the soil; None without a seabed beside the soil, or of a riser that has no weight."""
    soil, scales, seabed = riser.scene.soil, riser.scales, riser.seabed
    heavy = float(riser.elements.weight.max()) > 0.0
    if soil is None or riser.soil is None or seabed is None or not heavy:
        return None
    depth = float(riser.soil.whole.grid.high[2] - riser.soil.whole.grid.low[2])
    in_seabed = penetration(seabed.law, scales.weight, scales.diameter)
    return SoilEdge(scales.weight, settlement(soil, scales, depth), in_seabed, _dug(riser, soil.given_block))


def penetration(law: NormalLaw, weight: float, diameter: float) -> float:
    """Penetration [m] at which ground that was never touched bears a weight [N/m]; at most a diameter."""
    low, high = 0.0, diameter
    for _ in range(HALVINGS):
        middle = np.array([0.5 * (low + high)])
        bears = float(law.update(middle, law.initial_history(middle.shape)).force[0])
        low, high = (low, float(middle[0])) if bears >= weight else (float(middle[0]), high)
    return high


def _dug(riser: LineAssembly, block: Block | None) -> float:
    """Depth of the block's feature on the riser's line, the deepest of both edges [m]."""
    if block is None or block.feature is None:
        return 0.0
    (x0, y0, _), (x1, y1, _) = riser.line.to_global(riser.line.x)[[0, -1]]
    ends = block.y if abs(y1 - y0) > abs(x1 - x0) else block.x
    if isinstance(block.feature, Trench):
        return max(-block.feature.height(along, 0.0, 0.0) for along in ends)
    return -block.feature.height(0.0, 0.0, riser.scene.largest_diameter)
