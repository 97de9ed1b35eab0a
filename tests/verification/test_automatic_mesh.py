"""Automatic mesh: halving all cells, or the cells' length and the pipe's elements, changes little; fixed cells do."""

from __future__ import annotations

from copy import deepcopy
from typing import Any, NamedTuple

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.assembly import build
from riser_soil.assembly.scales import Scales
from riser_soil.checks.mesh_plausibility import GRADED
from riser_soil.checks.settlement import settlement
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.scene import Scene
from tests.support.automatic_cells import scaled
from tests.support.driven_stage import soil_under, take
from tests.support.pages import Tell, signed_percent
from tests.support.pushed_pipe import D, Pushed, slice_of_soil
from tests.support.scenes import CLAY, ELASTIC, PIPE, Mapping, block, level_pipe, static


class FineSlice(NamedTuple):
    """Force per length [N/m] on a pipe pushed in by D/50, and the width that touches [m]."""

    force: float
    width: float


FINE = FineSlice(4986.1, 0.0634)  # cells of D/128 over two diameters, 0.1 m at the sides


class Pressed(NamedTuple):
    """Force per length [N/m] at the given indentation, largest equivalent stress [Pa], plastic strain, unknowns."""

    force: float
    stress: float
    plastic_strain: float
    unknowns: int


def slice_scene(law: Mapping, weight: float, indentation: float, method: str = "surface") -> Mapping:
    """A slice of soil into which a pipe of this submerged weight [N/m] is pushed; block of eight diameters."""
    scene = slice_of_soil(2, method)
    scene["line_types"]["pipe"] |= {"submerged_weight": weight, "EA": 1e8}
    scene["soil"] |= {"law": deepcopy(law), "mesh": "auto"}
    scene["soil"]["block"] = {"x": [0.45, 0.55], "y": [-8.0 * D, 8.0 * D], "depth": 8.0 * D}
    for end in ("start", "end"):
        scene["stages"][0]["move"][end][2] = 0.5 * D - indentation
    return scene


def sinking(steps: int = 10) -> Mapping:
    """A pipe as heavy as the clay bears on its chord where it has sunk in by D/4, pushed there step by step."""
    chord = 2.0 * np.sqrt(0.25 * 0.75) * D
    scene = slice_scene(CLAY, (2.0 + np.pi) * CLAY["su"] * chord, D / 4.0)
    push, depths = scene["stages"][0], np.linspace(0.0, D / 4.0, steps + 1)[1:]
    scene["stages"] = [
        push | {"name": f"to {w:g}", "move": {end: [*at[:2], 0.5 * D - float(w)] for end, at in push["move"].items()}}
        for w in depths
    ]
    return scene


def lifted_pipe(law: Mapping, weight: float = 717.0, height: float = 0.05, elements: int = 16, **soil: Any) -> Mapping:
    """A pipe rests on a block of soil, then its end is lifted by `height` [m]: a touchdown zone without a riser above.

    weight: submerged [N/m]. soil: its keys beside the law.
    """
    z = 0.15 - 2e-3  # so far in the soil that Newton's method finds the pipe's rest
    return level_pipe(
        static("rest"),
        static("lift", move={"end": [8.0, 0.0, z + height]}),
        pipe=PIPE | {"submerged_weight": weight},
        length=8.0,
        elements=elements,
        height=z,
        rotation="free",
        seabed={"kind": "spring", "level": 0.0, "stiffness": 1.0e5},
        soil=block(law, (-1.0, 9.0), 2.4, 2.4, "auto", **soil),
        contact={"method": "surface"},
    )


def pushed(scene: Scene) -> Pressed:
    assembly, state = build(scene, MPI.COMM_SELF), None
    for stage in scene.stages:
        state = take(assembly, stage, state)
    assert state is not None
    assert assembly.soil is not None
    assert assembly.soil.contact is not None
    recovered = assembly.soil.recovered()
    assert recovered is not None
    grid, fields = assembly.soil.whole.grid, recovered.output_fields()
    force = -float(assembly.soil.contact.force_on_soil(state)[2]) / float(grid.high[0] - grid.low[0])
    unknowns = 3 * len(assembly.soil.whole.field.points)
    return Pressed(force, fields.von_mises.max(), fields.plastic_strain.max(), unknowns)


def halved(scene: Mapping) -> tuple[Pressed, Pressed]:
    """On automatic cells, and on half of them all."""
    read = scene_from_mapping(scene)
    return pushed(scaled(read)), pushed(scaled(read, across=0.5))


def shown(auto: Pressed, half: Pressed) -> str:
    """Force on automatic cells [N/m], and what half of them change of it and of the largest stress."""
    changes = (signed_percent([b / a - 1.0]) for a, b in ((auto.force, half.force), (auto.stress, half.stress)))
    return " | ".join([f"{auto.force:,.0f}", *changes])


def test_a_light_pipe_settles_the_same_on_cells_half_as_large(tell: Tell) -> None:
    auto, half = halved(slice_scene(ELASTIC, 1070.0, D / 200.0))
    tell({"halved elastic D/200": shown(auto, half)})
    assert half.force == pytest.approx(auto.force, rel=0.05)
    assert half.stress == pytest.approx(auto.stress, rel=0.05)


@pytest.mark.verify
@pytest.mark.parametrize(
    ("name", "law", "weight", "indentation"),
    [
        ("elastic D/50", ELASTIC, 5000.0, D / 50.0),
        ("clay D/200", CLAY, 830.0, D / 200.0),
        ("clay D/100", CLAY, 1350.0, D / 100.0),
    ],
)
def test_halving_all_cells_changes_little(
    tell: Tell, name: str, law: Mapping, weight: float, indentation: float
) -> None:
    """More where clay yields, whose largest stress is its strength."""
    auto, half = halved(slice_scene(law, weight, indentation))
    tell({f"halved {name}": shown(auto, half)})
    assert -0.07 < half.force / auto.force - 1.0 < 0.0
    assert half.stress == pytest.approx(auto.stress, rel=0.05)


@pytest.mark.verify
def test_a_pipe_that_has_sunk_in_meets_what_is_published_on_automatic_cells(tell: Tell) -> None:
    """Resistance by Merifield, White & Randolph, smooth, at D/4; half of all cells change it a little."""
    published = 5.3 * 0.25**0.25 * CLAY["su"] * D
    auto, half = halved(sinking())
    tell({"halved clay D/4": shown(auto, half)})
    assert -0.03 < half.force / auto.force - 1.0 < 0.0
    assert half.stress / auto.stress == pytest.approx(1.0, abs=0.01)
    assert half.force == pytest.approx(published, rel=0.03)


@pytest.mark.parametrize(("cells", "off"), [(2, 0.66), (4, 0.35), (8, 0.11)])
def test_what_cells_miss_is_reported(tell: Tell, cells: int, off: float) -> None:
    """Force at an indentation of D/50 above that of cells of D/128; the settlement is too small as `check` says."""
    force = Pushed(cells).q
    tell({f"cells under D/{cells}": f"{force:,.0f} | {signed_percent([force / FINE.force - 1.0])}"})
    assert force / FINE.force - 1.0 == pytest.approx(off, abs=0.02)
    soil, pipe = scene_from_mapping(slice_of_soil(cells)).soil, Scales(FINE.force, D, 1.0)
    assert soil is not None
    missed = GRADED + 1.0 - settlement(soil, pipe, 4.0, D / cells) / settlement(soil, pipe, 4.0)
    assert missed == pytest.approx(1.0 - FINE.force / force, abs=0.04)


def lifted(law: Mapping, along: float = 1.0, elements: int = 16) -> tuple[float, float]:
    """Largest settlement of the soil [m] and equivalent stress [Pa] away from the pipe's ends, one end lifted."""
    scene = scaled(scene_from_mapping(lifted_pipe(law, elements=elements)), across=2.0, along=along)
    assembly, state = build(scene, MPI.COMM_SELF), None
    for stage in scene.stages:
        state = take(assembly, stage, state)
    recovered = soil_under(assembly).recovered()
    assert recovered is not None
    mesh, fields = recovered.output_mesh(), recovered.output_fields()
    nodes, cells = mesh.points[:, 0], mesh.points[mesh.cells].mean(axis=1)[:, 0]
    down = -fields.displacement[(nodes > 1.5) & (nodes < 7.0), 2].min()
    return float(down), float(fields.von_mises[(cells > 1.5) & (cells < 7.0)].max())


@pytest.mark.verify
def test_half_or_twice_the_length_of_cells_and_elements_changes_little(tell: Tell) -> None:
    base = np.array(lifted(ELASTIC))
    others = {f"along {along:g}": lifted(ELASTIC, along=along) for along in (0.5, 2.0)}
    others |= {f"elements {16 / elements:g}": lifted(ELASTIC, elements=elements) for elements in (32, 8)}
    changes = {name: np.array(other) / base - 1.0 for name, other in others.items()}
    tell({f"lifted {name}": " | ".join(signed_percent([x]) for x in each) for name, each in changes.items()})
    assert np.abs(list(changes.values())).max() < 0.03
