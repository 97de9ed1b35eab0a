"""A pipe pressed into a block of clay, by riser_soil and by CalculiX: tables of docs/peers.md.

Usage: python -m benchmarks.peers.clay [--results FOLDER] [--page]
Runs that have left a file in the folder are not repeated. Without `ccx` (Debian's calculix-ccx) CalculiX is left out.
"""

from __future__ import annotations

import shutil
import sys
import time
from dataclasses import asdict, dataclass
from functools import cached_property
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from mpi4py import MPI

from benchmarks.peers import calculix
from benchmarks.peers.clay_case import DEPTHS, MESHES, STEPS, Mesh, Pressed, scene_of
from benchmarks.peers.in_turn import ROOT
from demos.page import publish, script, table
from riser_soil.assembly import Assembly, build
from riser_soil.calibration.segment import ContactForceLog
from riser_soil.contact.law import Penalty
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.system import Timer
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import run_stage

PAGE = ROOT / "docs" / "peers.md"
SHOWN = (3, 6, 9, 12)  # steps
OURS = "riser_soil"
ELEMENTS = {f"CalculiX, {element}": element for element in ("C3D8I", "C3D8R", "C3D8")}
FINEST = "finest"  # is left to riser_soil


@dataclass(eq=False)
class PressLog(ContactForceLog):
    """Forces, and Newton iterations of the steps taken."""

    iterations: int = 0

    def record(self, stepper: TimeStepper, step: AcceptedStep, last: bool) -> None:
        super().record(stepper, step, last)
        self.iterations += step.solution.iterations


@dataclass(frozen=True)
class Run:
    """The case on one mesh."""

    mesh: Mesh

    @cached_property
    def assembly(self) -> Assembly:
        return build(scene_from_mapping(scene_of(self.mesh)), MPI.COMM_SELF)

    @property
    def block(self) -> calculix.Block:
        assert self.assembly.soil is not None
        grid = self.assembly.soil.whole.grid
        points, order = grid.nodes.points, list(grid.family.vtk)
        return calculix.Block(points, grid.nodes.cells[:, order], grid.fixed_directions(points))

    @property
    def unknowns(self) -> int:
        """Displacements of the soil that are not held."""
        assert self.assembly.soil is not None
        return int((~self.assembly.soil.whole.field.prescribed).sum())

    def by(self, program: str, folder: Path) -> Pressed:
        """Pressed by riser_soil or with one of ELEMENTS; folder: for ccx' files."""
        if program == OURS:
            return self._ours()
        assert self.assembly.soil is not None
        law = self.assembly.soil.contact.law
        assert isinstance(law, Penalty)
        return calculix.run(self.block, law.stiffness, ELEMENTS[program], folder)

    def _ours(self) -> Pressed:
        """The second stage; in the first one nothing touches."""
        assembly, clock = self.assembly, Timer.new()
        touch, press = assembly.scene.stages
        rest = State.at_rest(0.0, assembly.size)
        before = run_stage(assembly, touch, rest, PressLog(assembly), clock)
        log, since = PressLog(assembly), time.process_time()
        run_stage(assembly, press, before, log, clock)
        seconds = time.process_time() - since
        force = np.interp(np.arange(1, STEPS + 1) / STEPS, log.times, log.forces)
        return Pressed(force, log.iterations, seconds)


@dataclass(frozen=True, eq=False)
class MeshRuns:
    """A mesh: its name, unknowns, and what the programs gave on it."""

    name: str
    unknowns: int
    by: dict[str, Pressed]


def main(results: Path, page: bool) -> None:
    results.mkdir(parents=True, exist_ok=True)
    if shutil.which("ccx") is None:
        print("there is no ccx here (Debian's calculix-ccx): CalculiX is left out", file=sys.stderr)
    Run(MESHES["coarse"]).by(OURS, results)  # compiles
    meshes = [_measured(name, mesh, results) for name, mesh in MESHES.items()]
    publish({"clay": clay_page(meshes)}, results, PAGE if page else None)


def _measured(name: str, mesh: Mesh, results: Path) -> MeshRuns:
    run, by = Run(mesh), {}
    others = [] if name == FINEST or shutil.which("ccx") is None else list(ELEMENTS)
    for program in (OURS, *others):
        path = results / f"clay_{ELEMENTS.get(program, OURS)}_{name}.npz"
        if not path.exists():
            with TemporaryDirectory() as folder:
                np.savez(path, **asdict(run.by(program, Path(folder))))
        with np.load(path) as stored:
            by[program] = Pressed(stored["force"], int(stored["iterations"]), float(stored["seconds"]))
    return MeshRuns(name, run.unknowns, by)


def clay_page(meshes: list[MeshRuns]) -> str:
    """Forces by depth of the pipe's middle, how far from riser_soil's on this mesh and on the finest; cost."""
    depth = 0.5e3 * sum(DEPTHS) / STEPS  # mm
    head = ["mesh, unknowns", "program", *(f"N at {step * depth:g} mm" for step in SHOWN)]
    rows = [_row(each, program, meshes[-1].by[OURS].force) for each in meshes for program in each.by]
    return table([*head, "off riser_soil", "off the finest", "Newton iterations", "processor s"], rows)


def _row(mesh: MeshRuns, program: str, finest: Array) -> list[str]:
    pressed = mesh.by[program]
    shown = ["–" if np.isnan(pressed.force[step - 1]) else f"{pressed.force[step - 1]:.1f}" for step in SHOWN]
    off = [_percent(pressed.force, other) for other in (mesh.by[OURS].force, finest)]
    cost = [str(pressed.iterations), f"{pressed.seconds:.1f}"]
    return [f"{mesh.name}, {mesh.unknowns}", program, *shown, *off, *cost]


def _percent(force: Array, other: Array) -> str:
    """Largest difference at the end of a step, over the largest force."""
    return f"{100.0 * np.nanmax(np.abs(force - other)) / other.max():.1f} %"


if __name__ == "__main__":
    script(main, __doc__, ROOT / "build" / "peers_clay")
