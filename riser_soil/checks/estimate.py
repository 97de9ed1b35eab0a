"""Estimate of a scene's size before anything is built: unknowns, steps, memory, disk space, run time.

Memory and disk are those of `check`'s report within some tens of per cent, the time within a factor of three or so, and
of blocks of soil within 1.5. The memory of scenes with soil is the largest that a run takes, within 30 %.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from riser_soil.assembly import sized
from riser_soil.assembly.assembly import LAID_IN
from riser_soil.assembly.motions import corner_count
from riser_soil.assembly.soil_block import block_of
from riser_soil.checks.factor_fill import factor_memory, nodes_of, operations
from riser_soil.core.outputs import ALONG_RISER, OF_SOIL
from riser_soil.scene.lines import by_line, on_soil
from riser_soil.scene.plane import initial_ends, resolved_dimension
from riser_soil.scene.scene import Scene
from riser_soil.scene.soil import MeshFile, SoilScene
from riser_soil.scene.stages import QuasiStaticStage, Stage, StaticStage
from riser_soil.soil.grading import BlockSpec

# Bytes of: a process with the packages that every scene needs, what dolfinx and gmsh add, element and matrix arrays of
# an unknown of the riser, all that a cell has for one entry of its matrix (mesh, value, place, matrix entry, tangent,
# histories), a time at which output is due, an element in a wave component.
PROCESS, SOIL_PROCESS, PER_RISER_DOF, PER_CELL_ENTRY, PER_STOP, PER_WAVE = 0.24e9, 0.14e9, 2e3, 55.0, 150.0, 150.0
PER_UNKNOWN = 1.5e3  # bytes of multigrid and of GMRES' vectors
PLANE = 3  # times as much has a cell in plane strain for an entry, as its law knows all components
PER_LAYER = 90.0  # bytes of the factors of an unknown in a section, whose band is as wide as two nodes of each layer
WITHIN = 1.3  # memory is at most this many times the forecast, or the forecast over this
# Doubles of a record: by node, by step; of a picture: by node of the riser, by cell of the soil with its nodes,
# somewhat more than one.
PER_NODE = PER_PICTURE = sum(output.numbers for output in ALONG_RISER)
PER_STEP, PER_CELL = 60, 1 + sum(output.numbers for output in OF_SOIL)
TENSOR = 9  # numbers, row by row
COPIES = 2.0  # copies of each file while it grows
# Seconds on one core: to lay an element out; of a step, and in it of an element, of an element and wave component, of a
# cell in a section; of a step on condensed soil, and once of a cell and of the factor by unknowns squared.
BUILD, STEP, ELEMENT, WAVE, CELL, FACTORED, ON_CONDENSED = 1.5e-4, 1.5e-3, 6e-5, 3e-7, 5e-5, 3e-9, 2e-2
# On a block: Newton iterations of a step, where soil yields and where it does not; seconds of an iteration, in it of a
# cell's law, of an unknown in solves and of an operation of the factor, whose making some of the iterations go without;
# of a cell's new place after a step at large strain: benchmarks/forecasts.py.
YIELDING, ELASTIC = 7.3, 2.3
ITERATION, LAW, SOLVED, OPERATION, MOVED = 1.5e-2, 9e-6, 2.5e-6, 5e-11, 2.5e-5
LONGEST_AUTO = 0.05  # of a stage: the longest automatic step
SAME = 1e-6  # steps
BYTES_OF_A_CELL = 60.0  # in a mesh file, with its nodes
TETRAHEDRA, NODES_OF_TETRAHEDRA = 6.0, 1.8  # in a cube of the size asked for; quadratic nodes for each


@dataclass(frozen=True)
class ProblemSize:
    """Size of a scene: elements and cells, unknowns, steps of all stages, records in results.nc, pictures.

    components: of the waves. entries: of a cell's matrix. factor: bytes of the soil's factor. auto: whether there are
    more steps, as some are automatic. stops: times that they have to hit. seconds: on one core. asked: numbers
    of a cell in a picture beyond those of all soil.
    """

    elements: int
    components: int
    riser_unknowns: int
    cells: float
    soil_unknowns: float
    entries: int
    factor: float
    steps: float
    auto: bool
    stops: float
    records: float
    pictures: float
    seconds: float
    asked: int = 0

    @property
    def steps_in_words(self) -> str:
        return f"for {'at least ' if self.auto else ''}{math.ceil(self.steps - SAME):.6g} steps"

    def memory(self, ranks: int) -> float:
        """Bytes over all ranks."""
        soil = soil_memory(ranks, self.cells, self.entries, self.factor) if self.cells else 0.0
        return riser_memory(ranks, self.riser_unknowns) + soil + self.memory_of_stops + self.memory_of_waves

    @property
    def memory_of_stops(self) -> float:
        """Bytes of the times that automatic steps have to hit."""
        return PER_STOP * self.stops

    @property
    def memory_of_waves(self) -> float:
        """Bytes of the phases of all components along the riser."""
        return PER_WAVE * self.elements * self.components

    @property
    def disk(self) -> float:
        """Bytes of the results, while they are written."""
        nodes = self.elements + 1
        series = PER_NODE * nodes * self.records + PER_STEP * self.steps
        pictures = (PER_PICTURE * nodes + (PER_CELL + self.asked) * self.cells) * self.pictures
        return 8.0 * COPIES * (series + pictures)


def riser_memory(ranks: int, unknowns: int) -> float:
    """Bytes of the processes and of the riser in them."""
    return ranks * PROCESS + PER_RISER_DOF * unknowns


def soil_memory(ranks: int, cells: float, entries: int, factor: float) -> float:
    """Bytes that the soil adds; entries: of a cell's matrix; factor: bytes of the factorisation, see `soil_factor`."""
    return ranks * SOIL_PROCESS + factor + PER_CELL_ENTRY * entries * cells


def worth(soil: SoilScene, entries: int) -> int:
    """Entries of a hexahedron's matrix that take the memory of so many of a cell's."""
    return PLANE * entries if soil.model == "sections" else entries


def soil_factor(scene: Scene, soil: SoilScene, unknowns: float) -> float:
    """Bytes of the factorisation of soil with so many unknowns, or of what takes its place; factors that are kept are
    those of the upper triangle.
    """
    if scene.solver.linear == "iterative" and not _condensed(scene, soil):
        return PER_UNKNOWN * unknowns
    if soil.model == "sections":
        return PER_LAYER * _block(scene, soil).layers()[2] * unknowns
    halved = scene.solver.linear != "direct" or _condensed(scene, soil) or _symmetric(scene, soil)
    return factor_memory(_sides(scene, soil), unknowns, halved)


def _condensed(scene: Scene, soil: SoilScene) -> bool:
    """Whether the soil is likely to be condensed."""
    return soil.is_linear and scene.solver.soil != "whole"


def _symmetric(scene: Scene, soil: SoilScene) -> bool:
    """Whether all tangents are symmetric, so that one triangle of the soil's factor is enough: inertia, damping,
    friction, drag and flowing contents have others.
    """
    from riser_soil.scene.soil_law import initial_stress

    middle = np.array([0.5 * soil.given_block.depth if soil.given_block else 1.0])
    lawful = all(law.at_points(middle, initial_stress(soil, middle)).symmetric for law in soil.laws)
    rubs = scene.contact is not None and scene.contact.friction is not None
    flows = any(view.line.inner_flow is not None for view in by_line(scene).values())
    dragged = scene.water is not None and scene.water.current is not None
    return lawful and not (scene.has_dynamic_stage or rubs or flows or dragged)


def _sides(scene: Scene, soil: SoilScene) -> tuple[float, float, float]:
    """The block's sides, in proportion to its nodes along x, y and z; those of a cube where only a file knows."""
    if isinstance(soil.mesh, MeshFile):
        return 1.0, 1.0, 1.0
    x, y, z = _block(scene, soil).free_nodes()
    return float(x), float(y), float(z)


def size_of(scene: Scene) -> ProblemSize:
    """The size of a scene."""
    scene = sized(scene)
    elements = sum(view.line.element_count for view in by_line(scene).values())
    cells, unknowns, entries = _soil(scene, scene.soil) if scene.soil is not None else (0.0, 0.0, 0)
    factor = soil_factor(scene, scene.soil, unknowns) if scene.soil is not None else 0.0
    stages = [_stage(scene, stage) for stage in scene.stages]
    steps, stops, records, pictures = (math.fsum(column) for column in zip(*stages, strict=True))
    waves = scene.water.waves if scene.water else None
    components = waves.count if waves else 0
    of_riser = STEP + elements * (ELEMENT + WAVE * components)
    of_soil = _soil_seconds(scene, scene.soil, cells, unknowns, steps) if scene.soil is not None else 0.0
    lines = len(by_line(scene))
    dofs = 3 if not scene.lines and resolved_dimension(scene) == 2 else 6
    auto = any(not isinstance(stage, StaticStage) and stage.time_step == "auto" for stage in scene.stages)
    return ProblemSize(
        elements=elements,
        components=components,
        riser_unknowns=dofs * (elements + lines + len(scene.bodies)),
        cells=cells,
        soil_unknowns=unknowns,
        entries=entries,
        factor=factor,
        steps=steps,
        auto=auto,
        stops=stops,
        records=records,
        pictures=pictures,
        seconds=BUILD * elements + steps * of_riser + of_soil,
        asked=TENSOR * len(scene.output.soil_fields),
    )


def _soil_seconds(scene: Scene, soil: SoilScene, cells: float, unknowns: float, steps: float) -> float:
    """Processor time [s] that the soil adds to all steps."""
    if _condensed(scene, soil):
        return cells * CELL + FACTORED * unknowns**2 + ON_CONDENSED * steps
    if soil.model == "sections":
        return cells * CELL * steps
    x, y, z = nodes_of(_sides(scene, soil), unknowns)
    each = ITERATION + LAW * cells + SOLVED * unknowns + OPERATION * operations(x, y, z)
    steps += LAID_IN - 1 if scene.initial is None else 0
    return steps * (ELASTIC * each if soil.is_linear else YIELDING * each + MOVED * cells)


def _stage(scene: Scene, stage: Stage) -> tuple[float, float, float, float]:
    """Steps, times that automatic steps have to hit, records and pictures of a stage."""
    if isinstance(stage, StaticStage):
        return float(scene.solver.load_steps), 0.0, 1.0, 1.0
    output = scene.output
    paces = [stage.duration / pace for pace in (output.interval, output.xdmf_interval) if pace is not None]
    given = 0.0 if stage.time_step == "auto" else stage.duration / stage.time_step
    if isinstance(stage, QuasiStaticStage):
        stops = math.fsum(paces) + corner_count(scene, stage)
        steps = max(stops, given) if given else stops * scene.solver.load_steps
    else:
        stops = 0.0 if given else math.fsum(paces)
        steps = given or max(stops, 1.0 / LONGEST_AUTO)
    pictures = _due(stage.duration, output.xdmf_interval or output.interval, steps)
    return steps, stops, max(pictures, _due(stage.duration, output.interval, steps)), pictures


def _due(duration: float, interval: float | None, steps: float) -> float:
    """Number of outputs: every step without an interval."""
    return steps if interval is None else min(steps, duration / interval + 1.0)


def _soil(scene: Scene, soil: SoilScene) -> tuple[float, float, int]:
    """Cells, unknowns, and entries of a cell's matrix."""
    if isinstance(soil.mesh, MeshFile):
        cells = soil.mesh.file.stat().st_size / BYTES_OF_A_CELL
        return cells, 3.0 * cells, 24 * 24
    block = _block(scene, soil)
    if block.kind == "hex":
        cells, (x, y, z) = float(math.prod(block.layers())), block.free_nodes()
        if soil.model == "sections":
            nodes = float(block.layers()[block.axis]) * (x, y)[1 - block.axis] * z
            return cells, 2.0 * nodes, worth(soil, 12 * 12)
        return cells, 3.0 * x * y * z, 24 * 24
    cells = TETRAHEDRA * block.cubes()
    return cells, 3.0 * NODES_OF_TETRAHEDRA * cells, 30 * 30


def _block(scene: Scene, soil: SoilScene) -> BlockSpec:
    own = on_soil(scene)
    assert own is not None
    start, end = initial_ends(own.line)
    return block_of(own, soil, ((start[0], start[1]), (end[0], end[1])))
