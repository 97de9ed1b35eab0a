"""Plausibility of results: strains, bending and compression beyond what the elements stand for, soil never touched."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from riser_soil.assembly import LineAssembly
from riser_soil.checks.overload import over_a_length, surface_bearing
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.saved_state import Saved, gathered, packed, restore_all, unpacked
from riser_soil.core.snapshot import Record
from riser_soil.results.largest import Largest, largest_along
from riser_soil.riser.section_forces import at_most
from riser_soil.riser.sections import larger_beside
from riser_soil.scene.stages import Stage

if TYPE_CHECKING:
    from riser_soil.soil.soil import Soil

# Strain from which EA and EI would be no constants, and a section would not keep its shape.
LARGE_STRAIN = 0.1
# Stretch in plan of the soil's surface under the riser from which small strain no longer holds: a pipe pushed into a
# slice of plastic clay, with 8 cells across its diameter, is borne less and less from between 1.3 and 1.6 on.
LARGE_STRETCH = 1.2
# Load over the bearing capacity from which the soil's strength comes of its cells. (What a strip on fine cells bears
# beyond Prandtl's load is some per cent; a square bears 1.2 times as much per length.)
OVERLOADED = 1.25
# Stress at the block's bottom or sides, over the riser's weight on its diameter, from which the block is too small to
# stand for the ground: 0.1 at eight diameters from the pipe, 0.4 at three. (The largest in it hangs on the cells.)
NEAR_STRESS = 0.15
# Shares of the largest moment by which turn and end moments of an element may differ, see results/bending_misfit.py.
# Of 48 catenaries, hanging, clamped and on the seabed, those whose largest moment is off by less than 2 % stay below.
SMOOTH_MISFIT, STEEP_MISFIT = 0.1, 0.2
# The same as a turn of the element [rad] that is too small to mind: it strains a pipe's outside by 1e-3 D/L.
SMALL_TURN = 2e-3
# The same over the stage's largest tension and the diameter: a moment moves the line in which tension acts by its share
# of the tension, here by so little of the diameter that the stress in a section changes by less than 0.02 % (a full
# round section: 8 M/(T D)). A taut rope has no larger moment; of a pipe of 10 km that hangs in its weight, whose moment
# elements of 125 m miss by ten times its size, it is 1e-4.
SMALL_ARM = 2e-5
# Compression beyond what elements bear that is too small to mind, as a share of the stage's largest tension.
SMALL_PUSH = 1e-3


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


class Worst(NamedTuple):
    """The largest value yet of what must stay small, the time [s] or load factor, and the arc length [m]."""

    value: float
    t: float
    arc: float


# What is followed, each >= 0: strains; tension and moment; compression beyond what elements bear [N]; misfits of their
# bending, all of them and those that count [N m]; force on the soil [N/m], way of the touchdown point beyond the block
# [m], stretch of the soil's surface.
_FOLLOWED = (
    *("axial strain", "bending strain", "tension", "moment", "compression", "misfit", "smooth misfit", "steep misfit"),
    *("force on soil", "beyond block", "stretch of soil"),
)


class Plausibility:
    """Plausibility of a stage's results at the recorded instants; on the rank that holds the riser.

    EA [N] and radius [m] (nn,): the smaller and the larger of what the two elements beside a node have. buckling [N]
    (nn,): the larger of their buckling loads, pi^2 EI/L^2 by the smaller EI.
    """

    def __init__(self, riser: LineAssembly) -> None:
        elements = riser.elements
        self._riser = riser
        self.EA = -at_most(np.repeat(-elements.EA[:, None], 2, axis=1))
        self.radius = larger_beside(0.5 * elements.outer_diameter)
        self.buckling = larger_beside(np.square(np.pi / elements.length) * np.minimum(elements.EI_y, elements.EI_z))
        self._middle = 0.5 * (riser.line.arc[1:] + riser.line.arc[:-1])
        self._small_misfit = SMALL_TURN * elements.larger_EI / elements.length
        self._arm = SMALL_ARM * float(elements.pipe_diameter.min())
        self._touched = riser.soil is None
        self._bearing = surface_bearing(riser)
        self._where = ""
        self._lowest: Array = np.full(3, np.nan)

    def begin_stage(self, stage: Stage) -> None:
        self._last_stage = stage.name == self._riser.scene.stages[-1].name
        self._unit = "of the load" if stage.kind == "static" else "s"
        self._largest = {what: Largest(beside=1, floor=0.0) for what in _FOLLOWED}
        self._boundary: BoundaryStress | None = None

    def _worst(self, what: str) -> Worst:
        return Worst(*self._largest[what].of())

    def _follow(self, times: Array, arc: Array, along: dict[str, Array]) -> None:
        """Take in values (nt, n) by what they are at times (nt,) and arc lengths (n,)."""
        for what, values in along.items():
            self._largest[what].update(times, *largest_along(values, arc))

    def look(self, times: Array, record: Record) -> None:
        """times (nt,): s of the run (static stages: load factor), of the record's instants."""
        tension = record.effective_tension
        at_nodes = {
            "axial strain": np.abs(tension) / self.EA,
            "bending strain": self.radius * record.curvature,
            "tension": tension,
            "moment": record.bending_moment,
            "compression": -tension - self.buckling,
        }
        self._follow(times, record.arc, at_nodes)

    def pressed_soil(self, state: State) -> PressedSoil | None:
        """The soil under the riser at an accepted state; None without soil."""
        if self._riser.soil is None:
            return None
        contact = self._riser.soil.contact
        stretch = math.nan if self._riser.scene.soil_moves else contact.stretch(state)
        return PressedSoil(contact.force_per_length(state), stretch)

    def look_at_soil(self, t: float, pressed: PressedSoil, record: Record) -> None:
        """t: as above; pressed, record: of one state, where there is soil."""
        self._touched = self._touched or bool(pressed.force.any())
        at, touchdown, nowhere = np.array([t]), record.touchdown_arc[None], np.full(1, np.nan)
        if self._bearing is not None:
            borne = over_a_length(pressed.force, self._riser.line, self._riser.scales.diameter)
            self._follow(at, record.arc, {"force on soil": borne[None]})
        self._follow(at, touchdown, {"beyond block": self._beyond_block(record)[None]})
        self._follow(at, nowhere, {"stretch of soil": np.array([[pressed.stretch]])})
        self._look_for_ground(record)

    def _look_for_ground(self, record: Record) -> None:
        down = not np.isnan(record.touchdown_arc)
        self._where = "touches down at" if down else "hangs with its lowest point at"
        self._lowest = record.touchdown_position if down else record.position[record.position[:, 2].argmin()]

    def look_around(self, boundary: BoundaryStress | None) -> None:
        """At the stage's end; None without soil."""
        self._boundary = boundary

    def _beyond_block(self, record: Record) -> Array:
        """How far the touchdown point lies beyond the soil in plan (1,) [m]; 0 where there is none."""
        assert self._riser.soil is not None
        grid, at = self._riser.soil.whole.grid, record.touchdown_position[:2]
        outside = np.maximum(grid.low[:2] - at, at - grid.high[:2]).max()
        return np.array([max(0.0, float(np.nan_to_num(outside, nan=0.0)))])

    def look_closely(self, times: Array, record: Record) -> None:
        """Take in misfits of the elements' bending, which cost more, at some times (nt,) as above."""
        misfits = {"misfit": record.smooth_misfit, "smooth misfit": self._without_small(record.smooth_misfit)}
        self._follow(times, self._middle, misfits | {"steep misfit": self._without_small(record.steep_misfit)})

    def _without_small(self, misfit: Array) -> Array:
        """Misfits (nt, ne) [N m]; 0 where the turn of the element is too small to mind."""
        return np.where(misfit < self._small_misfit, 0.0, misfit)

    def bending(self) -> dict[str, float]:
        """The largest misfit of the elements' bending, an estimate of the moment's error [N.m]: its size, share of the
        stage's largest moment, arc [m] and time [s] or load factor. Empty before it has been looked at.
        """
        misfit = self._worst("misfit")
        if math.isnan(misfit.t):
            return {}
        share = misfit.value / self._largest_moment(misfit)
        return {"moment_error": misfit.value, "share": share, "arc": misfit.arc, "time": misfit.t}

    def _largest_moment(self, misfit: Worst) -> float:
        """The stage's largest moment [N m], as which a larger misfit counts, too."""
        return max(misfit.value, self._worst("moment").value)

    def warnings(self) -> tuple[str, ...]:
        """With numbers and a remedy."""
        line = [*self._strains(), *self._too_long_for_bending(), *self._compressed()]
        soil = [*self._stretched(), *self._overloaded(), *self._left_the_block(), *self._block_too_small()]
        return (*line, *soil, *self._never_touched())

    def _strains(self) -> Iterator[str]:
        axial, bending = self._worst("axial strain"), self._worst("bending strain")
        if axial.value > LARGE_STRAIN:
            yield (
                f"the riser is strained along its axis by {self._at(axial)}; beams with a constant EA hold for "
                f"strains of some per cent, at most {LARGE_STRAIN:.0%}: correct EA, the length or what pulls"
            )
        if bending.value > LARGE_STRAIN:
            yield (
                f"the pipe's outside is strained by bending, curvature times D/2, by {self._at(bending)}; beams "
                f"whose sections keep their shape and EI hold for at most {LARGE_STRAIN:.0%}: correct EI or what bends"
            )

    def _too_long_for_bending(self) -> Iterator[str]:
        small = self._arm * self._worst("tension").value
        for what, allowed in (("smooth misfit", SMOOTH_MISFIT), ("steep misfit", STEEP_MISFIT)):
            misfit = self._worst(what)
            largest = self._largest_moment(misfit)
            share = misfit.value / largest if largest > 0.0 else 0.0
            if share > allowed and misfit.value > small:
                length = float(self._riser.line.length[np.abs(self._middle - misfit.arc).argmin()])
                yield (
                    f"elements of {length:.4g} m are too long for the bending at arc {misfit.arc:.5g} m: at "
                    f"{misfit.t:.5g} {self._unit} their turn and the moments at their ends differ by "
                    f"{misfit.value:.4g} N.m, {share:.0%} of the stage's largest (limit {allowed:.0%}); moments may be "
                    "off as much; take elements half as long there"
                )
                return

    def _compressed(self) -> Iterator[str]:
        push = self._worst("compression")
        if push.value <= SMALL_PUSH * self._worst("tension").value:
            return
        arc, length = self._riser.line.arc, self._riser.line.length
        node = int(np.abs(arc - push.arc).argmin())
        borne, long = float(self.buckling[node]), f"elements of {length[min(node, length.size - 1)]:.4g} m"
        where = f"at arc {push.arc:.5g} m and {push.t:.5g} {self._unit}"
        compressed = f"{where} the line is compressed by {push.value + borne:.4g} N"
        if borne > 0.0:
            yield (
                f"{compressed}: {long} bow out between their nodes beyond pi^2 EI/L^2 = {borne:.4g} N, which tensions "
                "don't know; take shorter elements there, or EI: 0 of chain and rope, which go slack"
            )
        else:
            yield (
                f"{compressed}, though it has no bending stiffness and goes slack: that is weight and inertia of "
                f"{long}, and tensions there may be off by as much; take shorter ones at rest, and damping of the line "
                "in motion"
            )

    def _stretched(self) -> Iterator[str]:
        stretch = self._worst("stretch of soil")
        if stretch.value > LARGE_STRETCH:
            yield (
                f"the soil's surface under the riser is stretched to {stretch.value:.3g} times its area at "
                f"{stretch.t:.5g} {self._unit}: this soil is computed at small strain, and soil that flows from "
                f"under the pipe bears too little from some {LARGE_STRETCH:g} times on; take soil.strain: large and "
                "contact.method: surface, and don't quote the depth that the riser sinks to"
            )

    def _overloaded(self) -> Iterator[str]:
        bearing, force = self._bearing, self._worst("force on soil")
        if bearing is not None and force.value > OVERLOADED * bearing.capacity:
            yield (
                f"the soil bears {force.value:.4g} N/m at arc {force.arc:.5g} m and {force.t:.5g} {self._unit}, "
                f"{force.value / bearing.capacity:.2g} times the {bearing.capacity:.4g} N/m that its clay can at the "
                f"surface, {bearing.meaning}: cells too coarse to yield bear the rest, and the riser would sink in; "
                "check su, take cells of at most an eighth of the diameter across (mesh: auto), or hold the riser up"
            )

    def _left_the_block(self) -> Iterator[str]:
        beyond = self._worst("beyond block")
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

    def _at(self, worst: Worst) -> str:
        return f"{worst.value:.3g} at arc {worst.arc:.5g} m and {worst.t:.5g} {self._unit}"

    def _never_touched(self) -> Iterator[str]:
        if self._riser.soil is None or self._touched or not self._last_stage:
            return
        (x0, y0, _), (x1, y1, _) = self._riser.soil.whole.grid.low, self._riser.soil.whole.grid.high
        down = ", ".join(f"{x:.5g}" for x in self._lowest)
        yield (
            f"in no stage did the riser touch the soil, x from {x0:.5g} to {x1:.5g} m and y from {y0:.5g} to {y1:.5g} "
            f"m: at the end it {self._where} [{down}] m; move the soil there, or leave it out"
        )

    def state(self) -> Saved:
        touched = {"touched": np.array(self._touched), "where": packed(self._where), "lowest": self._lowest}
        return gathered(self._largest) | touched

    def restore(self, saved: Saved) -> None:
        """In the stage that has begun."""
        restore_all(self._largest, saved)
        self._touched, self._where, self._lowest = bool(saved["touched"]), unpacked(saved["where"]), saved["lowest"]
