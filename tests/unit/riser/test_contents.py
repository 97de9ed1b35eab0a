"""Contents that flow and slugs: integrals, a pipe that conveys a fluid, energy, and what a scene may say of them."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.linalg import eig

from riser_soil.assembly.contents import contents_of
from riser_soil.core.arrays import Array
from riser_soil.core.part import Part, State, Weights
from riser_soil.errors import SceneError
from riser_soil.riser import shapes
from riser_soil.riser.beam import Beam
from riser_soil.riser.contents import Flow, FlowMatrices, InnerFlow, SlugTrain
from riser_soil.riser.hermite import consistent_mass
from riser_soil.riser.inertia import Inertia
from riser_soil.riser.line import Line
from riser_soil.riser.line_ends import End
from riser_soil.riser.sections import Surroundings
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.scene import Initial, Scene
from tests.support.dense_chain import residual, tangent
from tests.support.driven_stage import built
from tests.support.pipes import pipe
from tests.support.said import telling
from tests.support.sample_line import sample
from tests.support.scenes import Mapping, dynamic, prescribed, riser_scene, static

pytestmark = pytest.mark.usefixtures("uncompiled")

G, BORE, AREA = 9.81, 0.3, 0.25 * math.pi * 0.3**2
L = 8.0  # m, of the sample


def stretches(t: float, *slugs: SlugTrain, **more: Any) -> list[tuple[float, float, float]]:
    return Flow(850.0, slugs=slugs, **more).stretches(t, L)


def test_a_slug_passes_through() -> None:
    """A slug enters at the start, is cut off at the end, and is gone when all of it has left."""
    slug = SlugTrain(300.0, 3.0, front=-1.0)
    plugs = {t: stretches(t, slug, speed=2.0) for t in (0.0, 0.5, 1.0, 4.0, 5.0, 6.0)}
    assert plugs == {
        **{0.0: [], 0.5: []},
        **{1.0: [(0.0, 1.0, 300.0)], 4.0: [(4.0, 7.0, 300.0)], 5.0: [(6.0, 8.0, 300.0)], 6.0: []},
    }


def test_slugs_that_follow_come_one_after_the_other() -> None:
    train = SlugTrain(300.0, 1.0, 0.0, 2.5)
    assert stretches(2.0, train, speed=1.0) == [(1.0, 2.0, 300.0)]
    many = [(0.0, 1.0, 300.0), (2.5, 3.5, 300.0), (5.0, 6.0, 300.0), (7.5, 8.0, 300.0)]
    assert sorted(stretches(11.0, train, speed=1.0)) == many
    assert sorted(stretches(1001.0, train, speed=1.0)) == many


def test_flow_from_end_to_start_is_its_image() -> None:
    slugs = SlugTrain(300.0, 1.0, 0.4, 2.5), SlugTrain(-200.0, 0.7, 5.0)
    forth, back = (stretches(1.7, *slugs, speed=speed) for speed in (3.0, -3.0))
    assert back == [(L - last, L - first, density) for first, last, density in forth]


def test_without_a_running_clock_slugs_stand() -> None:
    slug = SlugTrain(300.0, 3.0, front=1.0)
    assert stretches(9.0, slug, speed=2.0, runs=False, clock=1.5) == stretches(0.0, slug, speed=2.0, clock=1.5)
    assert stretches(0.0, slug, speed=2.0, clock=1.5) == [(1.0, 4.0, 300.0)]


def matrices_of(part: InnerFlow, t: float) -> FlowMatrices:
    """The matrices of contents at a time."""
    part.renew_kernel_data(t, t)
    numbers: Any = part.kernel_data()
    matrices: FlowMatrices = numbers.now
    return matrices


def part_in(line: Line, flow: Flow) -> InnerFlow:
    return InnerFlow(line, np.full(line.length.size, BORE), flow)


def test_a_pipe_full_of_a_slug_has_its_consistent_mass_and_weight() -> None:
    at = sample(2)
    part = part_in(at.line, Flow(850.0, 0.0, [SlugTrain(200.0, L, L)], G, runs=False))
    numbers = matrices_of(part, 0.0)
    np.testing.assert_allclose(numbers.mass, consistent_mass(at.line.length, np.full(5, 200.0 * AREA)), rtol=1e-13)
    half = 0.5 * G * 200.0 * AREA * at.line.length
    np.testing.assert_allclose(numbers.weight[:, 0], half, rtol=1e-13)
    np.testing.assert_allclose(numbers.weight[:, 1], half * at.line.length / 6.0, rtol=1e-13)
    assert not numbers.coriolis.any()
    assert not numbers.centrifugal.any()


def test_weight_and_centrifugal_force_grow_with_the_load_factor() -> None:
    """In a first static stage; what else there is stays."""
    at, given = sample(2), Flow(850.0, 3.0, [SlugTrain(200.0, 2.0, 5.0)], G, runs=False)
    whole = matrices_of(part_in(at.line, given), 0.25)
    grown = matrices_of(part_in(at.line, replace(given, grows=True)), 0.25)
    for name, share in (("weight", 0.25), ("centrifugal", 0.25), ("mass", 1.0), ("coriolis", 1.0)):
        np.testing.assert_allclose(getattr(grown, name), share * getattr(whole, name), rtol=1e-14)
        assert getattr(whole, name).any()


@pytest.mark.parametrize("t", [0.3, 1.9, 3.1])
def test_weight_and_inertia_are_those_of_what_is_in_the_pipe(t: float) -> None:
    """Contents begin and end within elements: resultant, moment about the start and mass, by hand."""
    at = sample(2, shaken=False)
    line, flow = at.line, Flow(850.0, 2.0, [SlugTrain(300.0, 3.0, 0.5)], G)
    part = part_in(line, flow)
    matrices, first = matrices_of(part, t), line.arc[:-1]
    ends = max(0.5 + 2.0 * t - 3.0, 0.0), min(0.5 + 2.0 * t, L)
    length, middle = ends[1] - ends[0], 0.5 * (ends[0] + ends[1])
    rigid, one = np.array([1.0, 0.0, 1.0, 0.0]), np.ones(5)
    linear = np.stack([first, one, first + line.length, one], axis=1)
    assert matrices.weight.sum(axis=0) @ rigid == pytest.approx(300.0 * AREA * G * length, rel=1e-12)
    assert np.sum(matrices.weight * linear) == pytest.approx(300.0 * AREA * G * length * middle, rel=1e-12)
    assert rigid @ matrices.mass.sum(axis=0) @ rigid == pytest.approx(300.0 * AREA * length, rel=1e-12)
    flowing = 850.0 * AREA * L + 300.0 * AREA * length  # all that flows has Coriolis's force
    assert np.einsum("i,eij,ej->", rigid, matrices.coriolis, linear) == pytest.approx(2.0 * 2.0 * flowing, rel=1e-12)


def test_every_part_of_the_tangent_counts() -> None:
    """Each is there: without it the tangent is another one by more than a thousandth."""
    at = sample(3)
    state, weights = at.state(1), Weights(0.7, 1.3, 4.0, 9.0)
    whole = tangent([at.contents()], state, weights)
    for name in ("mass", "coriolis", "centrifugal"):
        part = at.contents()
        getattr(matrices_of(part, state.t), name)[:] = 0.0
        assert np.abs(tangent([part], state, weights) - whole).max() > 1e-3 * np.abs(whole).max(), name


# A straight pipe on two hinges that conveys a fluid

SPAN, EI, PIPE, FLUID = 10.0, 2.0e5, 60.0, 50.0  # m, N m2, kg/m


def hinged(u: float, n: int = 16) -> tuple[Array, Array, Array]:
    """Stiffness, gyroscopic matrix and mass of the motions across."""
    around = Surroundings(gravity=0.0, contents=FLUID / AREA)
    e = pipe(SPAN, n, around, EA=1.0e9, EI=EI, mass=PIPE, inner_diameter=BORE)
    straight = shapes.straight(e.arc)
    line = Line(2, shapes.layout(e.arc, e.outer_diameter, straight, straight), End(True), End(True))
    line.offset = 0
    parts: list[Part] = [Beam(line, e), Inertia(line, e.mass), InnerFlow(line, e.inner_diameter, Flow(FLUID / AREA, u))]
    across = np.zeros((line.nodes, 3), dtype=bool)
    across[:, 1:] = True
    free = np.ix_(*[np.flatnonzero(across.ravel() & ~line.prescribed)] * 2)
    at_rest = State.at_rest(0.0, line.size)
    whole = [tangent(parts, at_rest, Weights(*weights))[free] for weights in ((0, 1, 0, 0), (0, 1, 1, 0), (1, 0, 0, 1))]
    return whole[0], whole[1] - whole[0], whole[2]


CRITICAL = math.pi / SPAN * math.sqrt(EI / FLUID)


def test_flow_buckles_a_pipe_at_the_critical_speed() -> None:
    """u = pi/L (EI/m)^(1/2), as m u^2 is a compression (Paidoussis 1998, 3.4)."""
    least = [np.linalg.eigvals(hinged(share * CRITICAL)[0]).real.min() for share in (0.999, 1.001)]
    assert least[0] > 0.0 > least[1]


def galerkin(u: float, n: int = 12) -> float:
    """Lowest frequency [rad/s] by n sines: m u^2 and 2 m u by their integrals over the span."""
    r, s = np.meshgrid(np.arange(1, n + 1), np.arange(1, n + 1), indexing="ij")
    odd = (r + s) % 2 == 1
    slope = np.divide(4.0 * r * s, (r**2 - s**2) * SPAN, out=np.zeros((n, n)), where=odd)  # 2/L int sin_r d(sin_s)/dx
    wave = np.arange(1, n + 1) * math.pi / SPAN
    K = np.diag(EI * wave**4 - FLUID * u**2 * wave**2)
    return lowest(K, 2.0 * FLUID * u * slope, (PIPE + FLUID) * np.eye(n))


def lowest(K: Array, C: Array, M: Array) -> float:
    n = len(K)
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-K, -C]])
    B = np.block([[np.eye(n), np.zeros((n, n))], [np.zeros((n, n)), M]])
    values = eig(A, B, right=False)
    return float(np.abs(values.imag).min())


@pytest.mark.parametrize("share", [0.0, 0.4, 0.8])
def test_flow_slows_the_vibrations_of_a_pipe(share: float) -> None:
    u = share * CRITICAL
    assert lowest(*hinged(u)) == pytest.approx(galerkin(u), rel=2e-4)
    K, _, M = hinged(u)
    if share == 0.8:  # Coriolis's force counts
        assert abs(lowest(K, 0.0 * K, M) / galerkin(u) - 1.0) > 0.02


def test_coriolis_does_no_work_on_a_pipe_with_held_ends() -> None:
    _, C, _ = hinged(0.5 * CRITICAL)
    assert np.abs(C + C.T).max() < 1e-12 * np.abs(C).max()
    assert np.abs(C).max() > 0.0


# What acts takes and gives


def test_the_power_of_the_force_is_external_work() -> None:
    """Over a short step: minus the residual of group F times the way, and the change of the mass."""
    at, h = sample(3), 1e-5
    part, start = at.contents(), at.state(3)
    before = State(0.4, 0.0 * start.u, start.v, start.a)
    after = State(0.4 + h, h * start.v, start.v, start.a)
    work = part.work(before, after)
    expected = -residual([part], before, Weights(0.0, 1.0, 0.0, 0.0)) @ start.v * h
    changed = part.energy(State(after.t, 0.0 * start.u, start.v, start.a)).kinetic - part.energy(before).kinetic
    assert work.external - work.inertial == pytest.approx(expected, rel=1e-3)
    assert work.inertial == pytest.approx(changed, rel=1e-2)
    assert work.dissipated == 0.0


# Scenes

TUBE: Mapping = {"EA": 1.0e8, "EI": 1.0e4, "GJ": 1.0e4, "mass": 50.0, "outer_diameter": 0.4, "inner_diameter": BORE}


def scene(contents: Mapping | None, **more: Any) -> Mapping:
    given: dict[str, Any] = {"pipe": TUBE, "length": 50.0, "elements": 10, "gravity": G} | more
    given |= {"start": prescribed(0.0, 0.0, 0.0), "end": prescribed(30.0, 0.0, 25.0)}
    stages = given.pop("stages", (static(), dynamic(4.0, 0.1)))
    shape = [[0.0, 0.0, 0.0], [24.375, 0.0, 0.0], [30.0, 0.0, 25.0]]  # a catenary takes long to find as Python alone
    riser: Mapping = {"initial": {"points": shape}}
    return riser_scene(*stages, riser=riser if contents is None else riser | {"contents": contents}, **given)


def parts_of(contents: Mapping | None) -> list[str]:
    assembly = built(scene(contents))
    return [part.name for part in assembly.begin(assembly.scene.stages[1]).parts]


def test_nothing_is_built_where_nothing_flows() -> None:
    for contents in (None, {"density": 850.0}, {"density": 850.0, "speed": 0.0, "slugs": []}):
        assert "contents" not in parts_of(contents)
    slug = {"density": 900.0, "length": 5.0}
    for more in ({"speed": 2.0}, {"slugs": [slug | {"front": 5.0}]}, {"speed": -1.0, "slugs": [slug]}):
        assert "contents" in parts_of({"density": 850.0} | more)


def test_they_grow_in_the_first_static_stage_but_not_after_another_run() -> None:
    slug = {"density": 900.0, "length": 5.0, "front": 30.0}
    assembly = built(scene({"density": 850.0, "slugs": [slug]}, stages=(static("first"), static("second"))))
    goes_on = assembly.scene.model_copy(update={"initial": Initial.model_construct()})
    first, second = assembly.scene.stages
    weights = []
    for given, stage in ((assembly.scene, first), (assembly.scene, second), (goes_on, first)):
        contents = given.line.inner_flow
        assert contents is not None
        part = contents_of(given, contents, assembly.riser.line, assembly.riser.elements, stage)
        weights.append(matrices_of(part, 0.25).weight.sum())
    assert weights[1] > 0.0
    assert weights == pytest.approx([0.25 * weights[1], weights[1], weights[1]])


SLUG: Mapping = {"density": 900.0, "length": 5.0}
WRONG: list[tuple[Mapping, str]] = [
    ({"slugs": [SLUG]}, r"slugs\.0\.front.*without a speed do not move, and their place is not given; give front"),
    ({"speed": 1.0, "slugs": [SLUG | {"spacing": 5.0}]}, r"slugs\.0\.spacing.*longer than the slug \(5 m\)"),
    ({"speed": 1.0, "slugs": [SLUG | {"spacing": 9.0}, SLUG]}, "slugs that follow each other at a spacing are"),
    ({"speed": 1.0, "slugs": [SLUG, SLUG | {"front": 4.0}]}, "lies over another one, whose front is at 0 m"),
    ({"speed": -1.0, "slugs": [SLUG, SLUG | {"front": 46.0}]}, "lies over another one, whose front is at 50 m"),
    ({"speed": 1.0, "slugs": [SLUG | {"lenght": 4.0}]}, 'did you mean "length"'),
    ({"sped": 1.0}, 'did you mean "speed"'),
    ({"speed": 1.0, "slugs": [{"density": 900.0}]}, r"slugs\.0\.length: missing"),
    ({"speed": 1.0, "slugs": [SLUG | {"density": -1.0}]}, r"slugs\.0\.density"),
]


@pytest.mark.parametrize(("more", "message"), WRONG)
def test_contents_that_can_not_be_are_reported(more: Mapping, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        read(scene({"density": 850.0} | more))


def read(mapping: Mapping) -> Scene:
    return scene_from_mapping(mapping)


def test_slugs_may_touch_each_other() -> None:
    for speed, front in ((1.0, 5.0), (-1.0, 45.0)):
        read(scene({"density": 850.0, "speed": speed, "slugs": [SLUG, SLUG | {"front": front}]}))


def test_flow_needs_one_bore() -> None:
    given = scene({"density": 850.0, "speed": 1.0})
    given["line_types"]["narrow"] = TUBE | {"inner_diameter": 0.25}
    given["riser"]["segments"].append({"line_type": "narrow", "length": 1.0, "elements": 1})
    with pytest.raises(SceneError, match=telling("flow", "one bore", "inner_diameter", "0.25, 0.3 m")):
        read(given)
    given["riser"]["contents"] = {"density": 850.0}
    read(given)


def test_the_midpoint_rule_has_no_flow() -> None:
    stages = static(), dynamic(1.0, 0.1, scheme={"midpoint": {}})
    with pytest.raises(SceneError, match=telling("midpoint rule", "contents that flow")):
        read(scene({"density": 850.0, "speed": 1.0}, stages=stages))
    read(scene({"density": 850.0}, stages=stages))
