"""Marine growth by height and a tapered bend stiffener: line types by hand, integrals, a cantilever in closed form."""

from __future__ import annotations

import math
from collections.abc import Callable
from copy import deepcopy
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI
from scipy.integrate import quad

from riser_soil.assembly import Assembly, build
from riser_soil.assembly import riser as assembled
from riser_soil.core.part import Part
from riser_soil.errors import SceneError
from riser_soil.riser import additions
from riser_soil.riser.additions import Growth, with_growth
from riser_soil.riser.sections import Elements, Surroundings
from riser_soil.scene.reader import scene_from_mapping
from tests.support.dense_chain import tangent
from tests.support.differences import WEIGHTS, difference_tangent, error
from tests.support.pipes import pipe
from tests.support.said import telling
from tests.support.sample_line import Sample, sample
from tests.support.scenes import IN_WAVES, Mapping, in_waves, prescribed, riser_scene, static
from tests.support.stage_histories import stage_histories

RHO, G, D, T, DENSITY = 1025.0, 9.81, 0.3, 0.05, 1325.0
EVERYWHERE = [[0.0, T, DENSITY]]
LAYER = math.pi * T * (D + T)  # m2


def by_hand(scene: Mapping) -> Mapping:
    """The scene with the growth in the line type."""
    given = deepcopy(scene)
    pipe = given["line_types"]["pipe"]
    pipe["outer_diameter"] += 2.0 * T
    pipe["mass"] += DENSITY * LAYER
    if "submerged_weight" in pipe:
        pipe["submerged_weight"] += G * (DENSITY - RHO) * LAYER
    return given


def grown(scene: Mapping, growth: list[list[float]]) -> Mapping:
    given = deepcopy(scene)
    given["water"]["marine_growth"] = growth
    return given


@pytest.mark.parametrize("weight", [{}, {"submerged_weight": 400.0}])
def test_an_even_layer_is_a_line_type_by_hand(weight: Mapping) -> None:
    """In current, waves and at the surface: every place of every step."""
    bare = in_waves(0.1, 21.0)
    bare["line_types"]["pipe"] |= weight
    computed, expected = stage_histories(grown(bare, EVERYWHERE)), stage_histories(by_hand(bare))
    for one, other in zip(computed, expected, strict=True):
        np.testing.assert_allclose(np.array(one.position), np.array(other.position), rtol=0.0, atol=1e-11)
    plain = stage_histories(bare)
    assert np.abs(np.array(computed[1].position) - np.array(plain[1].position)).max() > 0.01


def hanging(growth: list[list[float]] | None, n: int = 20, **more: object) -> Mapping:
    given: Mapping = {"length": 120.0, "start": prescribed(0.0, 0.0, 5.0), "end": prescribed(60.0, 0.0, 80.0)} | more
    scene = riser_scene(static(), pipe=IN_WAVES, elements=n, gravity=G, water={"density": RHO}, **given)
    return scene if growth is None else grown(scene, growth)


def built(scene: Mapping) -> Assembly:
    return build(scene_from_mapping(scene), MPI.COMM_SELF)


def test_growth_is_integrated_along_the_elements() -> None:
    """On an upright pipe: thickness linear in height, density too, from the integrals by hand."""
    z, H = np.array([0.0, 10.0]), 10.0
    around = Surroundings(gravity=G, water=RHO)
    bare = pipe(H, 1, around, EA=1e8, EI=1e4, outer_diameter=D, mass=100.0)
    got = with_growth(bare, Growth(z, np.array([0.02, 0.1]), np.array([1200.0, 1400.0])), z, around)
    t, density = np.polynomial.Polynomial([0.02, 0.008]), np.polynomial.Polynomial([1200.0, 20.0])
    section = math.pi * t * (D + t)
    volume, mass = (float(p.integ()(H)) for p in (section, density * section))
    assert got.mass[0] * H == pytest.approx(100.0 * H + mass, rel=1e-13)
    assert got.weight[0] * H == pytest.approx(bare.weight[0] * H + G * (mass - RHO * volume), rel=1e-13)
    assert 0.25 * math.pi * (got.outer_diameter[0] ** 2 - D**2) * H == pytest.approx(volume, rel=1e-13)
    assert got.pipe_diameter[0] == D


def test_growth_ends_where_the_profile_has_none() -> None:
    assembly, bare = built(hanging([[30.0, T, DENSITY], [40.0, 0.0, DENSITY]])), built(hanging(None))
    z = assembly.riser.line.x[:, 1]
    above, below = (z[:-1] > 40.0) & (z[1:] > 40.0), (z[:-1] < 30.0) & (z[1:] < 30.0)
    assert above.any()
    assert below.any()
    np.testing.assert_array_equal(assembly.riser.elements.outer_diameter[above], D)
    np.testing.assert_allclose(assembly.riser.elements.outer_diameter[below], D + 2.0 * T, rtol=1e-12)
    grown, bare_mass = assembly.riser.elements.mass[below], bare.riser.elements.mass[below]
    np.testing.assert_allclose(grown - bare_mass, DENSITY * LAYER, rtol=1e-12)


def test_shape_and_growth_belong_together() -> None:
    """The growth is that of the heights of the shape in which the riser hangs with it, not without."""
    rows = [[-20.0, 0.1, 1600.0], [60.0, 0.0, 1600.0]]
    assembly, bare = built(hanging(rows)), built(hanging(None))
    growth, around = Growth(*np.array(rows).T), Surroundings(gravity=G, water=RHO)
    ends = [with_growth(bare.riser.elements, growth, each.riser.line.x[:, 1], around) for each in (assembly, bare)]
    own, first = (np.abs(each.weight / assembly.riser.elements.weight - 1.0).max() for each in ends)
    assert own < 1e-7
    assert first > 1e-3


def test_the_ends_bear_the_weight_of_the_growth() -> None:
    (run,) = stage_histories(hanging(EVERYWHERE))
    (bare,) = stage_histories(hanging(None))
    more = [each.end.end_force[2] + each.end.start_force[2] for each in (run, bare)]
    assert more[0] - more[1] == pytest.approx(120.0 * G * (DENSITY - RHO) * LAYER, rel=1e-6)


PARTS: list[Callable[[Sample], Part]] = [Sample.beam, Sample.inertia, Sample.morison]


@pytest.mark.parametrize("make", PARTS)
def test_tangents_stay_exact(make: Callable[[Sample], Part]) -> None:
    at = sample(3)
    growth = Growth(np.array([3.0, 7.0]), np.array([0.1, 0.02]), np.array([1300.0, 1300.0]))
    around = Surroundings(gravity=G, water=RHO)
    more: Elements = with_growth(at.elements, growth, at.line.to_global(at.line.x)[:, 2], around)
    part, state = make(Sample(at.line, more)), at.state(1)
    K = tangent([part], state, WEIGHTS)
    assert error(K, difference_tangent(part, state, WEIGHTS)) < 1e-7
    assert error(tangent([make(at)], state, WEIGHTS), K) > (0.0 if make is Sample.beam else 1e-3)


def test_growth_without_end_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(assembled, "MOST_SHAPES", 2)
    with pytest.raises(SceneError, match=telling("water.marine_growth:", "first shape")):
        built(hanging([[-20.0, 0.1, 1600.0], [60.0, 0.0, 1600.0]]))


def test_a_riser_without_growth_does_not_look_for_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(additions, "with_growth")
    built(hanging(None))
    with pytest.raises(ImportError):
        built(hanging(EVERYWHERE))


@pytest.mark.parametrize(
    ("growth", "message"),
    [
        ([[10.0, 0.1, 1300.0], [0.0, 0.1, 1300.0]], "the heights z must increase"),
        ([[0.0, -0.1, 1300.0]], r"water\.marine_growth\.0\.1"),
        ([[0.0, 0.1]], r"water\.marine_growth\.0"),
        ([[0.0, 0.1, 0.0]], r"water\.marine_growth\.0\.2"),
        ([], r"water\.marine_growth"),
    ],
)
def test_growth_that_is_none_is_reported(growth: list[list[float]], message: str) -> None:
    with pytest.raises(SceneError, match=message):
        scene_from_mapping(hanging(growth))


def test_growth_needs_a_diameter() -> None:
    scene = hanging(EVERYWHERE)
    pipe = scene["line_types"]["pipe"]
    del pipe["outer_diameter"], pipe["drag"], pipe["added_mass"]
    pipe["submerged_weight"] = 100.0
    with pytest.raises(SceneError, match=telling("marine growth", "outer diameter")):
        scene_from_mapping(scene)


PIPE: Mapping = {"EA": 1.0e8, "EI": 2.0e4, "outer_diameter": 0.2, "mass": 50.0}
TAPER: Mapping = {"length": 2.0, "base_diameter": 0.6, "tip_diameter": 0.25, "E": 6.0e7, "density": 1200.0}
L, F = 6.0, 4.0  # m, N: small turns


def scene(at: str = "start", elements: int = 24, taper: Mapping = TAPER, **more: Any) -> Mapping:
    clamped = prescribed(0.0, 0.0, 0.0, rotation="fixed") | {"bend_stiffener": dict(taper)}
    tip = "end" if at == "start" else "start"
    pushed = static(loads=[{"at": tip, "force": [0.0, 0.0, F]}])
    shape = [[0.0, 0.0, 0.0], [L, 0.0, 0.0]]
    ends: Mapping = {at: clamped, tip: "free"}
    points = {"unstressed": {"points": shape if at == "start" else shape[::-1]}}
    return riser_scene(pushed, pipe=PIPE, length=L, elements=elements, riser=points, **ends, **more)


def stiffness(x: float) -> float:
    D = TAPER["base_diameter"] + (TAPER["tip_diameter"] - TAPER["base_diameter"]) * x / TAPER["length"]
    cone = TAPER["E"] * np.pi / 64.0 * (D**4 - PIPE["outer_diameter"] ** 4)
    return float(PIPE["EI"] + (cone if x < TAPER["length"] else 0.0))


@pytest.mark.parametrize("at", ["start", "end"])
def test_a_cantilever_bends_by_its_varying_stiffness(at: str) -> None:
    """w = F times the integral of (L - x)^2/EI(x), by the unit load; with twice the elements a quarter of the error."""
    exact = F * quad(lambda x: (L - x) ** 2 / stiffness(x), 0.0, L, points=[TAPER["length"]])[0]
    errors = []
    for elements in (24, 48):
        (run,) = stage_histories(scene(at, elements))
        errors.append(run.position[-1][-1 if at == "start" else 0, 2] / exact - 1.0)
    assert abs(errors[1]) < 1e-3
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.2)


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_wall_in_it_bends_by_the_curvature_and_is_pressed_on_the_pipe(dimension: int) -> None:
    """E D/2 times the curvature, E the wall's own; where elements of a stiffener meet, that of the softer one."""
    wet: Mapping = {"density": 1000.0, "surface_level": 10.0}
    given = scene(dimension=dimension, gravity=9.81, water=wet)
    wall: Mapping = {"wall": {"outer_diameter": 0.18, "inner_diameter": 0.16}, "GJ": 2.0e4, "submerged_weight": 0.0}
    given["line_types"]["pipe"] |= wall
    (run,) = stage_histories(given)
    assembly = build(scene_from_mapping(given), MPI.COMM_SELF)
    I = np.pi / 64.0 * (0.18**4 - 0.16**4)
    EI = assembly.riser.elements.EI_y
    softer = np.minimum(np.append(np.inf, EI), np.append(EI, np.inf))
    expected = PIPE["EI"] / I * 0.09 * run.end.bending_moment / softer
    assert run.end.wall_bending_stress == pytest.approx(expected, rel=1e-9, abs=1e-6 * expected.max())
    assert run.end.wall_bending_stress[0] < 0.1 * run.end.bending_moment[0] * 0.09 / I, "bent as the stiffener lets it"
    pressed = 9.81 * 1000.0 * (10.0 - run.end.position[:, 2]) * 0.25 * np.pi * 0.18**2
    assert run.end.wall_tension == pytest.approx(run.end.effective_tension - pressed, rel=1e-9)


def test_it_weighs_its_volume_less_the_water() -> None:
    """pi/4 (D^2 - d^2) over the cone's length; also where an element ends beyond its tip."""
    given = scene(elements=25, gravity=9.81, water={"density": 1000.0})
    elements = build(scene_from_mapping(given), MPI.COMM_SELF).riser.elements
    volume = quad(lambda x: 0.25 * np.pi * ((0.6 - 0.175 * x) ** 2 - 0.04), 0.0, 2.0)[0]
    bare = 9.81 * (50.0 - 1000.0 * np.pi * 0.01) * L
    assert float(elements.mass @ elements.length) == pytest.approx(50.0 * L + 1200.0 * volume, rel=1e-12)
    assert float(elements.weight @ elements.length) == pytest.approx(bare + 9.81 * 200.0 * volume, rel=1e-12)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"base_diameter": 0.2}, "is less than tip_diameter"),
        ({"tip_diameter": 0.1}, r"tip_diameter.*is less than the pipe's \(0.2 m\)"),
        ({"length": 4.0}, "at most half as long as the segment"),
        ({"length": 0.5}, "has elements of 0.25 m on its 0.5 m: at least 4 are needed"),
    ],
)
def test_stiffeners_that_do_not_fit(change: Mapping, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        scene_from_mapping(scene(taper=TAPER | change))


def test_a_free_end_has_no_base() -> None:
    given = scene()
    given["riser"]["start"]["rotation"] = "free"
    with pytest.raises(SceneError, match=telling("riser.start.bend_stiffener:", "no base")):
        scene_from_mapping(given)
