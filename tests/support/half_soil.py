"""A riser pressed into half of a block or of sections, and into all of it; run by itself it tells figures as JSON."""

from __future__ import annotations

import json
import sys
from typing import Any, NamedTuple

import numpy as np
from mpi4py import MPI

from riser_soil.assembly import build
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.system import Timer
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import run_stage
from tests.support.driven_stage import Watcher, soil_under
from tests.support.scenes import LAY, Mapping, block, cells, static, touchdown

PUSH = static("push", loads=[{"at": 7.0, "force": [0.0, 0.0, -900.0]}])
CLAY: Mapping = {
    "kind": "kinematic-hardening",
    **{"su": 600.0, "su_gradient": 500.0, "E_over_su": 200.0, "nu": 0.49, "elastic_share": 0.1},
}


def pressed(symmetry: str, width: float = 1.6, **more: Any) -> Mapping:
    """The riser is laid and pressed down, with friction, on soft clay of a width [m]; more: keys of the soil."""
    scene = touchdown(LAY, PUSH)
    mesh = cells({"along": 1.0, "across": 0.04, "strip": 0.2}, 0.3)
    scene["soil"] |= block(CLAY, (5.0, 9.0), 0.5 * width, 0.5, mesh, symmetry=symmetry, **more)
    scene["contact"] = {"method": "surface", "friction": {"axial": 0.4, "lateral": 0.7}}
    scene["solver"] = {"tolerance": 1e-11, "load_steps": 5}
    return scene


def along_y(scene: Mapping) -> Mapping:
    """The scene, turned so that its riser runs along y."""
    for end in ("start", "end"):
        x, y, z = scene["riser"][end]["position"]
        scene["riser"][end]["position"] = [y, x, z]
    block = scene["soil"]["block"]
    block["x"], block["y"] = block["y"], block["x"]
    return scene


class Results(NamedTuple):
    """At the end: unknowns and new meshes; by place, displacement, stress, plastic strain (rank 0); depth of the riser,
    its forces on the soil by length, and their sums on both; energies of all steps, with what they have dissipated.
    """

    unknowns: int
    renewals: int
    displacement: Array
    stress: Array
    plastic: Array
    depth: Array
    along: Array
    sums: Array
    energies: Array

    @property
    def compared(self) -> dict[str, Array]:
        """The results that must be the same."""
        return {name: values for name, values in self._asdict().items() if isinstance(values, np.ndarray)}


def run(scene: Mapping, comm: Any = MPI.COMM_SELF) -> Results:
    """Take all stages of a scene; collective."""
    made, energies = build(scene_from_mapping(scene), comm), list[tuple[float, ...]]()

    def watch(stepper: TimeStepper, step: AcceptedStep) -> None:
        energies.append((stepper.energy.strain, stepper.energy.potential, step.dissipated))

    state = State.at_rest(0.0, made.size)
    for stage in made.scene.stages:
        state = run_stage(made, stage, state, Watcher(watch), Timer.new())
    soil, contact, renewal = soil_under(made).whole, soil_under(made).contact, soil_under(made).mesh_renewal
    fields, mesh = soil.output_fields(), soil.output_mesh()
    nodes, cells = (_by_place(places) for places in (mesh.points, mesh.points[mesh.cells].mean(axis=1)))
    free = int(np.count_nonzero(soil.field.owned & ~soil.field.prescribed))
    sums = np.concatenate([contact.force_on_riser(state), contact.force_on_soil(state)])
    return Results(
        comm.allreduce(free),
        0 if renewal is None else renewal.count,
        fields.displacement[nodes],
        fields.von_mises[cells],
        fields.plastic_strain[cells],
        contact.depth(state),
        contact.force_on_soil_per_length(state),
        sums,
        np.array(energies),
    )


def _by_place(points: Array) -> Array:
    return np.lexsort(np.round(points, 6).T)


if __name__ == "__main__":
    result = run(pressed("auto", model=sys.argv[1]), MPI.COMM_WORLD)
    if MPI.COMM_WORLD.rank == 0:
        print(json.dumps({name: np.asarray(values).tolist() for name, values in result._asdict().items()}))
