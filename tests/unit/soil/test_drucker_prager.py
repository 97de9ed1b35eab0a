"""Sand by Drucker & Prager: strength against Mohr & Coulomb, flow, tangents, the apex, dissipation."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.soil import mandel
from riser_soil.soil.drucker_prager import DruckerPrager, FrictionalSoil
from riser_soil.soil.law import PLASTIC_STRAIN
from tests.support.material_paths import initial_stress, random_paths
from tests.support.scenes import touchdown

E, NU, C = 2.0e7, 0.3, 200.0
ANGLES = pytest.mark.parametrize(("phi", "psi"), [(20.0, 0.0), (35.0, 5.0), (32.0, 32.0), (45.0, 15.0)])


def sand(n: int = 1, phi: float = 35.0, psi: float = 5.0, K0: float = 0.5, **constants: Any) -> FrictionalSoil:
    given = {"cohesion": C, "E": E, "nu": NU} | constants
    law = DruckerPrager(kind="drucker-prager", friction_angle_deg=phi, dilation_angle_deg=psi, **given)
    return law.at_points(np.linspace(0.0, 2.0, n), initial_stress(n, K0))


def coulomb(stress: Array, phi: float) -> Array:
    """Largest shear stress over Mohr & Coulomb's (n,)."""
    tensor = np.zeros((len(stress), 3, 3))
    for k, (i, j) in enumerate([(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]):
        tensor[:, i, j] = tensor[:, j, i] = stress[:, k] / (1.0 if i == j else np.sqrt(2.0))
    low, _, high = np.linalg.eigvalsh(tensor).T
    friction = np.radians(phi)
    return 0.5 * (high - low) / (C * np.cos(friction) - 0.5 * (high + low) * np.sin(friction))


def sheared(law: FrictionalSoil, direction: Array, steps: int = 400) -> tuple[Array, Array]:
    """Stress and the last change of it (n, 6) after so many equal increments."""
    history, stress, change = law.start(), law.initial, np.zeros_like(law.initial)
    for _ in range(steps):
        update = law.update(direction, history)
        change, stress, history = update.stress - stress, update.stress, update.history
    return stress, change


@ANGLES
def test_plane_strain_fails_as_mohr_and_coulomb_say(phi: float, psi: float) -> None:
    """Sheared with the dilation that the flow wants, so that the stress comes to rest."""
    law = sand(1, phi, psi)
    dilates = np.sin(np.radians(psi))
    stress, change = sheared(law, 6e-5 * np.array([[1.0 + dilates, 0.0, dilates - 1.0, 0.0, 0.0, 0.0]]), 1000)
    assert np.abs(change).max() < 1e-9 * np.abs(stress).max()
    assert coulomb(stress, phi)[0] == pytest.approx(1.0, rel=1e-9)
    assert law.overstress(stress)[0] == pytest.approx(1.0, abs=1e-12)


@ANGLES
def test_triaxial_compression_fails_as_mohr_and_coulomb_say(phi: float, psi: float) -> None:
    law = sand(1, phi, psi, K0=1.0, match="triaxial-compression")
    volume = 3.0 * law.dilation / (3.0 + law.dilation)  # over the axial strain, so that the mean stress comes to rest
    side = 0.5 * (1.0 + volume)
    stress, _ = sheared(law, 6e-5 * np.array([[side, side, -1.0, 0.0, 0.0, 0.0]]), 1000)
    assert coulomb(stress, phi)[0] == pytest.approx(1.0, rel=1e-9)
    low, high = -stress[0, 2], -stress[0, 0]
    passive = (1.0 + np.sin(np.radians(phi))) / (1.0 - np.sin(np.radians(phi)))
    assert low == pytest.approx(passive * high + 2.0 * C * np.sqrt(passive), rel=1e-9)


@ANGLES
def test_the_flow_dilates_by_its_angle(phi: float, psi: float) -> None:
    """Volume over largest shear of the plastic strain in plane strain: sin ψ."""
    law = sand(1, phi, psi)
    dilates = np.sin(np.radians(psi))
    direction = 6e-5 * np.array([[1.0 + dilates, 0.0, dilates - 1.0, 0.0, 0.0, 0.0]])
    stress, _ = sheared(law, direction, 1000)
    history = np.column_stack((stress, np.zeros(1)))
    update = law.update(direction, history)
    plastic = direction - mandel.elastic_strain(law.bulk, law.shear, update.stress - stress)
    volume, shear = plastic[0, 0] + plastic[0, 2], plastic[0, 0] - plastic[0, 2]
    assert abs(plastic[0, 1]) < 1e-6 * shear
    assert volume / shear == pytest.approx(dilates, abs=1e-6)


def test_the_associated_cone_is_drucker_and_pragers() -> None:
    """alpha = tan φ/√(9 + 12 tan² φ) of I1, k = 3 c/√(9 + 12 tan² φ), both for √J2."""
    tangent = np.tan(np.radians(30.0))
    root = np.sqrt(9.0 + 12.0 * tangent**2)
    law = DruckerPrager(kind="drucker-prager", friction_angle_deg=30.0, dilation_angle_deg=30.0, cohesion=C, E=E)
    slope, k, dilation = law.cone()
    assert slope == pytest.approx(3.0 * np.sqrt(3.0) * tangent / root, rel=1e-12)
    assert k == pytest.approx(3.0 * np.sqrt(3.0) * C / root, rel=1e-12)
    assert dilation == slope


def off(law: FrictionalSoil, increment: Array, history: Array) -> Array:
    """Largest difference of the tangent from that by differences, at each point, over 2G."""
    update, h = law.update(increment, history), 1e-8
    columns = [
        (law.update(increment + step, history).stress - law.update(increment - step, history).stress) / (2.0 * h)
        for step in h * np.eye(6)
    ]
    return np.abs(update.tangent - np.stack(columns, axis=2)).max(axis=(1, 2)) / (2.0 * law.shear)


@ANGLES
def test_the_tangent_is_that_of_the_stress(phi: float, psi: float) -> None:
    law, rng = sand(60, phi, psi), np.random.default_rng(4)
    history = law.update(1e-4 * rng.standard_normal((60, 6)), law.start()).history
    compressed = -3e-4 * np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
    kinds = set[str]()
    for push in (compressed, -3.0 * compressed):
        increment = push + 3e-4 * rng.standard_normal((60, 6))
        update = law.update(increment, history)
        errors = off(law, increment, history)
        allowed = np.where(np.abs(update.tangent).max(axis=(1, 2)) < 1e-3 * E, 3e-4, 1e-5)  # what is left at the apex
        assert np.mean(errors < allowed) > 0.9  # some points lie on a corner of the return
        elastic = np.abs(update.tangent - mandel.stiffness(law.bulk, law.shear)).max(axis=(1, 2)) == 0.0
        apex = np.abs(update.stress - C / np.tan(np.radians(phi)) * mandel.UNIT).max(axis=1) < 1e-9 * C
        cone = ~elastic & ~apex
        kinds |= {name for name, of in (("cone", cone), ("apex", apex)) if np.count_nonzero(of) > 9}
        turned = np.abs(update.tangent - np.swapaxes(update.tangent, 1, 2)).max()
        assert (turned < 1e-10 * E) == law.symmetric or not cone.any()
    assert kinds == {"cone", "apex"}


def test_no_tension_beyond_the_apex() -> None:
    """What is sheared there is sheared for good: √2 e/√3 of the tensor's component e, a shear strain of 2 e."""
    law = sand(3, K0=1.0)
    pulled = law.update(np.tile([1e-2, 1e-2, 1e-2, 1e-3, 0.0, 0.0], (3, 1)), law.start())
    apex = C / np.tan(np.radians(35.0))
    np.testing.assert_allclose(pulled.stress, apex * np.tile(mandel.UNIT, (3, 1)), rtol=1e-12)
    slipped = 2.0 * (1e-3 / np.sqrt(2.0)) / np.sqrt(3.0)
    np.testing.assert_allclose(pulled.history[:, law.columns.index(PLASTIC_STRAIN)], slipped, rtol=1e-12)


@ANGLES
def test_random_paths_stay_inside_and_only_take_work(phi: float, psi: float) -> None:
    """100,000 increments in all."""
    law = sand(1000, phi, psi)
    assert random_paths(law, law.initial, 25, seed=int(phi), largest=-1.5) <= 1.0 + 1e-10


def test_closed_cycles_take_work() -> None:
    """Random cycles that end at the strain and, after some rounds, nearly at the stress where they began."""
    law, rng = sand(200), np.random.default_rng(6)
    corners = 2e-4 * rng.standard_normal((3, 200, 6))
    path = [corners[0], corners[1] - corners[0], corners[2] - corners[1], corners[0] - corners[2]]
    history, before = law.start(), law.initial
    history = law.update(path[0], history).history
    for _ in range(30):
        work: Array = np.zeros(200)
        before = history[:, :6]
        for increment in path[1:]:
            update = law.update(increment, history)
            work += mandel.product(update.stress, increment)
            history = update.history
        change = mandel.elastic_strain(law.bulk, law.shear, update.stress)
        stored = 0.5 * mandel.product(update.stress, change)
        stored -= 0.5 * mandel.product(before, mandel.elastic_strain(law.bulk, law.shear, before))
        assert np.min(work - stored) > -1e-9 * np.max(np.abs(work))
    closed = np.abs(update.stress - before).max(axis=1) < 1e-3 * np.abs(before).max(axis=1)
    assert np.count_nonzero(closed) > 20
    assert work[closed].min() > -1e-3 * np.abs(work).max()


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("friction_angle_deg", 75.0, "must be at most 60"),
        ("dilation_angle_deg", 40.0, "must be at most friction_angle_deg"),
        ("cohesion", 0.0, "must be greater than 0"),
        ("E_gradient", -2e7, "E must stay positive"),
        ("match", "circle", "plane-strain"),
    ],
)
def test_wrong_constants_are_reported(key: str, value: object, message: str) -> None:
    scene = touchdown()
    right = {"kind": "drucker-prager", "friction_angle_deg": 35.0, "cohesion": 200.0, "E": 1e7}
    scene["soil"]["law"] = right
    scene_from_mapping(scene)
    scene["soil"]["law"] = right | {key: value}
    with pytest.raises(SceneError, match=message):
        scene_from_mapping(scene)
