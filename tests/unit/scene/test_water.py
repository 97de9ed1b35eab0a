"""The water that a scene asks for, stage by stage; its plane; plausibility of its waves."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from riser_soil.assembly.sea import wave_age, wave_clock
from riser_soil.checks.wave_plausibility import wave_warnings
from riser_soil.scene.dump import dump_scene
from riser_soil.scene.plane import leaving_the_plane, resolved_dimension
from riser_soil.scene.reader import read_scene
from tests.support.scenes import CURRENT, MIDWATER, dynamic, in_water, static
from tests.support.seas import components_of, water_of

AIRY = {"airy": {"height": 3.0, "period": 8.0}}
ROOT = Path(__file__).parents[3]


@pytest.mark.parametrize("water", [None, {}, {"density": 1000.0}])
def test_still_water_without_a_surface_is_not_built(water: Any) -> None:
    scene = in_water(water)
    assert all(water_of(scene, stage) is None for stage in scene.stages)
    assert components_of(scene) is None


def test_waves_alone_need_no_water_in_statics_but_the_surface() -> None:
    scene = in_water({"surface_level": 100.0, "waves": AIRY})
    water = water_of(scene, scene.stages[0])
    assert water is not None
    motion = water(1.0, MIDWATER)
    assert motion.immersion == pytest.approx(50.0)
    assert not motion.velocity.any()


def test_current_grows_in_the_first_static_stage_and_stays() -> None:
    scene = in_water({"current": CURRENT})
    for stage, factor in zip(scene.stages, (0.3, 1.0, 1.0, 1.0), strict=True):
        water = water_of(scene, stage)
        assert water is not None
        assert water(0.3, MIDWATER).velocity[0] == pytest.approx([0.6 * factor, 0.0, 0.0])
        assert np.isposinf(water(0.3, MIDWATER).immersion).all()


def test_current_is_there_at_once_where_dynamics_come_first() -> None:
    scene = in_water({"current": CURRENT}, dynamic(9.0, 0.1, "first"), static("then"))
    for stage in scene.stages:
        water = water_of(scene, stage)
        assert water is not None
        assert water(0.3, MIDWATER).velocity[0, 0] == pytest.approx(0.6)


def test_a_current_imports_no_waves() -> None:
    code = (
        "import sys; from tests.support.seas import water_of; from tests.support.scenes import *;"
        "s = in_water({'current': CURRENT});"
        "water_of(s, s.stages[1])(0.0, MIDWATER); print([m for m in sys.modules if 'riser_soil.sea.' in m])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT)
    assert "riser_soil.sea.current" in done.stdout
    assert not [name for name in ("sea.wave", "jonswap", "components") if name in done.stdout]


def test_waves_run_on_through_dynamic_stages() -> None:
    scene = in_water({"surface_level": 100.0, "waves": AIRY})
    assert [wave_clock(scene, stage) for stage in scene.stages] == [0.0, 0.0, 20.0, 20.0]
    first, second = water_of(scene, scene.stages[1]), water_of(scene, scene.stages[3])
    assert first is not None
    assert second is not None
    for before, after in zip(first(43.0, MIDWATER), second(23.0, MIDWATER), strict=True):
        assert after == pytest.approx(before, abs=1e-14)
    assert np.abs(second(23.0, MIDWATER).velocity).max() > 1e-3


def test_waves_grow_anew_after_a_static_stage() -> None:
    """And only there: in a dynamic stage after a dynamic one they go on in full."""
    stages = static("a"), dynamic(20.0, 0.1, "b"), dynamic(6.0, 0.1, "c"), static("d"), dynamic(2.0, 0.1, "e")
    scene = in_water({"surface_level": 100.0, "waves": AIRY}, *stages, dynamic(9.0, 0.1, "f"))
    assert [wave_age(scene, stage) for stage in scene.stages] == [0.0, 0.0, 20.0, 26.0, 0.0, 2.0]
    assert scene.water is not None
    assert scene.water.waves is not None
    ramp, (through, after, on) = scene.water.waves.ramp, (water_of(scene, scene.stages[n]) for n in (1, 4, 5))
    assert through is not None
    assert after is not None
    assert on is not None
    assert not np.any(after(0.0, MIDWATER).velocity)
    full = through(26.0 + 0.5 * ramp, MIDWATER)
    assert np.abs(full.velocity).max() > 1e-3
    level = 100.0 - MIDWATER[:, 2]
    assert after(0.5 * ramp, MIDWATER).immersion - level == pytest.approx(0.5 * (full.immersion - level), abs=1e-12)
    assert on(0.5 * ramp - 2.0, MIDWATER).velocity == pytest.approx(after(0.5 * ramp, MIDWATER).velocity, abs=1e-14)


def test_current_and_waves_add_up() -> None:
    together, waves, current = (
        water_of(scene, scene.stages[1])
        for scene in (
            in_water({"surface_level": 100.0, "waves": AIRY, "current": CURRENT}),
            in_water({"surface_level": 100.0, "waves": AIRY}),
            in_water({"current": CURRENT}),
        )
    )
    assert together is not None
    assert waves is not None
    assert current is not None
    sum_of_both = waves(5.0, MIDWATER).velocity + current(5.0, MIDWATER).velocity
    assert together(5.0, MIDWATER).velocity == pytest.approx(sum_of_both)


def test_components_follow_the_scene() -> None:
    turned = {"height": 3.0, "period": 8.0, "direction_deg": 90.0, "phase_deg": 180.0}
    wave = components_of(in_water({"surface_level": 100.0, "waves": {"airy": turned}}))
    assert wave is not None
    k = (2.0 * np.pi / 8.0) ** 2 / 9.81
    assert np.array(wave)[:, 0] == pytest.approx([1.5, 2.0 * np.pi / 8.0, k, 0.5 * np.pi, np.pi])
    jonswap = {"Hs": 4.0, "Tp": 10.0, "components": 30, "seed": 5}
    sea = components_of(in_water({"surface_level": 100.0, "waves": {"jonswap": jonswap}}))
    assert sea is not None
    assert sea.amplitude.shape == (30,)
    assert np.sum(sea.amplitude**2) / 2.0 == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("more", "depth"),
    [
        ({}, np.inf),
        ({"seabed": {"kind": "rigid", "level": 0.5, "contact_at": "axis"}}, 99.5),
        ({"seabed": {"kind": "spring", "stiffness": 1e5, "profile": [[-50.0, -24.0], [50.0, -26.0]]}}, 125.0),
    ],
)
def test_depth_is_that_of_the_scene(more: Any, depth: float) -> None:
    scene = in_water({"surface_level": 100.0, "waves": AIRY}, **more)
    assert scene.water_depth == depth
    assert in_water({"surface_level": 100.0, "depth": 40.0, "waves": AIRY}, **more).water_depth == 40.0


def test_ramp_is_one_period_by_default() -> None:
    def ramp(waves: Any) -> float:
        water = in_water({"surface_level": 100.0, "waves": waves}).water
        assert water is not None
        assert water.waves is not None
        return water.waves.ramp

    assert ramp(AIRY) == 8.0
    assert ramp({"jonswap": {"Hs": 2.0, "Tp": 9}}) == 9.0
    assert ramp({**AIRY, "ramp": None}) == 8.0
    assert ramp({**AIRY, "ramp": 0.0}) == 0.0


def test_echo_of_the_water_resolves_to_itself(tmp_path: Any) -> None:
    scene = in_water({"surface_level": 100.0, "current": CURRENT, "waves": {"jonswap": {"Hs": 2.0, "Tp": 9.0}}})
    file = tmp_path / "scene.yaml"
    file.write_text(dump_scene(scene), encoding="utf-8")
    assert "ramp: 9.0" in file.read_text()
    assert read_scene(file) == scene


@pytest.mark.parametrize(
    ("water", "leaving"),
    [
        ({"current": CURRENT}, None),
        ({"current": {"profile": [[0.0, 0.0, 0.0], [9.0, -1.0, 0.0]]}}, None),
        ({"current": {"profile": [[0.0, 1.0, 0.0], [9.0, 1.0, 0.2]]}}, ("water", "current", "profile", 1)),
        ({"surface_level": 100.0, "waves": AIRY}, None),
        ({"surface_level": 100.0, "waves": {"airy": {"height": 1.0, "period": 8.0, "direction_deg": 180.0}}}, None),
        (
            {"surface_level": 100.0, "waves": {"airy": {"height": 1.0, "period": 8.0, "direction_deg": 1.0}}},
            ("water", "waves", "airy", "direction_deg"),
        ),
        (
            {"surface_level": 100.0, "waves": {"jonswap": {"Hs": 1.0, "Tp": 8.0, "direction_deg": 90.0}}},
            ("water", "waves", "jonswap", "direction_deg"),
        ),
    ],
)
def test_water_across_the_plane_makes_three_dimensions(water: Any, leaving: Any) -> None:
    scene = in_water(water)
    assert next(leaving_the_plane(scene), None) == leaving
    assert resolved_dimension(scene) == (2 if leaving is None else 3)


GROUND = {"kind": "rigid", "level": 0.5, "contact_at": "axis"}


@pytest.mark.parametrize(
    ("waves", "more", "words"),
    [
        ({"airy": {"height": 8.0, "period": 8.0}}, {}, "H = 8 m over L = 99.92 m is steep: 0.56 of the height"),
        ({"jonswap": {"Hs": 7.0, "Tp": 8.0}}, {}, "2 pi Hs/(g Tp^2) = 0.0701 is more than seas with a peak at 8 s"),
        ({"airy": {"height": 3.0, "period": 20.0}}, {"depth": 8.0}, "Ursell's number H L^2/h^3 = 179 is above 40"),
        (AIRY, {"depth": 80.0}, "water.depth is 80 m, but the surface lies 99.5 m above the seabed"),
    ],
)
def test_warnings_about_waves_state_their_numbers(waves: Any, more: Any, words: str) -> None:
    warnings = list(wave_warnings(in_water({"surface_level": 100.0, "waves": waves, **more}, seabed=GROUND)))
    assert any(words in line for line in warnings), warnings


@pytest.mark.parametrize("waves", [AIRY, {"jonswap": {"Hs": 9.0, "Tp": 14.0}}])
def test_ordinary_waves_raise_no_doubt(waves: Any) -> None:
    assert not list(wave_warnings(in_water({"surface_level": 100.0, "waves": waves}, seabed=GROUND)))


def test_waves_in_a_static_scene_are_doubted() -> None:
    warnings = list(wave_warnings(in_water({"surface_level": 100.0, "waves": AIRY}, static("only"))))
    assert any("no stage is dynamic" in line for line in warnings)
