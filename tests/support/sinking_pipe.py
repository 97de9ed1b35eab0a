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
from tests.support.coupled_scenes import Mapping
from tests.support.driven_stage import Watcher, built

D, SU, STIFF = 0.3, 5.0e3, 400.0  # m, Pa, E over su
CLAY: Mapping = {"kind": "von-mises", "su": SU, "E_over_su": STIFF}


def sinking(cells: int, depth: float, steps: int, law: Mapping = CLAY, **more: Any) -> Mapping:
    """To an embedment of `depth` diameters in so many steps, on so many cells across the pipe; one cell is plane
    strain. more: keys of the soil; contact: of contact.
    """
    size, contact = D / cells, more.pop("contact", {})
    ends = {name: {"position": [x, 0.0, 0.5 * D], "rotation": "fixed"} for name, x in (("start", 0.0), ("end", D))}
    down = {name: [*end["position"][:2], 0.5 * D - depth * D] for name, end in ends.items()}
    pipe = {"outer_diameter": D, "submerged_weight": 500.0, "mass": 120.0, "EA": 1e10, "EI": 1e9}
    around = {"x": [0.5 * (D - size), 0.5 * (D + size)], "y": [-5.0 * D, 5.0 * D], "depth": 5.0 * D}
    cell_sizes = {"along": size, "across": size, "strip": (1.5 + depth) * D}
    return {
        "title": "Pipe that sinks into clay",
        "gravity": 9.81,
        "dimension": 2,
        "line_types": {"pipe": pipe},
        "riser": {"segments": [{"line_type": "pipe", "length": D, "elements": 1}], **ends, "initial": "straight"},
        "soil": {
            "block": around,
            "mesh": {"kind": "hex", "size_at_riser": cell_sizes, "size_far": D},
            "law": dict(law),
            "strain": "large",
            **more,
        },
        "contact": {"method": "surface", **contact},
        "solver": {"load_steps": steps},
        "stages": [{"name": "push", "kind": "static", "move": down}],
    }


def sinking_into_tetrahedra(cells: int, depth: float, steps: int, **more: Any) -> Mapping:
    """The same on tetrahedra, so many across the pipe, in a slice of two."""
    scene = sinking(cells, depth, steps, **more)
    size = D / cells
    block = scene["soil"]["block"] | {"x": [0.5 * D - size, 0.5 * D + size]}
    mesh = {"kind": "tet", "size_at_riser": size, "size_far": D}
    return scene | {"soil": scene["soil"] | {"block": block, "mesh": mesh}}


@dataclass(frozen=True, eq=False)
class Sunk:
    """Step by step: embedment over D, loads down and to the side (+y) per length over su D, Newton iterations, the
    stage's t, lift: area of the section times the height to which it has risen from level ground, over D³; new meshes
    that it took; and the area of the slice's section over that at first.
    """

    w: Array
    V: Array
    H: Array
    iterations: Array
    t: Array
    lift: Array
    renewals: int
    area: float

    def at(self, w: float) -> float:
        """V/(su D) at an embedment w/D."""
        return float(np.interp(w, self.w, self.V))


def sink(scene: Mapping, followed: int = 0) -> Sunk:
    """Take the scene's stages up to the one of that number, of which it tells; embedments are those of the first."""
    assembly, rows = built(scene), list[tuple[float, ...]]()
    contact, friction, soil = assembly.soil_contact, assembly.only.soil_friction, assembly.soil
    assert contact is not None
    assert soil is not None
    bearing = float(soil.grid.high[0] - soil.grid.low[0]) * SU * D
    deepest = 0.5 - scene["stages"][0]["move"]["start"][2] / D
    first = soil.cells.volumes.sum()

    def watch(stepper: TimeStepper, step: AcceptedStep) -> None:
        forces = [contact.force_on_soil(stepper.before)]
        if friction is not None:
            forces.append(friction.force_on_soil(stepper.before))
        _, side, up = np.sum(forces, axis=0) / bearing
        rows.append((step.t * deepest, -up, side, step.solution.iterations, step.t, lifted(soil.surface) / D**3))

    state = State.at_rest(0.0, assembly.size)
    for stage in assembly.scene.stages[: followed + 1]:
        rows.clear()
        state = run_stage(assembly, stage, state, Watcher(watch), Timer.new())
    w, V, H, iterations, t, lift = np.array(rows).T
    renewals = 0 if assembly.mesh_renewal is None else assembly.mesh_renewal.count
    return Sunk(w, V, H, iterations, t, lift, renewals, float(soil.cells.volumes.sum() / first))


def lifted(surface: SoilSurface) -> float:
    """Area of a slice's section times its height above level ground [m3]: the integral of z²/2 along its surface."""
    points = surface.points + surface.committed
    line = points[surface.points[:, 0] < surface.points[:, 0].min() + 1e-9]
    y, z = line[np.argsort(line[:, 1]), 1:].T
    return float(np.sum(np.diff(y) * (z[1:] ** 2 + z[1:] * z[:-1] + z[:-1] ** 2)) / 6.0)
