"""Stress cases in water: strong current, storm waves over a short riser, a pipe that floats."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from riser_soil.results import Run
from tests.robustness.stress.bounds import Answer, near
from tests.robustness.stress.case import Trial, one, stress_case
from tests.support.scenes import dynamic, prescribed, riser_scene, static

RHO, G = 1025.0, 9.81


@stress_case(quick=True)
def current_of_10_m_per_s() -> Trial:
    """A taut vertical line of 50 m, D = 0.2 m, Cd = 1, EA = 1e12 N, in a current of 10 m/s: its ends hold rho D Cd u^2
    L/2 = 512.5 kN together, less the square of its slope, q L/(2 T) = 0.026.
    """
    scene = riser_scene(
        static(),
        pipe={"EA": 1e12, "EI": 1e3, "submerged_weight": 100.0, "outer_diameter": 0.2, "drag": {"normal": 1.0}},
        length=50.0,
        elements=50,
        start=prescribed(0.0, 0.0, 0.0),
        end=prescribed(0.0, 0.0, 50.0005),
        gravity=G,
        water={"density": RHO, "current": {"profile": [[0.0, 10.0, 0.0]]}},
        riser={"initial": "straight"},
    )

    def answers(run: Run) -> Iterator[Answer]:
        final = run.summary["stages"][-1]["final"]
        drag = -(final["start"]["force"][0] + final["end"]["force"][0])
        yield near("horizontal force [N]", drag, 0.5 * RHO * 0.2 * 100.0 * 50.0, rel=2e-3)

    return one(scene, answers)


@stress_case()
def storm_waves_over_a_short_riser() -> Trial:
    """A stiff pipe of 8 m stands on the bottom in 15 m of water under waves of 8 m and 10 s: its foot holds Morison's
    force, integrated over its height from Airy's u = pi H/T cosh kz/sinh kd cos wt and its rate, Cd = 1 and Cm = 2.
    """
    H, T, d, D, L = 8.0, 10.0, 15.0, 0.5, 8.0
    scene = riser_scene(
        dynamic(30.0, 0.05, "storm"),
        pipe={
            "EA": 1e10, "EI": 1e9, "mass": 200.0, "submerged_weight": 100.0, "outer_diameter": D,
            "drag": {"normal": 1.0}, "added_mass": {"normal": 1.0},
        },
        length=L,
        elements=16,
        start=prescribed(0.0, 0.0, 0.0, rotation="fixed"),
        end="free",
        gravity=G,
        water={
            "density": RHO, "surface_level": d, "depth": d,
            "waves": {"airy": {"height": H, "period": T}, "stretching": "vertical", "ramp": 10.0},
        },
        riser={"unstressed": {"points": [[0.0, 0.0, 0.0], [0.0, 0.0, L]]}},
    )  # fmt: skip

    def answers(run: Run) -> Iterator[Answer]:
        t = run.time
        late = t > 20.0
        exact = -_morison(t[late], H, T, d, D, L)
        off = np.abs(run["start_force"][late][:, 0] - exact).max() / np.abs(exact).max()
        yield near("largest error of the foot's force, of its largest [-]", float(off), 0.0, within=0.02)

    return one(scene, answers)


def _morison(t: np.ndarray, H: float, T: float, d: float, D: float, L: float) -> np.ndarray:
    """Force on a rigid vertical pile, Cd = 1, Cm = 2 [N]; crest over it at t = 0."""
    w = 2.0 * np.pi / T
    k = w * w / G
    for _ in range(200):
        k = w * w / G / np.tanh(k * d)
    z = (np.arange(400) + 0.5) * L / 400
    size = 0.5 * H * w * np.cosh(k * z) / np.sinh(k * d)
    u, rate = np.outer(np.cos(w * t), size), np.outer(-w * np.sin(w * t), size)
    per_length = 0.5 * RHO * D * np.abs(u) * u + 2.0 * RHO * 0.25 * np.pi * D * D * rate
    total: np.ndarray = per_length.sum(axis=1) * L / 400
    return total


@stress_case()
def light_pipe_that_floats() -> Trial:
    """A free pipe half as dense as the water, let go 0.2 m above the surface: it comes to lie with its axis in it, as
    half of its section displaces its weight (Archimedes).
    """
    D = 0.3
    scene = riser_scene(
        dynamic(60.0, 0.02, "float"),
        pipe={
            "EA": 1e7, "EI": 1e4, "mass": 0.5 * RHO * 0.25 * np.pi * D * D, "outer_diameter": D,
            "drag": {"normal": 1.0}, "added_mass": {"normal": 1.0},
        },
        length=10.0,
        elements=10,
        start="free",
        end="free",
        gravity=G,
        dimension=2,
        water={"density": RHO, "surface_level": -0.2},
        riser={"initial": "straight"},
        output={"interval": 0.1},
    )  # fmt: skip

    def answers(run: Run) -> Iterator[Answer]:
        z = run["position"][run.time > 40.0][:, :, 2].mean()
        yield near("mean height of the axis over the surface at the end [m]", float(z) + 0.2, 0.0, within=2e-3)

    return one(scene, answers)
