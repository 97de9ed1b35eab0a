"""Report of `riser-soil check`: parts, unknowns, memory, disk, run time and plausibility warnings."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from riser_soil.assembly import Assembly, build, sized
from riser_soil.assembly.condensation import why_whole
from riser_soil.assembly.packages import communicator_of
from riser_soil.assembly.soil_block import why_all
from riser_soil.checks.estimate import ProblemSize, riser_memory, soil_factor, soil_memory, worth
from riser_soil.checks.inventory import built, left_out, no_new_mesh, unknowns
from riser_soil.checks.limits import in_bytes, in_words, size_that_fits, tell, tight, too_long
from riser_soil.checks.plausibility import physical_warnings
from riser_soil.scene.scene import Scene

if TYPE_CHECKING:
    from riser_soil.soil.soil import Soil


def describe(scene: Scene) -> str:
    """The report of `riser-soil check`; collective. Raises SceneError or MeshError."""
    comm, scene = communicator_of(scene), sized(scene)
    size = size_that_fits(scene, Path(), comm)
    tell(size, comm)
    of_size = [*tight(size, comm), *too_long(size)]
    assembly = build(scene, comm)
    lines = [*_parts(assembly), *_unknowns(assembly), _memory_line(assembly), *_results(size)]
    warnings = [*physical_warnings(assembly), *of_size]
    return "\n".join([*lines, *(f"warning: {warning}" for warning in warnings), _verdict(warnings)])


def _verdict(warnings: list[str]) -> str:
    return _counted(len(warnings), "warning") if warnings else "no warnings"


def _counted(number: int, name: str) -> str:
    return f"{number} {name}" if number == 1 else f"{number} {name}s"


def told_waves(assembly: Assembly) -> Iterator[str]:
    """What theory a regular wave follows, where the scene has one of finite height."""
    water = assembly.scene.water
    if water is not None and water.waves is not None:
        from riser_soil.checks.wave_plausibility import told_regular

        yield from told_regular(assembly.scene)


def _parts(assembly: Assembly) -> Iterator[str]:
    stages = len(assembly.scene.stages)
    yield f"{assembly.scene.title}: {_counted(stages, 'stage')}, riser in {assembly.line.dimension} dimensions"
    yield "built: " + ", ".join(built(assembly.scene))
    yield from (f"left out: {name}: {reason}" for name, reason in left_out(assembly.scene).items())
    yield from told_waves(assembly)


def _unknowns(assembly: Assembly) -> Iterator[str]:
    from riser_soil.checks.element_proposal import proposal
    from riser_soil.checks.line_summary import line_summary

    line = assembly.line
    yield (
        f"riser: {line.length.size} elements of {line.length.min():.4g} to {line.length.max():.4g} m, "
        f"{unknowns(assembly.comm, line)} unknowns"
    )
    yield from line_summary(assembly)
    if better := proposal(assembly):
        yield better
    if assembly.attachments:
        net = sum(attachment.net_weight for attachment in assembly.attachments)
        yield f"{_counted(len(assembly.attachments), 'attachment')}: weight less buoyancy {net:.4g} N in all"
    if assembly.soil is not None:
        cells = assembly.comm.allreduce(assembly.soil.blocks()["soil"].shape[0])
        yield f"soil: {cells} cells, {unknowns(assembly.comm, assembly.soil.field)} unknowns"
        yield from _computed(assembly.scene)
        yield from _condensed(assembly, assembly.soil)
        yield from resolution(assembly)
        from riser_soil.checks.soil_edge import edge_report
        from riser_soil.checks.soil_mesh import mesh_report

        yield from mesh_report(assembly)
        yield from edge_report(assembly)
    for ground, stiffness in assembly.contact_stiffness.items():
        yield f"contact stiffness on the {ground}: {stiffness:.4g} N/m2"


def _computed(scene: Scene) -> Iterator[str]:
    """At large strain or small, and why; and why all of the soil is computed, where it is."""
    assert scene.soil is not None
    asked = "as soil.strain asks" if scene.soil.strain == "large" else "as it yields under contact with its surface"
    yield f"soil: at large strain, {asked}" if scene.soil_moves else f"soil: at small strain: {no_new_mesh(scene)}"
    if why := why_all(scene, scene.soil):
        yield f"soil: all of it is computed, not half: {why}"


def _condensed(assembly: Assembly, soil: Soil) -> Iterator[str]:
    """How linear soil is solved for, and why."""
    assert assembly.scene.soil is not None
    if assembly.condensed is not None:
        yield "soil: condensed to what the riser touches of its surface; the whole is recovered for results"
        if assembly.condensed.top.compliance.kept:
            yield "soil: what earlier runs have found of its compliance is at hand"
    elif assembly.scene.soil.is_linear:
        reason = why_whole(assembly.scene, soil, assembly.line, assembly.scales.diameter)
        yield f"soil: solved for as a whole, not condensed: {reason}"


def resolution(assembly: Assembly) -> Iterator[str]:
    """The soil's cells under the riser against what touches, where the scene has them meshed."""
    if assembly.soil is None:
        return
    from riser_soil.checks.mesh_plausibility import told_resolution

    told = told_resolution(assembly)
    if told is not None:
        yield told


def _memory_line(assembly: Assembly) -> str:
    return f"estimated memory: {memory(assembly) / 1e6:.0f} MB on {_counted(assembly.comm.size, 'rank')}"


def _results(size: ProblemSize) -> Iterator[str]:
    yield f"estimated results: {_counted(round(size.records), 'record')}, {in_bytes(size.disk)}"
    yield f"estimated time: {in_words(size.seconds)} on one core, {size.told_steps}"


def memory(assembly: Assembly) -> float:
    """Estimated bytes over all ranks; collective."""
    comm = assembly.comm
    total = riser_memory(comm.size, unknowns(comm, assembly.line))
    if assembly.soil is not None and assembly.scene.soil is not None:
        cells, rows, cols = assembly.soil.blocks()["soil"].shape
        factor = soil_factor(assembly.scene, assembly.scene.soil, unknowns(comm, assembly.soil.field))
        entries = worth(assembly.scene.soil, rows * cols)
        total += soil_memory(comm.size, comm.allreduce(cells), entries, factor)
    return total
