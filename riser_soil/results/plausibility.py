"""Plausibility of results: strains, bending and compression beyond what the elements stand for, soil never touched."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import astuple, dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from riser_soil.assembly import LineAssembly
from riser_soil.checks.overload import over_a_length, surface_bearing
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.part import State
from riser_soil.core.saved_state import Saved, packed, unpacked
from riser_soil.core.snapshot import Record
from riser_soil.riser.section_forces import at_most
from riser_soil.riser.sections import Elements, larger_beside
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
    found = [float(change[cells].max(initial=0.0)) for cells in (bottom, sides)]
    return BoundaryStress(*(grid.nodes.comm.allreduce(value, MPI.MAX) for value in found))


@dataclass(frozen=True)
class LargestValue:
    """The largest value yet of what must stay small, its arc [m], and the time [s] or load factor."""

    value: float = 0.0
    arc: float = math.nan
    t: float = math.nan

    def or_larger(self, values: Array, arcs: Array, t: float) -> LargestValue:
        at = int(values.argmax())
        return self.or_this(float(values[at]), arcs, at, t)

    def or_largest(self, values: Array, arcs: Array, times: Array) -> LargestValue:
        """The first of the largest values, each (n,) with its arc and time, where it is larger."""
        at = int(values.argmax())
        return self.or_this(float(values[at]), arcs, at, float(times[at]))

    def or_largest_along(self, values: Array, arc: Array, times: Sequence[float]) -> LargestValue:
        """The first of the largest values (nt, nn) along the riser at times (nt,), where it is larger."""
        k, n = divmod(int(values.argmax()), arc.size)
        return self.or_this(float(values[k, n]), arc, n, times[k])

    def or_this(self, value: float, arcs: Array, at: int, t: float) -> LargestValue:
        """This value, at the place of a number, where it is larger."""
        return LargestValue(value, float(arcs[at]), t) if value > self.value else self


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
        self._touched = riser.soil is None
        self._bearing = surface_bearing(riser)
        self._where = ""
        self._lowest: Array = np.full(3, np.nan)

    def begin_stage(self, stage: Stage) -> None:
        self._last_stage = stage.name == self._riser.scene.stages[-1].name
        self._unit = "of the load" if stage.kind == "static" else "s"
        self._largest = 0.0  # moment [N.m]
        self._tension = 0.0  # the largest [N]
        self._boundary: BoundaryStress | None = None
        self._axial = self._bending = self._smooth = self._steep = self._stretch = self._beyond = LargestValue()
        self._load = self._misfit = self._pushed = LargestValue()
        self._warned: tuple[tuple[object, ...], tuple[str, ...]] | None = None  # of what, and what

    def look(self, times: Sequence[float], record: Record) -> None:
        """times: s of the run (static stages: load factor), of the record's instants."""
        arc, tension = self._riser.line.arc, record.effective_tension
        self._axial = self._axial.or_largest_along(np.abs(tension) / self.EA, arc, times)
        self._bending = self._bending.or_largest_along(self.radius * record.curvature, arc, times)
        self._largest = max(self._largest, float(record.bending_moment.max()))
        self._tension = max(self._tension, float(tension.max()))
        if tension.min() < 0.0:
            self._pushed = self._pushed.or_largest_along(-tension - self.buckling, arc, times)

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
        if self._bearing is not None:
            borne = over_a_length(pressed.force, self._riser.line, self._riser.scales.diameter)
            self._load = self._load.or_larger(borne, record.arc, t)
        self._beyond = self._beyond.or_larger(self._past_the_block(record), np.array([record.touchdown_arc]), t)
        self._stretch = self._stretch.or_larger(np.array([pressed.stretch]), np.full(1, np.nan), t)
        self._look_for_ground(record)

    def _look_for_ground(self, record: Record) -> None:
        down = not np.isnan(record.touchdown_arc)
        self._where = "touches down at" if down else "hangs with its lowest point at"
        self._lowest = record.touchdown_position if down else record.position[record.position[:, 2].argmin()]

    def look_around(self, boundary: BoundaryStress | None) -> None:
        """At the stage's end; None without soil."""
        self._boundary = boundary

    def _past_the_block(self, record: Record) -> Array:
        """How far the touchdown point lies beyond the soil in plan (1,) [m]; 0 where there is none."""
        assert self._riser.soil is not None
        grid, at = self._riser.soil.whole.grid, record.touchdown_position[:2]
        outside = np.maximum(grid.low[:2] - at, at - grid.high[:2]).max()
        return np.array([max(0.0, float(np.nan_to_num(outside, nan=0.0)))])

    def look_closely(self, times: Array, smooth: Array, steep: Array) -> None:
        """times (nt,): as above; smooth, steep (nt, ne): from `bending_misfits`."""
        elements, rows = self._riser.elements, np.arange(times.size)
        e, s = smooth.argmax(axis=1), steep.argmax(axis=1)
        self._misfit = self._misfit.or_largest(smooth[rows, e], self._middle[e], times)
        self._smooth = self._smooth.or_largest(_not_small(smooth[rows, e], e, elements), self._middle[e], times)
        self._steep = self._steep.or_largest(_not_small(steep[rows, s], s, elements), self._middle[s], times)

    def bending(self) -> dict[str, float]:
        """The largest misfit of the elements' bending, an estimate of the moment's error [N.m]: its size, share of the
        stage's largest moment, arc [m] and time [s] or load factor. Empty before it has been looked at.
        """
        found, largest = self._misfit, max(self._misfit.value, self._largest)
        if math.isnan(found.t):
            return {}
        return {"moment_error": found.value, "share": found.value / largest, "arc": found.arc, "time": found.t}

    def warnings(self) -> tuple[str, ...]:
        """With numbers and a remedy."""
        basis = (*self._largest_values, self._boundary, self._largest, self._tension, self._lowest, self._touched)
        if self._warned is None or any(a is not b for a, b in zip(basis, self._warned[0], strict=True)):
            self._warned = basis, tuple(self._found_warnings())
        return self._warned[1]

    def _found_warnings(self) -> Iterator[str]:
        yield from self._strains()
        yield from self._blurred()
        yield from self._compressed()
        yield from self._stretched()
        yield from self._overloaded()
        yield from self._left()
        yield from self._too_small()
        if self._last_stage and not self._touched:
            yield self._never()

    def _strains(self) -> Iterator[str]:
        if self._axial.value > LARGE_STRAIN:
            yield (
                f"the riser is strained along its axis by {self._at(self._axial)}; beams with a constant EA hold for "
                f"strains of some per cent, at most {LARGE_STRAIN:.0%}: correct EA, the length or what pulls"
            )
        if self._bending.value > LARGE_STRAIN:
            yield (
                f"the pipe's outside is strained by bending, curvature times D/2, by {self._at(self._bending)}; beams "
                f"whose sections keep their shape and EI hold for at most {LARGE_STRAIN:.0%}: correct EI or what bends"
            )

    def _blurred(self) -> Iterator[str]:
        for found, allowed in ((self._smooth, SMOOTH_MISFIT), (self._steep, STEEP_MISFIT)):
            largest = max(found.value, self._largest)
            share = found.value / largest if largest > 0.0 else 0.0
            if share > allowed:
                length = float(self._riser.line.length[np.abs(self._middle - found.arc).argmin()])
                yield (
                    f"elements of {length:.4g} m are too long for the bending at arc {found.arc:.5g} m: at "
                    f"{found.t:.5g} {self._unit} their turn and the moments at their ends differ by {found.value:.4g} "
                    f"N.m, {share:.0%} of the stage's largest (limit {allowed:.0%}); moments may be off as much; "
                    "take elements half as long there"
                )
                return

    def _compressed(self) -> Iterator[str]:
        found = self._pushed
        if found.value <= SMALL_PUSH * self._tension:
            return
        arc, length = self._riser.line.arc, self._riser.line.length
        node = int(np.abs(arc - found.arc).argmin())
        borne, long = float(self.buckling[node]), f"elements of {length[min(node, length.size - 1)]:.4g} m"
        where = f"at arc {found.arc:.5g} m and {found.t:.5g} {self._unit}"
        push = f"{where} the line is compressed by {found.value + borne:.4g} N"
        if borne > 0.0:
            yield (
                f"{push}: {long} bow out between their nodes beyond pi^2 EI/L^2 = {borne:.4g} N, which tensions don't "
                "know; take shorter elements there, or EI: 0 of chain and rope, which go slack"
            )
        else:
            yield (
                f"{push}, though it has no bending stiffness and goes slack: that is weight and inertia of {long}, and "
                "tensions there may be off by as much; take shorter ones at rest, and damping of the line in motion"
            )

    def _stretched(self) -> Iterator[str]:
        if self._stretch.value > LARGE_STRETCH:
            yield (
                f"the soil's surface under the riser is stretched to {self._stretch.value:.3g} times its area at "
                f"{self._stretch.t:.5g} {self._unit}: this soil is computed at small strain, and soil that flows from "
                f"under the pipe bears too little from some {LARGE_STRETCH:g} times on; take soil.strain: large and "
                "contact.method: surface, and don't quote the depth that the riser sinks to"
            )

    def _overloaded(self) -> Iterator[str]:
        bearing, worst = self._bearing, self._load
        if bearing is not None and worst.value > OVERLOADED * bearing.capacity:
            yield (
                f"the soil bears {worst.value:.4g} N/m at arc {worst.arc:.5g} m and {worst.t:.5g} {self._unit}, "
                f"{worst.value / bearing.capacity:.2g} times the {bearing.capacity:.4g} N/m that its clay can at the "
                f"surface, {bearing.meaning}: cells too coarse to yield bear the rest, and the riser would sink in; "
                "check su, take cells of at most an eighth of the diameter across (mesh: auto), or hold the riser up"
            )

    def _left(self) -> Iterator[str]:
        if self._touched and self._beyond.value > self._riser.scales.diameter:
            yield (
                f"the touchdown point left the soil's block: it was {self._beyond.value:.3g} m beyond at "
                f"{self._beyond.t:.5g} {self._unit}, arc {self._beyond.arc:.5g} m, where the seabed bears the riser, "
                "if there is one; enlarge soil.block, or take block: auto"
            )

    def _too_small(self) -> Iterator[str]:
        found, scales = self._boundary, self._riser.scales
        if found is None:
            return
        nominal = scales.weight / scales.diameter
        for stress, where, remedy in (
            (found.bottom, "bottom", "deeper"),
            (found.sides, "sides along the riser", "wider"),
        ):
            if stress > NEAR_STRESS * nominal:
                yield (
                    f"the riser changes the soil's stress at the block's {where} by {stress:.3g} Pa, "
                    f"{stress / nominal:.0%} of its weight over its diameter (limit {NEAR_STRESS:.0%}): the block "
                    f"holds the soil where the ground would give; take a {remedy} one"
                )

    def _at(self, worst: LargestValue) -> str:
        return f"{worst.value:.3g} at arc {worst.arc:.5g} m and {worst.t:.5g} {self._unit}"

    def _never(self) -> str:
        assert self._riser.soil is not None
        (x0, y0, _), (x1, y1, _) = self._riser.soil.whole.grid.low, self._riser.soil.whole.grid.high
        down = ", ".join(f"{x:.5g}" for x in self._lowest)
        return (
            f"in no stage did the riser touch the soil, x from {x0:.5g} to {x1:.5g} m and y from {y0:.5g} to {y1:.5g} "
            f"m: at the end it {self._where} [{down}] m; move the soil there, or leave it out"
        )

    @property
    def _largest_values(self) -> tuple[LargestValue, ...]:
        of_soil = self._stretch, self._beyond, self._load
        return self._axial, self._bending, self._smooth, self._steep, *of_soil, self._misfit, self._pushed

    def state(self) -> Saved:
        worst = [astuple(found) for found in self._largest_values]
        kept = {"largest": np.array(self._largest), "touched": np.array(self._touched), "worst": np.array(worst)}
        kept |= {"tension": np.array(self._tension)}
        return kept | {"where": packed(self._where), "lowest": self._lowest}

    def restore(self, saved: Saved) -> None:
        """In the stage that has begun."""
        self._largest, self._touched = float(saved["largest"]), bool(saved["touched"])
        self._tension = float(saved["tension"])
        found = (LargestValue(*row) for row in saved["worst"].tolist())
        self._axial, self._bending, self._smooth, self._steep, *of_soil, self._misfit, self._pushed = found
        self._stretch, self._beyond, self._load = of_soil
        self._where, self._lowest = unpacked(saved["where"]), saved["lowest"]


def _not_small(moment: Array, e: IntArray, elements: Elements) -> Array:
    """Misfits [N m] of elements e, each (n,); 0 where the turn of the element is too small to mind."""
    small = moment * elements.length[e] < SMALL_TURN * elements.larger_EI[e]
    return np.where(small, 0.0, moment)
