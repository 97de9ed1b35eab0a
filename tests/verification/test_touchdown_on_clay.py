"""The touchdown point of a long steel riser, on hysteretic clay as on springs."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from demos.compute import compute
from riser_soil.assembly.seabed import GAUSS_POINTS
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.system import Timer
from riser_soil.riser import stations
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import run_stage
from tests.support.contact_along import touchdown_at
from tests.support.driven_stage import Watcher, built
from tests.support.scenes import Mapping, prescribed, riser_scene, static
from tests.support.touchdown_reference import equivalent_point

D, AREA, INERTIA = 0.27, 1.71405e-2, 1.32801e-4  # m, m2, m4 of a steel pipe whose wall is 22 mm
PIPE: Mapping = {"outer_diameter": D, "EA": 2.07e11 * AREA, "EI": 2.07e11 * INERTIA, "submerged_weight": 1060.0}
STRENGTH: Mapping = {"su": 2.0e3, "su_gradient": 1.5e3}
SPRINGS: Mapping = {"kind": "spring", "stiffness": 1.0e5}


def clay(kind: str, **strength: float) -> Mapping:
    return {"kind": "hysteretic", "law": {"kind": kind} | STRENGTH | strength}


SEABEDS = {"springs": SPRINGS, "R&Q": clay("randolph-quiggin"), "A&B": clay("aubeny-biscontin")}


@dataclass(frozen=True, eq=False)
class Laid:
    """One load step: the touchdown arc [m] that the program gives; arc and share of the length [m] of the stations and
    their force [N/m], all (n,), and the force by the law of ground that nothing has touched before.
    """

    touchdown: float
    arc: Array
    share: Array
    force: Array
    first: Array


def laid(seabed: Mapping, size: float, *stages: Mapping, **more: Mapping) -> list[Laid]:
    """A riser of 2,500 m in water of 1,500 m, in elements of a size [m]; step by step."""
    scene = riser_scene(
        static("lay"),
        *stages,
        pipe=PIPE,
        length=2500.0,
        elements=round(2500.0 / size),
        start=prescribed(0.0, 0.0, 0.5 * D),
        end=prescribed(1500.0, 0.0, 1500.0),
        seabed=seabed,
        gravity=9.81,
        dimension=2,
        **more,
    )
    assembly, states = built(scene), list[Laid]()
    seabed_contact = assembly.riser.seabed
    assert seabed_contact is not None
    law = seabed_contact.law
    arc = assembly.riser.line.arc[:-1, None] + assembly.riser.line.length[:, None] * stations.gauss(GAUSS_POINTS).points

    def watch(stepper: TimeStepper, step: AcceptedStep) -> None:
        clearance, force = seabed_contact.contact_along_line(stepper.now)
        penetration = (-clearance - law.start).reshape(seabed_contact.share.shape)
        first = law.update(penetration, law.initial_history(penetration.shape)).force
        at = (x.ravel() for x in (arc, seabed_contact.share, force, first))
        states.append(Laid(touchdown_at(seabed_contact, stepper.now), *at))

    before = State.at_rest(0.0, assembly.size)
    for stage in assembly.scene.stages:
        before = run_stage(assembly, stage, before, Watcher(watch), Timer.new())
    return states


@pytest.mark.parametrize("seabed", SEABEDS)
def test_converges_with_the_elements(seabed: str) -> None:
    """To the end of the rigid contact with the resultant and moment of all forces, where the weight is what rests."""
    coarse, fine = (laid(SEABEDS[seabed], size)[-1] for size in (5.0, 1.25))
    for state in (coarse, fine):
        exact, _ = equivalent_point(state.arc, state.share, state.force, PIPE["submerged_weight"])
        assert state.touchdown == pytest.approx(exact, abs=1e-4)
    assert coarse.touchdown == pytest.approx(fine.touchdown, abs=0.01 if seabed == "springs" else 0.05)


@pytest.mark.parametrize("seabed", ["R&Q", "A&B"])
def test_clay_never_touched_answers_as_to_a_first_penetration(seabed: str) -> None:
    """In one step, also where dynamic relaxation found it: on its way it left no trace."""
    state = laid(SEABEDS[seabed], 2.5)[-1]
    assert np.count_nonzero(state.force) > 1000
    assert state.force == pytest.approx(state.first, rel=1e-12)


def test_clay_as_elastic_as_springs_bears_the_riser_as_they_do() -> None:
    """Hard clay that the riser enters along its first slope, 660 su."""
    hard = 1.0e4
    on_clay = laid(clay("aubeny-biscontin", su=hard, su_gradient=0.0), 2.5)[-1]
    k = 660.0 * hard
    corner = {"smoothing": 1e-4 * PIPE["submerged_weight"] / k}
    on_springs = laid({"kind": "spring", "stiffness": k}, 2.5, contact=corner)[-1]
    assert on_clay.touchdown == pytest.approx(on_springs.touchdown, abs=1e-4)


@pytest.mark.parametrize("seabed", ["A&B", pytest.param("R&Q", marks=pytest.mark.verify)])
def test_moves_as_smoothly_as_the_end(seabed: str) -> None:
    """Pulled by 10 m and let back, over clay whose forces turn, in twice as many steps: half as far by each."""
    far: list[float] = []
    for steps in (20, 40):
        stages = [static(name, move={"end": [x, 0.0, 1500.0]}) for name, x in (("out", 1510.0), ("in", 1500.0))]
        states = laid(SEABEDS[seabed], 5.0, *stages, solver={"load_steps": steps})
        far.append(float(np.abs(np.diff([each.touchdown for each in states])).max()))
    assert far[0] > 0.1
    assert far[1] < 0.6 * far[0]


@pytest.mark.verify
@pytest.mark.parametrize("law", ["randolph-quiggin", "aubeny-biscontin"])
def test_swinging_hose_moves_it_smoothly(law: str, tmp_path: Path) -> None:
    """The hose of the tank, its end at its fastest: with half the step, little more than half as far by each."""
    scene = Path(__file__).parents[1] / "scenes/tank.yaml"
    seabed = f"seabed={{kind: hysteretic, contact_at: axis, law: {{kind: {law}, su: 1500.0, su_gradient: 1500.0}}}}"
    by_step = [
        compute(scene, tmp_path / step, seabed, *every, "stages.1.duration=14.0", "contact={}")
        for step in ("0.05", "0.025")
        for every in [(f"stages.1.time_step={step}", f"output.interval={step}")]
    ]
    coarse, fine = (float(np.abs(np.diff(run["touchdown_arc"])).max()) for run in by_step)
    assert np.ptp(by_step[0]["touchdown_arc"]) > 1.0
    assert coarse < 0.03
    assert fine < 0.65 * coarse
