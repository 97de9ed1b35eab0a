"""Linear elastic soil condensed to the dofs of its top that the riser touches: the part "soil" in place of `Soil`.

With no force on it but at the reached dofs A, such soil moves by u = C f: its stiffness there is the inverse of the
compliance, K = inv(C_AA), and the rest of the top follows as C_TA K u_A. That is static condensation (Guyan, AIAA
Journal 3, 1965, 380, from memory), exact without inertia. It is done from the compliance, whose columns are solved for
once and kept, while A grows and shrinks and for other runs. A force on another dof has no place in it: it is noticed,
and A is extended.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.identity_cache import IdentityCache
from riser_soil.core.part import Energy, Forces, MatrixBlock, State, Traits, Weights, Work
from riser_soil.core.roles import Adaptive
from riser_soil.core.saved_state import Saved, Stateful, gathered, restore_all
from riser_soil.soil.compliance import Compliance
from riser_soil.soil.soil import Soil
from riser_soil.soil.surface import SoilTop

SPARE, FEW = 1.5, 20  # nodes that are reached may be so many times those that must be, and so many more
NO_FORCE = 1e-11  # of the largest force on a dof of the top: round-off where nothing presses


@dataclass(frozen=True, eq=False)
class Reached:
    """Dofs of the top that forces may act on, and how the soil answers.

    nodes: of the top. dofs (na,): free ones of these nodes. compliance (3 np, na) [m/N]: of all the top's dofs.
    """

    nodes: IntArray
    dofs: IntArray
    compliance: Array

    @cached_property
    def stiffness(self) -> Array:
        """(na, na) [N/m], of the reached dofs while no other bears a force."""
        own = self.compliance[self.dofs]
        inverse = np.linalg.inv(0.5 * (own + own.T))
        return np.asarray(0.5 * (inverse + inverse.T))


class SurfaceResponse(NamedTuple):
    """Response of the soil at a state: forces (na,) [N] on the reached dofs that hold the top there, and displacement
    (np, 3) [m] of the whole top since the geostatic start.
    """

    forces: Array
    displacement: Array


class CondensedTop:
    """Field "surface": the dofs of the soil's top, of which those that are not reached follow the others.

    They are prescribed: their increments are zero, and mean nothing. points, facets, committed, placed: as in
    `SoilTop`. unreached: dofs that are free to move, but are not reached.
    """

    name = "surface"
    space = "soil"
    moves = False

    def __init__(self, soil: Soil) -> None:
        top = soil.surface
        self.points, self.facets, self.global_index = top.points, top.facets, top.global_index
        self.committed, self.placed = np.zeros_like(top.points), np.zeros_like(top.points)
        self.size, self.offset = top.size, 0
        self.owned: BoolArray = np.ones(top.size, dtype=bool)
        self._fixed, self._soil = top.prescribed, soil
        self._responses = IdentityCache[State, SurfaceResponse](latest=2, first=1)
        self.reach(np.empty(0, dtype=np.int64))

    @cached_property
    def compliance(self) -> Compliance:
        return Compliance(self._soil)

    def reach(self, nodes: IntArray) -> None:
        """Let forces act on these nodes, and on no others."""
        dofs = (3 * nodes[:, None] + np.arange(3)).ravel()
        free = ~self._fixed[dofs]
        columns = self.compliance.columns(nodes).reshape(self.size, -1) if len(nodes) else np.zeros((self.size, 0))
        self.reached = Reached(nodes, dofs[free], np.ascontiguousarray(columns[:, free]))
        self.prescribed: BoolArray = np.ones(self.size, dtype=bool)
        self.prescribed[self.reached.dofs] = False
        self.unreached: IntArray = np.flatnonzero(self.prescribed & ~self._fixed)
        self._responses.forget()

    def own(self, values: Array) -> Array:
        """The field's slice of a local array."""
        return values[self.offset : self.offset + self.size]

    def forces(self, state: State) -> Array:
        """Forces on the reached dofs (na,) [N] that hold the top where it is at a state."""
        return self._at(state).forces

    def displacement(self, state: State) -> Array:
        """Displacement of the whole top (np, 3) since the geostatic start [m]."""
        return self._at(state).displacement

    def _at(self, state: State) -> SurfaceResponse:
        """Kept for the first state of a step and the last two."""
        return self._responses.made_of(state, self._response)

    def _response(self, state: State) -> SurfaceResponse:
        at = self.reached.dofs
        moves = self.own(state.u)[at]
        moved = self.committed.ravel()[at] + moves
        forces = np.asarray(self.reached.stiffness @ moved)
        if not moves.any():
            return SurfaceResponse(forces, self.committed)
        out = self.reached.compliance @ forces
        out[at] = moved
        return SurfaceResponse(forces, out.reshape(-1, 3))

    def prescribe(self, t: float, u: Array, v: Array, a: Array) -> None:
        for values in (u, v, a):
            values[self.prescribed] = 0.0

    def magnitudes(self, state: State) -> Array:
        return np.abs(self.displacement(state).ravel())

    def commit(self, state: State) -> None:
        self.committed = self.displacement(state)
        self._responses.forget()

    def state(self) -> Saved:
        return {"committed": self.committed, "reached": self.reached.nodes}

    def restore(self, saved: Saved) -> None:
        self.committed = saved["committed"].copy()
        self.reach(saved["reached"])

    def describe(self, entry: int) -> str:
        return self._soil.surface.describe(entry)


SoilSurface = SoilTop | CondensedTop  # the soil's surface as contact uses it


class CondensedSoil:
    """Part "soil" over a `CondensedTop`, see the module's text; in group E, as the whole soil is.

    outgrown: in the residual evaluated last a force acts on dofs that are not reached, or many more are reached than
    bear one; trials of a line search on its way there do not count. It comes after all parts that load the soil, as it
    looks at what these have added to the residual.
    """

    name = "soil"
    active = True
    traits = Traits("E", symmetric=True, roles=(Adaptive, Stateful))

    def __init__(self, soil: Soil, top: CondensedTop) -> None:
        self.whole, self.top = soil, top
        self._undisturbed = gathered(self._owners)
        self._loaded: Array = np.zeros(top.size)
        self._wanted: BoolArray = np.zeros(len(top.points), dtype=bool)
        self._newly_loaded: IntArray = np.empty(0, dtype=np.int64)
        self._recovered = True

    def blocks(self) -> dict[str, MatrixBlock]:
        rows = (self.top.offset + self.top.reached.dofs)[None]
        return {"soil": MatrixBlock(rows, rows)}

    def residual(self, state: State, forces: Forces) -> None:
        own = self.top.own(forces.end)
        self._newly_loaded = np.unique(self.top.unreached[own[self.top.unreached] != 0.0] // 3)
        own[self.top.reached.dofs] += self.top.forces(state)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        values["soil"][0] += self.top.reached.stiffness

    def energy(self, state: State) -> Energy:
        """Strain energy since the geostatic start: half of what the forces would do on the way here."""
        displaced = self.top.displacement(state).ravel()[self.top.reached.dofs]
        return Energy(strain=0.5 * float(self.top.forces(state) @ displaced))

    def work(self, before: State, after: State) -> Work:
        """What the forces at the end of the step do beyond the energy stored, all of it by the time scheme."""
        at = self.top.reached.dofs
        moved = (self.top.displacement(after) - self.top.committed).ravel()[at]
        lost = 0.5 * float((self.top.forces(after) - self._loaded[at]) @ moved)
        return Work(dissipated=lost, by_scheme=lost)

    def commit(self, state: State) -> None:
        self._loaded = np.zeros(self.top.size)
        self._loaded[self.top.reached.dofs] = self.top.forces(state)
        self._wanted = self._bearing()
        self._recovered = False

    def _bearing(self) -> BoolArray:
        """Which nodes (np,) bear a force."""
        size = np.abs(self._loaded).reshape(-1, 3).max(axis=1)
        return np.asarray(size > NO_FORCE * size.max())

    @property
    def outgrown(self) -> bool:
        return self._newly_loaded.size > 0 or self._spare(len(self.top.reached.nodes))

    def rebuild(self, state: State) -> None:
        """Reach the nodes that bear a force, or have come to bear one in the step so far, and those reached before, as
        long as these are not many more.
        """
        self._wanted[self._newly_loaded] = True
        self._newly_loaded = np.empty(0, dtype=np.int64)
        wanted = np.flatnonzero(self._wanted)
        both = np.union1d(wanted, self.top.reached.nodes)
        self.top.reach(wanted if self._spare(len(both)) else both)

    def note_newly_loaded(self, nodes: IntArray) -> None:
        """Note nodes that are not reached, and have come to bear a force in the step so far."""
        self._newly_loaded = nodes

    def _spare(self, nodes: int) -> bool:
        """Whether so many reached nodes are too many beside those that bear a force."""
        return nodes > SPARE * np.count_nonzero(self._wanted) + FEW

    def recover(self) -> Soil:
        """The whole soil as committed, from the forces on its top and the undisturbed state: so it does not depend,
        to the last bit, on how often it is recovered.
        """
        if not self._recovered:
            restore_all(self._owners, self._undisturbed)
            state = State.at_rest(0.0, self.whole.field.size)
            state.u[:] = self.top.compliance.displacement(self._loaded)
            self.whole.commit(state)
            self.whole.field.commit(state)
            self._recovered = True
        return self.whole

    @property
    def _owners(self) -> dict[str, Stateful]:
        return {"soil": self.whole, "field": self.whole.field}

    def state(self) -> Saved:
        return {"loaded": self._loaded, "wanted": self._wanted.copy()}

    def restore(self, saved: Saved) -> None:
        self._loaded, self._wanted, self._recovered = saved["loaded"], saved["wanted"].copy(), False
