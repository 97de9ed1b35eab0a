"""Coupled runs on difficult soil get to their end: almost incompressible, or without strength at the seabed; and a pipe
that leaves the soil as a whole and comes down again.
"""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.system import System
from riser_soil.scene.stages import Stage
from riser_soil.solve.time_stepper import AcceptedStep
from tests.support.coupled_scenes import LAY, Mapping, heave, touchdown
from tests.support.driven_stage import built, take
from tests.support.falling_on_soil import CLAY, ELASTIC, MIDDLE, D, falling


def changed(kind: str, law: Mapping) -> Mapping:
    scene = touchdown(LAY, heave(0.3), kind=kind, su=1000.0)
    scene["soil"]["law"] |= law
    scene["contact"] = {"method": "surface"}
    return scene


SCENES = {
    "nearly incompressible, hex": changed("hex", {"nu": 0.4999}),
    "nearly incompressible, tet": changed("tet", {"nu": 0.4999}),
    "no strength at the seabed, hex": changed("hex", {"su": 0.0, "su_gradient": 8.0e3}),
    "no strength at the seabed, tet": changed("tet", {"su": 0.0, "su_gradient": 8.0e3}),
}


@pytest.mark.verify
@pytest.mark.parametrize("name", SCENES)
def test_riser_is_laid_and_heaves_on_difficult_soil(name: str) -> None:
    runs_and_bears(SCENES[name])


def runs_and_bears(scene: Mapping) -> None:
    """The grounds bear the part of the weight that does not hang from the end."""
    assembly, borne, iterations = built(scene), list[float](), list[int]()

    def watch(system: System, step: AcceptedStep) -> None:
        state = step.solution.state
        borne.append(float(sum(contact.force_on_riser(state)[2] for contact in assembly.contacts)))
        iterations.append(step.solution.iterations)

    before = State.at_rest(0.0, assembly.size)
    for stage in assembly.scene.stages:
        before = take(assembly, stage, before, watch)
    weight = float(assembly.elements.weight @ assembly.line.length)
    print(f"borne {np.array(borne) / weight}, iterations {iterations}")
    assert np.all((np.array(borne) > 0.2 * weight) & (np.array(borne) < weight))


@pytest.mark.parametrize("law", [ELASTIC, CLAY], ids=["elastic", "clay"])
def test_pipe_that_leaves_the_soil_touches_again(law: Mapping) -> None:
    """Both ends go up and down by 0.06 m every half a second about 0.05 m above the soil."""
    scene = falling(1e7, 0.02, law, MIDDLE)
    z = 0.5 * D + 0.05
    motion = {"harmonic": {"amplitude": [0.0, 0.0, 0.06], "period": 0.5, "ramp": 0.25}}
    scene["riser"] |= {
        end: {"position": [x, 0.0, z], "rotation": "fixed"} for end, x in (("start", 0.0), ("end", 1.0))
    }
    scene["riser"]["initial"] = "straight"
    dip = {"name": "dip", "kind": "dynamic", "duration": 1.6, "time_step": 0.02}
    scene["stages"] = [dip | {"motion": {"start": motion, "end": motion}}]
    force = forces(scene)
    touching = force > 0.0
    landings = np.count_nonzero(touching[1:] & ~touching[:-1])
    assert landings == 3, force
    assert force.min() == 0.0
    assert force.max() > 100.0


def forces(scene: Mapping) -> Array:
    """What the soil bears [N], step by step of the only stage."""
    assembly, found = built(scene), list[float]()
    contact = assembly.soil_contact
    assert contact is not None
    stage: Stage = assembly.scene.stages[0]
    take(assembly, stage, watch=lambda _, step: found.append(-float(contact.force_on_soil(step.solution.state)[2])))
    return np.array(found)
