"""Point and distributed loads of a stage on the riser, or on a body, with their load histories: the part "loads"."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.part import State, Traits, Weights, Work
from riser_soil.errors import SceneError
from riser_soil.riser import hermite
from riser_soil.riser.attachments import GivenForces, add_given
from riser_soil.riser.configuration import Maps, SpatialConfiguration
from riser_soil.riser.line_part import CompiledPart
from riser_soil.riser.moving_nodes import MovingNodes
from riser_soil.riser.part_kernels import LineForces, add_energy, add_forces, add_tangent
from riser_soil.riser.rotations import moment_stiffness
from riser_soil.riser.vectors import matrix, matvec, transpose, vector


@dataclass(frozen=True, eq=False)
class AppliedLoad:
    """force [N] and moment [N m] at an arc length [m], or a load distributed [N/m] over the whole riser;
    global axes.

    All keep their directions while the riser turns. factor: of seconds since the stage began (load factor in
    statics).
    """

    factor: Callable[[float], float]
    arc: float = 0.0
    force: Array | None = None
    moment: Array | None = None
    distributed: Array | None = None


class _Share(NamedTuple):
    """What a load of factor 1 puts somewhere in an array of residuals, with its sign turned."""

    load: AppliedLoad
    at: int | slice
    values: Array


class SpatialMoments(NamedTuple):
    """`GivenForces`, and moments (k, 3) of fixed axes at nodes (k,)."""

    F: Array
    nodal: Array
    node: IntArray
    moment: Array


class PointLoads(CompiledPart):
    """Loads of a stage (group F).

    Forces spread to their element by the cubic shape functions, at a node to that node alone; moments must sit at one.
    A moment of fixed axis has no potential in space, so its tangent isn't symmetric there.
    """

    name = "loads"

    def __init__(self, line: MovingNodes, loads: list[AppliedLoad]) -> None:
        super().__init__(line)
        self._along = [self._spread(load, load.distributed) for load in loads if load.distributed is not None]
        self._nodal: list[_Share] = []
        for load in loads:
            if load.distributed is None:
                self._place(load)
        moments = [_Share(load, self._node(load), load.moment) for load in loads if load.moment is not None]
        self._moments = moments if line.dimension == 3 else []
        if line.dimension == 2:
            self._nodal += [share._replace(values=_in_plane(share.values, line)) for share in moments]
        self.traits = Traits("F", symmetric=not self._moments)

    def _node(self, load: AppliedLoad) -> int:
        node = int(np.argmin(np.abs(self.line.arc - load.arc)))
        if abs(self.line.arc[node] - load.arc) > 1e-9 * self.line.arc[-1]:
            raise SceneError(
                f"stages: loads: a moment at arc {load.arc:.9g} m lies between nodes; "
                f"move it to the nearest, {self.line.arc[node]:.9g} m, or put a node there by other elements"
            )
        return node

    def _spread(self, load: AppliedLoad, per_length: Array) -> _Share:
        along = hermite.uniform_load(self.line.length)[:, :, None]
        return _Share(load, slice(None), along * (per_length @ self.line.basis))

    def _place(self, load: AppliedLoad) -> None:
        """A force, within an element or at a node."""
        line = self.line
        if not -1e-9 * line.arc[-1] <= load.arc <= line.arc[-1] * (1.0 + 1e-9):
            raise SceneError(
                f"stages: loads: at arc {load.arc:.6g} m: the riser ends at {line.arc[-1]:.6g} m"
            )
        if load.force is None:
            return
        (e, xi), force = line.element_at(load.arc), load.force @ line.basis
        if xi in (0.0, 1.0):
            self._nodal.append(_Share(load, e + int(xi), np.pad(force, (0, line.frames.dofs))))
        else:
            shapes = hermite.shapes(np.array([xi]), line.length[e : e + 1])[0]
            self._along.append(_Share(load, e, shapes[:, None] * force))

    def make_kernel_data(self) -> GivenForces | SpatialMoments:
        line, node = self.line, np.array([share.at for share in self._moments], dtype=np.int64)
        F, nodal = np.zeros((line.length.size, 4, line.dimension)), np.zeros((line.nodes, line.ndof))
        if self._moments:
            return SpatialMoments(F, nodal, node, np.zeros((node.size, 3)))
        return GivenForces(F, nodal, potential=False)

    def renew_kernel_data(self, start: float, end: float) -> None:
        data = self._data
        for residual, shares in ((data.F, self._along), (data.nodal, self._nodal)):
            residual[:] = 0.0
            for share in shares:
                residual[share.at] -= share.load.factor(end) * share.values
        for k, share in enumerate(self._moments):
            data.moment[k] = share.load.factor(end) * share.values

    def nodal_forces(self, state: State) -> Array | None:
        return self.forces_on_nodes(state) if self._nodal or self._moments else None

    def work(self, before: State, after: State) -> Work:
        """Work of the mean loads over the step."""
        return Work(external=-self.work_against(before, after))


def _in_plane(moment: Array, line: MovingNodes) -> Array:
    """A moment in global axes as what is conjugate to a node's dofs (3,): about the plane's normal."""
    return np.array([0.0, 0.0, moment @ np.cross(*line.basis.T)])


@add_forces.of(SpatialMoments)
def _moment_forces(part: SpatialMoments, at: SpatialConfiguration, out: LineForces) -> None:
    add_given(part.F, part.nodal, out)
    for k in range(part.node.size):
        n = part.node[k]
        conjugate = matvec(transpose(matrix(at.H[n])), vector(part.moment[k]))
        for i in range(3):
            out.force[n, 3 + i] -= conjugate[i]


@add_tangent.of(SpatialMoments)
def _moment_tangent(
    part: SpatialMoments, at: SpatialConfiguration, maps: Maps, weights: Weights, K: Array
) -> None:
    for k in range(part.node.size):
        n = part.node[k]
        e, first = (n, 3) if n < K.shape[0] else (n - 1, 9)
        change = moment_stiffness(matrix(at.Rn[n]), vector(at.Theta[n]), vector(part.moment[k]))
        for i in range(3):
            for j in range(3):
                K[e, first + i, first + j] -= weights.force * change[i][j]


@add_energy.of(SpatialMoments)
def _moment_energy(part: SpatialMoments, at: SpatialConfiguration, energy: Array) -> None:
    """They have no potential."""
