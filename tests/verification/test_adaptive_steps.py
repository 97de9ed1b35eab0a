"""Automatic steps: a smooth motion, output times, an unreachable tolerance; error and cost on the hose in a tank."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from benchmarks import adaptive
from riser_soil.errors import SolveError
from riser_soil.results import Run
from riser_soil.scene.reader import read_scene, scene_from_mapping
from riser_soil.whole_run import run
from tests.support.said import telling
from tests.support.scenes import AVERAGE, dynamic, prescribed, riser_scene
from tests.support.stage_histories import stage_histories

CATENARY = Path(__file__).parents[1] / "scenes/catenary.yaml"
AUTO = ("stages.1.time_step=auto", "riser.segments.0.elements=30")


@pytest.fixture(scope="module")
def surged(tmp_path_factory: pytest.TempPathFactory) -> Run:
    folder = tmp_path_factory.mktemp("surge") / "results"
    run(read_scene(CATENARY, [*AUTO, "stages.1.duration=42", "stages.1.tolerance=0.01", "output.interval=1.4"]), folder)
    return Run(folder)


def test_records_lie_at_the_output_times(surged: Run) -> None:
    np.testing.assert_allclose(surged["time"][1:], 1.4 * np.arange(1, 31), rtol=1e-12)
    assert surged["step_time"][-1] == 42.0


def test_steps_and_their_sizes_are_recorded(surged: Run) -> None:
    dt, t = surged["time_step"][1:], surged["step_time"][1:]
    np.testing.assert_allclose(np.cumsum(dt), t, rtol=1e-12)
    assert dt.max() > 2.0 * dt.min()


def test_a_smooth_motion_settles_on_a_plateau(surged: Run) -> None:
    """In the steady surge sizes vary by less than a factor of two, with few steps tried again."""
    steady = surged["step_time"] > 21.0
    dt = surged["time_step"][steady]
    assert dt.max() < 2.0 * dt.min()
    assert surged["step_cuts"].sum() < 0.03 * len(surged["step_cuts"])


@pytest.mark.verify
def test_changes_of_size_do_not_shake_the_tension() -> None:
    """The riser's top tension varies by 3 kN. Steps that change size by a third at the ramp's end, and a little all the
    time, are as near as those of 0.4 s, the largest that they are.
    """
    surge = ("stages.1.duration=21", "riser.segments.0.elements=30")
    reference = adaptive.step_history(*surge, "stages.1.time_step=0.02", scene_file=CATENARY)
    history = adaptive.step_history(*surge, "stages.1.time_step=auto", scene_file=CATENARY)
    assert np.ptp(history.dt) > 0.2
    assert adaptive.errors(history, reference)[0] < 16.0


@pytest.mark.parametrize(
    "scheme",
    [
        {"generalized_alpha": {"rho_inf": 0.8}},
        pytest.param(AVERAGE, marks=pytest.mark.verify),
        pytest.param({"midpoint": {}}, marks=pytest.mark.verify),
    ],
)
def test_error_falls_with_the_tolerance(scheme: dict[str, object]) -> None:
    """A hanging cable swung sideways and back: errors fall about with the 2/3rd power of the tolerance."""

    def swung(**steps: object) -> np.ndarray:
        surge = {"amplitude": [0.5, 0.0, 0.2], "period": 3.0, "ramp": 1.5}
        stage = dynamic(4.0, 0.1, motion={"end": {"harmonic": surge}}, scheme=scheme) | steps
        pipe = {"EA": 1e6, "EI": 500.0, "mass": 60.0, "outer_diameter": 0.2}
        hung = {"name": "hang", "kind": "static"}
        scene = riser_scene(
            hung,
            stage,
            pipe=pipe,
            length=20.0,
            elements=10,
            start=prescribed(0, 0, 0),
            end=prescribed(12, 0, 4),
            gravity=9.81,
        )
        return stage_histories(scene)[1].position[-1]

    exact = swung(time_step=0.002)
    errors = [np.abs(swung(time_step="auto", tolerance=x) - exact).max() for x in (1e-2, 1e-3, 1e-4)]
    assert errors[0] > 2.5 * errors[1] > 6.0 * errors[2]
    assert errors[0] < 0.05


def test_a_tolerance_out_of_reach_is_reported() -> None:
    scene = riser_scene(
        dynamic(1.0, 0.1, loads=[{"at": "end", "force": [0.0, 0.0, 1e4]}]) | {"time_step": "auto", "tolerance": 1e-6},
        pipe={"EA": 1e6, "EI": 500.0, "mass": 60.0, "outer_diameter": 0.2},
        length=10.0,
        elements=5,
        start=prescribed(0, 0, 0, rotation="fixed"),
        end="free",
        riser={"initial": "straight"},
        solver={"min_time_step": 0.01},
    )
    with pytest.raises(SolveError, match=telling("smallest step 0.01:", "tolerance of 1e-06 m")):
        stage_histories(scene_from_mapping(scene))


@pytest.mark.verify
def test_hose_in_a_tank_errs_and_costs_no_more_than_with_the_best_fixed_steps() -> None:
    """Errors in top tension and touchdown over 30 s fall with the tolerance; the Newton iterations that they take are
    at most 1.3 times those of steps of one size with the same error, interpolated between sizes.
    """
    reference = adaptive.swing(adaptive.FINE)
    fixed = [adaptive.swing(dt) for dt in adaptive.STEPS]
    automatic = [adaptive.automatic(tolerance) for tolerance in adaptive.TOLERANCES]
    costs = np.log([history.iterations for history in fixed])
    for which in (0, 1):
        by_size = np.log([adaptive.errors(history, reference)[which] for history in fixed])
        by_tolerance = np.log([adaptive.errors(history, reference)[which] for history in automatic])
        assert np.all(np.diff(by_tolerance) < 0.0)
        same = np.interp(by_tolerance, by_size[::-1], costs[::-1])
        ratio = np.array([history.iterations for history in automatic]) / np.exp(same)
        assert ratio.max() < 1.3
