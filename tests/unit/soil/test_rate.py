"""Clay that is stronger the faster it flows: closed forms in shear, relaxation and creep, tangents, dissipation."""

from __future__ import annotations

import math
from itertools import pairwise
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
from riser_soil.soil.law import PLASTIC_STRAIN, Formula
from riser_soil.soil.layered import of_layers
from riser_soil.soil.rate import Rate
from riser_soil.soil.remoulding import Remoulding
from riser_soil.soil.von_mises import VonMises
from tests.support.material_paths import initial_stress, random_paths
from tests.support.scenes import touchdown

SU, NU, MU, SLOW = 4.0e3, 0.45, 0.12, 1.0e-5
G = 300.0 * SU / (2.0 * (1.0 + NU))
BY_E = MU / math.log(10.0)
GIVEN: dict[str, Any] = {"su": SU, "E_over_su": 300.0, "nu": NU}
RATE = Rate(mu=MU, reference=SLOW)
REMOULDING = Remoulding(sensitivity=4.0, xi_95=2.0)


def clays(**more: Any) -> list[UndrainedClay]:
    return [
        VonMises(kind="von-mises", **GIVEN, **more),
        KinematicHardening(kind="kinematic-hardening", **GIVEN, **more),
        IwanOverlay(kind="iwan", elements=6, **GIVEN, **more),
    ]


def each(**more: Any) -> pytest.MarkDecorator:
    return pytest.mark.parametrize("clay", clays(**more), ids=lambda clay: clay.kind)


def at(clay: UndrainedClay, n: int = 1, K0: float = 1.0) -> Formula:
    return clay.at_points(np.zeros(n), initial_stress(n, K0))


def shear(law: Formula, strains: Array, seconds: Array) -> tuple[Array, Array]:
    """Shear stress [Pa] and plastic shear strain gone through after each of a row of shear strains, at these times."""
    history, curve = law.start(), list[tuple[float, float]]()
    for strain, dt in zip(np.diff(strains, prepend=0.0), np.diff(seconds, prepend=0.0), strict=True):
        increment = np.zeros((1, 6))
        increment[0, 4] = strain / np.sqrt(2.0)
        answer = law.update(increment, history, dt)
        history = answer.history
        slip = float(history[0, law.columns.index(PLASTIC_STRAIN)])
        curve.append((float(answer.stress[0, 4]) / np.sqrt(2.0), np.sqrt(3.0) * slip))
    stress, slips = np.array(curve).T
    return stress, slips


@each(rate=RATE)
@pytest.mark.parametrize(("times", "gain"), [(0.01, 0.0), (1.0, 0.0), (10.0, MU), (100.0, 2.0 * MU)])
def test_steady_shear_finds_the_strength_of_its_rate(clay: UndrainedClay, times: float, gain: float) -> None:
    strains = np.linspace(0.0, 6.0, 301)[1:]
    stress, _ = shear(at(clay), strains, strains / (times * SLOW))
    assert stress[-1] == pytest.approx(SU * (1.0 + gain), rel=1e-6)


@each(rate=RATE)
def test_a_change_of_rate_changes_the_strength_alone(clay: UndrainedClay) -> None:
    """Within a strain of a few per cent the strength is that of the new rate, whatever the step."""
    strains = np.concatenate([np.linspace(0.0, 6.0, 301)[1:], 6.0 + np.linspace(0.0, 6.0, 301)[1:]])
    rates = np.where(strains <= 6.0, 1000.0, 10.0) * SLOW
    stress, _ = shear(at(clay), strains, np.cumsum(np.diff(strains, prepend=0.0) / rates))
    assert stress[[299, 599]] == pytest.approx(SU * np.array([1.0 + 3.0 * MU, 1.0 + MU]), rel=1e-6)
    assert np.diff(stress[300:]).max() < 1e-9 * SU


@each(rate=RATE)
def test_slow_is_as_without_rate_and_at_once_is_elastic(clay: UndrainedClay) -> None:
    law, intact, rng = at(clay, 40, 0.9), at(clays()[clays_at(clay)], 40, 0.9), np.random.default_rng(4)
    history = law.update(0.01 * rng.standard_normal((40, 6)), law.start()).history
    increment = 0.01 * rng.standard_normal((40, 6))
    for slow, plain in zip(law.update(increment, history), intact.update(increment, history), strict=True):
        np.testing.assert_array_equal(slow, plain)
    update = law.update(increment, history, dt=0.0)
    elastic = mandel.elastic_stress(law.bulk, law.shear, increment)
    np.testing.assert_allclose(update.stress, history[:, :6] + elastic, rtol=1e-9, atol=1e-6 * SU)
    np.testing.assert_allclose(update.tangent, mandel.stiffness(law.bulk, law.shear), rtol=1e-12, atol=1e-9 * G)


def clays_at(clay: UndrainedClay) -> int:
    return [each.kind for each in clays()].index(clay.kind)


@each(rate=RATE)
def test_no_gain_is_the_law_without_rate(clay: UndrainedClay) -> None:
    none = clay.model_copy(update={"rate": Rate(mu=0.0, reference=SLOW)})
    increment = 0.01 * np.random.default_rng(4).standard_normal((9, 6))
    law, plain = at(none, 9, 0.9), at(clays()[clays_at(clay)], 9, 0.9)
    update, wanted = law.update(increment, law.start(), 1e-3), plain.update(increment, plain.start())
    for values, expected in zip(update, wanted, strict=True):
        np.testing.assert_array_equal(values, expected)


def test_held_clay_relaxes_by_the_logarithm_of_time() -> None:
    """τ' = -G rate of 10^((τ/su - 1)/µ), and so τ = τ0 - a ln(1 + t/T), a = su µ/ln 10, T = a/(G rate0); order one."""
    law, fast, gone = at(clays(rate=RATE)[0]), 1000.0 * SLOW, 30.0
    strains = np.linspace(0.0, 0.1, 401)[1:]
    first, _ = shear(law, strains, strains / fast)
    a = SU * BY_E
    exact = first[-1] - a * np.log1p(gone * G * fast / a)
    errors = []
    for n in (40, 80, 160):
        times = np.linspace(0.0, gone, n + 1)[1:]
        path = np.concatenate([strains, np.full(n, strains[-1])])
        stress, _ = shear(law, path, np.concatenate([strains / fast, strains[-1] / fast + times]))
        errors.append(stress[-1] - exact)
    assert SU < exact < 0.98 * first[-1]
    assert 0.0 < errors[-1] < 2e-3 * SU
    np.testing.assert_allclose(np.log2(np.array(errors[:-1]) / errors[1:]), 1.0, atol=0.15)


@each(rate=RATE)
def test_held_clay_relaxes_to_the_strength_of_slow_shear(clay: UndrainedClay) -> None:
    strains = np.append(np.linspace(0.0, 6.0, 301)[1:], np.full(60, 6.0))
    times = np.append(strains[:300] / (1000.0 * SLOW), 600.0 + np.geomspace(1e-2, 1e8, 60))
    stress, _ = shear(at(clay), strains, times)
    assert np.diff(stress[299:]).max() <= 1e-9 * SU
    kept = 0.9 * 3.0 * MU if clay.kind == "kinematic-hardening" else 0.0  # what α has gained stays until clay flows
    assert stress[-1] == pytest.approx(SU * (1.0 + kept), rel=1e-2)


@pytest.mark.parametrize("remoulding", [None, REMOULDING], ids=["", "remoulded"])
@each(rate=RATE)
def test_the_tangent_is_that_of_the_stress(clay: UndrainedClay, remoulding: Remoulding | None) -> None:
    """The tangent is checked by differences; without the gain's derivative it is another one."""
    law, rng = at(clay.model_copy(update={"remoulding": remoulding}), 40, 0.9), np.random.default_rng(3)
    history = law.start()
    for _ in range(4):
        history = law.update(0.05 * rng.standard_normal((40, 6)), history, 10.0).history
    for size, dt in ((1e-3, 1.0), (5e-3, 30.0), (5e-3, 1e-3)):
        increment, h = size * rng.standard_normal((40, 6)), 1e-8
        update = law.update(increment, history, dt)
        slow = law.update(increment, history).tangent
        off, without = np.empty((2, 40, 6, 6))
        for j, step in enumerate(h * np.eye(6)):
            ahead, behind = (law.update(increment + sign * step, history, dt).stress for sign in (1.0, -1.0))
            off[:, :, j] = update.tangent[:, :, j] - (ahead - behind) / (2.0 * h)
            without[:, :, j] = slow[:, :, j] - (ahead - behind) / (2.0 * h)
        assert np.quantile(np.abs(off), 0.9) < 1e-6 * G
        assert np.abs(off).max(axis=(1, 2)).mean() < 1e-5 * G
        assert np.quantile(np.abs(without).max(axis=(1, 2)), 0.5) > 1e-2 * G
        skew = np.abs(update.tangent - np.swapaxes(update.tangent, 1, 2)).max()
        assert skew < 1e-10 * G or not law.symmetric


@pytest.mark.parametrize("remoulding", [None, REMOULDING], ids=["", "remoulded"])
@each(rate=RATE)
def test_random_paths_only_take_work(clay: UndrainedClay, remoulding: Remoulding | None) -> None:
    """At rates that jump by powers of ten from step to step; stress stays within the strength of the fastest."""
    law = at(clay.model_copy(update={"remoulding": remoulding}), 500, 0.9)
    seconds = 10.0 ** np.random.default_rng(6).uniform(-3.0, 5.0, 40)
    worst = random_paths(law, initial_stress(500, 0.9), 40, seed=2, seconds=[*seconds])
    assert 1.2 < worst < 1.0 + 10.0 * MU


def cycles(law: Formula, rate: float, amplitude: float, n: int, turns: int = 9) -> tuple[Array, Array]:
    """Shear stress and plastic shear strain at the turns of cycles at a rate of strain."""
    ends = np.append(0.0, amplitude * (-1.0) ** np.arange(turns))
    path = np.concatenate([np.linspace(a, b, n + 1)[1:] for a, b in pairwise(ends)])
    stress, slips = shear(law, path, np.cumsum(np.abs(np.diff(path, prepend=0.0))) / rate)
    return np.abs(stress[n - 1 :: n]), slips[n - 1 :: n]


@each(rate=RATE, remoulding=REMOULDING)
def test_cycles_weaken_by_what_they_have_remoulded_and_strengthen_by_their_rate(clay: UndrainedClay) -> None:
    """Turn by turn su δ(ξ) (1 + µ lg rate), later cycles below earlier ones; the fast ones flow a little less."""
    strengths = [cycles(at(clay), times * SLOW, 1.5, 400) for times in (1.0, 100.0)]
    for (stress, xi), gain in zip(strengths, (0.0, 2.0 * MU), strict=True):
        remaining = 0.25 + 0.75 * np.exp(-1.5 * xi)
        near = 0.03 if clay.kind == "iwan" else 0.01  # whose strongest element yields last
        np.testing.assert_allclose(stress, SU * remaining * (1.0 + gain), rtol=near)
        assert (np.diff(stress) < 0.0).all()
        assert stress[-1] < 0.3 * (1.0 + gain) * SU
    assert (strengths[1][1] < strengths[0][1]).all()


def test_smaller_steps_of_a_cycle_converge_at_order_one() -> None:
    law = at(clays(rate=RATE, remoulding=REMOULDING)[1])
    results = [cycles(law, 100.0 * SLOW, 0.05, n, turns=5)[0] for n in (50, 100, 200, 400)]
    changes = np.array([np.abs(fine - coarse).max() / SU for coarse, fine in pairwise(results)])
    assert changes[-1] < 2e-3
    np.testing.assert_allclose(np.log2(changes[:-1] / changes[1:]), 1.0, atol=0.2)


def test_layers_with_and_without_rate_lie_side_by_side() -> None:
    laws = [clays(rate=RATE)[0], clays()[1]]
    initial = initial_stress(6, 1.0)
    law = of_layers(laws, np.array([0, 1, 0, 1, 1, 0]), np.zeros(6), initial)
    assert law.by_rate
    assert not of_layers(laws[1:], np.zeros(6, dtype=int), np.zeros(6), initial).by_rate
    increment = 0.05 * np.random.default_rng(1).standard_normal((6, 6))
    update = law.update(increment, law.start(), 1.0)
    for places, own in (([0, 2, 5], laws[0]), ([1, 3, 4], laws[1])):
        alone = own.at_points(np.zeros(3), initial[places])
        wanted = alone.update(increment[places], alone.start(), 1.0)
        np.testing.assert_array_equal(update.stress[places], wanted.stress)
        np.testing.assert_array_equal(update.tangent[places], wanted.tangent)
    over = law.overstress(update.stress)
    assert over[[0, 2, 5]].min() > 1.3 > 1.0 + 1e-9 > over[[1, 3, 4]].max()


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"mu": -0.1, "reference": 1e-5}, "must be at least 0"),
        ({"mu": 1.5, "reference": 1e-5}, "must be at most 1"),
        ({"mu": 0.1, "reference": 0.0}, "must be greater than 0"),
        ({"mu": 0.1}, "missing"),
        ({"mu": 0.1, "reference": 1e-5, "gain": 1.0}, "no such key"),
    ],
)
def test_wrong_constants_are_reported(given: dict[str, float], message: str) -> None:
    scene = touchdown()
    scene["soil"]["law"]["rate"] = given
    with pytest.raises(SceneError, match=message):
        scene_from_mapping(scene)
