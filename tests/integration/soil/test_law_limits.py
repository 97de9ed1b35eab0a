"""All soil laws at their limits: clay without strength at the seabed, soil that hardly changes its volume."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.assembly import build
from riser_soil.errors import SceneError
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.soil import mandel
from riser_soil.soil.law import SoilLaw
from riser_soil.soil.laws import LAWS
from tests.support.driven_stage import take
from tests.support.material_paths import initial_stress, random_paths
from tests.support.said import telling
from tests.support.scenes import LAY, touchdown

CLAY = {"su": 4.0e3, "su_gradient": 1.0e3, "E_over_su": 300.0}
GIVEN: dict[str, dict[str, Any]] = {
    "linear-elastic": {"E": 1.0e6},
    "von-mises": CLAY,
    "kinematic-hardening": CLAY,
    "iwan": CLAY,
    "drucker-prager": {"friction_angle_deg": 32.0, "dilation_angle_deg": 4.0, "cohesion": 200.0, "E": 1.0e7},
}
CLAYS = ("von-mises", "kinematic-hardening", "iwan")


def law(kind: str, nu: float = 0.49, **other: float) -> SoilLaw:
    return LAWS[kind].model_validate({"kind": kind, "nu": nu} | GIVEN[kind] | other)


def test_all_laws_are_among_them() -> None:
    """But for laws of one's own."""
    assert set(GIVEN) == {*LAWS} - {"imported"}


@pytest.mark.parametrize("nu", [0.0, 0.4999])
@pytest.mark.parametrize("kind", GIVEN)
def test_random_paths_at_the_limits_of_poissons_ratio(kind: str, nu: float) -> None:
    initial = initial_stress(300, 0.9)
    formula = law(kind, nu).at_points(np.linspace(0.0, 2.0, 300), initial)
    assert random_paths(formula, initial, 20, seed=3, largest=-1.5) <= 1.0 + 1e-9


@pytest.mark.parametrize("kind", CLAYS)
def test_clay_without_strength_at_the_seabed_has_that_of_its_depth(kind: str) -> None:
    depth = np.array([1e-5, 1e-4, 0.05, 2.0])
    formula = law(kind, su=0.0).at_points(depth, np.zeros((4, 6)))
    random_paths(formula, np.zeros((4, 6)), 30, seed=5, largest=-1.0)
    strain = np.zeros((4, 6))
    strain[:, 4] = 0.1
    history = formula.start()
    for _ in range(200):
        update = formula.update(strain, history)
        history = update.history
    np.testing.assert_allclose(mandel.von_mises(update.stress), np.sqrt(3.0) * 1.0e3 * depth, rtol=1e-6)


@pytest.mark.parametrize("kind", CLAYS)
def test_contact_goes_by_the_modulus_at_half_a_diameter_there(kind: str) -> None:
    assert law(kind).surface_modulus(0.3) == 300.0 * 4.0e3
    assert law(kind, su=0.0).surface_modulus(0.3) == pytest.approx(300.0 * 0.15e3)


def on_clay(su: float, gradient: float) -> dict[str, Any]:
    scene = touchdown(LAY)
    scene["soil"]["law"] |= {"su": su, "su_gradient": gradient}
    return scene


def test_no_strength_anywhere_is_refused() -> None:
    with pytest.raises(SceneError, match=telling("soil.law.su:", "value 0.0:", "above 0", "su_gradient")):
        scene_from_mapping(on_clay(0.0, 0.0))


def test_a_riser_comes_down_on_clay_without_strength_at_the_seabed() -> None:
    assembly = build(scene_from_mapping(on_clay(0.0, 2.0e4)), MPI.COMM_SELF)
    assert assembly.riser.contact_stiffness["soil"] >= 10.0 * 300.0 * 0.15 * 2.0e4
    take(assembly, assembly.scene.stages[0])
    assert assembly.soil is not None
    settled = -assembly.soil.whole.field.total.reshape(-1, 3)[:, 2].min()
    assert 1e-4 < settled < 0.05
