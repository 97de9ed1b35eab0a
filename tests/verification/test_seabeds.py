"""Risers at rest on seabeds without a continuum: level, sloping, by a profile; at nodes and along the elements."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from riser_soil.core.snapshot import Record
from riser_soil.errors import ResultsError
from riser_soil.results import Run
from riser_soil.scene.reader import read_scene
from riser_soil.seabed.laws import LAWS
from riser_soil.whole_run import run
from tests.support.scenes import Mapping, prescribed, riser_scene, static
from tests.support.stage_histories import distance, stage_histories

SCENES = Path(__file__).parents[1] / "scenes"
W, SLOPE = 700.0, 2.0  # N/m, deg; steeper, the riser would be pushed at its start, and lie down beside its plane
PIPE = {"EA": 3e8, "EI": 2e4, "GJ": 1e4, "outer_diameter": 0.3, "submerged_weight": W}
RISE = float(np.tan(np.radians(SLOPE)))


def lying(
    seabed: Mapping,
    method: str = "line",
    elements: int = 150,
    length: float = 150.0,
    more_stages: tuple[Mapping, ...] = (),
    more_contact: Mapping | None = None,
    **more: Any,
) -> Record:
    """A riser from the ground at its start, where its axis rests, to 60 m above and 110 m away; after all stages."""
    ground = {"kind": "spring", "stiffness": 1e5, "contact_at": "axis"} | seabed
    scene = riser_scene(
        static(),
        *more_stages,
        pipe=PIPE,
        length=length,
        elements=elements,
        start=prescribed(0.0, 0.0, 0.0),
        end=prescribed(88.0, 66.0, 60.0),
        gravity=9.81,
        seabed={key: value for key, value in ground.items() if value is not None},
        contact={"method": method} | (more_contact or {}),
        solver={"tolerance": 1e-10},
        **more,
    )
    return stage_histories(scene)[-1].end


def resting(record: Record) -> slice:
    """Nodes well within the stretch that lies on the ground."""
    touching = np.flatnonzero(record.contact_force > 0.0)
    return slice(int(touching[0]) + 12, int(touching[-1]) - 12)


@pytest.mark.parametrize("method", ["line", "node"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_riser_on_a_slope(method: str, dimension: int) -> None:
    """Where it lies straight the ground bears w cos(slope), and the tension grows uphill by w sin(slope)."""
    record = lying({"slope_deg": SLOPE}, method, dimension=dimension)
    at = resting(record)
    assert len(record.contact_force[at]) > 10
    cosine, sine = np.cos(np.radians(SLOPE)), np.sin(np.radians(SLOPE))
    assert record.contact_force[at] == pytest.approx(W * cosine, rel=1e-4)
    assert np.diff(record.effective_tension[at]) == pytest.approx(np.full(at.stop - at.start - 1, W * sine), rel=1e-3)
    total = record.start_force + record.end_force
    assert total[2] == pytest.approx(150.0 * W - np.sum(_tributary(record) * record.contact_force) * cosine, rel=1e-6)


def _tributary(record: Record) -> np.ndarray:
    share = np.full(len(record.contact_force), 1.0)
    share[[0, -1]] = 0.5
    return share


def test_profile_of_the_slope_is_the_slope() -> None:
    slope = lying({"slope_deg": SLOPE})
    profile = lying({"profile": [[-50.0, -50.0 * RISE], [40.0, 40.0 * RISE], [200.0, 200.0 * RISE]]})
    assert distance(slope.position, profile.position) < 1e-8
    assert profile.contact_force == pytest.approx(slope.contact_force, abs=1e-4)


@pytest.mark.parametrize("method", ["line", "node"])
def test_riser_over_a_trench(method: str) -> None:
    """Sunk in or spanning it, the riser is borne by supports and ground together; it follows gentle ground."""
    profile = [[-10.0, 0.0], [0.0, 0.0], [20.0, -0.4], [40.0, 0.0], [60.0, 0.0], [150.0, 0.0]]
    record = lying({"profile": profile}, method)
    along = record.position @ np.array([0.8, 0.6, 0.0])
    lowest = record.position[np.argmin(record.position[:, 2])]
    assert -0.45 < lowest[2] < -0.2
    assert 15.0 < along[np.argmin(record.position[:, 2])] < 25.0
    touched = record.contact_force > 0.0
    assert touched[(along > 5.0) & (along < 15.0)].any()
    vertical = record.start_force[2] + record.end_force[2] + np.sum(_tributary(record) * record.contact_force)
    assert vertical == pytest.approx(150.0 * W, rel=2e-3)  # the ground's push leans by its slope, 1/25 at most


def test_line_contact_converges_faster_than_contact_at_nodes() -> None:
    """Errors of the horizontal tension against 1,200 elements, on springs; see the demo of the tank for more."""
    exact = lying({}, elements=1200).end_force[0]
    line, node = (
        [abs(lying({}, method, elements=n).end_force[0] / exact - 1.0) for n in (75, 150, 300)]
        for method in ("line", "node")
    )
    assert line[0] < 0.2 * node[0]
    assert line[-1] < 4e-6
    assert np.all(np.array(line) < np.array(node))


def test_methods_agree_on_fine_meshes() -> None:
    line, node = (lying({}, method, elements=600) for method in ("line", "node"))
    assert line.end_force == pytest.approx(node.end_force, rel=2e-5)
    assert line.bending_moment.max() == pytest.approx(node.bending_moment.max(), rel=1e-4)


CLAY = {"kind": "randolph-quiggin", "su": 2e3, "su_gradient": 1.5e3}


@pytest.mark.parametrize("law", ["randolph-quiggin", "aubeny-biscontin"])
def test_riser_at_rest_on_hysteretic_clay(law: str) -> None:
    """Well behind the touchdown point it lies as deep as the law answers with its weight."""
    clay = {"kind": "hysteretic", "stiffness": None, "law": CLAY | {"kind": law}}
    record = lying(clay, dimension=2)
    at = resting(record)
    assert record.contact_force[at] == pytest.approx(W, rel=1e-4)
    known = LAWS[law](**CLAY | {"kind": law}).of_pipe(0.3)
    depth = -record.position[at, 2]
    force = known.update(depth, known.initial_history(depth.shape)).force
    assert force == pytest.approx(W, rel=1e-3)


MU = 0.35


@pytest.mark.parametrize("dimension", [2, 3])
def test_pulled_riser_slides_as_far_as_friction_lets_it(dimension: int) -> None:
    """Where it has slid, its tension falls by mu w per length towards the anchor, and nowhere faster."""
    pull = static("pull", move={"end": [92.0, 69.0, 60.0]})
    friction = {"friction": {"axial": MU, "mobilisation": 1e-4}}
    record = lying({}, dimension=dimension, more_stages=(pull,), more_contact=friction)
    lain = lying({}, dimension=dimension, more_contact=friction)
    T, f = record.effective_tension, record.contact_force
    lying_there = np.flatnonzero((f[:-1] > 0.9 * W) & (f[1:] > 0.9 * W))
    share = np.diff(T)[lying_there] / (MU * 0.5 * (f[lying_there] + f[lying_there + 1]))
    assert T.max() > lain.effective_tension.max() + 500.0
    assert share.max() < 1.02
    assert np.count_nonzero(np.abs(share - 1.0) < 0.02) > 5


def test_slip_is_reported_where_there_is_friction(tmp_path: Path) -> None:
    """The pulled end's side slides, the anchor's side does not; without friction the field is left out."""
    scene = read_scene(SCENES / "hysteretic.yaml", ("stages.1.duration=6.0", "contact.friction.mobilisation=1e-3"))
    run(scene, tmp_path / "rough")
    slip = Run(tmp_path / "rough")["slip"]
    assert np.all(np.diff(slip, axis=0) >= 0.0)
    assert slip[-1].max() > 1e-3
    assert slip[-1, 0] < 0.5 * slip[-1].max()
    run(read_scene(SCENES / "tank.yaml", ("stages.1.duration=0.5",)), tmp_path / "smooth")
    with pytest.raises(ResultsError, match="no slip;"):
        Run(tmp_path / "smooth")["slip"]
