"""From the scene to its parts: the only place that asks whether a scene has a thing, and that imports what it has."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from mpi4py import MPI

from riser_soil.arrays import Array
from riser_soil.motion.harmonic import Harmonic
from riser_soil.motion.move import Move
from riser_soil.part import Field, Model, Part
from riser_soil.riser import sections, shapes
from riser_soil.riser.beam import Beam
from riser_soil.riser.line import End, Line, Motion
from riser_soil.riser.springs import EndSpring
from riser_soil.scene import stages
from riser_soil.scene.line_types import LineType
from riser_soil.scene.plane import resolved_dimension, vertical_plane
from riser_soil.scene.riser import Riser, RotationSpring, Support
from riser_soil.scene.scene import Scene
from riser_soil.scene.seabed import SpringSeabed
from riser_soil.scene.shapes import ArcShape, PointsShape
from riser_soil.scene.soil import LinearElastic, MeshFile
from riser_soil.scene.soil import Soil as SoilScene
from riser_soil.time_scheme import GeneralizedAlpha, Scheme, Static

if TYPE_CHECKING:
    from riser_soil.contact.contact import Contact
    from riser_soil.riser.loads import Load
    from riser_soil.seabed.plane import Plane
    from riser_soil.soil.grid import Grid
    from riser_soil.soil.soil import Soil

FORCE_FLOOR = 1e-14  # of EA: a residual below this is round-off even where all forces vanish


@dataclass(eq=False)
class World:
    """The parts of a scene that live through all its stages. soil and contact are None where the scene has none."""

    scene: Scene
    comm: MPI.Intracomm
    line: Line
    elements: sections.Elements
    riser_parts: list[Part]
    horizontal_tension: float | None
    soil: Soil | None = None
    contact: Contact | None = None
    contact_stiffness: dict[str, float] = field(default_factory=dict)

    @property
    def fields(self) -> list[Field]:
        soil: list[Field] = [self.soil.field, self.soil.surface] if self.soil is not None else []
        return [self.line, *soil]

    @property
    def size(self) -> int:
        """Entries of a local array on this rank."""
        return sum(f.size for f in self.fields)

    @property
    def force_floor(self) -> float:
        return FORCE_FLOOR * float(self.elements.EA.max())

    @property
    def weight(self) -> float:
        """Typical force per length [N/m]."""
        return max(float(np.abs(self.elements.weight).max()), 1e-6 * float(self.elements.EA.max() / self.line.arc[-1]))

    def begin(self, stage: stages.Stage) -> Model:
        """Set the ends in motion and name the parts of a stage."""
        _set_motions(self.line, stage)
        parts = [*self.riser_parts, *_loads(self.line, stage)]
        if isinstance(stage, stages.DynamicStage):
            parts += _dynamic_parts(self.scene, self.line, self.elements)
        parts += [p for p in (self.soil, self.contact) if p is not None]
        return Model(self.fields, parts)

    def scheme(self, stage: stages.Stage) -> Scheme:
        if isinstance(stage, stages.StaticStage):
            return Static()
        if isinstance(stage.scheme, stages.NewmarkScheme):
            return GeneralizedAlpha.newmark(stage.scheme.newmark.beta, stage.scheme.newmark.gamma)
        return GeneralizedAlpha.from_rho_inf(stage.scheme.generalized_alpha.rho_inf)


def build(scene: Scene, comm: MPI.Intracomm) -> World:
    """Build the parts of a scene; collective. Raises SceneError or MeshError."""
    elements = _elements(scene)
    line, tension = _line(scene, elements, active=comm.rank == 0)
    world = World(scene, comm, line, elements, [Beam(line, elements), *_springs(scene.riser, line)], tension)
    if scene.soil is not None:
        world.soil = _soil(scene, scene.soil, line, comm)
    if scene.contact is not None:
        _add_contact(world)
    return world


# Riser


def _elements(scene: Scene) -> sections.Elements:
    around = sections.Surroundings(
        gravity=scene.gravity,
        contents=scene.riser.contents.density if scene.riser.contents else 0.0,
        water=scene.water.density if scene.water else 0.0,
    )
    types = {name: _line_type(t) for name, t in scene.used_line_types.items()}
    segments = [
        sections.Segment(types[s.line_type], s.length, s.number_of_elements) for s in scene.riser.segments
    ]
    return sections.elements(segments, around)


def _line_type(given: LineType) -> sections.LineType:
    EI_y, EI_z = given.bending_stiffness
    return sections.LineType(
        EA=given.EA,
        EI_y=EI_y,
        EI_z=EI_z,
        GJ=given.GJ or 0.0,
        outer_diameter=given.outer_diameter or 0.0,
        inner_diameter=given.inner_diameter,
        mass=given.mass or 0.0,
        submerged_weight=given.submerged_weight,
        drag=(given.drag.normal, given.drag.tangential) if given.drag else (0.0, 0.0),
        added_mass=(given.added_mass.normal, given.added_mass.tangential) if given.added_mass else (0.0, 0.0),
    )


def _line(scene: Scene, elements: sections.Elements, active: bool) -> tuple[Line, float | None]:
    """The line in its initial shape, and the horizontal tension [N] where that is a catenary."""
    unstressed = _unstressed(scene.riser, elements.arc)
    initial, tension = _initial(scene, elements, unstressed)
    layout = shapes.layout(elements.arc, elements.outer_diameter, unstressed, initial)
    start, end = _end(scene.riser.start), _end(scene.riser.end)
    line = Line(
        resolved_dimension(scene),
        layout,
        start,
        end,
        direction=np.asarray(vertical_plane(scene).direction),
        hold_spin=not _holds_spin(scene.riser),
        active=active,
    )
    return line, tension


def _end(given: str | Support) -> End:
    return End(held=isinstance(given, Support), rotation_fixed=isinstance(given, Support) and given.rotation == "fixed")


def _holds_spin(riser: Riser) -> bool:
    """Whether an end keeps the riser from spinning about its own axis."""
    return any(isinstance(end, Support) and end.rotation != "free" for end in (riser.start, riser.end))


def _springs(riser: Riser, line: Line) -> list[Part]:
    ends = ((0, riser.start), (-1, riser.end))
    return [
        EndSpring(line, node, end.rotation.stiffness)
        for node, end in ends
        if isinstance(end, Support) and isinstance(end.rotation, RotationSpring)
    ]


def _ends(riser: Riser) -> tuple[Array | None, Array | None]:
    start, end = (np.asarray(e.position) if isinstance(e, Support) else None for e in (riser.start, riser.end))
    return start, end


def _unstressed(riser: Riser, arc: Array) -> shapes.Curve:
    if isinstance(riser.unstressed, ArcShape):
        given = riser.unstressed.arc
        return shapes.circle(arc, given.centre, given.from_point, np.radians(given.angle_deg), given.axis)
    if isinstance(riser.unstressed, PointsShape):
        return shapes.through(arc, riser.unstressed.points)
    start, end = _ends(riser)
    if start is None or end is None or np.array_equal(start, end):
        return shapes.straight(arc, np.zeros(3) if start is None else start)
    return shapes.straight(arc, start, end - start)


def _initial(
    scene: Scene, elements: sections.Elements, unstressed: shapes.Curve
) -> tuple[shapes.Curve, float | None]:
    given = scene.riser.initial
    start, end = _ends(scene.riser)
    if given == "catenary":
        return _catenary(scene, elements, start, end)
    if isinstance(given, PointsShape):
        return shapes.through(elements.arc, given.points), None
    if given == "straight" and start is not None and end is not None:
        return shapes.between(elements.arc, start, end), None
    if given == "straight":
        return shapes.straight(elements.arc, np.zeros(3) if start is None else start), None
    return unstressed, None


def _catenary(
    scene: Scene, elements: sections.Elements, start: Array | None, end: Array | None
) -> tuple[shapes.Curve, float]:
    from riser_soil.riser.catenary import catenary

    assert start is not None and end is not None  # the scene's checks have seen to it
    weight = float(np.average(elements.weight, weights=elements.length))
    EA = elements.arc[-1] / float(np.sum(elements.length / elements.EA))
    has_ground = scene.seabed is not None or scene.soil is not None
    level = scene.seabed_level + _radius(scene, elements).max() if has_ground else -np.inf
    shape = catenary(elements.arc, start, end, weight, EA, level)
    return shape.curve, shape.H


def _radius(scene: Scene, elements: sections.Elements) -> Array:
    """Distance (ne,) from the axis to the line of the pipe that touches [m]."""
    return 0.5 * elements.outer_diameter * (scene.contact_at == "outer")


# Stages


def _set_motions(line: Line, stage: stages.Stage) -> None:
    for end, node, name in ((line.start, 0, "start"), (line.end, -1, "end")):
        end.motion = _motion(line.to_global(line.x[node]), stage, name) if end.held else None


def _motion(origin: Array, stage: stages.Stage, name: str) -> Motion | None:
    if isinstance(stage, stages.StaticStage):
        target = getattr(stage.move, name, None)
        return None if target is None else Move(origin, np.asarray(target))
    given = getattr(stage.motion, name, None)
    if given is None:
        return None
    h = given.harmonic
    return Harmonic(origin, np.asarray(h.amplitude), h.period, h.ramp, np.radians(h.phase_deg))


def _loads(line: Line, stage: stages.Stage) -> list[Part]:
    if not stage.loads:
        return []
    from riser_soil.riser.loads import PointLoads

    return [PointLoads(line, [_load(line, load, stage.kind == "static") for load in stage.loads])]


def _load(line: Line, given: stages.Load, static: bool) -> Load:
    from riser_soil.riser.loads import Load

    places = {"start": 0.0, "end": float(line.arc[-1]), None: 0.0}
    vectors = {k: getattr(given, k) for k in ("force", "moment", "distributed")}
    return Load(
        _factor(given, static),
        places[given.at] if isinstance(given.at, str | None) else given.at,
        **{k: np.asarray(v) for k, v in vectors.items() if v is not None},
    )


def _factor(given: stages.Load, static: bool) -> Callable[[float], float]:
    if given.history is None:
        return (lambda t: t) if static else (lambda t: 1.0)
    times, factors = np.array(given.history).T
    return lambda t: float(np.interp(t, times, factors))


def _dynamic_parts(scene: Scene, line: Line, elements: sections.Elements) -> list[Part]:
    from riser_soil.riser.inertia import Inertia

    parts: list[Part] = [Inertia(line, elements.mass)]
    if scene.water is not None and (elements.drag.any() or elements.added_mass.any()):
        from riser_soil.sea import morison_law
        from riser_soil.sea.morison import Morison

        rho, D = scene.water.density, elements.outer_diameter
        drag = morison_law.drag_coefficients(rho, D, *elements.drag.T)
        parts.append(Morison(line, drag, morison_law.added_masses(rho, D, *elements.added_mass.T)))
    return parts


# Ground


def _soil(scene: Scene, given: SoilScene, line: Line, comm: MPI.Intracomm) -> Soil:
    from riser_soil.soil.linear_elastic import LinearElastic as Elastic
    from riser_soil.soil.soil import Soil
    from riser_soil.soil.von_mises import VonMises

    law = given.law
    constants = law.model_dump(exclude={"kind"})
    make = Elastic.at_depth if isinstance(law, LinearElastic) else VonMises.at_depth
    return Soil(
        _grid(scene, given, line, comm),
        lambda depth: make(depth, **constants),
        level=scene.seabed_level,
        unit_weight=given.submerged_unit_weight,
        K0=given.K0,
    )


def _grid(scene: Scene, given: SoilScene, line: Line, comm: MPI.Intracomm) -> Grid:
    from riser_soil.soil.block import BlockSpec
    from riser_soil.soil.grid import block_grid, file_grid

    if isinstance(given.mesh, MeshFile):
        return file_grid(comm, given.mesh.file)
    assert given.block is not None  # the scene's checks have seen to it
    ends = [tuple(map(float, line.to_global(line.x[node])[:2])) for node in (0, -1)]
    return block_grid(
        comm,
        BlockSpec(
            x=given.block.x,
            y=given.block.y,
            depth=given.block.depth,
            size_at_riser=given.mesh.size_at_riser,
            size_far=given.mesh.size_far,
            level=scene.seabed_level,
            kind=given.mesh.kind,
            riser=(ends[0], ends[1]),
        ),
    )


def _add_contact(world: World) -> None:
    from riser_soil.contact.contact import Contact
    from riser_soil.contact.law import Penalty

    scene, line = world.scene, world.line
    assert scene.contact is not None
    world.contact_stiffness = _stiffnesses(world)
    smoothing = scene.contact.smoothing
    on_soil = world.contact_stiffness.get("soil")
    radius = _radius(scene, world.elements)
    world.contact = Contact(
        line,
        np.maximum(np.append(radius, 0.0), np.append(0.0, radius)),
        plane=_plane(scene, world.contact_stiffness, smoothing),
        surface=world.soil.surface if world.soil is not None else None,
        penalty=Penalty(on_soil, smoothing) if on_soil is not None else None,
        active=world.comm.rank == 0,
    )


def _stiffnesses(world: World) -> dict[str, float]:
    """Force per length and penetration [N/m2] by ground: the scene's own, else the automatic choice."""
    from riser_soil.contact.law import automatic_stiffness

    scene, out = world.scene, {}
    assert scene.contact is not None
    given = scene.contact.stiffness
    size = float(world.elements.outer_diameter.max()) or 0.1
    if scene.soil is not None:
        E = surface_modulus(scene.soil)
        out["soil"] = automatic_stiffness(E, world.weight, size) if given == "auto" else float(given)
    if isinstance(scene.seabed, SpringSeabed):
        out["plane"] = scene.seabed.stiffness
    elif scene.seabed is not None:
        out["plane"] = automatic_stiffness(None, world.weight, size) if given == "auto" else float(given)
    return out


def surface_modulus(soil: SoilScene) -> float:
    """Young's modulus at the soil's surface [Pa]."""
    return soil.law.E if isinstance(soil.law, LinearElastic) else soil.law.E_over_su * soil.law.su


def _plane(scene: Scene, stiffness: dict[str, float], smoothing: float) -> Plane | None:
    from riser_soil.seabed.plane import Plane

    return Plane(scene.seabed.level, stiffness["plane"], smoothing) if scene.seabed is not None else None
