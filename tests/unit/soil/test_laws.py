"""Constitutive laws against closed forms, and tangents against finite differences."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.soil import mandel
from riser_soil.soil.law import PLASTIC_STRAIN, STRESS, Formula
from riser_soil.soil.linear_elastic import Elastic, LinearElastic
from riser_soil.soil.von_mises import PerfectlyPlastic, VonMises

SU, E, NU = 4.0e3, 1.2e6, 0.49


def clay(depth: Array, nu: float = NU) -> PerfectlyPlastic:
    law = VonMises(kind="von-mises", su=SU, su_gradient=1.5e3, E_over_su=300.0, nu=nu)
    return law.intact(depth, np.zeros((len(depth), 6)))


def rock(depth: Array, nu: float) -> Elastic:
    law = LinearElastic(kind="linear-elastic", E=E, nu=nu)
    return law.at_points(depth, np.zeros((len(depth), 6)))


def plastic_strain(law: Formula, history: Array) -> Array:
    return history[:, law.columns.index(PLASTIC_STRAIN)]


def shear_strain(gamma: Array) -> Array:
    """Simple shear in the plane xz: engineering strain gamma (n,)."""
    strain = np.zeros((len(gamma), 6))
    strain[:, 4] = gamma / np.sqrt(2.0)
    return strain


def load_path(law: Formula, path: Array) -> tuple[Array, Array]:
    """Stress and history (n, ..) after the increments path (steps, n, 6) from an unstressed start."""
    stress: Array = np.zeros(path.shape[1:])
    history = law.start()
    for increment in path:
        stress, _, history, _, _ = law.update(increment, history)
    return stress, history


def central_difference(law: Formula, increment: Array, history: Array, step: float) -> Array:
    columns = []
    for j in range(6):
        shift = step * np.eye(6)[j]
        ahead, behind = (law.update(increment + s * shift, history).stress for s in (1.0, -1.0))
        columns.append((ahead - behind) / (2.0 * step))
    return np.stack(columns, axis=2)


def test_elastic_uniaxial_tension_has_modulus_and_contraction() -> None:
    law = rock(np.zeros(1), 0.3)
    strain = 1e-3 * np.array([[1.0, -0.3, -0.3, 0.0, 0.0, 0.0]])
    stress = law.update(strain, law.start()).stress
    np.testing.assert_allclose(stress, [[E * 1e-3, 0, 0, 0, 0, 0]], atol=1e-9 * E)


def test_elastic_modulus_is_the_same_at_every_depth() -> None:
    law = rock(np.array([0.0, 2.0]), 0.3)
    stress = law.update(shear_strain(np.full(2, 1e-3)), law.start()).stress
    G = E / 2.6
    np.testing.assert_allclose(stress[:, 4] / np.sqrt(2.0), [1e-3 * G, 1e-3 * G], rtol=1e-14)


@pytest.mark.parametrize("law", [rock(np.array([1.0]), NU), clay(np.array([1.0]))])
def test_elastic_strain_inverts_the_elastic_stress(law: Formula) -> None:
    strain = 1e-6 * np.random.default_rng(1).standard_normal((1, 6))
    update = law.update(strain, law.start())
    np.testing.assert_allclose(update.elastic, strain, rtol=1e-12)
    np.testing.assert_allclose(update.stored, 0.5 * np.sum(update.stress * strain, axis=1), rtol=1e-12)


@pytest.mark.parametrize("law", [rock(np.zeros(3), NU), clay(np.zeros(3))])
def test_each_column_of_the_history_has_a_name(law: Formula) -> None:
    assert law.start().shape == (3, len(law.columns))
    assert law.update(shear_strain(np.full(3, 0.05)), law.start()).history.shape == (3, len(law.columns))
    assert len(set(law.columns)) == len(law.columns)


def test_a_law_depends_on_its_path_if_it_keeps_more_than_the_stress() -> None:
    assert (LinearElastic.path_dependent, VonMises.path_dependent) == (False, True)
    assert (len(rock(np.zeros(1), NU).columns), len(clay(np.zeros(1)).columns)) == (len(STRESS), len(STRESS) + 1)


def test_simple_shear_yields_at_su_of_the_depth() -> None:
    depth = np.array([0.0, 1.0, 2.5])
    law = clay(depth)
    stress, history = load_path(law, np.stack([shear_strain(np.full(3, 2e-3))] * 10))
    su = SU + 1.5e3 * depth
    np.testing.assert_allclose(stress[:, 4] / np.sqrt(2.0), su, rtol=1e-13)
    G = 300.0 * su / (2.0 * (1.0 + NU))
    np.testing.assert_allclose(plastic_strain(law, history), (0.02 - su / G) / np.sqrt(3.0), rtol=1e-12)


def test_uniaxial_strain_splits_into_limit_and_pressure() -> None:
    """Confined compression: q stops at √3 su while the pressure goes on as K times the volume."""
    law = clay(np.zeros(1))
    strain = np.array([[0.0, 0.0, -0.05, 0.0, 0.0, 0.0]])
    stress, _ = load_path(law, np.stack([0.1 * strain] * 10))
    pressure = float(law.bulk[0]) * 0.05
    q = np.sqrt(3.0) * SU
    expected = [-pressure + q / 3.0, -pressure + q / 3.0, -pressure - 2.0 * q / 3.0, 0.0, 0.0, 0.0]
    np.testing.assert_allclose(stress[0], expected, rtol=1e-12, atol=1e-9)


def test_unloading_is_elastic() -> None:
    law = clay(np.zeros(1))
    stress, history = load_path(law, np.stack([shear_strain(np.array([0.05]))]))
    back, _, after, _, _ = law.update(shear_strain(np.array([-1e-3])), history)
    np.testing.assert_allclose((stress - back)[0, 4], np.sqrt(2.0) * law.shear * 1e-3, rtol=1e-12)
    np.testing.assert_array_equal(plastic_strain(law, after), plastic_strain(law, history))


def test_stress_never_exceeds_the_limit_and_slip_never_shrinks() -> None:
    law, rng = clay(np.linspace(0.0, 2.5, 50)), np.random.default_rng(2)
    history = law.start()
    for _ in range(20):
        stress, _, after, _, _ = law.update(5e-3 * rng.standard_normal((50, 6)), history)
        assert np.all(plastic_strain(law, after) >= plastic_strain(law, history))
        assert law.overstress(stress).max() <= 1.0 + 1e-12
        history = after


def test_nothing_happens_at_zero_strain() -> None:
    law = clay(np.zeros(2))
    update = law.update(np.zeros((2, 6)), law.start())
    assert not update.stress.any()
    assert not update.history.any()
    assert not update.stored.any()
    np.testing.assert_array_equal(
        law.update(np.zeros((2, 6)), update.history).tangent, mandel.stiffness(law.bulk, law.shear)
    )


def test_tangent_matches_finite_differences_in_the_plastic_range() -> None:
    law, rng = clay(np.linspace(0.0, 2.5, 20)), np.random.default_rng(3)
    history = law.update(5e-3 * rng.standard_normal((20, 6)), law.start()).history
    increment = 8e-3 * rng.standard_normal((20, 6))
    _, tangent, after, _, _ = law.update(increment, history)
    assert np.all(plastic_strain(law, after) > plastic_strain(law, history))
    scale = 2.0 * law.shear.max()
    np.testing.assert_allclose(
        tangent / scale, central_difference(law, increment, history, 1e-7) / scale, atol=1e-7
    )
    without_flow = mandel.stiffness(law.bulk, law.shear)
    assert np.abs(tangent - without_flow).max() > 0.1 * scale


def test_continuum_tangent_differs_from_the_consistent_one() -> None:
    """A tangent without the shrink factor would be wrong by the size of the step."""
    law, increment = clay(np.zeros(1)), shear_strain(np.array([0.05]))
    tangent = law.update(increment, law.start()).tangent
    transverse = tangent[0, 3, 3] / (2.0 * law.shear[0])
    shrink = SU / (law.shear[0] * 0.05)
    assert transverse == pytest.approx(shrink, rel=1e-12)


def test_von_mises_stress_of_uniaxial_and_shear_states() -> None:
    uniaxial = np.array([-3.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    shear = np.array([0.0, 0.0, 0.0, np.sqrt(2.0) * 2.0, 0.0, 0.0])
    assert mandel.von_mises(uniaxial) == pytest.approx(3.0)
    assert mandel.von_mises(shear) == pytest.approx(2.0 * np.sqrt(3.0))


def test_many_points_that_flow_answer_as_a_few_do() -> None:
    """The moduli of many points are compiled."""
    depth, strain = np.linspace(0.0, 3.0, 300), 0.02 * np.random.default_rng(4).normal(size=(300, 6))
    whole = clay(depth).update(strain, clay(depth).start())
    assert (plastic_strain(clay(depth), whole.history) > 0.0).all()
    for some in (slice(0, 50), slice(200, 280)):
        law = clay(depth[some])
        for mine, other in zip(law.update(strain[some], law.start()), whole, strict=True):
            np.testing.assert_allclose(mine, other[some], rtol=1e-12, atol=1e-9 * np.abs(other).max())
