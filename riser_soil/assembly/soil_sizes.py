"""Automatic block and mesh of the soil: from the pipe, its weight, the clay and where the riser touches down."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from riser_soil.assembly.contact_laws import contact_width
from riser_soil.assembly.graded_segments import to_four_figures
from riser_soil.assembly.motions import end_places
from riser_soil.assembly.riser import elements_of
from riser_soil.assembly.scales import Scales, scales_of
from riser_soil.assembly.sea import sea_of
from riser_soil.assembly.touchdown_forecast import TouchdownForecast, forecast
from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.riser.sections import Elements
from riser_soil.scene.plane import vertical_plane
from riser_soil.scene.scene import Scene
from riser_soil.scene.soil import Block, CellSizes, GeneratedMesh, SoilScene
from riser_soil.soil.grading import PARALLEL
from riser_soil.soil.law import SoilLaw

# Cells across the width that touches; across the diameter at least, as the resistance of clay that a pipe sinks into
# climbs cell by cell; largest size over the block's depth. What they leave of the exact settlement: docs/accuracy.md.
ACROSS, ROUND, FAR = 4.0, 16.0, 0.6
# The strip where cells don't grow: of their width, and of the width that touches, beside which clay heaves.
STRIP, BESIDE = 8.0, 1.25
# Length of the cells: this part of the shorter of the lengths over which tension and the soil bend the pipe, and at
# most so many diameters.
ALONG, LONGEST = 0.55, 4.0
# The block: to the sides and down, in diameters and in widths that touch; beyond the touchdown points, in bending
# lengths and diameters; how much farther they go than statics say.
DIAMETERS, WIDTHS = 8.0, 10.0
BENDINGS, BEYOND = 4.0, 10.0
DYNAMIC = 1.25
# Bending lengths, of a cell's length at least, before the touchdown points, within which a block's cells don't grow
# along the riser: it touches down one of them before its cable does, and presses hardest within another.
BEFORE = 3.0


def with_sizes(scene: Scene, soil: SoilScene) -> SoilScene:
    """The soil with numbers where its block or mesh is auto; SceneError where there is none to choose."""
    chosen = SoilSizes(scene, soil)
    block = chosen.block if soil.block == "auto" else soil.block
    assert isinstance(block, Block)
    mesh = chosen.mesh(block) if soil.mesh == "auto" else soil.mesh
    _check_strength(soil.top_law, block)
    return soil.model_copy(update={"block": block, "mesh": mesh})


@dataclass(frozen=True, eq=False)
class SoilSizes:
    """Sizes of a scene's block of soil and of the cells in it."""

    scene: Scene
    soil: SoilScene

    @cached_property
    def elements(self) -> Elements:
        return elements_of(self.scene)

    @cached_property
    def scales(self) -> Scales:
        return scales_of(self.elements)

    @cached_property
    def touchdown(self) -> TouchdownForecast | None:
        return forecast(self.scene, self.elements, list(end_places(self.scene, sea_of(self.scene))))

    @cached_property
    def width(self) -> float:
        """Width over which the pipe touches at rest [m]."""
        return touching_width(self.scales, self.soil.top_law)

    @cached_property
    def bending_length(self) -> float:
        """Length over which tension bends the pipe at the touchdown point [m]: sqrt(EI/H); 0 where H is not known."""
        EI = float(np.maximum(self.elements.EI_y, self.elements.EI_z).max())
        return float(np.sqrt(EI / self.touchdown.H)) if self.touchdown is not None else 0.0

    @property
    def half_width(self) -> float:
        """Distance from the pipe to the block's sides and to its bottom [m]."""
        return max(DIAMETERS * self.scales.diameter, WIDTHS * self.width)

    @property
    def block(self) -> Block:
        """Around the touchdown points that the ends' motions lead to; SceneError where there are none."""
        if self.touchdown is None:
            raise SceneError(
                "soil.block: auto: the touchdown point is not known, as no catenary between two prescribed ends "
                "comes down to the soil; give block: {x: [from, to], y: [from, to], depth: ...}"
            )
        points = _farther(self.touchdown)
        along = np.abs(np.asarray(vertical_plane(self.scene).direction)[:2])
        beyond = BENDINGS * self.bending_length + BEYOND * self.scales.diameter
        around = beyond * along + self.half_width * along[::-1]
        low, high = _rounded(np.stack([points.min(axis=0) - around, points.max(axis=0) + around]))
        depth = float(_rounded(np.array([self.half_width]))[0])
        return Block(x=(float(low[0]), float(high[0])), y=(float(low[1]), float(high[1])), depth=depth)

    def mesh(self, block: Block) -> GeneratedMesh:
        """Hexahedra that resolve what touches; SceneError under a riser across x and y."""
        x, y, _ = np.abs(np.asarray(vertical_plane(self.scene).direction))
        if min(x, y) > PARALLEL * max(x, y):
            raise SceneError(
                "soil.mesh: auto: cells are long along x or y, and the riser runs across both: turn the scene until it "
                "runs along x, or give mesh: {kind, size_at_riser, size_far}"
            )
        across = min(self.width / ACROSS, self.scales.diameter / ROUND)
        strip = max(STRIP * across, BESIDE * self.width)
        sizes = CellSizes(
            along=to_four_figures(max(self.along, across)),
            across=to_four_figures(across),
            strip=to_four_figures(strip),
            touchdown=self.touchdown_zone(block) if self.soil.model == "block" else None,
        )
        return GeneratedMesh(kind="hex", size_at_riser=sizes, size_far=to_four_figures(max(FAR * block.depth, across)))

    def touchdown_zone(self, block: Block) -> tuple[float, float] | None:
        """Range along the riser in which it may touch down, as far as the block has it [m]; None where that is not
        foretold, and where all of the block is in it.
        """
        if self.touchdown is None:
            return None
        axis = int(np.argmax(np.abs(self.touchdown.ahead)))
        points, ahead = _farther(self.touchdown), self.touchdown.ahead
        before = BEFORE * max(self.bending_length, self.along)
        reached = np.concatenate((points - before * ahead, points + self.along * ahead))[:, axis]
        low, high = (block.x, block.y)[axis]
        first, last = (to_four_figures(each) for each in _rounded(np.clip([reached.min(), reached.max()], low, high)))
        return (first, last) if low < last and first < high and (first, last) != (low, high) else None

    @property
    def along(self) -> float:
        """Length of the cells along the riser [m]; chain and rope have no bend to be resolved."""
        bends = bending_on_soil(self.elements, self.soil.top_law), self.bending_length
        shortest = min((length for length in bends if length > 0.0), default=np.inf)
        return min(ALONG * shortest, LONGEST * self.scales.diameter)


def _farther(forecast: TouchdownForecast) -> Array:
    """Touchdown points (n, 2) that the ends' motions lead to, somewhat farther than statics say."""
    first = forecast.points[0]
    return np.asarray(first + DYNAMIC * (forecast.points - first))


def bending_on_soil(elements: Elements, law: SoilLaw) -> float:
    """Length over which the soil bends the pipe [m]: of a beam on springs as stiff as E at the surface."""
    EI = float(np.maximum(elements.EI_y, elements.EI_z).max())
    return float((4.0 * EI / law.surface_modulus(scales_of(elements).diameter)) ** 0.25)


def touching_width(scales: Scales, law: SoilLaw) -> float:
    """Width over which the pipe touches at rest [m], at most D: on elastic soil, or where that is more, as strong as
    the soil bears the pipe's weight on.
    """
    elastic = contact_width(scales, law.surface_modulus(scales.diameter))
    limit = law.bearing(scales.diameter)
    if limit is None:
        return elastic
    low, high = 0.0, scales.diameter
    for _ in range(50):
        middle = 0.5 * (low + high)
        borne = law.bearing(middle)
        low, high = (low, middle) if borne is not None and borne.capacity > scales.weight else (middle, high)
    return max(elastic, high)


def _check_strength(law: SoilLaw, block: Block) -> None:
    wrong = law.wrong_within(block.depth)
    if wrong:
        raise SceneError(f"soil.block: auto: {block.depth:g} m deep: soil.law: {wrong[0]}; {wrong[1]}")


def _rounded(values: Array) -> Array:
    """Sizes rounded to three figures of the largest, of several rows in that in which it is smallest: all alike."""
    unit = 10.0 ** (np.floor(np.log10(np.abs(values).max(axis=-1).min() or 1.0)) - 2.0)
    return np.asarray(np.round(values / unit) * unit)
