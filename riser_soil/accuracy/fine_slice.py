"""Error of the soil's cells by a slice across the riser, on the run's cells and on fine ones.

A riser's settlement follows from its load and the cells below it. A stiff pipe is pressed into a slice of the run's
cells until it settles as deep as the riser did; its resistance then is the load. On fine cells its settlement under the
same load is another one. A slice costs so little that its cells can be finer than the run's, so that clay which yields
on fine cells alone has its effect.

Fine cells resolve the contact width, as automatic ones do, and are at most half as large as the run's; far from the
pipe they are the run's. The slice has the run's laws and contact, and is in plane strain.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np

from riser_soil.assembly import Assembly, build, sized
from riser_soil.assembly.riser import elements_of
from riser_soil.assembly.scales import Scales, scales_of
from riser_soil.assembly.soil_sizes import ACROSS, BESIDE, ROUND, STRIP, touching_width
from riser_soil.core.arrays import Array
from riser_soil.scene.lines import on_soil
from riser_soil.scene.plane import vertical_plane
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.scene import Scene
from riser_soil.scene.soil import Block, CellSizes, GeneratedMesh
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import StatelessObserver, solve_stages
from riser_soil.variants.settings import resolved

PEAK = 1.5  # load at a touchdown point over the weight, for which fine cells are chosen
COARSEST = 0.5  # largest size of fine cells over the run's
# Depth to which the first stage presses the pipe, over the riser's settlement; ratio of depths from stage to stage;
# least number of load steps of a stage, of which the first has as many as a riser that is laid.
FIRST, DEEPER, STEPS = 1.25, 1.5, 3
DEEPEST = 0.45  # to which a pipe is pressed, over the diameter
STIFF = 1e3  # stiffness of the pipe over the soil's
LENGTH = 0.2  # length of the slice under the pipe, in diameters
FEW = 3.0  # cells along the riser of a block that has too few slices for one to be cheap


def has_many_slices(scene: Scene) -> bool:
    """Whether soil is so long along the riser that one slice of it costs little beside the run."""
    own = on_soil(sized(scene))
    soil = None if own is None else own.soil
    if own is None or soil is None or not isinstance(soil.mesh, GeneratedMesh) or not isinstance(soil.block, Block):
        return True
    low, high = (soil.block.x, soil.block.y)[1 - _across(own)]
    return high - low >= FEW * soil.mesh.along


def settlements_on_fine_cells(scene: Scene, settlements: Sequence[float]) -> list[float] | None:
    """Settlements on fine cells of a riser with these settlements [m]; not collective. Raises the errors of a run.

    None where there is no slice: with a mesh file, a trench, contact at nodes, or a pipe without weight or settlement.
    """
    own = on_soil(resolved(scene))
    if own is None:
        return None
    scene, scales = own, scales_of(elements_of(own))
    if not _has_slice(scene, scales) or min(settlements, default=0.0) <= 0.0:
        return None
    deepest = max(settlements)
    settled, borne = _pressed(slice_of(scene, scales, _run_cells(scene), deepest), settlement=deepest)
    loads = [_at(settled, borne, each) for each in settlements]
    settled, borne = _pressed(slice_of(scene, scales, _fine_cells(scene, scales), deepest), load=max(loads))
    return [_at(borne, settled, load) for load in loads]


def _has_slice(scene: Scene, scales: Scales) -> bool:
    soil, contact = scene.soil, scene.contact
    if soil is None or contact is None or contact.at_nodes or scales.weight <= 0.0:
        return False
    return isinstance(soil.mesh, GeneratedMesh) and soil.given_block is not None and soil.given_block.feature is None


def _run_cells(scene: Scene) -> GeneratedMesh:
    mesh = _given_mesh(scene)
    return _cells(mesh.across, max(mesh.strip, mesh.across), mesh)


def _fine_cells(scene: Scene, scales: Scales) -> GeneratedMesh:
    assert scene.soil is not None
    mesh, width = _given_mesh(scene), touching_width(replace(scales, weight=PEAK * scales.weight), scene.soil.top_law)
    across = min(width / ACROSS, scales.diameter / ROUND, COARSEST * mesh.across)
    return _cells(across, max(STRIP * across, BESIDE * width), mesh)


def _given_mesh(scene: Scene) -> GeneratedMesh:
    assert scene.soil is not None
    assert isinstance(scene.soil.mesh, GeneratedMesh)
    return scene.soil.mesh


def _cells(across: float, strip: float, mesh: GeneratedMesh) -> GeneratedMesh:
    """Mesh of hexahedra of a section, far from the pipe as large as those of a mesh."""
    return GeneratedMesh(
        size_at_riser=CellSizes(along=mesh.along, across=across, strip=strip), size_far=max(mesh.size_far, across)
    )


def slice_of(scene: Scene, scales: Scales, mesh: GeneratedMesh, settlement: float) -> Scene:
    """A stiff pipe over a slice of the scene's soil, pressed in stages as deep as a settlement [m], and on."""
    soil, D = scene.soil, scales.diameter
    assert soil is not None
    assert isinstance(soil.block, Block)
    origin, axis = vertical_plane(scene).origin, _across(scene)
    low, high = (bound - origin[axis] for bound in (soil.block.x, soil.block.y)[axis])
    middle = 0.5 * (1.0 - LENGTH) * D, 0.5 * (1.0 + LENGTH) * D
    part = {"model": "sections", "mesh": mesh, "block": Block(x=middle, y=(low, high), depth=soil.block.depth)}
    pipe = _pipe(scales, soil.top_law.surface_modulus(D))
    more: dict[str, Any] = {"soil": soil.model_copy(update=part), "contact": scene.contact}
    more["solver"] = scene.solver.model_copy(update={"load_steps": STEPS})
    return scene_from_mapping(pipe | {"stages": [*_stages(D, settlement)]}).model_copy(update=more)


def _across(scene: Scene) -> int:
    """The axis, x (0) or y (1), that is across the riser, or more so than the other."""
    x, y, _ = vertical_plane(scene).direction
    return int(abs(x) > abs(y))


def _pipe(scales: Scales, E: float) -> dict[str, Any]:
    """Scene of a length of pipe that is stiff compared with soil of modulus E [Pa], with fixed ends."""
    D, gravity = scales.diameter, 9.81
    pipe = {"outer_diameter": D, "submerged_weight": scales.weight, "mass": scales.weight / gravity}
    pipe |= {"EA": STIFF * E * D**2, "EI": STIFF * E * D**4}
    ends = {end: {"position": at, "rotation": "fixed"} for end, at in _ends(D, 0.5 * D).items()}
    riser = {"segments": [{"line_type": "pipe", "length": D, "elements": 2}], "initial": "straight"} | ends
    return {"gravity": gravity, "dimension": 2, "line_types": {"pipe": pipe}, "riser": riser}


def _ends(D: float, z: float) -> dict[str, list[float]]:
    return {"start": [0.0, 0.0, z], "end": [D, 0.0, z]}


def _stages(D: float, settlement: float) -> Iterator[dict[str, Any]]:
    depth, n = FIRST * settlement, 1
    while n == 1 or depth <= DEEPEST * D:
        yield {"name": f"{n}", "kind": "static", "move": _ends(D, 0.5 * D - depth)}
        depth, n = DEEPER * depth, n + 1


class _ReachedError(Exception):
    """Ends a stage before its end."""


class _Pressing(StatelessObserver):
    """Settlement [m] and load [N] after each load step, until one of them is reached."""

    def __init__(self, assembly: Assembly, settlement: float, load: float) -> None:
        self._assembly, self._settlement, self._load = assembly, settlement, load
        self.settled, self.borne = [0.0], [0.0]

    def record(self, stepper: TimeStepper, step: AcceptedStep, last: bool) -> None:
        soil = self._assembly.soil
        assert soil is not None
        self.settled.append(float(-soil.recovered().output_fields().displacement[:, 2].min()))
        self.borne.append(self._assembly.ground_force(stepper.now))
        if self.settled[-1] >= self._settlement or self.borne[-1] >= self._load:
            raise _ReachedError


def _pressed(scene: Scene, settlement: float = np.inf, load: float = np.inf) -> tuple[Array, Array]:
    """Settlements [m] and loads [N] on the way to one of them."""
    from mpi4py import MPI

    assembly = build(scene, MPI.COMM_SELF)
    pressing = _Pressing(assembly, settlement, load)
    with suppress(_ReachedError):
        solve_stages(assembly, pressing)
    return np.array(pressing.settled), np.array(pressing.borne)


def _at(x: Array, y: Array, value: float) -> float:
    """Value of a curve y(x), x increasing, with linear extrapolation at both ends."""
    n = int(np.clip(np.searchsorted(x, value), 1, x.size - 1))
    return float(y[n - 1] + (y[n] - y[n - 1]) * (value - x[n - 1]) / (x[n] - x[n - 1]))
