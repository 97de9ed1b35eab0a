"""Point and distributed loads of a stage on the riser, with their load histories: the part "loads"."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, State, Traits, Weights, Work
from riser_soil.errors import SceneError
from riser_soil.riser import hermite
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart
from riser_soil.riser.load_kernels import GivenForces, SpatialMoments
from riser_soil.riser.spatial_directors import SpatialOrientation, moment_stiffness
from riser_soil.riser.trial import Trial


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


class PointLoads(LinePart):
    """Loads of a stage (group F).

    Forces spread to their element by the cubic shape functions; moments must sit at a node. A moment of fixed
    axis has no potential in space, so its tangent isn't symmetric there.
    """

    name = "loads"

    def __init__(self, line: Line, loads: list[AppliedLoad]) -> None:
        super().__init__(line)
        self._loads = loads
        self._places = {load: self._place(load) for load in loads}
        self._within = [load for load in loads if self._inside(load)]
        self._moments = [(load, self._node(load)) for load in loads if load.moment is not None]
        self.traits = Traits("F", symmetric=not (self._moments and line.dimension == 3))

    def _node(self, load: AppliedLoad) -> int:
        node = int(np.argmin(np.abs(self.line.arc - load.arc)))
        if abs(self.line.arc[node] - load.arc) > 1e-9 * self.line.arc[-1]:
            raise SceneError(
                f"stages: loads: a moment at arc {load.arc:.9g} m lies between nodes; "
                f"move it to the nearest, {self.line.arc[node]:.9g} m, or put a node there by other elements"
            )
        return node

    def _place(self, load: AppliedLoad) -> tuple[slice, Array]:
        """Elements that the load acts on, and what their q gets of it (m, 4, d)."""
        line = self.line
        if load.distributed is not None:
            return slice(None), hermite.uniform_load(line.length)[:, :, None] * (
                load.distributed @ line.basis
            )
        if not -1e-9 * line.arc[-1] <= load.arc <= line.arc[-1] * (1.0 + 1e-9):
            raise SceneError(
                f"stages: loads: at arc {load.arc:.6g} m: the riser ends at {line.arc[-1]:.6g} m"
            )
        e, xi = line.place(load.arc)
        force = np.zeros(3) if load.force is None else load.force
        return slice(e, e + 1), hermite.shapes(np.array([xi]), line.length[e : e + 1])[:, :, None] * (
            force @ line.basis
        )

    def _inside(self, load: AppliedLoad) -> bool:
        """Whether a load acts within elements rather than on a node."""
        return load.distributed is not None or self.line.place(load.arc)[1] not in (0.0, 1.0)

    def _F(self, t: float, loads: list[AppliedLoad]) -> Array:
        """Residual of some of the loads, conjugate to q (ne, 4, d)."""
        F = np.zeros((self.line.length.size, 4, self.line.dimension))
        for load in loads:
            at, share = self._places[load]
            F[at] -= load.factor(t) * share
        return F

    def element_forces(self, state: State) -> tuple[Array | None, Array | None]:
        """Element residuals (inertia, force), each (ne, 2 ndof) or None, of what acts within elements, not on
        nodes.
        """
        return None, self.line.trial(state).pull_back(self._F(state.t, self._within))

    def nodal_forces(self, state: State) -> Array:
        """Residual (nn, ndof) of what acts on nodes."""
        out = np.zeros_like(state.u)
        self._add(self.line.trial(state), out)
        inside = np.zeros_like(state.u)
        self.line.collect(self.line.trial(state), self._F(state.t, self._within), inside)
        return self.line.nodal(out - inside)

    def residual(self, state: State, forces: Forces) -> None:
        self._add(self.line.trial(state), forces.force)

    def _add(self, trial: Trial, out: Array) -> None:
        self.line.collect(trial, self._F(trial.state.t, self._loads), out)
        rotations = self.line.nodal(out)[:, self.line.dimension :]
        for load, node in self._moments:
            rotations[node] -= self._conjugate(trial, node, self._moment(load, trial.state.t))

    def _moment(self, load: AppliedLoad, t: float) -> Array:
        return load.factor(t) * np.asarray(load.moment, dtype=float)

    def _conjugate(self, trial: Trial, node: int, moment: Array) -> Array:
        """Generalised forces on the node's rotation dofs (r,) of a moment in global axes."""
        if isinstance(trial.turn, SpatialOrientation):
            return np.asarray(trial.turn.H[node].T @ moment)
        return np.array([moment @ self.line.normal])

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        trial, K = self.line.trial(state), values[self.line.name]
        trial.add_turning(K, weights.force, self._F(state.t, self._loads))
        if isinstance(trial.turn, SpatialOrientation):
            for load, node in self._moments:
                self._add_moment_stiffness(K, trial.turn, node, -weights.force * self._moment(load, state.t))

    def _add_moment_stiffness(self, K: Array, turn: SpatialOrientation, node: int, moment: Array) -> None:
        element, at = (node, 3) if node < len(K) else (node - 1, 9)
        K[element, at : at + 3, at : at + 3] += np.array(
            moment_stiffness(turn.Rn[node], turn.Theta[node], moment)
        )

    def numbers(self) -> GivenForces | SpatialMoments:
        F = np.zeros((self.line.length.size, 4, self.line.dimension))
        self._numbers: GivenForces | SpatialMoments
        if self._moments and self.line.dimension == 3:
            nodes = np.array([node for _, node in self._moments], dtype=np.int64)
            self._numbers = SpatialMoments(F, nodes, np.zeros((nodes.size, 3)))
        else:
            self._numbers = GivenForces(F, np.zeros(self.line.nodes if self._moments else 0), potential=False)
        return self._numbers

    def numbers_within(self, numbers: tuple[Any, ...]) -> None:
        """Those have what acts on nodes, too."""

    def renew_numbers(self, start: float, end: float) -> None:
        self._numbers.F[:] = self._F(end, self._loads)
        self._numbers.moment[:] = 0.0
        for k, (load, node) in enumerate(self._moments):
            if isinstance(self._numbers, SpatialMoments):
                self._numbers.moment[k] = self._moment(load, end)
            else:
                self._numbers.moment[node] -= self._moment(load, end) @ self.line.normal

    def work(self, before: State, after: State) -> Work:
        """Work of the mean loads over the step."""
        residual = np.zeros_like(after.u)
        for state in (before, after):
            self._add(self.line.trial(state), residual)
        part = self.line.part
        return Work(external=-0.5 * float(residual[part] @ (after.u - before.u)[part]))
