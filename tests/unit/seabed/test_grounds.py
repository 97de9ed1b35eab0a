"""Distances from the seabed: closed forms, and derivatives against differences."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.assembly.riser import elements_of
from riser_soil.assembly.shape import catenary_between
from riser_soil.core.arrays import Array
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.seabed.grounds import Ground, Plane
from riser_soil.seabed.height_field import Profile
from tests.support.scenes import prescribed, riser_scene, static

X = np.random.default_rng(4).uniform(-3.0, 12.0, size=(40, 3))
HILL = Profile(
    np.array([1.0, -2.0]), np.array([0.6, 0.8]), np.array([0.0, 2.0, 5.0, 9.0]), np.array([0.0, 0.8, -0.5, 0.3])
)
SLOPE = Plane.sloping(np.array([1.0, 2.0, -3.0]), np.radians(12.0), np.radians(50.0))
GROUNDS: dict[str, Ground] = {"level": Plane.level(-1.5), "slope": SLOPE, "profile": HILL}


def differences(ground: Ground, x: Array, h: float = 1e-5) -> tuple[Array, Array]:
    """Gradient of the distance and of its gradient by central differences."""
    steps = [(ground.distance(x + h * e), ground.distance(x - h * e)) for e in np.eye(3)]
    gradient = np.stack([(a.value - b.value) / (2.0 * h) for a, b in steps], axis=1)
    hessian = np.stack([(a.gradient - b.gradient) / (2.0 * h) for a, b in steps], axis=2)
    return gradient, hessian


@pytest.mark.parametrize("name", GROUNDS)
def test_derivatives_of_the_distance(name: str) -> None:
    distance = GROUNDS[name].distance(X)
    gradient, hessian = differences(GROUNDS[name], X)
    assert distance.gradient == pytest.approx(gradient, abs=1e-8)
    exact = np.zeros((len(X), 3, 3)) if distance.hessian is None else distance.hessian
    assert exact == pytest.approx(hessian, abs=1e-7)


def test_distance_from_a_slope_is_normal_to_it() -> None:
    uphill = np.array([np.cos(np.radians(50.0)), np.sin(np.radians(50.0)), np.tan(np.radians(12.0))])
    on_ground = SLOPE.point + 3.0 * uphill
    distance = SLOPE.distance(np.array([on_ground, on_ground + 2.0 * np.eye(3)[2]]))
    assert distance.value == pytest.approx([0.0, 2.0 * np.cos(np.radians(12.0))], abs=1e-12)


def test_profile_passes_through_its_points_and_goes_on_straight() -> None:
    s = np.array([0.0, 2.0, 5.0, 9.0])
    at = np.concatenate([HILL.origin + s[:, None] * HILL.direction, HILL.z[:, None]], axis=1)
    assert HILL.distance(at).value == pytest.approx(np.zeros(4), abs=1e-12)
    beyond = np.array([*(HILL.origin + 20.0 * HILL.direction), 0.0])
    ends = HILL.distance(np.array([beyond, beyond + np.array([0.6, 0.8, 0.0])]))
    assert ends.gradient[0] == pytest.approx(ends.gradient[1], abs=1e-12)
    across = np.array([-0.8, 0.6, 0.0])
    assert HILL.distance(X + 7.0 * across).value == pytest.approx(HILL.distance(X).value, abs=1e-10)


def test_profile_of_a_straight_slope_is_the_plane() -> None:
    slope = np.radians(12.0)
    s = np.array([-5.0, 5.0])
    profile = Profile(np.array([1.0, 2.0]), np.array([1.0, 0.0]), s, -3.0 + s * np.tan(slope))
    plane = Plane.sloping(np.array([1.0, 2.0, -3.0]), slope, 0.0)
    assert profile.distance(X).value == pytest.approx(plane.distance(X).value, abs=1e-12)
    assert profile.distance(X).gradient == pytest.approx(np.asarray(plane.distance(X).gradient), abs=1e-12)


FALL = 80.0 * np.tan(np.radians(3.0))


@pytest.mark.parametrize("seabed", [{"slope_deg": -3.0}, {"profile": [[0.0, 0.0], [80.0, -FALL]]}])
def test_a_riser_is_first_laid_on_the_ground_below_its_lower_end(seabed: dict[str, object]) -> None:
    """Written from the floater down, along a seabed that falls: its anchor lies below the seabed under its start."""
    pipe = {"EA": 3.0e8, "EI": 0.0, "submerged_weight": 500.0, "outer_diameter": 0.3}
    ends = {"start": prescribed(0.0, 0.0, 100.0), "end": prescribed(80.0, 0.0, -4.0)}
    ground = {"kind": "spring", "stiffness": 1e5, **seabed}
    scene = scene_from_mapping(
        riser_scene(static(), pipe=pipe, length=160.0, elements=40, **ends, seabed=ground, gravity=9.81)
    )
    start, end = np.array([0.0, 0.0, 100.0]), np.array([80.0, 0.0, -4.0])
    height = catenary_between(scene, elements_of(scene), (), start, end).curve.position[:, 2]
    assert height.min() == pytest.approx(0.15 - FALL, abs=1e-4)
