"""Static scenes run as a user runs them, judged by their result files alone."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.results import Run
from riser_soil.scene.reader import read_scene, scene_from_mapping
from riser_soil.scene.scene import Scene
from riser_soil.whole_run import run
from tests.support.flexible_riser import elastica_H, guess, properties
from tests.support.rod_reference import Rod, tip
from tests.support.scenes import Mapping, prescribed, riser_scene, static
from tests.support.stage_histories import stage_histories

SCENES = Path(__file__).parents[1] / "scenes"
Solve = Callable[..., Run]


@pytest.fixture
def solve(tmp_path: Path) -> Solve:
    """Runs a scene, given as a mapping or as the name of a file, without its dynamic stages."""

    def solved(scene: str | Mapping, *overrides: str) -> Run:
        checked = read_scene(SCENES / scene, overrides) if isinstance(scene, str) else scene_from_mapping(scene)
        run(statics_of(checked), tmp_path / "results", force=True)
        return Run(tmp_path / "results")

    return solved


def statics_of(scene: Scene) -> Scene:
    return scene.model_copy(update={"stages": tuple(s for s in scene.stages if s.kind == "static")})


def end_forces(done: Run) -> tuple[Array, Array]:
    """Forces of the supports at start and end after the last stage (3,) [N]."""
    return done["start_force"][-1], done["end_force"][-1]


# The hanging flexible riser


def test_support_forces_of_the_flexible_riser_are_those_of_the_elastica(solve: Solve) -> None:
    H, V = elastica_H()
    start, end = end_forces(solve("catenary.yaml"))
    weight = float(properties(1).weight[0]) * 350.0
    assert [-start[0], end[0]] == pytest.approx([H, H], rel=4e-6)
    assert [-start[2], end[2]] == pytest.approx([V, V + weight], rel=4e-6)


def test_support_forces_without_bending_stiffness_are_those_of_the_catenary(solve: Solve) -> None:
    start, end = end_forces(solve("catenary.yaml", "riser.segments.0.elements=140", "line_types.flexible.EI=20.0"))
    expected = guess(properties(140))
    slope = expected.curve.tangent[[0, -1], [0, 1], 2]
    V1, V2 = expected.tension[[0, -1]] * slope
    assert [-start[0], end[0]] == pytest.approx([expected.H] * 2, rel=1e-4)
    assert [-start[2], end[2]] == pytest.approx([V1, V2], rel=1e-4)


@pytest.mark.parametrize("dimension", [2, 3])
def test_supports_bear_the_weight(solve: Solve, dimension: int) -> None:
    """In a plane that is oblique to the axes."""
    changes = ("solver.tolerance=1e-11", "riser.end.position=[90.0, -120.0, 150.0]", "line_types.flexible.GJ=2.0e4")
    sway = "stages.1.motion.end.harmonic.amplitude=[0.6, -0.8, 0.0]"
    done = solve("catenary.yaml", f"dimension={dimension}", sway, *changes)
    weight = float(properties(1).weight[0]) * 350.0
    start, end = end_forces(done)
    assert np.abs(start + end - [0.0, 0.0, weight]).max() < 1e-9 * weight
    assert np.abs([done["start_moment"], done["end_moment"]]).max() < 1e-9 * weight


def test_summary_holds_the_end_of_the_stage(solve: Solve) -> None:
    done = solve("catenary.yaml")
    final = done.summary["stages"][0]["final"]
    assert final["end"]["force"] == pytest.approx(done["end_force"][-1])
    assert final["max_bending_moment"]["value"] == pytest.approx(done["bending_moment"][-1].max())
    assert final["min_effective_tension"]["value"] == pytest.approx(done["effective_tension"][-1].min())


# The 45 degree bend


def test_45_degree_bend(solve: Solve) -> None:
    """Against the rod's equations; 16 elements of fourth order."""
    frame = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    EI = 8.333333333e5
    rod = Rod(25.0 * np.pi, 1e7, np.full(3, EI), np.array([0.0, 0.0, 0.01]), frame)
    position = solve("bend45.yaml", "solver.tolerance=1e-10")["position"][-1, -1]
    assert np.linalg.norm(position - tip(rod, np.array([0.0, 0.0, 600.0]), np.zeros(3))) < 2e-4


# Beams with known deflections, loaded so little that they stay straight

BEAM = {"EA": 1.0e9, "EI": 1.0e6, "GJ": 1.0e6}
SPAN, FORCE, EI = 10.0, 2.0, 1.0e6


def beam(*stages: Mapping, start: Any, end: Any, elements: int = 8, **more: Any) -> Mapping:
    solver = {"tolerance": 1e-11} | more.pop("solver", {})
    options: Mapping = {"pipe": BEAM, "length": SPAN, "start": start, "end": end, "solver": solver}
    return riser_scene(*stages, elements=elements, **options, **more)


@pytest.mark.parametrize("dimension", [2, 3])
def test_sprung_end(solve: Solve, dimension: int) -> None:
    """The spring turns by P L/k, the cantilever adds P L^3/(3 EI)."""
    k = 4.0e5
    load = {"at": "end", "force": [0.0, 0.0, FORCE]}
    start = prescribed(0.0, 0.0, 0.0, rotation={"stiffness": k})
    done = solve(beam(static(loads=[load]), start=start, end="free", dimension=dimension))
    expected = FORCE * SPAN**2 / k + FORCE * SPAN**3 / (3.0 * EI)
    assert done["position"][-1, -1, 2] == pytest.approx(expected, rel=1e-6)
    assert done["start_moment"][-1] == pytest.approx(np.array([0.0, FORCE * SPAN, 0.0]), abs=1e-5 * FORCE * SPAN)
    assert done["bending_moment"][-1] == pytest.approx(FORCE * (SPAN - done.arc), abs=1e-5 * FORCE * SPAN)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("at", [3.75, 4.3])
def test_point_load_at_an_arc(solve: Solve, dimension: int, at: float) -> None:
    """A simply supported beam, at a node and within an element; deflection of the nodes left of the load."""
    load = {"at": at, "force": [0.0, 0.0, -FORCE]}
    left, right = prescribed(0.0, 0.0, 0.0), prescribed(SPAN, 0.0, 0.0)
    scene = beam(static(loads=[load]), start=left, end=right, dimension=dimension)
    done = solve(scene)
    x = done.arc[done.arc <= at]
    b = SPAN - at
    expected = -FORCE * b * x * (SPAN**2 - b**2 - x**2) / (6.0 * EI * SPAN)
    assert done["position"][-1, : x.size, 2] == pytest.approx(expected, rel=1e-5, abs=1e-12)
    start, end = end_forces(done)
    assert [start[2], end[2]] == pytest.approx([FORCE * b / SPAN, FORCE * at / SPAN], rel=1e-6)


@pytest.mark.parametrize("dimension", [2, 3])
def test_moment_at_an_arc(solve: Solve, dimension: int) -> None:
    """A simply supported beam turned at a node, right-handed about +y: M x (L^2 - 3 b^2 - x^2)/(6 EI L) up."""
    M, at = 30.0, 3.75
    load = {"at": at, "moment": [0.0, M, 0.0]}
    left, right = prescribed(0.0, 0.0, 0.0), prescribed(SPAN, 0.0, 0.0)
    scene = beam(static(loads=[load]), start=left, end=right, dimension=dimension)
    done = solve(scene)
    x = done.arc[done.arc <= at]
    b = SPAN - at
    expected = M * x * (SPAN**2 - 3.0 * b**2 - x**2) / (6.0 * EI * SPAN)
    assert done["position"][-1, : x.size, 2] == pytest.approx(expected, rel=1e-5, abs=1e-12)
    start, end = end_forces(done)
    assert [start[2], end[2]] == pytest.approx([-M / SPAN, M / SPAN], rel=1e-6)


def test_distributed_load(solve: Solve) -> None:
    """5 q L^4/(384 EI) at the middle of a simply supported beam."""
    load = {"distributed": [0.0, 0.0, -FORCE / SPAN]}
    scene = beam(static(loads=[load]), start=prescribed(0.0, 0.0, 0.0), end=prescribed(SPAN, 0.0, 0.0))
    sag = solve(scene)["position"][-1, 4, 2]
    assert sag == pytest.approx(-5.0 * FORCE * SPAN**3 / (384.0 * EI), rel=1e-6)


@pytest.mark.parametrize(
    ("history", "factor"), [(None, 1.0), ([[0.0, 0.0], [1.0, 0.4]], 0.4), ([[0.0, 0.0], [0.5, 1.0], [1.0, 0.0]], 0.0)]
)
def test_history_of_a_static_load(solve: Solve, history: list[list[float]] | None, factor: float) -> None:
    """The stage's end counts; on the way the load has bent the beam, as the largest moment of the stage shows."""
    load: Mapping = {"at": "end", "force": [0.0, 0.0, FORCE]} | ({"history": history} if history else {})
    start = prescribed(0.0, 0.0, 0.0, rotation="fixed")
    done = solve(beam(static(loads=[load]), start=start, end="free", solver={"load_steps": 4}))
    bent, unseen = (force * SPAN**3 / (3.0 * EI) for force in (factor * FORCE, 1e-14 * BEAM["EA"]))
    assert done["position"][-1, -1, 2] == pytest.approx(bent, rel=1e-5, abs=unseen)
    greatest = max(f for _, f in history) if history else 1.0
    extremes = done.summary["stages"][0]["extremes"]["max_bending_moment"]
    assert extremes["max"] == pytest.approx(greatest * FORCE * SPAN, rel=1e-5)


def test_loads_end_with_their_stage(solve: Solve) -> None:
    load = {"at": "end", "force": [0.0, 0.0, FORCE]}
    start = prescribed(0.0, 0.0, 0.0, rotation="fixed")
    done = solve(beam(static("push", loads=[load]), static("rest"), start=start, end="free"))
    bent, straight = done["position"][:, -1, 2]
    assert bent == pytest.approx(FORCE * SPAN**3 / (3.0 * EI), rel=1e-5)
    assert abs(straight) < 1e-9 * bent


@pytest.mark.parametrize("force", [1e-3, 1e-6, 1e-12])
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_load_below_the_round_off_of_strains_still_bends(dimension: int, force: float) -> None:
    """A cantilever whose EA is 1e9 times EI/L^2: residuals of 1e-14 EA count as none, but not before one iteration."""
    shape: Mapping = {"riser": {"unstressed": {"points": [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]}}, "dimension": dimension}
    scene = riser_scene(
        static(loads=[{"at": "end", "force": [0.0, 0.0, force]}]),
        pipe={"EA": 1e9, "EI": 1.0, "GJ": 1.0},
        length=1.0,
        elements=10,
        start=prescribed(0.0, 0.0, 0.0, rotation="fixed"),
        end="free",
        **shape,
    )
    assert stage_histories(scene)[0].position[-1][-1, 2] == pytest.approx(force / 3.0, rel=1e-6)
