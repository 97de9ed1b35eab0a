"""A stiff pipe pushed into a slice of clay at large strain: load by embedment."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.system import Timer
from riser_soil.soil.condensed import SoilSurface
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import run_stage
from tests.support.driven_stage import Watcher, built, soil_under
from tests.support.scenes import Mapping, block, cells, level_pipe, pushed_to

D, SU, STIFF = 0.3, 5.0e3, 400.0  # m, Pa, E over su
CLAY: Mapping = {"kind": "von-mises", "su": SU, "E_over_su": STIFF}


def sinking(across: int, depth: float, steps: int, law: Mapping = CLAY, **more: Any) -> Mapping:
    """A scene that presses a pipe to an embedment of `depth` diameters in so many steps, on so many cells across the
    pipe; one cell is plane strain. more: keys of the soil; contact: of contact.
    """
    size, contact = D / across, more.pop("contact", {})
    mesh = cells({"along": size, "across": size, "strip": (1.5 + depth) * D}, D)
    around = (0.5 * (D - size), 0.5 * (D + size))
    return level_pipe(
        pushed_to(D, 0.5 * D - depth * D),
        pipe={"outer_diameter": D, "submerged_weight": 500.0, "mass": 120.0, "EA": 1e10, "EI": 1e9},
        length=D,
        elements=1,
        height=0.5 * D,
        soil=block(law, around, 5.0 * D, 5.0 * D, mesh, **{"strain": "large"} | more),
        contact={"method": "surface"} | contact,
        solver={"load_steps": steps},
    )


def sinking_into_tetrahedra(across: int, depth: float, steps: int, **more: Any) -> Mapping:
    """The scene of `sinking` on tetrahedra, so many across the pipe, in a slice of two."""
    scene, size = sinking(across, depth, steps, **more), D / across
    scene["soil"]["block"]["x"] = [0.5 * D - size, 0.5 * D + size]
    scene["soil"]["mesh"] = cells(size, D, "tet")
    return scene


@dataclass(frozen=True, eq=False)
class Sunk:
    """Step by step: embedment over D, loads down and to the side (+y) per length over su D, Newton iterations, the
    stage's t, lift: area of the section times the height to which it has risen from level ground, over D³, and R: load
    down with which each step was solved, as V; solutions: of each step, on as many geometries; new meshes that it took;
    and the area of the slice's section over that at first.
    """

    w: Array
    V: Array
    H: Array
    iterations: Array
    t: Array
    lift: Array
    R: Array
    solutions: Array
    renewals: int
    area: float

    def at(self, w: float) -> float:
        """V/(su D) at an embedment w/D."""
        return float(np.interp(w, self.w, self.V))


def sink(scene: Mapping, followed: int = 0) -> Sunk:
    """Take the scene's stages up to the one of that number, of which it tells; embedments are those of the first."""
    assembly, rows = built(scene), list[tuple[float, ...]]()
    ground = soil_under(assembly)
    contact, friction, soil = ground.contact, ground.friction, ground.whole
    bearing = float(soil.grid.high[0] - soil.grid.low[0]) * SU * D
    deepest = 0.5 - scene["stages"][0]["move"]["start"][2] / D
    first = soil.cells.volumes.sum()

    def watch(stepper: TimeStepper, step: AcceptedStep) -> None:
        forces = [contact.force_on_soil(stepper.before)]
        if friction is not None:
            forces.append(friction.force_on_soil(stepper.before))
        _, side, up = np.sum(forces, axis=0) / bearing
        borne = -step.solution.forces.end[contact.line.translation_dofs[:, -1]].sum() / bearing
        solved, solutions = (step.solution.iterations, step.t), 1 + (step.solution.iterations_before > 0)
        rows.append((step.t * deepest, -up, side, *solved, lifted(soil.surface) / D**3, borne, solutions))

    state = State.at_rest(0.0, assembly.size)
    for stage in assembly.scene.stages[: followed + 1]:
        rows.clear()
        state = run_stage(assembly, stage, state, Watcher(watch), Timer.new())
    w, V, H, iterations, t, lift, borne, solutions = np.array(rows).T
    renewals = 0 if ground.mesh_renewal is None else ground.mesh_renewal.count
    area = float(soil.cells.volumes.sum() / first)
    return Sunk(w, V, H, iterations, t, lift, borne, solutions, renewals, area)


def lifted(surface: SoilSurface) -> float:
    """Area of a slice's section times its height above level ground [m3]: the integral of z²/2 along its surface."""
    points = surface.points + surface.committed
    line = points[surface.points[:, 0] < surface.points[:, 0].min() + 1e-9]
    y, z = line[np.argsort(line[:, 1]), 1:].T
    return float(np.sum(np.diff(y) * (z[1:] ** 2 + z[1:] * z[:-1] + z[:-1] ** 2)) / 6.0)
