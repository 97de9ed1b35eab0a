"""Buoyancy modules in water at rest and in motion, in the time loop, against closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from riser_soil.sea.waterline import wet_share
from tests.support.scenes import Mapping, dynamic, prescribed, riser_scene, static
from tests.support.stage_histories import StageHistory, stage_histories

G, RHO = 9.81, 1025.0
ROD: Mapping = {"EA": 1.0e9, "EI": 1.0e8, "GJ": 1.0e8, "mass": 1.0, "submerged_weight": 0.0}
WATER: Mapping = {"density": RHO}
both_dimensions = pytest.mark.parametrize("dimension", [2, 3])


def scene(*stages: Mapping, module: Mapping, water: Mapping = WATER, **more: Any) -> Mapping:
    sizes: dict[str, Any] = {"pipe": ROD, "gravity": G, "elements": 3, "length": 2.0}
    riser: Mapping = {"attachments": [module], "initial": "unstressed"}
    return riser_scene(*stages, riser=riser, water=water, **(sizes | more))


def sunk(time_step: float, dimension: int) -> StageHistory:
    module = {"at": 1.0, "mass": 900.0, "volume": 0.5, "drag_area": 0.6, "added_mass": 0.5}
    falling = scene(dynamic(4.0, time_step), module=module, start="free", end="free", dimension=dimension)
    return stage_histories(falling)[0]


@both_dimensions
def test_a_sinking_weight_falls_by_the_hyperbolic_tangent(dimension: int) -> None:
    """(m + Ca rho V) v' = (m - rho V) g - c v^2 falls V T log cosh(t/T), V^2 = w/c, T = m V/w. Steps halved once."""
    mass, weight = 2.0 + 900.0 + 0.5 * RHO * 0.5, (900.0 - RHO * 0.5) * G
    final = np.sqrt(weight / (0.5 * RHO * 0.6))
    time = mass * final / weight
    coarse, fine = (sunk(dt, dimension) for dt in (0.04, 0.02))
    heights = [np.array([x[:, 2].mean() for x in history.position]) for history in (coarse, fine)]
    exact = -final * time * np.log(np.cosh(np.array(coarse.t) / time))
    errors = [np.abs(h - exact).max() / np.abs(exact).max() for h in (heights[0], heights[1][1::2])]
    assert errors[1] < 1e-4
    assert errors[0] / errors[1] > 3.5
    lost = np.array(fine.work)
    assert np.array(fine.energy) - fine.energy[0] == pytest.approx(np.cumsum(lost) - lost[0], abs=2e-3 * weight)


@both_dimensions
def test_a_current_pushes_a_module_with_its_drag_area(dimension: int) -> None:
    module = {"at": 0.7, "mass": 10.0, "drag_area": 0.8}
    stream = WATER | {"current": {"profile": [[0.0, 1.3, 0.0]]}}
    ends = {"start": prescribed(0.0, 0.0, 0.0), "end": prescribed(0.0, 0.0, 2.0)}
    end = stage_histories(scene(static(), module=module, water=stream, dimension=dimension, **ends))[0].end
    total = end.start_force + end.end_force
    assert total == pytest.approx([-0.5 * RHO * 0.8 * 1.3**2, 0.0, 10.0 * G], rel=1e-9, abs=1e-6)


@both_dimensions
def test_a_buoy_floats_at_the_draught_that_carries_its_rod(dimension: int) -> None:
    """A hinged rod of weight w L rests half its weight on the buoy at its end."""
    buoy, rod = {"at": 2.0, "mass": 40.0, "volume": 0.2}, ROD | {"submerged_weight": 300.0}
    water = WATER | {"surface_level": 0.1}
    scene_ = scene(
        static(), module=buoy, water=water, pipe=rod, start=prescribed(0.0, 0.0, 0.0), end="free", dimension=dimension
    )
    end = stage_histories(scene_)[0].end
    share = (0.5 * 300.0 * 2.0 + 40.0 * G) / (RHO * G * 0.2)
    assert 0.1 < share < 0.9
    span = np.cbrt(6.0 * 0.2 / np.pi)
    assert wet_share(0.1 - end.position[-1, 2], span) == pytest.approx(share, rel=1e-7)
    assert end.start_force[2] == pytest.approx(0.5 * 300.0 * 2.0, rel=1e-7)


def test_waves_accelerate_the_water_in_and_around_a_module() -> None:
    """Held in small deep-water waves it feels -rho V (1 + Ca) omega^2 a exp(k z) sin(omega t)."""
    V, Ca, height, period, depth = 0.4, 0.6, 0.2, 8.0, 5.0
    module = {"at": 1.0, "mass": RHO * V, "volume": V, "added_mass": Ca}
    waves = {"airy": {"height": height, "period": period}, "stretching": "vertical", "ramp": 2.0}
    ends = {key: prescribed(x, 0.0, -depth, rotation="fixed") for key, x in (("start", -1.0), ("end", 1.0))}
    water = WATER | {"surface_level": 0.0, "waves": waves}
    times: list[float] = []
    pushed: list[float] = []
    scheme = {"generalized_alpha": {"rho_inf": 0.0}}
    for duration in np.linspace(8.0, 16.0, 9):
        stage = dynamic(float(duration), 0.1, scheme=scheme)
        end = stage_histories(scene(stage, module=module, water=water, elements=2, **ends))[0].end
        times.append(duration)
        pushed.append(-(end.start_force[0] + end.end_force[0]))
    omega = 2.0 * np.pi / period
    amplitude = RHO * V * (1.0 + Ca) * 0.5 * height * omega**2 * np.exp(-(omega**2) / G * depth)
    assert pushed == pytest.approx(-amplitude * np.sin(omega * np.array(times)), abs=5e-3 * amplitude)
