"""A slice of a run's soil on fine cells, under the load by which the riser settled: against closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from riser_soil.accuracy import fine_slice
from riser_soil.accuracy.fine_slice import has_many_slices, settlements_on_fine_cells
from riser_soil.core.arrays import Array
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.scene import Scene
from riser_soil.scene.soil import GeneratedMesh

D, DEPTH, E, NU, WEIGHT = 0.3, 1.8, 1.2e6, 0.45, 700.0
ELASTIC = {"kind": "linear-elastic", "E": E, "nu": NU}
CLAY = {"kind": "von-mises", "su": 2.0e3, "E_over_su": 300.0, "nu": 0.49}
WIDE = D / 3.0


def laid(across: float, law: dict[str, Any] = ELASTIC, axis: int = 0, along: float = 0.5) -> Scene:
    """A riser along x (0) or y (1), 2 m beside that axis, onto sections whose cells are so wide."""

    def turned(x: Any, y: Any) -> list[Any]:
        return [y, x] if axis else [x, y]

    pipe = {"outer_diameter": D, "submerged_weight": WEIGHT, "mass": 150.0, "EA": 3.0e8, "EI": 5.0e4}
    low, high = turned([20.0, 36.0], [2.0 - DEPTH, 2.0 + DEPTH])
    size = {"along": along, "across": across, "strip": 8.0 * across}
    soil = {"model": "sections", "block": {"x": low, "y": high, "depth": DEPTH}, "law": law}
    soil["mesh"] = {"size_at_riser": size, "size_far": 0.6}
    riser: dict[str, Any] = {"segments": [{"line_type": "pipe", "length": 148.0, "elements": 148}]}
    riser |= {"start": {"position": [*turned(0.0, 2.0), 0.15]}, "end": {"position": [*turned(80.0, 2.0), 100.0]}}
    return scene_from_mapping({
        "line_types": {"pipe": pipe}, "riser": riser, "soil": soil, "dimension": 2,
        "seabed": {"kind": "spring", "stiffness": 2.0e5}, "contact": {"method": "surface"},
        "stages": [{"name": "lay", "kind": "static"}],
    })  # fmt: skip


def fine(scene: Scene, *settlements: float) -> list[float]:
    values = settlements_on_fine_cells(scene, settlements)
    assert values is not None
    return values


def strip(load: float, width: float) -> float:
    """Settlement q/(pi E*) (2 ln(4 z/width) - 1) under an even strip (Johnson, Contact Mechanics, 1985)."""
    return load * (1.0 - NU**2) / (np.pi * E) * (2.0 * float(np.log(4.0 * DEPTH / width)) - 1.0)


def test_wide_cells_settle_less_by_their_logarithm() -> None:
    """A cell of D/3 bears as a strip of 1.75 cells does (`test_settlement`), resolved contact by Hertz: 2 sqrt(4 q
    R/(pi E*)). The penalty and cells that are none too fine share what is left.
    """
    load = 1.2 * WEIGHT
    touching = 2.0 * float(np.sqrt(2.0 * load * D * (1.0 - NU**2) / (np.pi * E)))
    on_cells = strip(load, 1.75 * WIDE)
    (settlement,) = fine(laid(WIDE), on_cells)
    assert settlement == pytest.approx(strip(load, touching), rel=0.08)
    assert settlement > 1.3 * on_cells


def test_cells_that_resolve_what_touches_are_right() -> None:
    """Cells of D/64, where D/15 touches."""
    assert fine(laid(D / 64.0), 2.0e-3) == pytest.approx([2.0e-3], rel=0.01)


@pytest.mark.parametrize(("across", "expected"), [(D / 64.0, D / 128.0), (0.5 * D, 0.25 * 0.02239)])
def test_fine_cells_are_half_of_the_run_s_or_a_quarter_of_what_touches(
    across: float, expected: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """At 1.5 times the weight Hertz has 22.39 mm touch, of soil without change of volume, E* = 4/3 E."""
    cells = []

    def sees(scene: Scene, **_: float) -> tuple[Array, Array]:
        assert scene.soil is not None
        assert isinstance(scene.soil.mesh, GeneratedMesh)
        cells.append(scene.soil.mesh.across)
        return np.array([0.0, 1.0]), np.array([0.0, 1.0])

    monkeypatch.setattr(fine_slice, "_pressed", sees)
    fine(laid(across), 1e-3)
    assert cells == pytest.approx([across, expected], rel=2e-3)


def test_clay_yields_on_fine_cells_alone() -> None:
    """Cells of D/2 bear (2 + pi) su 1.75 cells, three times the weight; a pipe that has hardly sunk bears nothing."""
    settlement = 2.0e-3
    (elastic,), (clay,) = fine(laid(0.5 * D), settlement), fine(laid(0.5 * D, CLAY), settlement)
    assert clay > 1.5 * elastic


def test_settlements_of_several_stages_are_those_of_one_curve() -> None:
    one, other = fine(laid(WIDE), 1.0e-3, 2.0e-3)
    assert one < other
    assert other == pytest.approx(fine(laid(WIDE), 2.0e-3)[0], rel=1e-9)


def test_a_riser_along_y_has_the_same_slice() -> None:
    assert fine(laid(WIDE, axis=1), 2.0e-3) == pytest.approx(fine(laid(WIDE), 2.0e-3), rel=1e-9)


def test_where_no_slice_tells() -> None:
    """Contact at nodes is by other rules; what does not settle bears nothing."""
    scene = laid(WIDE)
    assert scene.contact is not None
    at_nodes = scene.model_copy(update={"contact": scene.contact.model_copy(update={"method": "node"})})
    assert settlements_on_fine_cells(at_nodes, [1e-3]) is None
    assert settlements_on_fine_cells(scene, [0.0, 1e-3]) is None
    assert settlements_on_fine_cells(scene, []) is None


@pytest.mark.parametrize(("along", "many"), [(0.5, True), (5.0, True), (6.0, False)])
def test_soil_of_a_few_slices(along: float, many: bool) -> None:
    """Slices of 16 m; three cells are many."""
    for axis in (0, 1):
        assert has_many_slices(laid(WIDE, along=along, axis=axis)) is many
