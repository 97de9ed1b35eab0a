"""Interface of parts and fields: residual, tangent, energy and commit, as the system needs them.

Every part adds its share to one residual R(u, v, a) = inertia·I + force·F + E, internal minus external:

- I, inertia: forces that the time scheme weights as inertia (mass, added mass);
- F, force: forces that the scheme weights as stiffness and damping (beam, weight, drag, loads);
- E, end of step: forces always taken at the end of the step (contact, quasi-static soil).

A residual has no memory: it depends on the trial state alone. History changes only in `commit`, once per accepted step.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.saved_state import Saved

GROUPS = "IFE"  # of forces; see the module's text


@dataclass(eq=False)
class State:
    """Trial state of all local dofs; another state is another object, as some are known by what was found at them.

    t: seconds since the stage began; in a static stage the load factor, 0 to 1.
    u: increment since the last accepted state: displacement [m], body-axes rotation vector [rad].
    v: rate: velocity [m/s], body-axes angular velocity [rad/s].
    a: acceleration [m/s2], body-axes angular acceleration [rad/s2].
    dt: seconds that the increments take: inf in statics, where all is slow; 0 of an accepted state, which has none.
    """

    t: float
    u: Array
    v: Array
    a: Array
    dt: float = field(default=0.0, kw_only=True)

    @classmethod
    def at_rest(cls, t: float, size: int) -> State:
        return cls(t, np.zeros(size), np.zeros(size), np.zeros(size))


class Weights(NamedTuple):
    """Weights of the groups in the time scheme, and how rates follow increments (dv/du [1/s], da/du [1/s2])."""

    inertia: float
    force: float
    shift_v: float
    shift_a: float

    @classmethod
    def of_statics(cls) -> Weights:
        """No inertia, and no rates."""
        return cls(inertia=0.0, force=1.0, shift_v=0.0, shift_a=0.0)


@dataclass(frozen=True, eq=False)
class MatrixBlock:
    """A batch of m dense element matrices: local dof numbers of rows (m, nr) and columns (m, nc); -1 is absent.

    filled (m,): of a batch most of which stays zero, those that the parts have written to, who mark them; else None.
    """

    rows: IntArray
    cols: IntArray
    filled: BoolArray | None = None

    @property
    def shape(self) -> tuple[int, int, int]:
        return (self.rows.shape[0], self.rows.shape[1], self.cols.shape[1])

    def zeros(self) -> Array:
        """The matrices themselves, all zero."""
        return np.zeros(self.shape)


@dataclass(eq=False)
class Forces:
    """Local residual [N, N.m] by group; see the module's text."""

    inertia: Array
    force: Array
    end: Array

    @classmethod
    def zeros(cls, size: int) -> Forces:
        return cls(np.zeros(size), np.zeros(size), np.zeros(size))


@dataclass
class Energy:
    """Energy stored at a state [J]."""

    kinetic: float = 0.0
    strain: float = 0.0
    potential: float = 0.0

    def __add__(self, other: Energy) -> Energy:
        return Energy(
            self.kinetic + other.kinetic, self.strain + other.strain, self.potential + other.potential
        )

    @property
    def total(self) -> float:
        return self.kinetic + self.strain + self.potential


@dataclass
class Work:
    """Energy turned over in one accepted step [J]: dissipated, and put in by external non-conservative loads.

    inertial: the share of `external` that a mass gains as it changes, beyond the work of its force m a.
    by_scheme: the share of `dissipated` that is the time scheme's, which takes a force at the end of the step for all
    of it; only of parts that know it.
    """

    dissipated: float = 0.0
    external: float = 0.0
    inertial: float = 0.0
    by_scheme: float = 0.0

    def __add__(self, other: Work) -> Work:
        return Work(
            self.dissipated + other.dissipated,
            self.external + other.external,
            self.inertial + other.inertial,
            self.by_scheme + other.by_scheme,
        )


@dataclass(frozen=True)
class Traits:
    """Properties of a part, declared here, never guessed from its name, its blocks or its methods.

    groups: letters of those that its forces are in. In E they may jump from step to step, as where the riser lands.
    symmetric: its tangent.
    follows: its forces follow the line, but hardly stiffen or soften it, such as the drag of a current.
    path_dependent: its state depends on the path that the riser took, and is no part of its present configuration.
    gradual: its forces in E grow along a curve, as clay's do; at a penalty's corner Newton's method may go astray.
    roles: what it does beyond the contract of a part, see `roles`.
    """

    groups: str
    symmetric: bool
    follows: bool = False
    path_dependent: bool = False
    gradual: bool = False
    roles: tuple[type, ...] = ()

    def __post_init__(self) -> None:
        if not self.groups or set(self.groups) - set(GROUPS):
            raise ValueError(f'groups of a part are letters of "{GROUPS}", not "{self.groups}"')


class Contribution(Protocol):
    """Residual, tangent and energy of a part, or of several that are evaluated together. name: of its time."""

    name: str

    def residual(self, state: State, forces: Forces) -> None:
        """Add this rank's share of the residual."""
        ...

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        """Add this rank's share of dR/du, rates included by the shifts, into values[key] of shape (m, nr, nc)."""
        ...

    def energy(self, state: State) -> Energy:
        """This rank's share of the stored energy."""
        ...


@runtime_checkable
class Compiled(Protocol):
    """A contribution by kernels."""

    def bind(self) -> None:
        """Bind all of them: those that are missing are compiled together, as soon as one is called."""
        ...


class Part(Contribution, Protocol):
    """A contribution to the system: riser, inertia, Morison loads, soil, contact, …"""

    traits: Traits

    @property
    def active(self) -> bool:
        """Whether this rank evaluates the part; where not, no other method is called."""
        ...

    def blocks(self) -> dict[str, MatrixBlock]:
        """Patterns that the part adds to. Parts that share a key share the very same rows and columns."""
        ...

    def work(self, before: State, after: State) -> Work:
        """This rank's share of the energy turned over by the step from `before` to `after`, called before commit."""
        ...

    def commit(self, state: State) -> None:
        """Accept the step: keep its configuration and history; increments restart from zero."""
        ...


class Field(Protocol):
    """Owner of dofs. Fields of one `space` share a numbering (the soil and its surface as seen by contact).

    One some of whose entries view others in a mirror has a sign (size,), too: -1. of those that are minus the dof that
    they view, else 1.
    """

    name: str
    space: str
    size: int
    offset: int
    global_index: IntArray
    owned: BoolArray

    @property
    def prescribed(self) -> BoolArray:
        """Which entries (size,) are not free."""
        ...

    def prescribe(self, t: float, u: Array, v: Array, a: Array) -> None:
        """Write increment, rate and acceleration of the prescribed entries into these views of the field's slice."""
        ...

    def magnitudes(self, state: State) -> Array:
        """Sizes (size,) of the coordinates [m] and angles [rad] at a state, whose round-off the residual has; the
        direction of what has not turned is one of a radian.
        """
        ...

    def commit(self, state: State) -> None:
        """Accept the increments of the field's slice."""
        ...

    def state(self) -> Saved:
        """The committed configuration, as arrays by name."""
        ...

    def restore(self, saved: Saved) -> None:
        """Take over a configuration that was saved."""
        ...

    def describe(self, entry: int) -> str:
        """Description of a local entry's place, for messages."""
        ...


class LineField(Field, Protocol):
    """A field of translations (nn, d) and rotations along a line, or of a body, one node; it may turn as a whole.

    lever: arm [m] by which moments are converted to forces in norms, so that nothing depends on the unit of length.
    turns_axes: whether the axes of its rotation dofs turn with the line, from step to step.
    """

    @property
    def lever(self) -> float: ...

    @property
    def turns_axes(self) -> bool: ...

    @property
    def translation_dofs(self) -> IntArray:
        """Local numbers (nn, d)."""
        ...

    def predict(self, guess: State) -> Array:
        """A better first guess of a step than the increments of `guess`, by its prescribed motion; a copy."""
        ...

    def all_prescribed(self) -> AbstractContextManager[None]:
        """While the context lasts all dofs are prescribed not to move."""
        ...

    def inadmissible(self, state: State, before: State | None = None) -> str:
        """Why a state in balance is none of the thing modelled, or none that one step leads to from an accepted state
        `before`, the same on all ranks; empty for a good one.
        """
        ...

    def in_new_axes(self, conjugate: Array, increments: Array) -> Array:
        """Forces (field's slice) conjugate to the increments, as those of the step after these increments have them."""
        ...

    def free_turns(self, state: State) -> Array:
        """Motions (k, size) as a whole that move no support, their largest displacement the line's own length."""
        ...

    def in_newtons(self, forces: Array) -> Array:
        """Forces and moments (size,) of the field, moments over the line's length."""
        ...


@dataclass(eq=False)
class Model:
    """The model of a stage: the lines and bodies, the parts that act on them, and the other owners of dofs, such as the
    soil.

    joined: those of some parts that are evaluated together made one contribution, as of each line (`line_part.joined`).
    """

    lines: Sequence[LineField]
    parts: Sequence[Part] = ()
    others: Sequence[Field] = ()
    joined: Callable[[Sequence[Part]], Sequence[Contribution]] = list

    @property
    def fields(self) -> list[Field]:
        return [*self.lines, *self.others]


def local(field: Field) -> slice:
    """The field's slice of local arrays."""
    return slice(field.offset, field.offset + field.size)
