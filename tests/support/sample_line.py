"""A small riser in general position, in the plane and in space: curved, uneven, moving, with a history."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.riser import shapes
from riser_soil.riser.attachments import Attachments, PointAttachment, masses
from riser_soil.riser.beam import Beam
from riser_soil.riser.contents import Flow, InnerFlow, SlugTrain
from riser_soil.riser.inertia import Inertia, RotaryInertia
from riser_soil.riser.line import Line
from riser_soil.riser.line_ends import End, SupportRotation
from riser_soil.riser.loads import AppliedLoad, PointLoads
from riser_soil.riser.sections import Elements, Surroundings, joined
from riser_soil.riser.springs import EndSpring
from riser_soil.riser.structural_damping import StructuralDamping
from riser_soil.sea.morison import Morison, in_still_water
from riser_soil.sea.morison_law import added_masses, drag_coefficients
from riser_soil.sea.pipe import Pipe
from tests.support.pipes import pipe

DIRECTION = np.array([0.6, 0.8, 0.0])
UP = np.array([0.0, 0.0, 1.0])
START = np.array([3.0, -2.0, 5.0])
THICK: dict[str, Any] = {
    "EA": 4.0e4,
    "EI_y": 900.0,
    "EI_z": 1400.0,
    "GJ": 700.0,
    "outer_diameter": 0.5,
    "inner_diameter": 0.3,
    "mass": 150.0,
    "drag": (1.2, 0.1),
    "added_mass": (1.0, 0.2),
    "rotary_inertia": None,
    "damping": 0.3,
}
THIN: dict[str, Any] = {
    "EA": 3.0e4,
    "EI_y": 500.0,
    "EI_z": 300.0,
    "GJ": 250.0,
    "outer_diameter": 0.4,
    "mass": 120.0,
    "drag": (0.9, 0.05),
    "added_mass": (0.8, 0.0),
    "rotary_inertia": 1.7,
    "damping": 0.5,
}
AROUND = Surroundings(gravity=9.81, contents=850.0, water=1025.0)
RHO = 1025.0


@dataclass(frozen=True, eq=False)
class Sample:
    line: Line
    elements: Elements

    def state(self, seed: int, size: float = 0.2, t: float = 0.7) -> State:
        """Random increments, rates and accelerations; in space they leave the plane."""
        u, v, a = np.random.default_rng(seed).normal(size=(3, self.line.size))
        return State(t, size * u, 1.5 * v, 3.0 * a)

    def beam(self) -> Beam:
        beam = Beam(self.line, self.elements, load=np.array([12.0, -7.0, 3.0]))
        beam.factor = lambda t: 0.5 + t
        return beam

    def inertia(self) -> Inertia:
        return Inertia(self.line, self.elements.mass, masses(self.line, self.attached()))

    def rotary(self) -> RotaryInertia:
        """More about the pipe's axis than a round section has."""
        across = self.elements.rotary_inertia
        return RotaryInertia(self.line, across, 3.0 * across)

    def damping(self) -> StructuralDamping:
        return StructuralDamping(self.line, self.elements)

    def morison(self) -> Morison:
        e = self.elements
        drag = drag_coefficients(RHO, e.outer_diameter, e.drag[:, 0], e.drag[:, 1])
        mass = added_masses(RHO, e.outer_diameter, e.added_mass[:, 0], e.added_mass[:, 1])
        return in_still_water(Pipe(self.line), drag, mass)

    def spring(self) -> EndSpring:
        return EndSpring(self.line, -1, 800.0)

    def turned_spring(self) -> EndSpring:
        """A spring whose support has turned about the normal of the sample's plane."""
        rotation, still = 0.9 * np.cross(DIRECTION, UP), np.zeros(3)
        self.line.end.turning = lambda t: SupportRotation(t * rotation, rotation, still)
        return self.spring()

    def attached(self) -> list[PointAttachment]:
        """A module within an element, a clump weight at a node and another at the end."""
        given = (2.7, 80.0, -240.0, 0.1), (3.0, 300.0, 2600.0, 0.0), (8.0, 50.0, 120.0, 0.0)
        return [PointAttachment(*numbers) for numbers in given]

    def attachments(self) -> Attachments:
        return Attachments(self.line, self.attached())

    def forces(self) -> PointLoads:
        """A force within an element, one at the end, and a distributed load."""
        arc = self.line.arc
        tip, inner = np.array([30.0, 40.0, 25.0]), np.array([60.0, -20.0, 50.0])
        spread = AppliedLoad(lambda t: 2.0, distributed=np.array([5.0, 4.0, -3.0]))
        loads = [AppliedLoad(lambda t: 1.0 + t, arc[-1], tip), AppliedLoad(lambda t: t, 0.3 * arc[1], inner), spread]
        return PointLoads(self.line, loads)

    def contents(self) -> InnerFlow:
        """In flow, with slugs that begin and end within elements."""
        flow = Flow(850.0, 2.0, [SlugTrain(400.0, 1.7, 5.0, 2.6)], gravity=9.81)
        return InnerFlow(self.line, np.full(self.line.length.size, 0.3), flow)

    def moments(self) -> PointLoads:
        moment = np.array([150.0, -90.0, 60.0])
        loads = [AppliedLoad(lambda t: 1.0 + t, self.line.arc[2], moment=moment)]
        return PointLoads(self.line, [*loads, AppliedLoad(lambda t: -t, self.line.arc[-1], moment=moment[::-1])])


def planar_points(seed: int = 3) -> Array:
    """Points of the initial shape in the vertical plane of START and DIRECTION."""
    p, z = np.array([0.0, 2.0, 4.5, 6.5]), np.array([0.0, -1.2, -0.4, 2.0])
    return np.asarray(START + p[:, None] * DIRECTION + z[:, None] * UP)


def sample(
    dimension: int, ends: tuple[End, End] | None = None, offset: int = 0, shaken: bool = True
) -> Sample:
    """The riser with an unstressed bend in the plane; shaken: after three random steps."""
    e = joined([pipe(3.0, 2, AROUND, **THICK), pipe(5.0, 3, AROUND, **THIN)])
    radius, normal = 6.0, np.cross(UP, DIRECTION)
    bend = shapes.circle(e.arc, START - radius * UP, START, 8.0 / radius, normal)
    layout = shapes.layout(e.arc, e.outer_diameter, bend, shapes.through(e.arc, planar_points()))
    start, end = ends or (End(prescribed=True), End(prescribed=False))
    made = Sample(Line(dimension, layout, start, end, direction=DIRECTION), e)
    made.line.offset = 0
    for seed in range(3 if shaken else 0):
        made.line.commit(made.state(100 + seed, 0.3))
    made.line.offset = offset
    return made
