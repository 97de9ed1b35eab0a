"""Fields of the soil by name: tensors against closed forms, at large strain and behind a mirror; what is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from demos.own_law.run import HERE
from riser_soil.assembly import build
from riser_soil.assembly.packages import communicator_of
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.errors import SceneError
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.soil import mandel
from riser_soil.soil.drucker_prager import DruckerPrager
from riser_soil.soil.imported_law import ImportedLaw
from riser_soil.soil.law import SoilLaw
from riser_soil.soil.linear_elastic import LinearElastic
from riser_soil.soil.mirror import Mirror, Unfolding
from riser_soil.soil.requested_fields import fields_of
from riser_soil.soil.soil import Soil
from riser_soil.soil.von_mises import VonMises
from tests.support.said import line_with, telling
from tests.support.scenes import LAY, Mapping, touchdown
from tests.support.soil_bench import Bench
from tests.support.soil_cases import KINDS, distorted, sheared, small_block

E, NU, SU, GAMMA = 1.2e6, 0.49, 4.0e3, 5.0e3
G = E / (2.0 * (1.0 + NU))
CLAY = VonMises(kind="von-mises", su=SU, E_over_su=E / SU, nu=NU)
SAND = DruckerPrager(kind="drucker-prager", friction_angle_deg=35.0, cohesion=500.0, E=E)
CAM: dict[str, Any] = {"M": 1.0, "lam": 0.2, "kappa": 0.04, "e0": 1.2, "G_over_p": 50.0, "OCR": 1.5}
CAM |= {"kind": "imported", "from": f"{HERE / 'my_clay.py'}:CamClay", "attraction": 3.0e3, "water": 5.0e6}


def soil(law: SoilLaw, *names: str, kind: str = "hex", **given: Any) -> Soil:
    options = {"level": 0.0, "unit_weight": GAMMA, **given}
    return Soil(distorted(small_block(kind)), law.at_points, fields=fields_of(names, (law,)), **options)


def take(soil: Soil, u: Array) -> None:
    """Accept a step of increments (n, 3), in equilibrium or not."""
    state = State(1.0, u.ravel(), np.zeros(u.size), np.zeros(u.size))
    soil.commit(state)
    soil.field.commit(state)


def tensors(soil: Soil, name: str) -> Array:
    """(nc, 3, 3)."""
    values = soil.output_fields().requested[name]
    assert values.shape == (len(soil.output_mesh().cells), 9)
    return values.reshape(-1, 3, 3)


@pytest.mark.parametrize("kind", KINDS)
def test_stress_and_strain_of_a_column_under_its_weight(kind: str) -> None:
    """At rest sideways: σz = -γ z, σh = ν/(1 - ν) σz, εz = σz (1 + ν)(1 - 2ν)/((1 - ν) E); nothing is plastic."""
    law = LinearElastic(kind="linear-elastic", E=E, nu=NU)
    requested = fields_of(("stress", "strain", "plastic_strain"), (law,))
    options: dict[str, Any] = {"level": 0.0, "unit_weight": GAMMA, "start": "unstressed", "fields": requested}
    column = Soil(small_block(kind), law.at_points, **options)
    Bench(column, np.zeros(column.field.size, dtype=bool)).step(np.zeros(column.field.size))
    mesh = column.output_mesh()
    stress, strain, plastic = (tensors(column, name) for name in requested.names)
    down = GAMMA * mesh.points[mesh.cells].mean(axis=1)[:, 2]
    diagonal = np.array([NU / (1.0 - NU), NU / (1.0 - NU), 1.0])
    np.testing.assert_allclose(stress, down[:, None, None] * np.diag(diagonal), atol=1e-6 * GAMMA)
    squeezed = down * (1.0 + NU) * (1.0 - 2.0 * NU) / (1.0 - NU) / E
    np.testing.assert_allclose(strain, squeezed[:, None, None] * np.diag([0.0, 0.0, 1.0]), atol=1e-6 * GAMMA / E)
    assert np.abs(plastic).max() < 1e-12


def test_simple_shear_beyond_the_strength_leaves_what_is_not_elastic() -> None:
    """τ = su, γ = 2 εxz, of which su/G is elastic."""
    clay, gamma = soil(CLAY, "stress", "strain", "plastic_strain", unit_weight=0.0), 0.05
    for _ in range(4):
        take(clay, sheared(clay, gamma / 4.0).u.reshape(-1, 3))
    for name, xz in (("stress", SU), ("strain", 0.5 * gamma), ("plastic_strain", 0.5 * (gamma - SU / G))):
        strain, wanted = tensors(clay, name), np.zeros((3, 3))
        wanted[0, 2] = wanted[2, 0] = xz
        np.testing.assert_allclose(strain, np.broadcast_to(wanted, strain.shape), atol=1e-9 * xz)


def test_strain_turns_with_the_material_and_no_turn_adds_to_it() -> None:
    """Sheared a little, then turned by half a radian about y: strain and plastic strain are those, turned."""
    clay, gamma, angle = soil(CLAY, "strain", "plastic_strain", unit_weight=0.0, moves=True), 0.02, 0.5
    take(clay, sheared(clay, gamma).u.reshape(-1, 3))
    before = {name: tensors(clay, name) for name in ("strain", "plastic_strain")}
    Q = np.array([[np.cos(angle), 0.0, np.sin(angle)], [0.0, 1.0, 0.0], [-np.sin(angle), 0.0, np.cos(angle)]])
    take(clay, clay.points @ Q.T - clay.points)
    for name, values in before.items():
        np.testing.assert_allclose(tensors(clay, name), Q @ values @ Q.T, atol=1e-3 * gamma, err_msg=name)
        assert np.abs(tensors(clay, name) - values).max() > 0.2 * gamma


def test_effective_stress_is_what_the_law_says_beyond_its_pore_pressure() -> None:
    law = ImportedLaw.model_validate(CAM)
    clay = soil(law, "stress", "effective_stress", "histories", K0=1.0)
    u = sheared(clay, 0.02).u.reshape(-1, 3)
    u[:, 2] = 1e-3 * clay.field.points[:, 2]
    take(clay, u)
    fields = clay.output_fields().requested
    assert set(fields) == {"stress", "effective_stress", "pressure", "preconsolidation", "pore_pressure"}
    total, effective = (fields[name].reshape(-1, 3, 3) for name in ("stress", "effective_stress"))
    pore = fields["pore_pressure"]
    np.testing.assert_allclose(pore, -5.0e6 * 1e-3, rtol=1e-6)  # it was stretched
    np.testing.assert_allclose(effective, total + pore[:, None, None] * np.eye(3), rtol=1e-9, atol=1e-6)
    mean = -np.trace(effective, axis1=1, axis2=2) / 3.0
    np.testing.assert_allclose(mean, fields["pressure"] - 3.0e3, rtol=1e-9)


def test_the_stress_of_sand_is_effective() -> None:
    sand = soil(SAND, "stress", "effective_stress")
    fields = sand.output_fields().requested
    assert np.array_equal(fields["stress"], fields["effective_stress"])


def test_there_are_no_fields_unless_requested() -> None:
    clay = soil(CLAY)
    assert not clay.output_fields().requested
    assert not any(name.startswith("strain") for name in clay.law.columns)


def test_an_image_has_shear_across_the_mirror_with_the_other_sign() -> None:
    points = np.array([[0.0, y, z] for y in (0.0, 1.0) for z in (0.0, 1.0)])
    rows = np.arange(9.0)[None, :] + 1.0
    unfolding = Unfolding.of(Mirror(1, 0.0, 1e-9), points, np.arange(4)[None, :])
    unfolded = unfolding.tensors(rows)
    signs = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0])
    assert np.array_equal(unfolded, np.concatenate([rows, signs * rows]))
    assert np.array_equal(Unfolding.of(None, points, np.arange(4)[None, :]).tensors(rows), rows)


def test_components_of_a_tensor_row_by_row() -> None:
    matrix = np.array([[1.0, 2.0, 3.0], [2.0, 4.0, 5.0], [3.0, 5.0, 6.0]])
    six = np.array([1.0, 4.0, 6.0, *(np.sqrt(2.0) * np.array([2.0, 3.0, 5.0]))])
    np.testing.assert_allclose(mandel.components(six), matrix.ravel(), rtol=1e-15)


@pytest.mark.parametrize(
    ("law", "name", "words"),
    [
        (CLAY, "effective_stress", ("von-mises", "total", "pore_pressure")),
        (LinearElastic(kind="linear-elastic", E=E, nu=NU), "effective_stress", ("linear-elastic",)),
        (CLAY, "backstress", ("no backstress", "stress, effective_stress, strain, plastic_strain, histories")),
        (CLAY, "von_mises_stress", ("output.fields",)),
        (ImportedLaw.model_validate(CAM), "pore", ("no pore", "preconsolidation")),
    ],
)
def test_fields_that_are_not_known_are_refused(law: SoilLaw, name: str, words: tuple[str, ...]) -> None:
    with pytest.raises(SceneError, match=telling("output.soil_fields", *words)):
        soil(law, name)


def scene(**changed: Any) -> Mapping:
    return touchdown(LAY) | changed


def test_a_scene_asks_for_them_and_needs_soil(tmp_path: Path) -> None:
    requested = {"soil_fields": ["strain", "histories"]}
    made = scene_from_mapping(scene(output=requested))
    assert made.output.soil_fields == ("strain", "histories")
    without = scene(output=requested)
    del without["soil"]
    with pytest.raises(SceneError, match=telling("output.soil_fields", "no soil")):
        scene_from_mapping(without)
    wrong = scene_from_mapping(scene(output={"soil_fields": ["effective_stress"]}))
    with pytest.raises(SceneError) as refused:
        build(wrong, communicator_of(wrong))
    line_with(str(refused.value), "output.soil_fields", "effective_stress", "von-mises")
