"""Clay under cyclic strain: backbones, Masing loops and damping against closed forms, tangents, dissipation."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.soil import mandel
from riser_soil.soil.iwan import IwanOverlay, Overlay
from riser_soil.soil.kinematic_hardening import CyclicClay, KinematicHardening
from riser_soil.soil.law import PLASTIC_STRAIN, StressUpdate
from tests.support.scenes import touchdown

SHARE, STEP = 0.1, 1e-2  # elastic share of su; strain of a step, over su/G
Modulus = Callable[[float, float], float]
"""By the distance to the bound and that at which yielding began: plastic modulus over G."""


class YieldRange:
    """A range of 2 SHARE about a backstress, which moves by a plastic modulus."""

    def __init__(self, modulus: Modulus) -> None:
        self._modulus, self.stress = modulus, 0.0
        self._back, self._way, self._began = 0.0, 0.0, 0.0

    def strain(self, by: float) -> float:
        """The stress after a strain."""
        steps = max(1, round(abs(by) / STEP))
        for _ in range(steps):
            self._step(by / steps)
        return self.stress

    def _step(self, by: float) -> None:
        trial = self.stress + by
        beyond = abs(trial - self._back) - SHARE
        if beyond <= 0.0:
            self.stress, self._way = trial, 0.0
            return
        way = float(np.sign(trial - self._back))
        distance = max(1.0 - way * self.stress, 1e-12)
        if way != self._way:
            self._way, self._began = way, distance + 1e-9
        modulus = self._modulus(distance, self._began)
        self._back += way * modulus * beyond / (1.0 + modulus)
        self.stress = self._back + way * SHARE


def two_surfaces(h: float) -> YieldRange:
    return YieldRange(lambda distance, began: h * distance / max(began - distance, 1e-12))


def fading_backstress(h: float) -> YieldRange:
    """Armstrong & Frederick's: the modulus falls with the distance itself."""
    return YieldRange(lambda distance, began: h * distance / (1.0 - SHARE))


def lost_a_cycle(law: YieldRange, mean_strain: float, amplitude: float, cycles: int = 14) -> float:
    """Share of the mean stress that a cycle of strain takes, down by twice the amplitude from what is held."""
    law.strain(mean_strain)
    turns = [(law.strain(-2.0 * amplitude), law.strain(2.0 * amplitude)) for _ in range(cycles)]
    first, last = (sum(turns[n]) for n in (0, -1))
    return float(1.0 - (last / first) ** (1.0 / (cycles - 1)))


def added_by_the_last_cycle(law: YieldRange, low: float, high: float, cycles: int = 14) -> float:
    """Strain that the last of some cycles of stress adds."""
    tops, strain = [], 0.0
    for _ in range(cycles + 1):
        for level, way in ((high, 1.0), (low, -1.0)):
            while way * (level - law.stress) > 0.0:
                law.strain(way * STEP)
                strain += way * STEP
            if way > 0.0:
                tops.append(strain)
    return tops[-1] - tops[-2]


SU, OVER_SU, NU = 4.0e3, 300.0, 0.45
G0 = OVER_SU * SU / (2.0 * (1.0 + NU))
CURVE = ((1e-4, 0.98), (1e-3, 0.8), (5e-3, 0.45), (2e-2, 0.2))


def kinematic(n: int = 1, K0: float = 1.0, share: float = 0.1, gradient: float = 0.0) -> CyclicClay:
    law = KinematicHardening(
        kind="kinematic-hardening", su=SU, su_gradient=gradient, E_over_su=OVER_SU, nu=NU, elastic_share=share
    )
    return law.intact(np.linspace(0.0, 2.0, n), initial(n, K0))


def iwan(
    n: int = 1, K0: float = 1.0, gradient: float = 0.0, curve: tuple[tuple[float, float], ...] | None = None
) -> Overlay:
    law = IwanOverlay(kind="iwan", su=SU, su_gradient=gradient, E_over_su=OVER_SU, nu=NU, curve=curve)
    return law.intact(np.linspace(0.0, 2.0, n), initial(n, K0))


def initial(n: int, K0: float) -> Array:
    pressure = np.linspace(2000.0, 6000.0, n)
    return np.column_stack([-K0 * pressure, -K0 * pressure, -pressure, *np.zeros((3, n))])


LAWS = pytest.mark.parametrize("make", [kinematic, iwan])


def shear(gamma: float, n: int = 1) -> Array:
    strain = np.zeros((n, 6))
    strain[:, 4] = gamma / np.sqrt(2.0)
    return strain


def drive(law: CyclicClay | Overlay, strains: Array) -> tuple[Array, Array]:
    """Shear stress at the ends of increments from one shear strain to the next, and the dissipation in each [J/m3]."""
    history, before, stress, lost = law.start(), 0.0, list[float](), list[float]()
    for strain in strains:
        increment = shear(strain - before)
        update = law.update(increment, history)
        lost.append(float(dissipation(law, increment, history, update)[0]))
        stress.append(float(update.stress[0, 4]) / np.sqrt(2.0))
        history, before = update.history, float(strain)
    return np.array(stress), np.array(lost)


def dissipation(law: CyclicClay | Overlay, increment: Array, history: Array, update: StressUpdate) -> Array:
    """Work of the stress at the increment's end less what is stored of it, per volume (n,)."""
    rest = law.update(np.zeros_like(increment), history)
    by_initial = mandel.product(law.initial, update.elastic - rest.elastic)
    return np.asarray(mandel.product(update.stress, increment) - (update.stored - rest.stored) - by_initial)


@LAWS
@pytest.mark.parametrize("K0", [1.0, 0.8])
def test_the_tangent_is_that_of_the_stress(make: type, K0: float) -> None:
    law, rng = make(30, K0, gradient=800.0), np.random.default_rng(3)
    history = law.update(4e-3 * rng.standard_normal((30, 6)), law.start()).history
    for size in (1e-5, 1e-3, 2e-2):
        increment = size * rng.standard_normal((30, 6))
        update, h = law.update(increment, history), 1e-7
        for j in range(6):
            step = h * np.eye(6)[j]
            ahead, behind = (law.update(increment + sign * step, history).stress for sign in (1.0, -1.0))
            off = np.abs(update.tangent[:, :, j] - (ahead - behind) / (2.0 * h)) / G0
            assert np.median(off) < 1e-7
            assert np.quantile(off, 0.9) < 1e-4  # elements that start to yield within the difference
        elastic = mandel.stiffness(law.bulk, law.shear)
        assert np.abs(update.tangent - elastic).max() > 0.1 * G0
        symmetric = np.abs(update.tangent - np.swapaxes(update.tangent, 1, 2)).max() < 1e-10 * G0
        assert symmetric or not law.symmetric


@LAWS
def test_the_strength_is_su_in_all_directions(make: type) -> None:
    law, rng = make(200, 0.9), np.random.default_rng(1)
    direction = mandel.deviator(rng.standard_normal((200, 6)))
    history = law.start()
    for _ in range(400):
        update = law.update(2e-2 * direction, history)
        history = update.history
    np.testing.assert_allclose(mandel.von_mises(update.stress), law.limit, rtol=1e-6)
    assert law.overstress(update.stress).max() <= 1.0 + 1e-10
    assert np.all(history[:, law.columns.index(PLASTIC_STRAIN)] > 0.1)


@LAWS
def test_random_paths_stay_inside_and_only_take_work(make: type) -> None:
    law, rng = make(500, 0.9), np.random.default_rng(2)
    history = law.start()
    for step in range(60):
        increment = 10.0 ** rng.uniform(-7.0, -0.5, (500, 1)) * rng.standard_normal((500, 6))
        update = law.update(increment, history)
        assert np.isfinite(update.history).all()
        assert np.isfinite(update.tangent).all()
        assert law.overstress(update.stress).max() <= 1.0 + 1e-10, step
        lost = dissipation(law, increment, history, update)
        scale = np.abs(update.stored) + mandel.product(np.abs(update.stress), np.abs(increment)) + 1e-9
        assert np.min(lost / scale) > -1e-10, step
        history = update.history


@LAWS
def test_a_start_under_stress_is_at_rest(make: type) -> None:
    law = make(5, 0.8)
    update = law.update(np.zeros((5, 6)), law.start())
    np.testing.assert_allclose(update.stress, law.initial, atol=1e-9)
    np.testing.assert_allclose(update.stored, 0.0, atol=1e-9)
    assert not update.elastic.any()
    np.testing.assert_allclose(law.start(), update.history, atol=1e-9)


def test_kinematic_hardening_in_shear_follows_its_closed_form() -> None:
    """q = q0 + (C/γ)(1 - exp(-γ p)) and shear strain τ/G + √3 p; backward Euler's error falls with the step."""
    law, last = kinematic(), 0.02
    recall = float(law.hardening[0] / (law.limit - law.elastic_limit)[0])
    p = np.linspace(0.0, last / np.sqrt(3.0), 20001)
    q = law.elastic_limit + law.hardening / recall * (1.0 - np.exp(-recall * p))
    tau = q / np.sqrt(3.0)
    exact = float(np.interp(last, tau / law.shear + np.sqrt(3.0) * p, tau))
    errors = [abs(drive(law, np.linspace(0.0, last, n + 1)[1:])[0][-1] / exact - 1.0) for n in (50, 100, 200)]
    assert errors[-1] < 2e-3
    assert np.log2(errors[0] / errors[1]) == pytest.approx(1.0, abs=0.15)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(1.0, abs=0.15)


def backbone(gamma: Array, curve: tuple[tuple[float, float], ...]) -> Array:
    """Polygon through the curve's points, its last side on to su."""
    strain = np.array([0.0, *(g for g, _ in curve)])
    stress = G0 * strain * np.array([1.0, *(ratio for _, ratio in curve)])
    slope = (stress[-1] - stress[-2]) / (strain[-1] - strain[-2])
    end = strain[-1] + (SU - stress[-1]) / slope
    return np.interp(gamma, [*strain, end], [*stress, SU])


def test_the_overlay_follows_its_curve() -> None:
    gamma = np.linspace(0.0, 0.12, 301)[1:]
    np.testing.assert_allclose(drive(iwan(curve=CURVE), gamma)[0], backbone(gamma, CURVE), rtol=1e-12)


def test_the_hyperbola_is_met_at_its_corners() -> None:
    reference = SU / G0
    gamma = reference * np.geomspace(0.05, 200.0, 12)
    stress, _ = drive(iwan(), gamma)
    np.testing.assert_allclose(stress[:-1], (SU * gamma / (reference + gamma))[:-1], rtol=1e-12)
    assert stress[-1] == pytest.approx(SU, rel=1e-12)


def test_points_in_one_line_are_no_corners() -> None:
    """A point on a side of the polygon adds no element, and changes nothing."""
    middle = 0.5 * (1e-3 + 5e-3)
    ratio = 0.5 * (1e-3 * 0.8 + 5e-3 * 0.45) / middle
    more = iwan(curve=(*CURVE[:2], (middle, ratio), *CURVE[2:]))
    assert more.moduli.shape == iwan(curve=CURVE).moduli.shape
    gamma = np.linspace(0.0, 0.05, 101)[1:]
    np.testing.assert_allclose(drive(more, gamma)[0], backbone(gamma, CURVE), rtol=1e-12)


@LAWS
def test_small_strain_leaves_no_plastic_strain(make: type) -> None:
    law = make()
    update = law.update(shear(0.02 * SU / G0), law.start())
    assert not update.history[:, law.columns.index(PLASTIC_STRAIN)].max() > 1e-18
    np.testing.assert_allclose(update.tangent, mandel.stiffness(law.bulk, law.shear), rtol=1e-12, atol=1e-9 * G0)


@LAWS
def test_plastic_strain_in_shear_is_what_the_stress_leaves_of_the_strain(make: type) -> None:
    """One way, in steps: (γ - τ/G)/√3."""
    law = make()
    history, slip = law.start(), law.columns.index(PLASTIC_STRAIN)
    for strain in np.linspace(0.0, 0.05, 51)[1:]:
        update = law.update(shear(1e-3), history)
        history = update.history
        remaining = strain - update.stress[0, 4] / np.sqrt(2.0) / law.shear[0]
        assert history[0, slip] == pytest.approx(remaining / np.sqrt(3.0), rel=1e-9)
    assert history[0, slip] > 0.02


def test_kinematic_hardening_keeps_the_work_of_its_backstress() -> None:
    """A spring of the stiffness C, besides the elastic one, under all that it bears beyond q0: at failure each stores
    half of its stress squared over its stiffness.
    """
    law, history = kinematic(share=0.25), kinematic(share=0.25).start()
    for _ in range(200):
        update = law.update(shear(1e-3), history)
        history = update.history
    elastic, hardened = SU**2 / (2.0 * G0), (0.75 * np.sqrt(3.0) * SU) ** 2 / (2.0 * OVER_SU * SU)
    assert update.stored[0] == pytest.approx(elastic + hardened, rel=1e-6)


@pytest.mark.parametrize(
    ("amplitude", "n"),
    [(3e-3, 200), *(pytest.param(*loop, marks=pytest.mark.verify) for loop in ((3e-4, 400), (3e-2, 200)))],
)
def test_loops_are_masings(amplitude: float, n: int) -> None:
    """τ = τa - 2 f((γa - γ)/2) on the way down, the same turned on the way up; damping from the loop's area. n: steps
    of an amplitude.
    """
    law, up = iwan(curve=CURVE), np.linspace(0.0, amplitude, n + 1)[1:]
    down = np.linspace(amplitude, -amplitude, 2 * n + 1)[1:]
    stress, lost = drive(law, np.concatenate([up, down, -down]))
    tau = backbone(np.array([amplitude]), CURVE)[0]
    np.testing.assert_allclose(
        stress[n : 3 * n], tau - 2.0 * backbone(0.5 * (amplitude - down), CURVE), rtol=1e-9, atol=1e-9 * SU
    )
    np.testing.assert_allclose(stress[3 * n :], -stress[n : 3 * n], rtol=1e-9, atol=1e-9 * SU)
    middles = amplitude * (np.arange(200000) + 0.5) / 200000
    area = 8.0 * amplitude * np.mean(backbone(middles, CURVE)) - 4.0 * tau * amplitude
    by_steps = lost[n:].sum()  # backward Euler books half a step's stress more than the loop has
    assert by_steps == pytest.approx(area, rel=0.03)
    closed = drive(law, np.concatenate([up, np.linspace(amplitude, -amplitude, 10 * n + 1)[1:]]))[1][n:].sum()
    assert abs(2.0 * closed - area) < 0.3 * abs(by_steps - area) + 1e-9 * area


def test_closed_loops_of_kinematic_hardening_are_stable() -> None:
    """Cycles of the same strain come to the same stress: no ratcheting in shear."""
    cycle = 0.004 * np.sin(np.linspace(0.0, 2.0 * np.pi, 201)[1:])
    stress, lost = drive(kinematic(), np.tile(cycle, 6))
    change = np.abs(np.diff(stress.reshape(6, 200), axis=0)).max(axis=1)
    assert np.all(change[1:] < change[:-1])
    assert change[-1] < 1e-3 * SU
    assert np.all(lost >= -1e-12 * SU)
    assert lost[-200:].sum() > 0.1 * SU * 0.004


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("curve", [[1e-3, 0.5], [2e-3, 0.8]], "ever less steeply"),
        ("curve", [[1e-3, 0.5], [4e-3, 0.1]], "must rise"),
        ("elements", 1, "must be at least 2"),
        ("elements", 101, "must be at most 100"),
        ("elastic_share", 1.0, "no such key"),
    ],
)
def test_wrong_constants_are_reported(key: str, value: object, message: str) -> None:
    scene = touchdown()
    scene["soil"]["law"] = {"kind": "iwan", "su": 600.0, "E_over_su": 300.0, key: value}
    with pytest.raises(SceneError, match=message):
        scene_from_mapping(scene)


HELD, AMPLITUDE = 3.0, 0.3  # shear strains over su/G: near the strength, and cycles that yield both ways
LOW, HIGH = 0.1, 0.7  # shear stresses over su


def test_two_surfaces_forget_as_a_fading_backstress_does() -> None:
    """Towards a bound that stays slip is easier than away from it: a mean stress relaxes, a mean load strains on,
    whatever law the modulus follows between. Both backbones are at 0.91 su at 3 su/G.
    """
    laws = partial(fading_backstress, 2.98 / 3.0), partial(two_surfaces, 0.6)
    assert [law().strain(HELD) for law in laws] == pytest.approx([0.911, 0.910], abs=2e-3)
    assert [lost_a_cycle(law(), HELD, AMPLITUDE) for law in laws] == pytest.approx([0.20, 0.13], abs=0.01)
    assert [added_by_the_last_cycle(law(), LOW, HIGH) for law in laws] == pytest.approx([0.49, 0.22], abs=0.02)
