"""Report of `riser-soil check`: tensions and touchdown by hand, warnings, lines, mesh, cost, and what the model has."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import accumulate
from pathlib import Path
from typing import TYPE_CHECKING

from riser_soil.assembly import Assembly, LineAssembly, build, sized
from riser_soil.assembly.packages import communicator_of
from riser_soil.assembly.seabed_reach import why_apart
from riser_soil.assembly.soil_block import why_all
from riser_soil.checks.bending_plausibility import proposal
from riser_soil.checks.by_hand import by_hand
from riser_soil.checks.estimate import ProblemSize, riser_memory, soil_factor, soil_memory, worth
from riser_soil.checks.inventory import Inventory, inventory, unknowns
from riser_soil.checks.limits import in_bytes, in_words, size_that_fits, tight, too_long
from riser_soil.checks.plausibility import physical_warnings, refuse_impossible
from riser_soil.core.communicator import Communicator
from riser_soil.scene.scene import Scene

if TYPE_CHECKING:
    from riser_soil.assembly.bodies_and_joints import BodiesAndJoints
    from riser_soil.assembly.soil_assembly import SoilAssembly

HEADS = ("line type", "from m", "to m", "OD m", "ID m", "empty kg/m", "filled kg/m", "in air N/m", "in water N/m")
STIFFNESSES = ("EA N", "EI N.m2")
WORDS = {  # words for parts, where an engineer has others
    "springs": "rotational springs at the ends",
    "contents": "internal flow",
    "morison": "drag and added mass",
    "vortices": "vortex forces",
    "vortices in line": "vortex forces in line",
    "friction": "friction on the seabed",
    "soil friction": "friction on soil",
    "new mesh": "large strain of soil",
    "cushion": "laying on a cushion",
    "wall tension": "true wall tension",
}
WITH_REASON = ("morison", "buoyancy", "body contact", "wall tension")  # absent for a reason that a scene doesn't show
WITHIN_SOIL = (  # details of the soil's and the riser's model, absent by default
    *("soil forms", "soil inertia", "soil boundary", "new mesh", "cushion", "half of the soil"),
    *("soil friction", "rotary inertia", "vortices in line", "body friction"),
)


def describe(scene: Scene, place: Callable[[str], str] = str) -> str:
    """The report of `riser-soil check`; collective. Raises SceneError or MeshError.

    What an engineer checks first comes first: tensions and touchdown point by hand, then warnings; line, mesh and cost
    follow, and at last what the model has and what it hasn't. place: puts before a warning that begins with a key
    where that key comes from.
    """
    comm, scene = communicator_of(scene), sized(scene)
    size = size_that_fits(scene, Path(), comm)
    of_size = [*tight(size, comm), *too_long(size)]
    refuse_impossible(scene)
    assembly = build(scene, comm)
    warnings = [place(warning) for warning in (*physical_warnings(assembly), *of_size)]
    lines = [_title(assembly)]
    for name, line in assembly.lines.items():
        lines += [f"{name}: {text}" if name and not text.startswith(" ") else text for text in by_hand(line)]
    lines += [*wave_theory(assembly), *(f"warning: {warning}" for warning in warnings), _verdict(warnings)]
    for name, line in assembly.lines.items():
        lines += [*_unknowns(line, name, comm)]
    lines += [*_bodies_and_joints(assembly), _memory_line(assembly), *_results(size), *_model(inventory(assembly))]
    return "\n".join(lines)


def _verdict(warnings: list[str]) -> str:
    return _counted(len(warnings), "warning") if warnings else "no warnings"


def _counted(number: int, name: str) -> str:
    return f"{number} {name}" if number == 1 else f"{number} {name}s"


def wave_theory(assembly: Assembly) -> Iterator[str]:
    """What theory a regular wave follows, where the scene has one of finite height."""
    if assembly.sea is not None and assembly.sea.waves is not None:
        from riser_soil.checks.wave_plausibility import regular_wave_theory

        yield from regular_wave_theory(assembly.sea.waves)


def _title(assembly: Assembly) -> str:
    steps = len(assembly.scene.stages)
    what = "riser" if not assembly.scene.lines else _counted(len(assembly.lines), "line")
    dimension = next(iter(assembly.lines.values())).line.dimension
    return f"{assembly.scene.title}: {_counted(steps, 'load step')}, {what} in {dimension} dimensions"


def _model(known: Inventory) -> Iterator[str]:
    """Lines on what the model has and lacks, with the reason where the scene does not give it."""
    yield "model: " + ", ".join(WORDS.get(name, name) for name in known.built)
    absent = known.left_out
    without = [WORDS.get(name, name) for name in absent if name not in (*WITH_REASON, *WITHIN_SOIL)]
    without += [f"{WORDS.get(name, name)} ({absent[name]})" for name in WITH_REASON if name in absent]
    if without:
        yield "not in the model: " + ", ".join(without)


def _bodies_and_joints(assembly: Assembly) -> Iterator[str]:
    """Bodies, and how stiff joints are that are rigid."""
    bodies_and_joints = assembly.bodies_and_joints
    for name, body in ({} if bodies_and_joints is None else bodies_and_joints.bodies).items():
        given = assembly.scene.bodies[name]
        buoyancy = assembly.scene.water.density * given.volume if assembly.scene.water is not None else 0.0
        net = assembly.scene.gravity * (given.mass - buoyancy)
        yield f"body {name}: {unknowns(assembly.comm, body)} unknowns, weight less buoyancy {net:.4g} N"
        if bodies_and_joints is not None and assembly.scene.seabed is not None:
            yield f"body {name}: {_touches(bodies_and_joints, name) or why_apart(assembly.scene, name)}"
    joints = None if bodies_and_joints is None else bodies_and_joints.joints
    for joint in () if joints is None else joints.joints:
        turns = f" and {joint.rotation:.4g} N.m/rad" if joint.rotation else ""
        yield f"joint {joint.name}: {joint.translation:.4g} N/m{turns}"


def _touches(bodies_and_joints: BodiesAndJoints, name: str) -> str:
    """How a body touches the seabed; empty where it doesn't."""
    if name not in bodies_and_joints.contacts:
        return ""
    contact, rubs = bodies_and_joints.contacts[name], bodies_and_joints.frictions.get(name)
    where = "a point" if len(contact.points) == 1 else f"{len(contact.points)} points"
    friction = "" if rubs is None else f", friction coefficient {rubs.coefficient:.4g}"
    sizes = f"radius {contact.radius:.4g} m, width {contact.length:.4g} m"
    net = bodies_and_joints.weights[name].net
    sunk = f"sinks in by {contact.sunk_by(net):.4g} m under its weight less buoyancy"
    return f"touches the seabed at {where}, {sizes}{friction}; {sunk}"


def _unknowns(riser: LineAssembly, name: str, comm: Communicator) -> Iterator[str]:
    line = riser.line
    yield (
        f"{name or 'riser'}: {line.length.size} elements of {line.length.min():.4g} to {line.length.max():.4g} m, "
        f"{unknowns(comm, line)} unknowns"
    )
    yield from line_summary(riser)
    if better := proposal(riser, f"lines.{name}" if name else "riser"):
        yield better
    if riser.attachments:
        net = sum(attachment.net_weight for attachment in riser.attachments)
        yield f"{_counted(len(riser.attachments), 'attachment')}: weight less buoyancy {net:.4g} N in all"
    if riser.soil is not None:
        from riser_soil.checks.soil_edge import edge_report
        from riser_soil.checks.soil_mesh import mesh_report

        soil = riser.soil.whole
        cells = comm.allreduce(soil.blocks()["soil"].shape[0])
        yield f"soil: {cells} cells, {unknowns(comm, soil.field)} unknowns"
        yield from _computed(riser.scene)
        yield from _condensed(riser.scene, riser.soil)
        yield from resolution(riser)
        yield from mesh_report(riser)
        yield from edge_report(riser)
    for ground, stiffness in riser.contact_stiffness.items():
        yield f"contact stiffness on the {ground}: {stiffness:.4g} N/m2"


def _computed(scene: Scene) -> Iterator[str]:
    """Words on large or small strain, and why; and why all of the soil is computed, where it is."""
    assert scene.soil is not None
    asked = "as soil.strain asks" if scene.soil.strain == "large" else "as it yields under contact with its surface"
    yield f"soil: at large strain, {asked}" if scene.soil_moves else f"soil: at small strain: {scene.why_small_strain}"
    if why := why_all(scene, scene.soil):
        yield f"soil: all of it is computed, not half: {why}"


def _condensed(scene: Scene, soil: SoilAssembly) -> Iterator[str]:
    """How linear soil is solved for, and why."""
    assert scene.soil is not None
    if soil.condensed is not None:
        yield "soil: condensed to what the riser touches of its surface; the whole is recovered for results"
        if soil.condensed.top.compliance.on_disk:
            yield "soil: what earlier runs have found of its compliance is at hand"
    elif scene.soil.is_linear:
        yield f"soil: solved for as a whole, not condensed: {soil.why_whole}"


def resolution(riser: LineAssembly) -> Iterator[str]:
    """The soil's cells under a riser against what touches, where the scene has them meshed."""
    from riser_soil.checks.mesh_plausibility import resolution_in_words

    line = resolution_in_words(riser)
    if line is not None:
        yield line


def _memory_line(assembly: Assembly) -> str:
    return f"estimated memory: {memory(assembly) / 1e6:.0f} MB on {_counted(assembly.comm.size, 'rank')}"


def _results(size: ProblemSize) -> Iterator[str]:
    yield f"estimated results: {_counted(round(size.records), 'record')}, {in_bytes(size.disk)}"
    yield f"estimated time: {in_words(size.seconds)} on one core, {size.steps_in_words}"


def memory(assembly: Assembly) -> float:
    """Estimated bytes over all ranks; collective."""
    comm = assembly.comm
    total = riser_memory(comm.size, sum(unknowns(comm, field) for field in assembly.moving))
    if assembly.soil is not None and assembly.scene.soil is not None:
        cells, rows, cols = assembly.soil.whole.blocks()["soil"].shape
        factor = soil_factor(assembly.scene, assembly.scene.soil, unknowns(comm, assembly.soil.whole.field))
        entries = worth(assembly.scene.soil, rows * cols)
        total += soil_memory(comm.size, comm.allreduce(cells), entries, factor)
    return total


def line_summary(riser: LineAssembly) -> list[str]:
    """Segments with their weights, and the weight of the whole line: lines of text."""
    return [*_table(_rows(riser)), *_whole(riser)]


def _table(rows: list[tuple[str, ...]]) -> Iterator[str]:
    widths = [max(len(cell) for cell in column) for column in zip(*rows, strict=True)]
    for row in rows:
        name, *numbers = zip(row, widths, strict=True)
        yield "  ".join([f"  {name[0]:<{name[1]}}", *(f"{cell:>{width}}" for cell, width in numbers)])


def _rows(riser: LineAssembly) -> list[tuple[str, ...]]:
    scene, elements = riser.scene, riser.elements
    rows: list[tuple[str, ...]] = [(*HEADS, *STIFFNESSES)]
    begin = 0.0
    firsts = accumulate((segment.element_count for segment in scene.line.segments), initial=0)
    for segment, first in zip(scene.line.segments, firsts, strict=False):
        e = first + segment.element_count // 2  # beyond bend stiffeners
        line = scene.line_types[segment.line_type]
        mass, end = float(elements.mass[e]), begin + segment.length
        numbers = (begin, end, line.outer_diameter, line.inner_diameter, line.mass, mass or None)
        weights = (scene.gravity * mass if mass else None, float(elements.weight[e]))
        rows.append((segment.line_type, *map(_shown, (*numbers, *weights, line.EA, max(line.bending_stiffness)))))
        begin = end
    return rows


def _shown(value: float | None) -> str:
    return "-" if value is None else f"{value:.4g}"


def _whole(riser: LineAssembly) -> Iterator[str]:
    """Length and weights of the whole line."""
    elements = riser.elements
    mass, wet = (float(each @ elements.length) for each in (elements.mass, elements.weight))
    net_weight = sum(attachment.net_weight for attachment in riser.attachments)
    parts = [f"line: {elements.length.sum():.6g} m"]
    if mass > 0.0:
        parts.append(f"{mass / 1e3:.4g} t with contents, weight in air {riser.scene.gravity * mass / 1e3:.4g} kN")
    parts.append(f"in water {wet / 1e3:.4g} kN")
    if riser.attachments:
        parts.append(f"with attachments {(wet + net_weight) / 1e3:.4g} kN")
    yield ", ".join(parts)
