"""Clay that loses strength with plastic strain: closed forms in shear, the current limit, tangents, dissipation."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.soil import mandel
from riser_soil.soil.clay import UndrainedClay
from riser_soil.soil.iwan import IwanOverlay
from riser_soil.soil.kinematic_hardening import KinematicHardening
from riser_soil.soil.law import PLASTIC_STRAIN
from riser_soil.soil.remoulding import RemouldedClay, Remoulding
from riser_soil.soil.von_mises import PerfectlyPlastic, VonMises
from tests.support.material_paths import at_start, dissipated, initial_stress, random_paths
from tests.support.scenes import touchdown

SU, NU, REST, XI = 4.0e3, 0.45, 0.25, 2.0
G = 300.0 * SU / (2.0 * (1.0 + NU))
GIVEN: dict[str, Any] = {"su": SU, "E_over_su": 300.0, "nu": NU, "remoulding": Remoulding(sensitivity=4.0, xi_95=XI)}
CLAYS: list[UndrainedClay] = [
    VonMises(kind="von-mises", **GIVEN),
    KinematicHardening(kind="kinematic-hardening", **GIVEN),
    IwanOverlay(kind="iwan", elements=6, **GIVEN),
]
EACH = pytest.mark.parametrize("clay", CLAYS, ids=lambda clay: clay.kind)


def at(clay: UndrainedClay, n: int, K0: float = 1.0) -> RemouldedClay:
    formula = clay.at_points(np.zeros(n), initial_stress(n, K0))
    assert isinstance(formula, RemouldedClay)
    return formula


def remaining(xi: Array | float) -> Any:
    return REST + (1.0 - REST) * np.exp(-3.0 * np.asarray(xi) / XI)


def shear(law: RemouldedClay, strains: Array) -> tuple[Array, Array]:
    """Shear stress [Pa] and plastic shear strain gone through after each of a row of shear strains."""
    history, before, curve = law.start(), 0.0, list[tuple[float, float]]()
    for strain in strains:
        increment = np.zeros((1, 6))
        increment[0, 4] = (strain - before) / np.sqrt(2.0)
        answer = law.update(increment, history)
        slip = float(answer.history[0, law.columns.index(PLASTIC_STRAIN)])
        curve.append((float(answer.stress[0, 4]) / np.sqrt(2.0), np.sqrt(3.0) * slip))
        history, before = answer.history, float(strain)
    stress, slips = np.array(curve).T
    return stress, slips


def test_ninety_five_per_cent_are_lost_at_xi_95() -> None:
    lost = 1.0 - Remoulding(sensitivity=4.0, xi_95=XI).factor(np.array([0.0, XI / np.sqrt(3.0), 1e3]))
    np.testing.assert_allclose(lost, [0.0, 0.75 * 0.950213, 0.75], rtol=1e-6)


def test_steady_shear_follows_the_strength_of_its_strain() -> None:
    """Step by step su δ of ξ at the step's start; with small steps τ = su δ(γ - τ/G)."""
    errors = []
    for n in (200, 400, 800):
        strains = np.linspace(0.0, 3.0, n + 1)[1:]
        stress, slips = shear(at(CLAYS[0], 1), strains)
        yields = slips > 0.0
        before = np.append(0.0, slips[:-1])
        np.testing.assert_allclose(stress[yields], (SU * remaining(before))[yields], rtol=1e-12)
        errors.append(np.abs(stress / (SU * remaining(strains - stress / G)) - 1.0)[yields].max())
    assert errors[-1] < 0.006
    np.testing.assert_allclose(np.log2(np.array(errors[:-1]) / errors[1:]), 1.0, atol=0.1)


def test_cycles_of_shear_follow_their_closed_form() -> None:
    """The strain ξ grows from turn to turn by 2 γa - su (δ + δ')/G: what is left of 2 γa after the elastic way back."""
    amplitude, n = 0.06, 300
    turns = amplitude * (-1.0) ** np.arange(12)
    path = np.concatenate([np.linspace(a, b, n + 1)[1:] for a, b in zip([0.0, *turns], turns, strict=False)])
    stress, slips = shear(at(CLAYS[0], 1), path)
    xi = [amplitude - SU / G]
    for way in (amplitude, *[2.0 * amplitude] * 11):
        before = xi[-1] if way > amplitude else 0.0
        elastic, after = SU * remaining(before) / G if way > amplitude else 0.0, before
        for _ in range(60):
            after = before + way - elastic - SU * remaining(after) / G
        xi.append(after)
    np.testing.assert_allclose(slips[n - 1 :: n], xi[1:], rtol=1e-3)
    np.testing.assert_allclose(np.abs(stress[n - 1 :: n]), SU * remaining(np.array(xi[1:])), rtol=1e-3)
    assert xi[-1] > 0.5 * XI


@EACH
def test_much_strain_leaves_the_remoulded_strength(clay: UndrainedClay) -> None:
    stress, _ = shear(at(clay, 1), np.linspace(0.0, 40.0, 801))
    assert stress[-1] == pytest.approx(REST * SU, rel=2e-3)


@EACH
def test_the_tangent_is_that_of_the_stress(clay: UndrainedClay) -> None:
    law, rng = at(clay, 30, 0.9), np.random.default_rng(3)
    history = law.start()
    for _ in range(6):
        history = law.update(0.05 * rng.standard_normal((30, 6)), history).history
    assert 0.3 < law.strength(history).mean() < 0.6
    increment, h = 3e-3 * rng.standard_normal((30, 6)), 1e-8
    update = law.update(increment, history)
    for j, step in enumerate(h * np.eye(6)):
        ahead, behind = (law.update(increment + sign * step, history).stress for sign in (1.0, -1.0))
        off = np.abs(update.tangent[:, :, j] - (ahead - behind) / (2.0 * h)) / G
        assert np.quantile(off, 0.8) < 1e-6


@EACH
def test_stress_stays_within_the_strength_that_is_left(clay: UndrainedClay) -> None:
    law, rng = at(clay, 300, 0.9), np.random.default_rng(7)
    history = law.start()
    for _ in range(40):
        limit = np.sqrt(3.0) * SU * law.strength(history)
        update = law.update(10.0 ** rng.uniform(-5.0, -0.7, (300, 1)) * rng.standard_normal((300, 6)), history)
        assert (mandel.von_mises(update.stress) / limit).max() < 1.0 + 1e-10
        history = update.history
    assert np.median(limit) < 0.35 * np.sqrt(3.0) * SU


@EACH
def test_random_paths_only_take_work(clay: UndrainedClay) -> None:
    law = at(clay, 500, 0.9)
    assert random_paths(law, initial_stress(500, 0.9), 40, seed=2) <= 1.0 + 1e-10


@EACH
def test_weaker_clay_that_stands_still_only_loses_energy(clay: UndrainedClay) -> None:
    """The limit falls after a step; without strain the next one lets stress down to it and dissipates what it held."""
    law = at(clay, 50, 0.9)
    strained = 0.4 * mandel.deviator(np.random.default_rng(1).standard_normal((50, 6)))
    before = law.update(strained, at_start(law, 50).history)
    after = law.update(np.zeros((50, 6)), before.history)
    lost = dissipated(initial_stress(50, 0.9), np.zeros((50, 6)), before, after)
    assert lost.min() > 0.0


def test_clay_without_remoulding_is_the_intact_one() -> None:
    law = VonMises(kind="von-mises", su=SU, E_over_su=300.0)
    assert isinstance(law.at_points(np.zeros(1), np.zeros((1, 6))), PerfectlyPlastic)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"sensitivity": 0.5, "xi_95": 10.0}, "must be at least 1"),
        ({"sensitivity": 3.0, "xi_95": 0.0}, "must be greater than 0"),
        ({"sensitivity": 3.0}, "missing"),
    ],
)
def test_wrong_constants_are_reported(given: dict[str, float], message: str) -> None:
    scene = touchdown()
    scene["soil"]["law"]["remoulding"] = given
    with pytest.raises(SceneError, match=message):
        scene_from_mapping(scene)
