"""A stiff pipe pushed into a slice of soil, and what Hertz says of it."""

from __future__ import annotations

import numpy as np

from tests.support.driven_stage import built, soil_under, take
from tests.support.scenes import ELASTIC, Mapping, block, cells, level_pipe, pushed_to

D, E, NU = 0.5, ELASTIC["E"], ELASTIC["nu"]
INDENTATION = 0.01  # m


def slice_of_soil(across: int, method: str = "surface") -> Mapping:
    """A stiff pipe over a slice of elastic soil, 8 m wide and 4 m deep, with so many cells across the diameter."""
    size = D / across
    return level_pipe(
        pushed_to(1.0, 0.5 * D - INDENTATION),
        pipe={"outer_diameter": D, "submerged_weight": 700.0, "mass": 70.0, "EA": 1e10, "EI": 1e9},
        length=1.0,
        elements=8,
        height=0.5 * D,
        soil=block(ELASTIC, (0.5 - 0.5 * size, 0.5 + 0.5 * size), 4.0, 4.0, cells(size, max(size, 0.5))),
        contact={"method": method},
    )


class Pushed:
    """The pipe pushed in: force per length q [N/m], and what Hertz says of it."""

    def __init__(self, cells: int, method: str = "surface", scene: Mapping | None = None) -> None:
        self.assembly = built(scene or slice_of_soil(cells, method))
        self.state = take(self.assembly, self.assembly.scene.stages[0])
        assert self.assembly.soil is not None
        assert self.assembly.soil.contact is not None
        grid = self.assembly.soil.whole.grid
        self.thickness = float(grid.high[0] - grid.low[0])
        self.q = -float(self.assembly.soil.contact.force_on_soil(self.state)[2]) / self.thickness
        self.modulus = E / (1.0 - NU**2)
        self.half_width = float(np.sqrt(2.0 * self.q * D / (np.pi * self.modulus)))

    @property
    def indentation(self) -> float:
        """Less the penalty's give [m]."""
        assert self.assembly.soil is not None
        return INDENTATION - self.assembly.soil.contact.max_penetration(self.state)

    def approach(self, depth: float) -> float:
        """How far the pipe comes nearer to a point so deep below it [m]; Johnson, Contact Mechanics, 5.6."""
        log = 2.0 * np.log(2.0 * depth / self.half_width) - NU / (1.0 - NU)
        return float(self.q / (np.pi * self.modulus) * log)

    def settled(self, depth: float) -> float:
        """Downward displacement of the soil at so deep below the pipe [m]."""
        soil = soil_under(self.assembly).recovered()
        assert soil is not None
        field = soil.field
        y, z = field.points[:, 1], field.points[:, 2]
        middle = np.abs(y) < np.abs(y).min() + 1e-9
        order = np.argsort(-z[middle])
        return -float(np.interp(depth, -z[middle][order], field.total[2::3][middle][order]))
