"""Layered soil: each point by its layer's law, the weight above, meshes whose cells end where layers meet."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import gmsh
import numpy as np
import pytest
from mpi4py import MPI
from ruamel.yaml import YAML

from riser_soil.core.arrays import Array
from riser_soil.errors import MeshError, SceneError
from riser_soil.scene.dump import dump_scene
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.soil import SoilScene
from riser_soil.scene.soil_law import law_of, strength_of, weight_of
from riser_soil.soil import mandel
from riser_soil.soil.block import BlockSpec
from riser_soil.soil.field import gather, top_of
from riser_soil.soil.grading import landing
from riser_soil.soil.grid import DistributedMesh, block_grid, file_grid, silent_gmsh
from riser_soil.soil.iwan import IwanOverlay
from riser_soil.soil.kinematic_hardening import KinematicHardening
from riser_soil.soil.law import PLASTIC_STRAIN, SoilLaw
from riser_soil.soil.layered import LayeredFormula, LayeredWeight, law_by_depth
from riser_soil.soil.linear_elastic import LinearElastic
from riser_soil.soil.soil import Soil
from riser_soil.soil.von_mises import VonMises
from tests.support.said import telling
from tests.support.scenes import touchdown
from tests.support.soil_bench import Bench
from tests.support.soil_cases import KINDS

COMM = MPI.COMM_SELF
SOFT, STIFF = (LinearElastic(kind="linear-elastic", E=E, nu=nu) for E, nu in ((2.0e5, 0.45), (2.0e8, 0.2)))
CLAY: dict[str, Any] = {"su": 3.0e3, "E_over_su": 300.0, "nu": 0.49}
LAWS: list[SoilLaw] = [
    STIFF,
    VonMises(kind="von-mises", su_gradient=1.0e3, **CLAY),
    IwanOverlay(kind="iwan", elements=4, **CLAY),
    KinematicHardening(kind="kinematic-hardening", **CLAY),
]
BOTTOMS = (1.0, 2.0, 3.0)
DEPTH = np.array([2.5, 0.2, 3.5, 1.5, 0.8, 2.9, 1.1])
LAYER = [2, 0, 3, 1, 0, 2, 1]


def layered(initial: Array | None = None) -> LayeredFormula:
    made = law_by_depth(LAWS, BOTTOMS, DEPTH, np.zeros((len(DEPTH), 6)) if initial is None else initial)
    assert isinstance(made, LayeredFormula)
    return made


def random_strain(n: int, size: float = 8e-3) -> Array:
    return np.asarray(size * np.random.default_rng(4).standard_normal((n, 6)))


def test_each_point_answers_by_the_law_of_its_layer() -> None:
    """Two steps well into the plastic range, beside each law alone at its depth below the layer's top."""
    law, strain = layered(), random_strain(len(DEPTH))
    first = law.update(strain, law.start())
    second = law.update(-1.5 * strain, first.history)
    for i, layer in enumerate(LAYER):
        alone = LAWS[layer].at_points(DEPTH[i : i + 1] - (0.0, *BOTTOMS)[layer], np.zeros((1, 6)))
        one = alone.update(strain[i : i + 1], alone.start())
        two = alone.update(-1.5 * strain[i : i + 1], one.history)
        for name in ("stress", "tangent", "stored", "elastic"):
            np.testing.assert_array_equal(getattr(second, name)[i : i + 1], getattr(two, name))
        own = [law.columns.index(name) for name in alone.columns]
        np.testing.assert_array_equal(second.history[i : i + 1, own], two.history)
        assert not np.delete(second.history[i], own).any()
        np.testing.assert_array_equal(law.overstress(second.stress)[i : i + 1], alone.overstress(two.stress))


def test_soil_that_is_unloaded_answers_by_its_elastic_moduli() -> None:
    """In the first of a way back, however far it has yielded."""
    law, strain = layered(), random_strain(len(DEPTH))
    yielded = law.update(strain, law.start())
    assert not np.allclose(law.update(1e-7 * strain, yielded.history).tangent, mandel.stiffness(law.bulk, law.shear))
    back = law.update(-1e-7 * strain, yielded.history)
    np.testing.assert_allclose(back.tangent, mandel.stiffness(law.bulk, law.shear), rtol=1e-9, atol=1e-3)


def test_columns_are_named_once_and_plastic_strain_is_common() -> None:
    law = layered()
    assert len({*law.columns}) == len(law.columns) == law.start().shape[1]
    assert law.columns.count(PLASTIC_STRAIN) == 1
    assert not law.symmetric
    assert law_by_depth(LAWS[:3], BOTTOMS[:2], DEPTH, np.zeros((7, 6))).symmetric


def test_tangent_matches_finite_differences() -> None:
    law, strain = layered(), random_strain(len(DEPTH), 3e-3)
    history = law.update(random_strain(len(DEPTH)), law.start()).history
    tangent = law.update(strain, history).tangent
    for j in range(6):
        shift = 1e-7 * np.eye(6)[j]
        ahead, behind = (law.update(strain + s * shift, history).stress for s in (1.0, -1.0))
        scale = np.abs(tangent).max(axis=(1, 2))[:, None]
        np.testing.assert_allclose((ahead - behind) / 2e-7 / scale, tangent[:, :, j] / scale, atol=1e-6)


def test_a_rank_without_points_has_the_same_columns() -> None:
    law = law_by_depth(LAWS, BOTTOMS, np.zeros(0), np.zeros((0, 6)))
    assert law.columns == layered().columns
    assert law.update(np.zeros((0, 6)), law.start()).tangent.shape == (0, 6, 6)


def test_weight_above() -> None:
    weight = LayeredWeight((1.0, 3.0), (5.0e3, 8.0e3, 0.0))
    np.testing.assert_allclose(weight.stress(np.array([0.5, 1.0, 2.0, 9.0])), [2.5e3, 5.0e3, 13.0e3, 21.0e3])
    np.testing.assert_allclose(weight.at(np.array([0.5, 2.0, 3.5])), [5.0e3, 8.0e3, 0.0])


def test_cells_land_on_the_places_and_keep_their_grading() -> None:
    x = -np.geomspace(8.0, 1.0, 20)
    out = landing(x, [-5.1, -2.03, -2.0])
    assert {-8.0, -5.1, -2.03, -2.0, -1.0} <= set(out)
    assert np.all(np.diff(out) > 0.0)
    assert abs(len(out) - len(x)) <= 2
    near = np.diff(out)[out[:-1] < -5.0] / np.interp(out[:-1][out[:-1] < -5.0], x[:-1], np.diff(x))
    assert 0.7 < near.min() < near.max() < 1.4
    np.testing.assert_allclose(landing(x, []), x, rtol=1e-15)


def column(kind: Any, bottoms: tuple[float, ...]) -> DistributedMesh:
    return block_grid(COMM, BlockSpec((0.0, 1.0), (0.0, 1.0), 3.0, 0.5, 1.0, kind=kind, boundaries=bottoms))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("laws", [(SOFT, STIFF), (STIFF, SOFT)])
def test_two_layers_settle_under_their_weight_as_a_column(kind: str, laws: tuple[LinearElastic, LinearElastic]) -> None:
    """1:1000 in stiffness: w(z) is the integral of σ/M below z, M = E(1−ν)/((1+ν)(1−2ν)) of each layer."""
    soil = column_of(kind, laws, (0.7,), LayeredWeight((0.7,), (4.0e3, 9.0e3)), start="unstressed")
    Bench(soil, np.zeros(soil.field.size, dtype=bool)).step(np.zeros(soil.field.size))
    depth = -soil.field.points[:, 2]
    M = [law.E * (1.0 - law.nu) / (1.0 + law.nu) / (1.0 - 2.0 * law.nu) for law in laws]
    upper = 0.5 * 4.0e3 * (0.7**2 - np.minimum(depth, 0.7) ** 2) / M[0]
    low = np.maximum(depth, 0.7) - 0.7
    lower = (4.0e3 * 0.7 * (2.3 - low) + 0.5 * 9.0e3 * (2.3**2 - low**2)) / M[1]
    exact = -(upper + lower)
    settlement = soil.field.total.reshape(-1, 3)
    np.testing.assert_allclose(settlement[:, 2], exact, atol=1e-7 * np.abs(exact).max())
    assert np.abs(settlement[:, :2]).max() < 1e-7 * np.abs(exact).max()


def column_of(
    kind: Any, laws: tuple[SoilLaw, ...], bottoms: tuple[float, ...], weight: LayeredWeight, **options: Any
) -> Soil:
    return Soil(
        column(kind, bottoms),
        lambda depth, initial: law_by_depth(laws, bottoms, depth, initial),
        level=0.0,
        unit_weight=weight,
        **options,
    )


@pytest.mark.parametrize("kind", KINDS)
def test_geostatic_start_bears_the_weight_of_all_layers(kind: str) -> None:
    """σv is the weight above, σh = K0 σv, in equilibrium at once with the nodal weight found another way. The forces'
    work along a stretch of one direction is the integral of its normal stress, be it that of sides which are held.
    """
    weight = LayeredWeight((0.7, 1.9), (4.0e3, 9.0e3, 6.0e3))
    soil = column_of(kind, (SOFT, STIFF, SOFT), (0.7, 1.9), weight, K0=0.6)
    loose = column_of(kind, (SOFT, STIFF, SOFT), (0.7, 1.9), weight, start="unstressed")
    free = ~soil.field.prescribed
    zero = np.zeros(soil.field.size)
    weighs = -Bench(loose, free).force(zero)
    assert np.abs(Bench(soil, free).force(zero)).max() <= 1e-12 * np.abs(weighs).max()
    internal = soil._internal(soil._initial)
    np.testing.assert_allclose(internal[free], weighs[free], atol=1e-9 * np.abs(weighs).max())
    assert weighs.sum() == pytest.approx(-(4.0e3 * 0.7 + 9.0e3 * 1.2 + 6.0e3 * 1.1), rel=1e-12)
    upper, middle, lower = 4.0e3 * 0.7**2 / 2.0, 2.8e3 * 1.2 + 9.0e3 * 1.2**2 / 2.0, 13.6e3 * 1.1 + 6.0e3 * 1.1**2 / 2.0
    stretched = (internal.reshape(-1, 3) * soil.field.points).sum(axis=0)
    assert stretched == pytest.approx(-(upper + middle + lower) * np.array([0.6, 0.6, 1.0]), rel=1e-9)


CLAYS: list[dict[str, Any]] = [
    {"to": 0.4, "law": {"kind": "von-mises", "su": 2.0e3, "E_over_su": 300.0}, "submerged_unit_weight": 4.0e3},
    {"law": {"kind": "von-mises", "su": 1.0e4, "su_gradient": 2.0e3, "E_over_su": 300.0}},
]


def scene_with(layers: Any, **soil: Any) -> Any:
    scene = touchdown()
    del scene["soil"]["law"]
    scene["soil"] |= {"layers": layers, **soil}
    return scene


def soil_scene(layers: Any, **soil: Any) -> SoilScene:
    made = scene_from_mapping(scene_with(layers, **soil)).soil
    assert made is not None
    return made


def test_the_echo_of_a_layered_scene_is_a_scene() -> None:
    scene = scene_from_mapping(scene_with(CLAYS))
    assert scene_from_mapping(YAML(typ="safe").load(dump_scene(scene))) == scene


def test_scene_gives_strength_and_weight_by_layer() -> None:
    given = soil_scene(CLAYS)
    grid = column("hex", (0.4,))
    soil = Soil(grid, law_of(given, grid), level=0.0, unit_weight=weight_of(given))
    assert isinstance(soil.law, LayeredFormula)
    depth = np.array([0.1, 0.4, 0.5, 1.4])
    law = law_of(given, grid)(depth, np.zeros((4, 6)))
    su = np.array([2.0e3, 2.0e3, 1.02e4, 1.2e4])
    q = law.overstress(np.tile([0.0, 0.0, 1.0e3, 0.0, 0.0, 0.0], (4, 1)))
    np.testing.assert_allclose(q, 1.0e3 / np.sqrt(3.0) / su, rtol=1e-12)
    np.testing.assert_allclose(strength_of(given)(np.zeros(4, dtype=np.int64), depth), su, rtol=1e-12)
    weight = weight_of(given)
    assert isinstance(weight, LayeredWeight)
    assert weight.values == (4.0e3, 5.0e3)
    assert given.top_law.surface_modulus(0.3) == 6.0e5


LAW = CLAYS[0]["law"]
WEAKER = {"kind": "von-mises", "su": 1.0e3, "su_gradient": -1.5e3, "E_over_su": 300.0}
REFUSED: dict[str, tuple[dict[str, Any], list[dict[str, Any]], str]] = {
    "both": ({"law": LAW}, [{"law": LAW}], "soil.layers (a list of 1 values): is given beside law"),
    "upwards": ({}, [{"to": 0.5, "law": LAW}, {"to": 0.2, "law": LAW}, {"law": LAW}], "must grow from layer to layer"),
    "no bottom": ({}, [{"law": LAW}, {"law": LAW}], "layer 0 lacks to"),
    "too short": ({}, [{"to": 0.5, "law": LAW}], "ends at 0.5 m, above the block's bottom at 1 m"),
    "too deep": ({}, [{"to": 1.5, "law": LAW}, {"law": LAW}], "begins at 1.5 m, below the block's 1 m"),
    "too weak": ({}, [{"to": 0.1, "law": LAW}, {"law": WEAKER}], "layer 1, 0.9 m thick: su must stay positive"),
    "volume": ({}, [{"volume": "sand", "law": LAW}], "this soil is a block"),
    "both ways": ({}, [{"volume": "sand", "to": 1.0, "law": LAW}], "is given beside to"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_layers_that_make_no_sense_are_refused(name: str) -> None:
    more, layers, says = REFUSED[name]
    with pytest.raises(SceneError) as caught:
        scene_from_mapping(scene_with(layers, **more))
    assert says.split(": ")[-1] in str(caught.value)
    assert "\n" not in str(caught.value)


def two_volumes(path: Path) -> Path:
    """Two boxes side by side, in gmsh's geometry, named left and right."""
    with silent_gmsh():
        boxes = [(3, gmsh.model.occ.addBox(x, 0.0, -1.0, 1.0, 1.0, 1.0)) for x in (0.0, 1.0)]
        gmsh.model.occ.fragment(boxes[:1], boxes[1:])
        gmsh.model.occ.synchronize()
        for (_, volume), name in zip(boxes, ("left", "right"), strict=True):
            gmsh.model.setPhysicalName(3, gmsh.model.addPhysicalGroup(3, [volume]), name)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.5)
        gmsh.model.mesh.generate(3)
        gmsh.write(str(path))
    return path


def test_layers_by_named_volumes(tmp_path: Path) -> None:
    grid = file_grid(COMM, two_volumes(tmp_path / "two.msh"), ("right", "left"))
    x = grid.nodes.points[grid.nodes.cells].mean(axis=1)[:, 0]
    np.testing.assert_array_equal(grid.volume, np.where(x > 1.0, 0, 1))
    elastic = {"kind": "linear-elastic", "E": 1e6, "nu": 0.3}
    layers = [{"volume": "right", "law": LAW}, {"volume": "left", "law": elastic}]
    given = soil_scene(layers, block=None, mesh={"file": str(tmp_path / "two.msh")})
    law = law_of(given, grid)(np.full(2 * len(x), 0.1), np.zeros((2 * len(x), 6)))
    limited = law.overstress(np.tile([0.0, 0.0, 1.0e3, 0.0, 0.0, 0.0], (2 * len(x), 1))) > 0.0
    np.testing.assert_array_equal(limited, np.repeat(x > 1.0, 2))
    top = top_of(grid, gather(grid), moves=False)
    under = top.points[top.facets].mean(axis=1)[:, 0]
    su = strength_of(given)(top.volume, np.full(len(under), 0.1))
    np.testing.assert_array_equal(su, np.where(under > 1.0, 2.0e3, np.inf))


def test_volumes_that_are_not_there_are_reported(tmp_path: Path) -> None:
    file = two_volumes(tmp_path / "two.msh")
    with pytest.raises(MeshError, match=telling("no volume named sand", "left, right")):
        file_grid(COMM, file, ("sand", "left"))
    with pytest.raises(MeshError, match=telling("lies in 0", "volumes left")):
        file_grid(COMM, file, ("left",))
