"""Plausibility of the soil under a riser: load, stretch and stress beyond what it is made for, soil never touched."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from riser_soil.assembly import LineAssembly
from riser_soil.checks.overload import over_a_length, surface_bearing
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.saved_state import Saved, packed, unpacked
from riser_soil.core.snapshot import Record
from riser_soil.results.largest import LargestAlong
from riser_soil.scene.stages import Stage

if TYPE_CHECKING:
    from riser_soil.assembly.soil_assembly import SoilAssembly
    from riser_soil.soil.soil import Soil

# Stretch in plan of the soil's surface under the riser from which small strain no longer holds: a pipe pushed into a
# slice of plastic clay, with 8 cells across its diameter, is borne less and less from between 1.3 and 1.6 on.
LARGE_STRETCH = 1.2
# Load over the bearing capacity from which the soil's strength comes of its cells. (What a strip on fine cells bears
# beyond Prandtl's load is some per cent; a square bears 1.2 times as much per length.)
OVERLOADED = 1.25
# Stress at the block's bottom or sides, over the riser's weight on its diameter, from which the block is too small to
# stand for the ground: 0.1 at eight diameters from the pipe, 0.4 at three. (The largest in it hangs on the cells.)
NEAR_STRESS = 0.15

# Force on the soil [N/m], way of the touchdown point beyond the block [m], stretch of the soil's surface.
_FOLLOWED = ("force on soil", "beyond block", "stretch of soil")


class BoundaryStress(NamedTuple):
    """Largest change of the equivalent stress since the start, as means of cells [Pa]: in cells at the bottom, and in
    cells at the two sides along the riser.
    """

    bottom: float
    sides: float


class PressedSoil(NamedTuple):
    """Contact force per length at the nodes (nn,) [N/m], and the largest stretch in plan of the soil's surface that
    presses, 1 without; nan at large strain, which no stretch spoils.
    """

    force: Array
    stretch: float


def boundary_stress(soil: Soil, across: int) -> BoundaryStress:
    """Change of stress at the soil's boundaries in the committed state, beside that at the riser; collective. across:
    the axis, x (0) or y (1), more nearly square to the riser.
    """
    from mpi4py import MPI

    grid, change = soil.grid, soil.stress_change()
    corners = grid.nodes.points[grid.nodes.cells]
    near = 1e-6 * float(np.max(grid.high - grid.low))
    bottom = (corners[..., 2] < grid.low[2] + near).any(axis=1)
    y = corners[..., across]
    sides = ((y < grid.low[across] + near) | (y > grid.high[across] - near)).any(axis=1)
    largest = [float(change[cells].max(initial=0.0)) for cells in (bottom, sides)]
    return BoundaryStress(*(grid.nodes.comm.allreduce(value, MPI.MAX) for value in largest))


class SoilPlausibility:
    """Plausibility of soil in a stage at the recorded instants, by warnings; on the rank that has the riser."""

    def __init__(self, riser: LineAssembly, soil: SoilAssembly) -> None:
        self._riser, self._soil = riser, soil
        self._bearing = surface_bearing(riser)
        self._touched = False
        self._where = ""
        self._lowest: Array = np.full(3, np.nan)

    def begin_stage(self, stage: Stage) -> None:
        self._last_stage = stage.name == self._riser.scene.stages[-1].name
        self._unit = "of the load" if stage.kind == "static" else "s"
        self._worst = LargestAlong(_FOLLOWED)
        self._boundary: BoundaryStress | None = None

    def pressed(self, state: State) -> PressedSoil:
        """The soil under the riser at an accepted state."""
        contact = self._soil.contact
        stretch = math.nan if self._riser.scene.soil_moves else contact.stretch(state)
        return PressedSoil(contact.force_per_length(state), stretch)

    def follow(self, t: float, pressed: PressedSoil, record: Record) -> None:
        """Take in a state. t: s of the run (static stages: load factor); pressed, record: of one state."""
        self._touched = self._touched or bool(pressed.force.any())
        at, touchdown, nowhere = np.array([t]), record.touchdown_arc[None], np.full(1, np.nan)
        if self._bearing is not None:
            borne = over_a_length(pressed.force, self._riser.line, self._riser.scales.diameter)
            self._worst.update(at, record.arc, {"force on soil": borne[None]})
        self._worst.update(at, touchdown, {"beyond block": self._beyond_block(record)[None]})
        self._worst.update(at, nowhere, {"stretch of soil": np.array([[pressed.stretch]])})
        self._follow_lowest(record)

    def _follow_lowest(self, record: Record) -> None:
        down = not np.isnan(record.touchdown_arc)
        self._where = "touches down at" if down else "hangs with its lowest point at"
        self._lowest = record.touchdown_position if down else record.position[record.position[:, 2].argmin()]

    def measure_boundary(self) -> None:
        """Take in the stress at the soil's boundaries, at the stage's end; collective."""
        across = int(np.abs(self._riser.line.direction[:2]).argmin())
        self._boundary = boundary_stress(self._soil.recovered(), across)

    def _beyond_block(self, record: Record) -> Array:
        """Distance of the touchdown point beyond the soil in plan (1,) [m]; 0 without a touchdown point."""
        grid, at = self._soil.whole.grid, record.touchdown_position[:2]
        outside = np.maximum(grid.low[:2] - at, at - grid.high[:2]).max()
        return np.array([max(0.0, float(np.nan_to_num(outside, nan=0.0)))])

    def warnings(self) -> tuple[str, ...]:
        """Warnings about the soil's results, with numbers and a remedy."""
        by_forces = [*self._stretched(), *self._overloaded()]
        return (*by_forces, *self._left_the_block(), *self._block_too_small(), *self._never_touched())

    def _stretched(self) -> Iterator[str]:
        stretch = self._worst["stretch of soil"]
        if stretch.value > LARGE_STRETCH:
            yield (
                f"the soil's surface under the riser is stretched to {stretch.value:.3g} times its area at "
                f"{stretch.t:.5g} {self._unit}: this soil is computed at small strain, and soil that flows from "
                f"under the pipe bears too little from some {LARGE_STRETCH:g} times on; take soil.strain: large and "
                "contact.method: surface, and don't quote the depth that the riser sinks to"
            )

    def _overloaded(self) -> Iterator[str]:
        bearing, force = self._bearing, self._worst["force on soil"]
        if bearing is not None and force.value > OVERLOADED * bearing.capacity:
            yield (
                f"the soil bears {force.value:.4g} N/m at arc {force.arc:.5g} m and {force.t:.5g} {self._unit}, "
                f"{force.value / bearing.capacity:.2g} times the {bearing.capacity:.4g} N/m that its clay can at the "
                f"surface, {bearing.meaning}: cells too coarse to yield bear the rest, and the riser would sink in; "
                "check su, take cells of at most an eighth of the diameter across (mesh: auto), or hold the riser up"
            )

    def _left_the_block(self) -> Iterator[str]:
        beyond = self._worst["beyond block"]
        if self._touched and beyond.value > self._riser.scales.diameter:
            yield (
                f"the touchdown point left the soil's block: it was {beyond.value:.3g} m beyond at "
                f"{beyond.t:.5g} {self._unit}, arc {beyond.arc:.5g} m, where the seabed bears the riser, "
                "if there is one; enlarge soil.block, or take block: auto"
            )

    def _block_too_small(self) -> Iterator[str]:
        change, scales = self._boundary, self._riser.scales
        if change is None:
            return
        nominal = scales.weight / scales.diameter
        for stress, where, remedy in (
            (change.bottom, "bottom", "deeper"),
            (change.sides, "sides along the riser", "wider"),
        ):
            if stress > NEAR_STRESS * nominal:
                yield (
                    f"the riser changes the soil's stress at the block's {where} by {stress:.3g} Pa, "
                    f"{stress / nominal:.0%} of its weight over its diameter (limit {NEAR_STRESS:.0%}): the block "
                    f"holds the soil where the ground would give; take a {remedy} one"
                )

    def _never_touched(self) -> Iterator[str]:
        if self._touched or not self._last_stage:
            return
        (x0, y0, _), (x1, y1, _) = self._soil.whole.grid.low, self._soil.whole.grid.high
        down = ", ".join(f"{x:.5g}" for x in self._lowest)
        yield (
            f"in no stage did the riser touch the soil, x from {x0:.5g} to {x1:.5g} m and y from {y0:.5g} to {y1:.5g} "
            f"m: at the end it {self._where} [{down}] m; move the soil there, or leave it out"
        )

    def state(self) -> Saved:
        touched = {"touched": np.array(self._touched), "where": packed(self._where), "lowest": self._lowest}
        return self._worst.state() | touched

    def restore(self, saved: Saved) -> None:
        """Resume in the stage that has begun."""
        self._worst.restore(saved)
        self._touched, self._where, self._lowest = bool(saved["touched"]), unpacked(saved["where"]), saved["lowest"]
