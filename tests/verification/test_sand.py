"""Sand at length: Prandtl's strip on soil with friction, a million random increments, a riser on sand."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.soil.drucker_prager import DruckerPrager
from tests.support.driven_stage import FirstStep, built
from tests.support.material_paths import initial_stress, random_paths
from tests.support.scenes import LAY, Mapping, heave, touchdown
from tests.support.stage_histories import HeavedSoil
from tests.support.strip import press_strip

pytestmark = pytest.mark.verify
SAND: Mapping = {
    "kind": "drucker-prager",
    "friction_angle_deg": 30.0,
    "dilation_angle_deg": 5.0,
    "cohesion": 500.0,
    "E": 1.0e7,
}


def test_strip_collapses_at_prandtls_load_with_friction() -> None:
    """Without weight: c (e^(π tan φ) tan²(45° + φ/2) - 1)/tan φ with flow normal to the cone."""
    phi, c = np.radians(10.0), 1.0e3
    law = DruckerPrager(
        kind="drucker-prager", friction_angle_deg=10.0, dilation_angle_deg=10.0, cohesion=c, E=1e6, nu=0.3
    )
    factor = (np.exp(np.pi * np.tan(phi)) * np.tan(np.pi / 4.0 + phi / 2.0) ** 2 - 1.0) / np.tan(phi)
    errors = []
    for cells in (4, 8):
        strip = press_strip("hex", cells, far=4.0 / cells, law=law, strength=c)
        assert strip.load[-1] - strip.load[-2] < 1e-2 * factor, strip.load
        errors.append(strip.load[-1] / factor - 1.0)
    assert errors == pytest.approx([0.22, 0.115], abs=0.005)


@pytest.mark.parametrize(("phi", "psi"), [(20.0, 0.0), (35.0, 5.0), (32.0, 32.0)])
def test_a_million_random_increments(phi: float, psi: float) -> None:
    law = DruckerPrager(
        kind="drucker-prager", friction_angle_deg=phi, dilation_angle_deg=psi, cohesion=100.0, E=2e7, nu=0.3
    )
    initial = initial_stress(10_000, 0.5)
    assert random_paths(law.at_points(np.zeros(10_000), initial), initial, 100, seed=9, largest=-1.0) <= 1.0 + 1e-10


def on_sand(*stages: Mapping) -> Mapping:
    scene = touchdown(LAY, *stages)
    scene["soil"] |= {"law": dict(SAND), "K0": 0.5, "submerged_unit_weight": 9.0e3}
    return scene


def test_the_matrix_is_the_slope_of_the_residual() -> None:
    step = FirstStep(built(on_sand(heave(1.0, time_step=0.01))))
    rng = np.random.default_rng(5)
    x = 1e-4 * rng.normal(size=step.free)
    matrix = step.matrix(x)
    for _ in range(3):
        direction = 1e-4 * rng.normal(size=step.free)
        wanted = step.slope(x, direction, 1e-5)
        assert np.linalg.norm(matrix @ direction - wanted) < 1e-5 * np.linalg.norm(wanted)


def test_heave_takes_energy_in_every_step() -> None:
    """Without a cut. (With full Newton steps a third of them are cut, and the others take 5 iterations.)"""
    heaved = HeavedSoil(on_sand(heave(6.0, 0.15)) | {"contact": {"method": "node"}})
    assert len(heaved.lost) == 40
    assert min(heaved.lost) > -1e-9 * max(heaved.lost)
    assert np.mean(heaved.iterations) < 7.0
    assert heaved.plastic_strain > 1e-5
