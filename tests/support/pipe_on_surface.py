"""A riser over a surface of soil, alone: its surface contact, with dense residual and tangent."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from riser_soil.contact.law import Penalty, SuctionLaw
from riser_soil.contact.soil_contact import CandidateRange
from riser_soil.contact.surface_contact import SurfaceContact
from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, Part, State, Weights
from riser_soil.riser import shapes
from riser_soil.riser.line import Line
from riser_soil.riser.line_ends import End
from riser_soil.soil.surface import SoilTop

WEIGHTS = Weights(inertia=0.0, force=0.0, shift_v=0.0, shift_a=0.0)
RADIUS, STIFFNESS = 0.15, 2.0e6  # m, N/m3
CORNERED = Penalty(STIFFNESS, 2e-3)


@dataclass
class PipeOnSurface:
    """A riser over a surface; dofs of another field lie between them."""

    line: Line
    surface: SoilTop
    contact: SurfaceContact

    @property
    def size(self) -> int:
        return self.surface.offset + self.surface.size

    def commit(self, u: Array, *parts: Part) -> None:
        """Accept a step: the parts first, then the fields."""
        state = self.state(u)
        for part in (*parts, self.contact):
            part.commit(state)
        self.surface.commit(state)
        self.line.commit(state)

    def state(self, u: Array | None = None) -> State:
        u = np.zeros(self.size) if u is None else u
        return State(0.0, u, np.zeros(self.size), np.zeros(self.size))

    def placed(self) -> tuple[Array, Array]:
        """Positions of the nodes (nn, 3) and unit tangents of the elements' ends (ne, 2, 3), global axes."""
        trial = self.line.trial(self.state())
        return self.line.to_global(trial.x), trial.turn.tangent @ self.line.basis.T

    def residual(self, u: Array, part: Part | None = None) -> Array:
        """Residual of contact, or of another part on it."""
        forces = Forces.zeros(self.size)
        (part or self.contact).residual(self.state(u), forces)
        assert not forces.inertia.any()
        assert not forces.force.any()
        return forces.end

    def tangent(self, u: Array, part: Part | None = None) -> Array:
        part = part or self.contact
        blocks = part.blocks()
        values = {key: block.zeros() for key, block in blocks.items()}
        part.tangent(self.state(u), WEIGHTS, values)
        K = np.zeros((self.size, self.size))
        for key, block in blocks.items():
            np.add.at(K, (block.rows[:, :, None], block.cols[:, None, :]), values[key])
        return K


def pipe_on_surface(
    points: Array,
    surface: SoilTop,
    dimension: int = 3,
    spacing: float = 0.05,
    pressure: Penalty | SuctionLaw = CORNERED,
) -> PipeOnSurface:
    """A riser through points (n, 3), smooth at the nodes."""
    arc = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))))
    ahead = np.array([*(points[-1] - points[0])[:2], 0.0])
    direction = ahead / np.linalg.norm(ahead)
    curved = shapes.from_nodes(points, shapes.nodal_tangents(points))
    straight = shapes.straight(arc, points[0], direction)
    layout = shapes.layout(arc, np.full(len(arc) - 1, 2.0 * RADIUS), straight, curved)
    line = Line(dimension, layout, End(False), End(False), direction=direction)
    line.offset = 2
    surface.offset = 2 + line.size + 3
    contact = SurfaceContact(
        line,
        np.full(len(arc) - 1, RADIUS),
        surface,
        pressure,
        (2.0 * spacing, spacing),
        along=direction[:2],
        reach=CandidateRange(0.5, 0.5),
    )
    return PipeOnSurface(line, surface, contact)


def sagging(angle: float = 0.3, depth: float = 0.03) -> Array:
    """Five nodes that cross the surface at an angle, the middle one deepest in it."""
    s = np.array([-1.1, -0.5, 0.1, 0.6, 1.2])
    z = RADIUS - depth + 0.06 * s**2
    return np.stack([1.5 + s * np.cos(angle), s * np.sin(angle), z], axis=1)


def shaken(made: PipeOnSurface, seed: int, size: float) -> Array:
    u = np.zeros(made.size)
    u[2:] = size * np.random.default_rng(seed).normal(size=made.size - 2)
    return u
