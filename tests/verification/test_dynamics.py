"""A riser in motion, through the time loop of a run: frequencies, order in time, energy, and agreement of paths."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.scene.reader import read_scene
from riser_soil.scene.scene import Scene
from tests.support.scenes import AVERAGE, Mapping, dynamic, prescribed, riser_scene, static
from tests.support.stage_histories import StageHistory, distance, stage_histories

SCENES = Path(__file__).parents[1] / "scenes"
FLEXIBLE = {
    "outer_diameter": 0.26,
    "inner_diameter": 0.20,
    "mass": 57.5,
    "EA": 15.38e8,
    "EI": 20.96e3,
    "GJ": 2.0e4,
    "drag": {"normal": 1.0, "tangential": 0.02},
    "added_mass": {"normal": 1.0, "tangential": 0.0},
}


# Frequencies

LENGTH, EA, EI, MASS, TENSION, DT = 30.0, 1.0e9, 5.0e5, 80.0, 4.0e4, 0.02
BEAM = {"EA": EA, "EI": EI, "GJ": EI, "mass": MASS}
ELEMENTS = 20


def plucked_string(dimension: int) -> Mapping:
    """Stretched to its tension, pushed aside by half a millimetre at a fifth of its length, and let go."""
    stretched = LENGTH * (1.0 + TENSION / EA)
    push = {"at": LENGTH / 5, "force": [0.0, 0.0, 5.0]}
    return riser_scene(
        static("stretch", move={"end": [stretched, 0.0, 0.0]}),
        static("push", loads=[push]),
        dynamic(12.0, DT, scheme=AVERAGE),
        pipe=BEAM,
        length=LENGTH,
        elements=ELEMENTS,
        start=prescribed(0.0, 0.0, 0.0),
        end=prescribed(LENGTH, 0.0, 0.0),
        dimension=dimension,
        solver={"tolerance": 1e-9},
    )


def closed_form(n: int) -> float:
    """Angular frequency of the stretched pinned beam [rad/s]."""
    stretch = 1.0 + TENSION / EA
    k = n * np.pi / (LENGTH * stretch)
    return float(np.sqrt((k**4 * EI + k**2 * TENSION) * stretch / MASS))


def frequency(series: Array, dt: float) -> float:
    """Angular frequency of a series q(n+1) + q(n-1) = 2 cos(w dt) q(n), freed of the average acceleration's own period
    error: tan(w dt/2) = (true w) dt/2 on a linear system.
    """
    middle = series[1:-1]
    cosine = 0.5 * float(middle @ (series[2:] + series[:-2])) / float(middle @ middle)
    return 2.0 / dt * float(np.tan(0.5 * np.arccos(cosine)))


@pytest.mark.parametrize("dimension", [2, 3])
def test_free_vibration_has_the_frequencies_of_the_tensioned_beam(dimension: int) -> None:
    shapes = np.sin(np.outer(np.arange(1, 4), np.linspace(0.0, np.pi, ELEMENTS + 1)))
    aside = np.array(stage_histories(plucked_string(dimension))[-1].position)[:, :, 2]
    frequencies = [frequency(aside @ shape, DT) for shape in shapes]
    assert frequencies == pytest.approx([closed_form(n) for n in (1, 2, 3)], rel=1e-4)


# Order in time


def surging(time_step: float, **more: Any) -> Mapping:
    """The hanging flexible riser, its upper end moved to and fro; 7 s unless `more` says otherwise."""
    motion = {"end": {"harmonic": {"amplitude": [2.0, 0.0, 0.5], "period": 7.0, "ramp": 7.0}}}
    surge: Mapping = {"duration": 7.0, "time_step": time_step, "motion": motion} | more
    return riser_scene(
        static(),
        dynamic(**surge),
        pipe=FLEXIBLE,
        length=350.0,
        elements=20,
        start=prescribed(0.0, 0.0, 0.0),
        end=prescribed(150.0, 0.0, 150.0),
        gravity=9.81,
        water={"density": 1025.0},
        riser={"contents": {"density": 1025.0}, "initial": "catenary"},
        solver={"tolerance": 1e-10},
    )


@pytest.mark.parametrize("scheme", [AVERAGE, {"generalized_alpha": {"rho_inf": 0.8}}, {"midpoint": {}}])
def test_second_order_in_the_time_step(scheme: Mapping) -> None:
    shapes = [stage_histories(surging(dt, scheme=scheme))[-1].end.position for dt in (0.2, 0.1, 0.05)]
    first, second = distance(shapes[0], shapes[1]), distance(shapes[1], shapes[2])
    assert np.log2(first / second) == pytest.approx(2.0, abs=0.2)
    assert second < 1e-2


@pytest.mark.parametrize("scheme", [AVERAGE, {"midpoint": {}}])
def test_a_moving_hinge_carries_no_moment(scheme: Mapping) -> None:
    """Its recorded moment is what the inertia beside it leaves of the balance."""
    last = stage_histories(surging(0.1, scheme=scheme, duration=3.0))[-1].end
    assert np.linalg.norm(last.end_moment) < 1e-6 * last.bending_moment.max()


def test_generalised_alpha_that_keeps_all_is_average_acceleration() -> None:
    one = stage_histories(surging(0.1, scheme=AVERAGE))[-1]
    other = stage_histories(surging(0.1, scheme={"generalized_alpha": {"rho_inf": 1.0}}))[-1]
    moved = distance(np.array(one.position), one.position[0])
    assert distance(np.array(one.position), np.array(other.position)) < 1e-9 * moved
    damped = stage_histories(surging(0.1, scheme={"generalized_alpha": {"rho_inf": 0.8}}))[-1]
    assert distance(np.array(one.position), np.array(damped.position)) > 1e-5 * moved


# Energy


def test_linear_beam_keeps_its_energy() -> None:
    """Relative to the energy of the pluck, over 1,000 steps of a 120th of the first period."""
    pipe = {"EA": 1.0e6, "EI": 1.0e6, "mass": 80.0}
    aside = [{"at": 3.0, "force": [0.0, 0.0, 0.01]}]
    scene = riser_scene(
        static("push", loads=aside),
        dynamic(50.0, 0.05, scheme=AVERAGE),
        pipe=pipe,
        length=30.0,
        elements=10,
        start=prescribed(0.0, 0.0, 0.0),
        end=prescribed(30.0, 0.0, 0.0),
        solver={"tolerance": 1e-9},
    )
    energy = np.array(stage_histories(scene)[-1].energy)
    assert energy.size == 1000
    assert np.abs(energy / energy[0] - 1.0).max() < 1e-8


# Rotations beyond a full turn

SPIN = {"EA": 1.0e8, "EI": 1.0e7, "GJ": 1.0e7, "mass": 50.0}
ARM, MOMENT, PUSHED = 6.0, 900.0, 8.0
INERTIA = 50.0 * ARM**3 / 3.0


def spun(dimension: int, axis: Array, direction: Array) -> list[StageHistory]:
    """A pipe hinged at its start is turned about an axis by a constant moment for 8 s, then left alone for 4 s."""
    moment = {"at": "start", "moment": list(MOMENT * axis)}
    points = [[0.0, 0.0, 0.0], list(ARM * direction)]
    scene = riser_scene(
        dynamic(PUSHED, 0.02, "push", loads=[moment], scheme=AVERAGE),
        dynamic(4.0, 0.02, "coast", scheme=AVERAGE),
        pipe=SPIN,
        length=ARM,
        elements=4,
        start=prescribed(0.0, 0.0, 0.0),
        end="free",
        dimension=dimension,
        riser={"initial": {"points": points}},
        solver={"tolerance": 1e-9},
    )
    return stage_histories(scene)


@pytest.mark.parametrize(
    ("dimension", "axis", "direction"),
    [
        (2, [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]),
        pytest.param(3, [0.0, -1.0, 0.0], [1.0, 0.0, 0.0], marks=pytest.mark.verify),
        (3, [-0.48, 0.64, 0.6], [0.8, 0.6, 0.0]),
    ],
)
def test_pipe_turns_many_times(dimension: int, axis: list[float], direction: list[float]) -> None:
    push, coast = spun(dimension, np.array(axis), np.array(direction))
    across = np.cross(axis, direction)
    tip = np.array([*push.position, *coast.position])[:, -1]
    angle = np.unwrap(np.arctan2(tip @ across, tip @ direction))
    expected = 0.5 * MOMENT / INERTIA * PUSHED**2
    assert angle[len(push.t) - 1] == pytest.approx(expected, rel=5e-3)
    assert angle[-1] > 4.0 * np.pi
    rate = np.diff(angle[len(push.t) :]) / 0.02
    assert rate == pytest.approx(np.full(rate.size, MOMENT * PUSHED / INERTIA), rel=2e-2)
    assert np.linalg.norm(tip, axis=1) == pytest.approx(np.full(len(tip), ARM), rel=1e-3)
    assert np.abs(tip @ axis).max() < 1e-6
    assert push.energy[-1] == pytest.approx(sum(push.work), rel=1e-3)
    assert np.ptp(coast.energy) < 1e-3 * coast.energy[0]


# Plane and space


def oblique(dimension: int, unstressed: Any = "straight") -> Mapping:
    """A riser in a vertical plane that is oblique to the axes, swaying in it."""
    d = np.array([0.8, -0.6, 0.0])
    start = np.array([5.0, -3.0, -20.0])
    amplitude = 1.5 * d + np.array([0.0, 0.0, 0.7])
    motion = {"end": {"harmonic": {"amplitude": list(amplitude), "period": 6.0, "ramp": 3.0}}}
    return riser_scene(
        static(),
        dynamic(3.0, 0.1, motion=motion),
        pipe=FLEXIBLE,
        length=60.0,
        elements=12,
        start=prescribed(*start, rotation="fixed"),
        end=prescribed(*(start + 35.0 * d + np.array([0.0, 0.0, 38.0])), rotation={"stiffness": 2.0e4}),
        dimension=dimension,
        gravity=9.81,
        water={"density": 1025.0},
        riser={"contents": {"density": 850.0}, "initial": "catenary", "unstressed": unstressed},
        solver={"tolerance": 1e-12},
    )


def arch() -> Mapping:
    """An unstressed arc of 60 m in the plane of `oblique`, from its start."""
    d, up, start = np.array([0.8, -0.6, 0.0]), np.array([0.0, 0.0, 1.0]), np.array([5.0, -3.0, -20.0])
    centre = start + 60.0 / np.radians(40.0) * (0.6 * d - 0.8 * up)
    return {"arc": {"centre": list(centre), "from": list(start), "angle_deg": 40.0, "axis": list(np.cross(up, d))}}


@pytest.mark.parametrize("unstressed", ["straight", "arc"])
def test_planar_scene_is_the_same_in_plane_and_space(unstressed: str) -> None:
    plane, space = (stage_histories(oblique(n, arch() if unstressed == "arc" else "straight")) for n in (2, 3))
    for a, b in zip(plane, space, strict=True):
        assert distance(np.array(a.position), np.array(b.position)) < 1e-9 * 60.0
        tension, moment = a.end.effective_tension, a.end.bending_moment
        assert np.abs(b.end.effective_tension - tension).max() < 1e-9 * tension.max()
        assert np.abs(b.end.bending_moment - moment).max() < 1e-9 * moment.max()
        for name in ("start_force", "end_force", "start_moment", "end_moment"):
            there, here = getattr(b.end, name), getattr(a.end, name)
            assert np.abs(there - here).max() < 1e-9 * tension.max(), name


# Steps that fail


def gust(iterations: int) -> Mapping:
    """The hanging riser is struck for 0.3 s and swings on for some seconds."""
    load = {"distributed": [500.0, 0.0, 0.0], "history": [[0.0, 0.0], [1.0, 0.0], [1.1, 1.0], [1.2, 1.0], [1.3, 0.0]]}
    scene = surging(0.2, duration=8.0, loads=[load], motion=None, scheme={"generalized_alpha": {"rho_inf": 0.5}})
    scene["riser"]["segments"][0]["elements"] = 40
    scene["solver"] = {"max_iterations": iterations}
    return scene


def test_failed_step_is_cut_and_grows_again() -> None:
    """With few iterations allowed the steps under the gust fail, and else those that make energy of it."""
    hard, easy = stage_histories(gust(6))[-1], stage_histories(gust(25))[-1]
    assert sum(hard.cuts) > 5
    assert sum(easy.cuts) < 5
    smallest = int(np.argmin(hard.dt))
    assert hard.dt[smallest] < 0.11
    assert max(hard.dt[smallest:]) == pytest.approx(0.2)
    assert hard.t == pytest.approx(np.cumsum(hard.dt))
    nominal = np.arange(1, 41) * 0.2
    assert np.abs(np.array(hard.t)[None, :] - nominal[:, None]).min(axis=1).max() < 1e-9
    moved = distance(np.array(easy.position), easy.position[0])
    assert distance(hard.end.position, easy.end.position) < 0.1 * moved


def test_three_stages_and_the_catenary_come_to_the_same_shape() -> None:
    by_stages, at_once = (read_scene(SCENES / name) for name in ("catenary-three-stages.yaml", "catenary.yaml"))
    assert distance(static_shape(by_stages), static_shape(at_once)) < 1e-6


def static_shape(scene: Scene) -> Array:
    """Shape (nn, 3) after the static stages of a scene."""
    stages = [s for s in scene.stages if s.kind == "static"]
    return stage_histories(scene.model_copy(update={"stages": stages}))[-1].end.position
