"""Chains of beam elements, clamped at the start and loaded at the tip, with a dense Newton iteration."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.riser import beam2d, beam3d, rotations
from riser_soil.riser.stiffness import LineStiffness, Stiffness
from riser_soil.riser.tension_only import Linear
from riser_soil.riser.vectors import vector
from tests.support import planar_elements, spatial_elements

Element2d = Callable[..., tuple[Array, Array]]
MAX_ITERATIONS = 40


class Chain(Protocol):
    """Increments u (nn * dofs,) of all nodes in, residual and tangent out; the start's dofs come first."""

    nn: int
    dofs: int

    def residual(self, u: Array, tip_load: Array) -> tuple[Array, Array]: ...

    def commit(self, u: Array) -> None: ...


def assemble(f: Array, K: Array) -> tuple[Array, Array]:
    """Forces (ne, 2m) and tangents (ne, 2m, 2m) of elements in a row to a dense vector and matrix."""
    ne, m = len(f), f.shape[1] // 2
    r, J = np.zeros((ne + 1) * m), np.zeros(((ne + 1) * m, (ne + 1) * m))
    for e in range(ne):
        at = slice(e * m, (e + 2) * m)
        r[at] += f[e]
        J[at, at] += K[e]
    return r, J


@dataclass
class PlaneChain:
    """Chain in a plane. x: (nn, 2) nodes, direction: (2, ne) tangents of both element ends."""

    x: Array
    direction: Array
    section: LineStiffness
    element: Element2d = planar_elements.forces_and_tangent
    dofs: int = 3
    theta: Array = field(init=False)
    ref: beam2d.LineReference = field(init=False)

    def __post_init__(self) -> None:
        self.nn, self.theta = len(self.x), np.zeros(len(self.x))
        self.ref = beam2d.reference(np.diff(self.x, axis=0), self.direction[0], self.direction[1])

    def residual(self, u: Array, tip_load: Array) -> tuple[Array, Array]:
        """tip_load: force (2,) and moment."""
        step = u.reshape(-1, 3)
        theta = self.theta + step[:, 2]
        ends = self.direction[0] + theta[:-1], self.direction[1] + theta[1:]
        f, K = self.element(np.diff(self.x + step[:, :2], axis=0), *ends, self.ref, self.section)
        f[-1, 3:] -= tip_load
        return assemble(f, K)

    def commit(self, u: Array) -> None:
        self.x = self.x + u.reshape(-1, 3)[:, :2]
        self.theta = self.theta + u[2::3]


@dataclass
class SpaceChain:
    """Chain in space. x: (nn, 3) nodes, T0: (2, ne, 3, 3) section frames of both element ends."""

    x: Array
    T0: Array
    section: LineStiffness
    dofs: int = 6
    R: Array = field(init=False)
    ref: beam3d.SpatialReference = field(init=False)

    def __post_init__(self) -> None:
        self.nn, self.R = len(self.x), np.tile(np.eye(3), (len(self.x), 1, 1))
        self.ref = beam3d.reference(np.diff(self.x, axis=0), self.T0[0], self.T0[1], self.section.L)

    def residual(self, u: Array, tip_load: Array) -> tuple[Array, Array]:
        """tip_load: force (3,) and moment (3,) about axes fixed in space."""
        step = u.reshape(-1, 6)
        Theta = np.ascontiguousarray(step[:, 3:])
        R = self.R @ np.array([rotations.exp(vector(t)) for t in Theta])
        H = self.R @ np.array([rotations.left_tangent(vector(t)) for t in Theta])
        chord = np.diff(self.x + step[:, :3], axis=0)
        ends = R[:-1] @ self.T0[0], R[1:] @ self.T0[1]
        f, K = spatial_elements.forces_and_tangent(chord, *ends, self.ref, self.section, np.zeros(chord.shape))
        f[-1, 6:] -= tip_load
        spatial_elements.to_increments(f, K, H, self.R, Theta)
        return assemble(f, K)

    def commit(self, u: Array) -> None:
        step = u.reshape(-1, 6)
        self.x = self.x + step[:, :3]
        self.R = self.R @ np.array([rotations.exp(vector(t)) for t in step[:, 3:]])


def load(chain: Chain, tip_load: Array, steps: int, tolerance: float = 1e-10) -> int:
    """Bring the chain into equilibrium with the tip load, in equal steps; returns the number of iterations.

    An iteration ends a step when it moves no dof by more than `tolerance` (m, rad).
    """
    iterations = 0
    for factor in np.linspace(0.0, 1.0, steps + 1)[1:]:
        u = np.zeros(chain.nn * chain.dofs)
        for _ in range(MAX_ITERATIONS):
            r, K = chain.residual(u, factor * tip_load)
            free = slice(chain.dofs, None)
            change = np.linalg.solve(K[free, free], r[free])
            u[free] -= change
            iterations += 1
            if np.abs(change).max() < tolerance:
                break
        else:
            raise AssertionError(
                f"no equilibrium at {factor:.3f} of the load: last change {np.abs(change).max():.1e}"
            )
        chain.commit(u)
    return iterations


def alike(n: int, L: float, EA: float, EI_y: float, EI_z: float, GJ: float) -> LineStiffness:
    """Stiffnesses of n elements that are L long together."""
    length, axial, about_y, about_z, twisting = (np.full(n, value) for value in (L / n, EA, EI_y, EI_z, GJ))
    return Stiffness(length, axial, about_y, about_z, twisting, Linear())


def straight_plane(n: int, L: float, EA: float, EI: float, element: Element2d) -> PlaneChain:
    """Straight chain of n elements along the first axis."""
    x = np.column_stack([np.linspace(0.0, L, n + 1), np.zeros(n + 1)])
    return PlaneChain(x, np.zeros((2, n)), alike(n, L, EA, EI, EI, EI), element)


def straight_space(n: int, L: float, EA: float, EI: tuple[float, float], GJ: float) -> SpaceChain:
    """Straight chain of n elements along x."""
    x = np.column_stack([np.linspace(0.0, L, n + 1), np.zeros(n + 1), np.zeros(n + 1)])
    return SpaceChain(x, np.tile(np.eye(3), (2, n, 1, 1)), alike(n, L, EA, *EI, GJ))


def arc_space(n: int, radius: float, angle: float, EA: float, EI: float, GJ: float) -> SpaceChain:
    """Circular arc of n elements in the x-y plane, leaving the origin along y and bending towards x."""
    s = np.linspace(0.0, angle, n + 1)
    o = np.zeros_like(s)
    x = radius * np.column_stack([1.0 - np.cos(s), np.sin(s), o])
    tangent, inward = np.column_stack([np.sin(s), np.cos(s), o]), np.column_stack([np.cos(s), -np.sin(s), o])
    frames = np.stack([tangent, inward, np.cross(tangent, inward)], axis=2)
    return SpaceChain(x, np.array([frames[:-1], frames[1:]]), alike(n, radius * angle, EA, EI, EI, GJ))
