"""Rotational spring between an end and its support: the parts "start spring" and "end spring"."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Energy, Forces, MatrixBlock, State, Traits, Weights, Work
from riser_soil.riser import rotations
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart
from riser_soil.riser.load_kernels import PlanarSpring, SpatialSpring
from riser_soil.riser.spatial_directors import SpatialOrientation, moment_stiffness


class EndSpring(LinePart):
    """Moment stiffness times the rotation vector from the support's orientation to the end's (group F).

    line: the riser's field. node: 0 for the start, -1 for the end. stiffness: N m/rad.
    At rest in the line's first configuration, but for what `Line.turn_support` has turned, from where the support may
    turn. In space the rotation is below pi and counts twist too; in the plane it is unlimited.
    """

    traits = Traits("F", symmetric=True)

    def __init__(self, line: Line, node: int, stiffness: float) -> None:
        super().__init__(line)
        self.stiffness = stiffness
        self.node = node % line.nodes
        self.name = "start spring" if self.node == 0 else "end spring"

    def blocks(self) -> dict[str, MatrixBlock]:
        first = self.line.offset + self.node * self.line.ndof + self.line.dimension
        dofs = np.arange(first, first + self.line.frames.dofs, dtype=np.int64)[None]
        return {self.name: MatrixBlock(dofs, dofs)}

    def moment(self, state: State) -> Array:
        """Moment of the spring on the riser in its own axes: (3,) global in space, (1,) in the plane."""
        return -self.stiffness * self._rotation(state)

    def _rotation(self, state: State) -> Array:
        support = self.line.support(self.node, state.t)
        return self.line.frames.rotation(support, self.line.trial(state).turn.at(self.node))

    def residual(self, state: State, forces: Forces) -> None:
        turn = self.line.trial(state).turn
        H = turn.H[self.node] if isinstance(turn, SpatialOrientation) else np.eye(1)
        self.line.nodal(forces.force)[self.node, self.line.dimension :] -= H.T @ self.moment(state)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        turn = self.line.trial(state).turn
        K = self._spatial_tangent(turn, state) if isinstance(turn, SpatialOrientation) else self.stiffness
        values[self.name][0] += weights.force * K

    def _spatial_tangent(self, turn: SpatialOrientation, state: State) -> Array:
        """H^T k T_L^-1(phi) H, and the change of H at fixed moment."""
        H, phi = turn.H[self.node], self._rotation(state)
        material = self.stiffness * H.T @ np.array(rotations.left_tangent_inverse(phi)) @ H
        frame, Theta = turn.Rn[self.node], turn.Theta[self.node]
        return np.asarray(material + np.array(moment_stiffness(frame, Theta, self.stiffness * phi)))

    def numbers(self) -> PlanarSpring | SpatialSpring:
        kind = PlanarSpring if self.line.dimension == 2 else SpatialSpring
        self._support = self.line.support(self.node, 0.0).copy()
        return kind(self.node, self.stiffness, self._support)

    def renew_numbers(self, start: float, end: float) -> None:
        self._support[:] = self.line.support(self.node, end)

    def energy(self, state: State) -> Energy:
        phi = self._rotation(state)
        return Energy(strain=0.5 * self.stiffness * float(phi @ phi))

    def work(self, before: State, after: State) -> Work:
        """Work of the support's rotation against the spring: the mean moment times the rotation."""
        rotation = self.line.frames.rotation(*(self.line.support(self.node, state.t) for state in (before, after)))
        return Work(external=0.5 * float((self.moment(before) + self.moment(after)) @ rotation))
