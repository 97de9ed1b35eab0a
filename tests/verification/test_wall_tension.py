"""The tension in the wall of vertical pipes, full and empty, in air and in water, against force balances by hand."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.stages import QuasiStaticStage, StaticStage, pressure_in
from tests.support.runs import run_of
from tests.support.said import telling
from tests.support.scenes import Mapping, dynamic, prescribed, riser_scene, static
from tests.support.stage_histories import StageHistory, stage_histories

G, RHO, OIL, L = 9.81, 1025.0, 850.0, 40.0
OUTER, INNER, MASS = 0.3, 0.2, 120.0
A_OUT, A_IN = 0.25 * np.pi * OUTER**2, 0.25 * np.pi * INNER**2
PIPE = {"EA": 1.0e9, "EI": 1.0e5, "GJ": 1.0e5, "mass": MASS, "outer_diameter": OUTER, "inner_diameter": INNER}


def hanging(top: float, contents: Mapping | None = None, **more: Any) -> Mapping:
    """A closed pipe that hangs from its start down to its free end."""
    riser: Mapping = {"unstressed": {"points": [[0.0, 0.0, top], [0.0, 0.0, top - L]]}}
    riser |= {"contents": contents} if contents else {}
    sizes: dict[str, Any] = {"pipe": PIPE, "length": L, "elements": 8, "end": "free"}
    sizes["start"] = prescribed(0.0, 0.0, top)
    return riser_scene(static(), riser=riser, gravity=G, **(sizes | more))


class Settled(NamedTuple):
    position: Array
    effective_tension: Array
    wall_tension: Array


def settled(scene: Mapping) -> Settled:
    (stage,) = stage_histories(scene)
    assert stage.end.wall_tension is not None
    return Settled(stage.end.position, stage.end.effective_tension, stage.end.wall_tension)


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_full_pipe_in_air_carries_its_contents_by_its_lower_end(dimension: int) -> None:
    """Its end cap feels p + rho g L on the bore; the steel above adds its own weight alone."""
    p = 2.0e6
    wall = settled(hanging(0.0, {"density": OIL, "pressure": p}, dimension=dimension)).wall_tension
    below = L - np.linspace(0.0, L, 9)
    stretched = pytest.approx((p + OIL * G * L) * A_IN + MASS * G * below, rel=1e-5)
    assert wall == stretched
    assert wall[0] == pytest.approx(p * A_IN + (MASS + OIL * A_IN) * G * L, rel=1e-9)


def test_the_foot_of_a_submerged_pipe_is_pressed_by_the_water() -> None:
    """T_w = -p_o A_o at a closed free end, whatever is above it; at the top the dry weight less that force."""
    history = settled(hanging(-10.0, water={"density": RHO, "surface_level": 0.0}))
    foot = RHO * G * -history.position[-1, 2] * A_OUT
    assert history.effective_tension[-1] == pytest.approx(0.0, abs=1e-6 * foot)
    assert history.wall_tension[-1] == pytest.approx(-foot, rel=1e-9)
    assert history.wall_tension[0] == pytest.approx(MASS * G * L - RHO * G * (10.0 + L) * A_OUT, rel=1e-9)


@pytest.mark.parametrize("given", [{"pipe_diameter": 0.25}, {"wall": {"outer_diameter": 0.25}}])
def test_a_coat_bears_the_water_on_itself(given: Mapping) -> None:
    """At the foot the pipe inside has the water's pressure on its own area, the coat on the rest."""
    scene = hanging(-10.0, water={"density": RHO, "surface_level": 0.0})
    scene["line_types"]["pipe"] = PIPE | given
    history = settled(scene)
    pressure = -RHO * G * history.position[:, 2]
    pressed = history.effective_tension - history.wall_tension
    assert pressed == pytest.approx(pressure * 0.25 * np.pi * 0.25**2, rel=1e-9)


def test_the_level_of_the_contents_can_be_given() -> None:
    default, given = (
        settled(hanging(5.0, {"density": OIL} | more)).wall_tension for more in ({}, {"pressure_level": 8.0})
    )
    assert given - default == pytest.approx(np.full(9, OIL * G * 3.0 * A_IN), rel=1e-9)


def test_above_the_water_nothing_presses_from_outside() -> None:
    history = settled(hanging(30.0, water={"density": RHO, "surface_level": 0.0}))
    z = history.position[:, 2]
    assert np.array_equal(history.wall_tension[z > 0.0], history.effective_tension[z > 0.0])
    pressed = history.effective_tension - history.wall_tension
    assert pressed[z < 0.0] == pytest.approx(-RHO * G * z[z < 0.0] * A_OUT, rel=1e-9)


def test_at_a_joint_the_areas_are_the_means_of_both_sides() -> None:
    scene = hanging(0.0, {"density": OIL, "pressure": 1.0e6})
    scene["line_types"]["thin"] = PIPE | {"inner_diameter": 0.1}
    half = {"length": 0.5 * L, "elements": 4}
    scene["riser"]["segments"] = [{"line_type": "pipe"} | half, {"line_type": "thin"} | half]
    history = settled(scene)
    areas = np.r_[np.full(4, A_IN), 0.5 * (A_IN + 0.25 * A_IN), np.full(4, 0.25 * A_IN)]
    pressure = 1.0e6 - OIL * G * history.position[:, 2]
    assert history.wall_tension - history.effective_tension == pytest.approx(pressure * areas, rel=1e-9)


SEA: Mapping = {"density": RHO, "surface_level": 0.0}


def stages_of(*given: Mapping, **more: Any) -> list[StageHistory]:
    """Stages of a pipe full of oil under 1 MPa, one stage after the other."""
    scene = hanging(-10.0, {"density": OIL, "pressure": 1.0e6}, water=SEA, **more)
    return stage_histories(scene | {"stages": list(given)})


def pressed(history: StageHistory) -> Array:
    """Pressure inside [Pa] by the tension in the wall, less that of the oil's own weight and of the water."""
    end = history.end
    assert end.wall_tension is not None
    z = end.position[:, 2]
    outside = -RHO * G * z * A_OUT
    return np.asarray((end.wall_tension - end.effective_tension + outside) / A_IN + OIL * G * (z + 10.0))


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_stage_changes_the_pressure_and_those_after_it_keep_it(dimension: int) -> None:
    """T_w = T + p_i A_i - p_o A_o, with T, shape and strain as they are."""
    test, later = static("test", pressure=5.0e6), dynamic(0.2, 0.1, "later")
    histories = stages_of(static("hang"), test, later, dynamic(0.2, 0.1, "open", pressure=0.0), dimension=dimension)
    for history, pressure in zip(histories, (1.0e6, 5.0e6, 5.0e6, 0.0), strict=True):
        np.testing.assert_allclose(pressed(history), pressure, rtol=1e-9, atol=1e-2)
    still = histories[0].end
    for history in histories[1:]:
        np.testing.assert_allclose(history.end.effective_tension, still.effective_tension, rtol=1e-9, atol=1e-4)
        np.testing.assert_allclose(history.end.position, still.position, atol=1e-9)


def test_over_a_static_stage_the_pressure_changes_with_the_load_factor() -> None:
    given = {"a": None, "b": 5.0e6, "c": 2.0e6}
    hang, test, last = (StaticStage(name=name, kind="static", pressure=p) for name, p in given.items())
    stages = hang, test, last
    assert [pressure_in(stages, test, t, 1.0e6) for t in (0.0, 0.25, 1.0)] == [1.0e6, 2.0e6, 5.0e6]
    assert [pressure_in(stages, last, t, 1.0e6) for t in (0.0, 0.5, 1.0)] == [5.0e6, 3.5e6, 2.0e6]
    assert pressure_in(stages, hang, 0.5, 1.0e6) == 1.0e6
    moved = QuasiStaticStage(name="d", kind="quasi-static", duration=9.0, pressure=7.0e6)
    assert pressure_in((*stages, moved), moved, 0.0, 1.0e6) == 7.0e6


def test_a_pressure_needs_contents() -> None:
    with pytest.raises(SceneError, match=telling("stages.0.pressure:", "contents", "riser is empty")):
        scene_from_mapping(hanging(0.0) | {"stages": [static(pressure=1.0e6)]})


def test_it_is_written_with_unit_and_extremes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    done = run_of(hanging(-10.0, {"density": OIL}, water={"density": RHO, "surface_level": 0.0}), tmp_path / "out")
    (stage,) = done.summary["stages"]
    wall = done["wall_tension"][-1]
    for name, node in (("max_wall_tension", wall.argmax()), ("min_wall_tension", wall.argmin())):
        assert stage["final"][name] == {"value": wall[node], "arc": done.arc[node]}
        assert stage["extremes"][name]["max"] >= wall[node] >= stage["extremes"][name]["min"]
    assert "wall tension" not in done.summary["parts"]["left_out"]
    assert "largest true wall tension" in capsys.readouterr().out
    assert "wall_tension" in (tmp_path / "out" / "riser.xdmf").read_text()


def test_where_the_pressure_outside_is_unknown_it_is_left_out(tmp_path: Path) -> None:
    done = run_of(hanging(-10.0, {"density": OIL}, water={"density": RHO}), tmp_path / "out")
    (stage,) = done.summary["stages"]
    assert "max_wall_tension" not in stage["final"]
    assert "surface_level" in done.summary["parts"]["left_out"]["wall tension"]
    with pytest.raises(Exception, match="has no wall_tension"):
        done["wall_tension"]
    assert "wall_tension" not in (tmp_path / "out" / "riser.xdmf").read_text()


def test_results_have_the_pressure_of_each_step(tmp_path: Path) -> None:
    """In results.nc, where many steps are told together, with the stress of the wall."""
    scene = hanging(-10.0, {"density": OIL, "pressure": 1.0e6}, water=SEA)
    scene["line_types"]["pipe"]["wall"] = {}
    scene["stages"] = [static("hang"), static("test", pressure=5.0e6), dynamic(0.4, 0.1, "open", pressure=2.0e6)]
    scene |= {"output": {"interval": 0.1}, "solver": {"load_steps": 4}}
    done = run_of(scene, tmp_path / "out")
    shown = 1e6 * np.array([1.0, 5.0, 2.0, 2.0, 2.0, 2.0])
    np.testing.assert_allclose(done["internal_pressure"][:, 0], shown, rtol=1e-9)
