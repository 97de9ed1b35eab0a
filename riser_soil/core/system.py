"""The coupled system of a stage: residual, tangent, prescribed motion and commit of all parts together."""

from __future__ import annotations

import time
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.communicator import Communicator, all_of, any_of, sum_of, wait_asleep
from riser_soil.core.compiled import njit
from riser_soil.core.entries import compile_wanted
from riser_soil.core.matrix import Matrix, Patterns
from riser_soil.core.numbering import Numbering
from riser_soil.core.part import (
    Compiled,
    Contribution,
    Energy,
    Field,
    Forces,
    MatrixBlock,
    Model,
    Part,
    State,
    Weights,
    Work,
    local,
)
from riser_soil.core.roles import Adaptive, require_roles, with_role
from riser_soil.core.saved_state import Saved

Groups = tuple[Array, Array, Array]


@dataclass
class Timer:
    """Seconds spent, by part."""

    seconds: defaultdict[str, float]

    @classmethod
    def new(cls) -> Timer:
        return cls(defaultdict(float))

    def add(self, name: str, since: float) -> None:
        """Count the time since `since` (of time.perf_counter)."""
        self.seconds[name] += time.perf_counter() - since

    @property
    def total(self) -> float:
        """Seconds counted so far."""
        return sum(self.seconds.values())

    def state(self) -> Saved:
        return {name: np.array(seconds) for name, seconds in self.seconds.items()}

    def restore(self, saved: Saved) -> None:
        """Count what was spent before, too."""
        for name, seconds in saved.items():
            self.seconds[name] += float(seconds)


class System:
    """Residual and matrix over the free dofs of the model's fields; collective over `comm`.

    patterns: of the matrix of a system before this one, see `Matrix`.
    smooth: whether no forces are taken at the end of the step alone, so that none may jump, as contact's do. gradual:
    whether those that there are grow along curves, see `Traits`.
    lever: the longest one of a line, see `LineField`; levers (size,): of each local dof, 1 for translations.
    no_increments (size,): zeros, the increments of accepted states, which are not to be written to.
    """

    def __init__(self, comm: Communicator, model: Model, clock: Timer, patterns: Patterns | None = None) -> None:
        self.comm, self.model, self.clock = comm, model, clock
        self._patterns = {} if patterns is None and with_role(model.parts, Adaptive) else patterns
        require_roles(model)
        self._active = [part for part in model.parts if part.active]
        self._joined: dict[tuple[int, ...], tuple[Sequence[Part], Sequence[Contribution]]] = {}
        self._number()
        self.no_increments: Array = np.zeros(self.numbering.size)
        self.lever, self.levers = self._weigh_moments()
        self.symmetric = all_of(comm, all(p.traits.symmetric for p in model.parts))
        at_end = [p.traits for p in model.parts if "E" in p.traits.groups]
        self.smooth = not any_of(comm, len(at_end) > 0)
        self.gradual = not any_of(comm, any(not traits.gradual for traits in at_end))
        self.matrix = self._new_matrix()

    def _number(self) -> None:
        self.numbering = Numbering(self.comm, self.model.fields)
        self.prescribed: BoolArray
        self.prescribed_dofs: IntArray
        self.renew_prescribed()

    def _weigh_moments(self) -> tuple[float, Array]:
        levers = np.ones(self.numbering.size)
        for line in self.model.lines:
            levers[local(line)] = line.lever
            levers[line.translation_dofs] = 1.0
        return max(line.lever for line in self.model.lines), levers

    def _new_matrix(self) -> Matrix:
        blocks: dict[str, MatrixBlock] = {}
        for part in self._active:
            blocks.update(part.blocks())
        self._couplings = [key for key, block in blocks.items() if _couples(block, self.end_of_lines)]
        return Matrix(self.numbering, blocks, self.symmetric, self._patterns)

    @property
    def end_of_lines(self) -> int:
        """Lines come first in local arrays."""
        return sum(line.size for line in self.model.lines)

    @property
    def whole_soil(self) -> Field | None:
        """The soil, where all of it is solved for."""
        return next((field for field in self.model.others if field.name == field.space == "soil"), None)

    @property
    def line_rows(self) -> int:
        """How many of this rank's rows are the lines': its first ones."""
        rows = self.numbering.index[: self.end_of_lines] - self.numbering.first
        return int(np.count_nonzero((rows >= 0) & (rows < self.numbering.owned)))

    @property
    def couples(self) -> bool:
        """Whether this rank's parts couple the lines with other fields in the tangent assembled last, or may do so.

        Where no rank's do, there is nothing beside its block of the lines and that of all else.
        """
        return self.matrix.written(self._couplings)

    def renew_pattern(self) -> None:
        """Number the dofs that are free now, and build the matrix anew from the parts' present blocks."""
        self.destroy()
        self._number()
        self.matrix = self._new_matrix()

    def renew_prescribed(self) -> None:
        """Look anew which dofs are free, where the matrix is not asked for."""
        self.prescribed = np.concatenate([f.prescribed for f in self.model.fields])
        self.prescribed_dofs = np.flatnonzero(self.prescribed)

    def prescribe(self, state: State) -> None:
        """Write the prescribed motion at state.t into the state's arrays."""
        for field in self.model.fields:
            at = local(field)
            field.prescribe(state.t, state.u[at], state.v[at], state.a[at])

    def forces(self, state: State) -> Forces:
        """This rank's residual by group (local arrays; shares of shared dofs are summed by the numbering)."""
        forces = Forces.zeros(self.numbering.size)
        for part in self._together(self._active):
            since = time.perf_counter()
            part.residual(state, forces)
            self.clock.add(part.name, since)
        return forces

    def assemble(self, state: State, weights: Weights, parts: Sequence[Part] | None = None) -> None:
        """Put dR/du at the state into the matrix; by default that of all parts."""
        self.matrix.clear()
        chosen = self._active if parts is None else [part for part in parts if part.active]
        for part in self._together(chosen):
            since = time.perf_counter()
            part.tangent(state, weights, self.matrix.values)
            self.clock.add(part.name, since)
        since = time.perf_counter()
        self.matrix.assemble()
        self.clock.add("matrix", since)

    def compile(self) -> None:
        """Compile what is missing of the kernels of all parts, together on all cores; collective."""
        for each in self._together(self._active):
            if isinstance(each, Compiled):
                each.bind()
        compile_wanted()
        wait_asleep(self.comm)

    def _together(self, parts: Sequence[Part]) -> Sequence[Contribution]:
        """Some of the parts, those of each line evaluated together."""
        which = tuple(map(id, parts))
        if which not in self._joined:
            self._joined[which] = parts, self.model.joined(parts)  # an id is one's own as long as the part is kept
        return self._joined[which][1]

    def magnitudes(self, state: State, weights: Weights) -> Array:
        """Sizes (size,) of the terms that this rank's residual is made of, to be summed by the numbering [N]: those of
        the tangent at fixed rates, which takes the matrix' place, times those of the coordinates. See `residual_norm`.
        """
        self.assemble(state, weights._replace(shift_v=0.0, shift_a=0.0))
        return self.matrix.magnitudes(np.concatenate([f.magnitudes(state) for f in self.model.fields]))

    def energy(self, state: State) -> Energy:
        mine = sum((part.energy(state) for part in self._together(self._active)), Energy())
        values = self.sum([mine.kinetic, mine.strain, mine.potential])
        return Energy(*values)

    def work(self, before: State, after: State) -> dict[str, Work]:
        """Energy turned over by each part; those of one name together."""
        mine: dict[str, Work] = {}
        for part in self.model.parts:
            turned = part.work(before, after) if part.active else Work()
            mine[part.name] = mine.get(part.name, Work()) + turned
        summed = iter(self.sum([x for work in mine.values() for x in vars(work).values()]))
        return {name: Work(*(next(summed) for _ in vars(work))) for name, work in mine.items()}

    def work_in_step(
        self, first: Forces, bulk: Array, last: Forces, u: Array, share: float
    ) -> tuple[float, float, float]:
        """Work [J] over the increments u of a step: what prescribed motions put in, by the mean reactions; what the
        bulk forces F, as their mean, and end-of-step forces E take out; and what E takes beyond its own mean.

        first, last: forces where the step begins and in its balance; bulk: F where it begins, in the step's own axes.
        share: of the means, what is there as the step begins.
        """
        at_start, ended = ((forces.inertia, forces.force, forces.end) for forces in (first, last))
        work = _work_of(self.prescribed_dofs, share, at_start, bulk, ended, u)
        put_in, removed, ahead = self.sum([float(joules) for joules in work])
        return put_in, removed, ahead

    def reactions(self, forces: Forces) -> Array:
        """Reactions at this rank's prescribed dofs [N, N.m]."""
        at = self.prescribed_dofs
        return forces.inertia[at] + forces.force[at] + forces.end[at]

    def commit(self, state: State, parts: Sequence[Part] | None = None) -> None:
        """Accept a state: parts first, by default all of them, then the fields that they act on."""
        for part in self._active if parts is None else parts:
            part.commit(state)
        for field in self.model.fields:
            field.commit(state)

    def describe(self, row: int) -> str:
        """Description of a row's place, for messages; collective."""
        entries = np.flatnonzero(self.numbering.index == row)
        return next(filter(None, self.comm.allgather(self._describe(entries))), f"row {row}")

    def _describe(self, entries: IntArray) -> str:
        for entry in entries:
            field = self._field_of(int(entry))
            if field.owned[entry - field.offset]:
                return field.describe(int(entry) - field.offset)
        return ""

    def _field_of(self, entry: int) -> Field:
        return next(f for f in self.model.fields if f.offset <= entry < f.offset + f.size)

    def sum(self, values: list[float]) -> list[float]:
        """Sums over all ranks; collective."""
        return sum_of(self.comm, values)

    def destroy(self) -> None:
        self.matrix.destroy()
        self.numbering.destroy()


def _couples(block: MatrixBlock, end_of_lines: int) -> bool:
    """Whether a batch has dofs of lines, the first ones, and of other fields."""
    dofs = np.concatenate([block.rows.ravel(), block.cols.ravel()])
    return bool((dofs >= end_of_lines).any() and ((dofs >= 0) & (dofs < end_of_lines)).any())


@njit
def _work_of(
    dofs: IntArray, share: float, first: Groups, bulk: Array, last: Groups, u: Array
) -> tuple[float, float, float]:
    """Work of the mean of all groups on some of the dofs; of the mean F and of E on all; of E beyond its mean."""
    work, against, ahead = 0.0, 0.0, 0.0
    for i in dofs:
        at_start, ended = first[0][i] + first[1][i] + first[2][i], last[0][i] + last[1][i] + last[2][i]
        work += (share * at_start + (1.0 - share) * ended) * u[i]
    for i in range(u.size):
        against += (share * bulk[i] + (1.0 - share) * last[1][i] + last[2][i]) * u[i]
        ahead += share * (last[2][i] - first[2][i]) * u[i]
    return work, against, ahead


def total(forces: Forces) -> Array:
    """Sum of all groups [N, N.m]: zero on free dofs in balance, the reaction on prescribed ones."""
    return forces.inertia + forces.force + forces.end
