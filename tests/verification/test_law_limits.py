"""All soil laws at length: a million random increments each, remoulded clay under a riser, collapse at ν = 0.4999 and
by the rate of shear.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from riser_soil.soil.laws import LAWS
from riser_soil.soil.rate import Rate
from riser_soil.soil.von_mises import VonMises
from tests.support.driven_stage import FirstStep, built
from tests.support.material_paths import initial_stress, random_paths
from tests.support.scenes import LAY, Mapping, heave, touchdown
from tests.support.stage_histories import HeavedSoil
from tests.support.strip import SU, press_strip

pytestmark = pytest.mark.verify
CLAY = {"su": 0.0, "su_gradient": 2.0e3, "E_over_su": 300.0}
REMOULDED = CLAY | {"su": 4.0e3, "remoulding": {"sensitivity": 4.0, "xi_95": 5.0}}
VISCOUS = {"rate": {"mu": 0.1, "reference": 1.0e-5}}
GIVEN: list[dict[str, Any]] = [
    {"kind": "linear-elastic", "E": 1.0e6},
    *({"kind": kind} | clay for kind in ("von-mises", "kinematic-hardening", "iwan") for clay in (CLAY, REMOULDED)),
]


@pytest.mark.parametrize("given", GIVEN, ids=lambda given: f"{given['kind']}{' remoulded' * ('remoulding' in given)}")
def test_a_million_random_increments(given: dict[str, Any]) -> None:
    """Sand has a test of its own."""
    law = LAWS[given["kind"]].model_validate(given | {"nu": 0.4999})
    depth = np.linspace(1e-3, 2.0, 10_000)
    initial = np.zeros((10_000, 6)) if given.get("su") == 0.0 else initial_stress(10_000, 0.9)
    assert random_paths(law.at_points(depth, initial), initial, 100, seed=8, largest=-1.0) <= 1.0 + 1e-9


@pytest.mark.parametrize("kind", ["hex", "tet"])
def test_strip_collapses_at_prandtls_load_at_almost_constant_volume(kind: str) -> None:
    law = VonMises(kind="von-mises", su=SU, E_over_su=300.0, nu=0.4999)
    usual, stiff = press_strip(kind, 4, far=1.0), press_strip(kind, 4, far=1.0, law=law)
    assert stiff.load[-1] == pytest.approx(usual.load[-1], rel=0.02)
    assert stiff.load[-1] - stiff.load[-2] < 1e-3 * stiff.load[-1]


@pytest.mark.parametrize("mu", [0.05, 0.2])
def test_a_strip_pressed_ten_times_as_fast_bears_mu_times_prandtls_load_more(mu: float) -> None:
    """Once all that flows is faster than the reference; the flow hardly changes with its speed."""
    law = VonMises(kind="von-mises", su=SU, E_over_su=300.0, rate=Rate(mu=mu, reference=1e-5))
    slow = press_strip("hex", 4, far=1.0).load[-1]
    loads = [press_strip("hex", 4, far=1.0, law=law, seconds=seconds).load[-1] for seconds in (10.0, 1.0, 0.1)]
    np.testing.assert_allclose(np.diff(loads), mu * slow, rtol=0.01)
    assert loads[0] > slow * (1.0 + mu)


def on_remoulded_clay(kind: str, *stages: Mapping, **more: Any) -> Mapping:
    scene = touchdown(LAY, *stages, su=700.0)
    scene["soil"]["law"] |= {"kind": kind, "remoulding": {"sensitivity": 3.0, "xi_95": 0.5}} | more
    return scene


@pytest.mark.parametrize("more", [{}, VISCOUS], ids=["", "rate"])
@pytest.mark.parametrize("kind", ["von-mises", "kinematic-hardening", "iwan"])
def test_remoulded_clay_under_a_riser_takes_energy(kind: str, more: dict[str, Any]) -> None:
    heaved = HeavedSoil(on_remoulded_clay(kind, heave(6.0, 0.15), **more))
    assert min(heaved.lost) > -1e-9 * max(heaved.lost)
    assert np.mean(heaved.iterations) < 6.0
    assert heaved.plastic_strain > 1e-4


@pytest.mark.parametrize("more", [{}, VISCOUS], ids=["", "rate"])
def test_the_matrix_on_remoulded_clay_is_the_slope_of_the_residual(more: dict[str, Any]) -> None:
    step = FirstStep(built(on_remoulded_clay("von-mises", heave(1.0, time_step=0.01), **more)))
    rng = np.random.default_rng(5)
    x = 2e-3 * rng.normal(size=step.free)
    matrix = step.matrix(x)
    for _ in range(3):
        direction = 2e-3 * rng.normal(size=step.free)
        wanted = step.slope(x, direction, 1e-5)
        assert np.linalg.norm(matrix @ direction - wanted) < 1e-5 * np.linalg.norm(wanted)
