"""Assembly of the soil block: its extent, the sizes of its cells, and whether elastic soil is condensed.

Whether linear elastic soil is condensed to the part of its top that the riser reaches.

What condensation costs are the solves for the columns of the compliance, some 3e-9 n^(4/3) s for each of the r dofs
that are reached, of n in all, and the dense block in each factorisation, some 5e-11 r^3 s. What it saves are
factorisations of the whole, some 2e-9 n^2 s each. With r = 2 n^(2/3) the former is paid for by three of the latter,
and the dense block is a fifth of one: below that condensation pays, as any scene on soil has tens of iterations.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

import numpy as np

from riser_soil.errors import SceneError
from riser_soil.riser.line import Line
from riser_soil.scene.plane import resolved_dimension, vertical_plane
from riser_soil.scene.scene import Scene
from riser_soil.scene.seabed_features import Groove, Trench
from riser_soil.scene.soil import Block, GeneratedMesh, SoilScene
from riser_soil.scene.soil_layers import boundaries
from riser_soil.soil.grading import BlockSpec, Point
from riser_soil.soil.seabed_feature import FeatureSpec, GrooveSpec, TrenchSpec

if TYPE_CHECKING:
    from riser_soil.soil.condensed import CondensedSoil
    from riser_soil.soil.soil import Soil
    from riser_soil.soil.surface import SoilTop

NONE = 1e-9  # slope in plan, and part of the block's width, that is none
MOST = 2.0  # dofs that are reached, over n^(2/3) of n in all


def block_of(scene: Scene, soil: SoilScene, riser: tuple[Point, Point]) -> BlockSpec:
    """A block that is fine under a line; riser: two points of it in plan [m]."""
    assert isinstance(soil.block, Block)  # the scene's checks have seen to it, and `with_sizes`
    assert isinstance(soil.mesh, GeneratedMesh)
    return BlockSpec(
        x=soil.block.x,
        y=soil.block.y,
        depth=soil.block.depth,
        size_at_riser=soil.mesh.across,
        size_far=soil.mesh.size_far,
        level=scene.seabed_level,
        kind=soil.mesh.kind,
        riser=riser,
        along=soil.mesh.along,
        touchdown=soil.mesh.touchdown if soil.model == "block" else None,
        strip=soil.mesh.strip,
        boundaries=boundaries(soil.layers or ()),
        feature=_feature_of(scene, soil.block),
        half=not why_all(scene, soil),
    )


def why_all(scene: Scene, soil: SoilScene) -> str:
    """Why all of the soil is computed; empty where half is, as it and the riser are symmetric about the riser's plane.
    Sizes are chosen.
    """
    plane = vertical_plane(scene)
    across = int(abs(plane.direction[1]) < abs(plane.direction[0]))
    if soil.symmetry == "whole":
        return "soil.symmetry is whole"
    if soil.forms is not None:
        return "terms of soil.forms may not be symmetric"
    if not isinstance(soil.mesh, GeneratedMesh) or soil.mesh.kind != "hex":
        return "it is no block of hexahedra"
    if soil.is_linear:
        return "it is linear, and may be condensed"
    if resolved_dimension(scene) == 3 and scene.line.across is None:
        return "the riser moves in three dimensions"
    if abs(plane.direction[across]) > NONE:
        return "the riser runs across x and y"
    assert isinstance(soil.block, Block)
    low, high = (soil.block.x, soil.block.y)[across]
    if abs(0.5 * (low + high) - plane.origin[across]) > NONE * (high - low):
        return f"the riser does not lie in the middle of soil.block.{'xy'[across]}"
    return ""


def _feature_of(scene: Scene, block: Block) -> FeatureSpec | None:
    match block.feature:
        case Trench() as trench:
            ramp = trench.run_out or trench.side
            return TrenchSpec(trench.depth, trench.width, trench.side, trench.along, ramp)
        case Groove() as groove:
            diameter = groove.diameter or scene.largest_diameter
            return GrooveSpec(groove.embedment * diameter, 0.5 * diameter)
        case None:
            return None
        case _:
            assert_never(block.feature)


def condensed_of(scene: Scene, soil: Soil, line: Line, diameter: float) -> CondensedSoil | None:
    """The condensed soil in the place of the whole one, where it is condensed; SceneError where that is asked for and
    can't be.
    """
    reason = why_whole(scene, soil, line, diameter)
    if reason and scene.solver.soil == "condensed":
        raise SceneError(f"solver.soil: the soil can't be condensed: {reason}; write auto")
    if reason:
        return None
    from riser_soil.soil.condensed import CondensedSoil, CondensedTop

    return CondensedSoil(soil, CondensedTop(soil))


def why_whole(scene: Scene, soil: Soil, line: Line, diameter: float) -> str:
    """Why the soil is solved for as a whole; empty where it is condensed. diameter: of the riser [m]."""
    assert scene.soil is not None
    ranks = soil.grid.nodes.comm.size
    if not scene.soil.is_linear:
        return f"it is not linear, its law is {' and '.join(sorted({law.kind for law in scene.soil.laws}))}"
    if scene.soil.inertia:
        return "it has inertia"
    if scene.soil.forms is not None:
        return "terms of soil.forms are added to it"
    if scene.soil.model == "sections":
        return "it is made of sections"
    if ranks > 1:
        return f"the run is on {ranks} ranks"
    if scene.solver.soil != "auto":
        return "solver.soil is whole" if scene.solver.soil == "whole" else ""
    reached, most = 3 * _under(line, soil.surface, diameter), MOST * soil.field.size ** (2.0 / 3.0)
    if reached > most:
        return f"{reached} unknowns of its surface lie under the riser; with more than {most:.0f} condensing costs more"
    return ""


def _under(line: Line, surface: SoilTop, diameter: float) -> int:
    """How many points of the top belong to facets under the riser's width in plan, where it begins."""
    from riser_soil.contact.ground import touching_boxes

    axis = line.to_global(line.x)
    axis[:, 2] = 0.0
    wide = np.array([0.5 * diameter, 0.5 * diameter, np.inf])
    low, high = np.minimum(axis[:-1], axis[1:]) - wide, np.maximum(axis[:-1], axis[1:]) + wide
    _, facets = touching_boxes(low, high, surface.points, surface.facets)
    return len(np.unique(surface.facets[facets]))
