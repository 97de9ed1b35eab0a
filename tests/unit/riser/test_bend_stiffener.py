"""A tapered bend stiffener as one entry of an end, against the closed form of a cantilever of varying stiffness."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from mpi4py import MPI
from scipy.integrate import quad

from riser_soil.assembly import build
from riser_soil.errors import SceneError
from riser_soil.scene.reader import scene_from_mapping
from tests.support.said import telling
from tests.support.scenes import Mapping, prescribed, riser_scene, static
from tests.support.stage_histories import stage_histories

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
