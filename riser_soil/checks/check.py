"""What a scene will be built of: parts, unknowns, memory, and physical doubts."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from mpi4py import MPI

from riser_soil.assembly import World, build
from riser_soil.checks.estimate import Size, riser_memory, soil_memory
from riser_soil.checks.inventory import built, left_out, unknowns
from riser_soil.checks.limits import in_bytes, in_words, size_that_fits, tell, too_long
from riser_soil.checks.plausibility import physical_warnings
from riser_soil.scene.scene import Scene


def describe(scene: Scene) -> str:
    """The report of `riser-soil check`; collective. Raises SceneError or MeshError."""
    size = size_that_fits(scene, Path(), MPI.COMM_WORLD)
    tell(size, MPI.COMM_WORLD)
    world = build(scene, MPI.COMM_WORLD)
    lines = [*_parts(world), *_unknowns(world), _memory_line(world), *_results(size)]
    doubts = [*physical_warnings(world), *too_long(size)]
    return "\n".join([*lines, *(f"warning: {doubt}" for doubt in doubts), _verdict(doubts)])


def _verdict(doubts: list[str]) -> str:
    return _counted(len(doubts), "warning") if doubts else "no warnings"


def _counted(number: int, name: str) -> str:
    return f"{number} {name}" if number == 1 else f"{number} {name}s"


def _parts(world: World) -> Iterator[str]:
    stages = len(world.scene.stages)
    yield f"{world.scene.title}: {_counted(stages, 'stage')}, riser in {world.line.dimension} dimensions"
    yield "built: " + ", ".join(built(world.scene))
    yield from (f"left out: {name}: {reason}" for name, reason in left_out(world.scene).items())


def _unknowns(world: World) -> Iterator[str]:
    line = world.line
    yield (
        f"riser: {line.length.size} elements of {line.length.min():.4g} to {line.length.max():.4g} m, "
        f"{unknowns(world.comm, line)} unknowns"
    )
    if world.attachments:
        net = sum(attachment.net_weight for attachment in world.attachments)
        yield f"{_counted(len(world.attachments), 'attachment')}: weight less buoyancy {net:.4g} N in all"
    if world.soil is not None:
        cells = world.comm.allreduce(world.soil.blocks()["soil"].shape[0])
        yield f"soil: {cells} cells, {unknowns(world.comm, world.soil.field)} unknowns"
    for ground, stiffness in world.contact_stiffness.items():
        yield f"contact stiffness on the {ground}: {stiffness:.4g} N/m2"


def _memory_line(world: World) -> str:
    return f"estimated memory: {memory(world) / 1e6:.0f} MB on {_counted(world.comm.size, 'rank')}"


def _results(size: Size) -> Iterator[str]:
    yield f"estimated results: {_counted(round(size.records), 'record')}, {in_bytes(size.disk)}"
    yield f"estimated time: {in_words(size.seconds)} on one core, {size.told_steps}"


def memory(world: World) -> float:
    """Estimated bytes over all ranks; collective."""
    comm = world.comm
    total = riser_memory(comm.size, unknowns(comm, world.line))
    if world.soil is not None:
        cells, rows, cols = world.soil.blocks()["soil"].shape
        total += soil_memory(comm.size, comm.allreduce(cells), rows * cols, unknowns(comm, world.soil.field))
    return total
