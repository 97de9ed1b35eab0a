"""The riser's line: dofs, committed configuration, end conditions and prescribed motion.

Dofs are interleaved by node: in space x, y, z and a body-axes rotation vector; in a vertical plane p, z and
an angle, p along the horizontal unit vector d, the angle positive from d towards z.
"""

from __future__ import annotations

from contextlib import AbstractContextManager
from functools import cached_property

import numpy as np

from riser_soil.core.arrays import Array, BoolArray, as_list
from riser_soil.core.bound import Packed, bound
from riser_soil.core.part import State
from riser_soil.core.saved_state import Saved
from riser_soil.errors import SceneError
from riser_soil.riser import line_kernels
from riser_soil.riser.configuration import write_folded
from riser_soil.riser.directors import initial_frames
from riser_soil.riser.line_ends import End, LineEnds, free_turns, unit_lengths
from riser_soil.riser.moving_nodes import MovingNodes, out_of_plane
from riser_soil.riser.placed_line import LineTrials
from riser_soil.riser.shapes import Layout
from riser_soil.riser.spatial_directors import SpatialFrames

UP = np.array([0.0, 0.0, 1.0])


class Line(MovingNodes):
    """Field of a line: committed configuration, dofs and ends; see the module's text and `Layout`.

    name: of the field, "riser" where it is the only line; its parts share the sparsity pattern of this name.

    dimension: 2 or 3. A planar line needs a layout in one vertical plane (`shapes.vertical_direction`).
    Where no end prescribes the rotation of a line in space, `prescribe_spin` keeps the start from spinning about the
    pipe's axis: nothing else would in statics, as a round pipe spins at no cost.
    active: whether this rank evaluates and owns the riser.
    loose: chords (ne,) [m] below which an element may be folded, as it lies in a heap; none by default.
    """

    def __init__(
        self,
        dimension: int,
        layout: Layout,
        start: End,
        end: End,
        direction: Array | None = None,
        prescribe_spin: bool = False,
        active: bool = True,
        name: str = "riser",
        loose: Array | None = None,
    ) -> None:
        self.dimension, self.start, self.end = dimension, start, end
        self.outer_diameter = layout.outer_diameter
        self.direction = np.array([1.0, 0.0, 0.0]) if direction is None else direction
        self.normal = np.cross(self.direction, UP)
        self.basis, self.origin = self._axes(layout.position[0])
        self.turning_axes = np.eye(3) if dimension == 3 else self.normal[:, None]
        self._check_plane(layout)
        self.chord0 = layout.chord0 @ (self.basis if dimension == 2 else layout.T0[0, 0])
        frames, x = initial_frames(layout.rotation, layout.T0, self.basis), (layout.position - self.origin) @ self.basis
        super().__init__(name, x, frames, layout.arc, self.basis, active)
        if loose is not None:
            self.loose = loose
        self._ends = LineEnds(start, end, self.arc.size, self.frames, self.origin, self.basis, self.turning_axes)
        self.prescribe_spin(prescribe_spin)

    def _axes(self, first: Array) -> tuple[Array, Array]:
        """Constant basis (3, d) and origin of the in-plane coordinates; z is counted from zero, not from the
        start.
        """
        if self.dimension == 3:
            return np.eye(3), np.zeros(3)
        return np.stack([self.direction, UP], axis=1), np.array([first[0], first[1], 0.0])

    def _check_plane(self, layout: Layout) -> None:
        """A planar line must not leave its plane."""
        off = self.normal
        away = max(np.abs((layout.position - layout.position[0]) @ off).max(), np.abs(layout.chord0 @ off).max())
        if self.dimension == 2 and away > 1e-9 * layout.arc[-1]:
            raise SceneError(
                f"dimension: 2: the riser's shapes leave the vertical plane by {away:.3g} m; use 3"
            )

    def prescribe_spin(self, spin: bool) -> None:
        """Whether the start of a line in space is kept from spinning about the pipe's axis; until the next call."""
        self._ends.prescribe_spin(spin)

    def keep_in_plane(self, across: int) -> None:
        """Keep a line in space, which lies in a plane across x (0) or y (1), in it."""
        assert isinstance(self.frames, SpatialFrames)
        self._ends.fix(out_of_plane(across, self.frames.R[0]))

    @property
    def prescribed(self) -> BoolArray:
        """Which dofs (size,) are prescribed."""
        return self._ends.prescribed

    def all_prescribed(self) -> AbstractContextManager[None]:
        """While the context lasts all dofs are prescribed not to move."""
        return self._ends.all_prescribed()

    @cached_property
    def lever(self) -> float:
        """Mean length of an element [m]: the arm by which a moment is weighed as the forces of a couple."""
        return float(self.length.mean())

    @cached_property
    def tributary_length(self) -> Array:
        """Arc length that belongs to each node (nn,): half of each adjoining element."""
        half = 0.5 * self.length
        return np.asarray(np.append(half, 0.0) + np.append(0.0, half))

    def commit(self, state: State) -> None:
        super().commit(state)
        self._ends.commit(state.t)

    def state(self) -> Saved:
        """Positions, chords and frames; where the supports have turned to, and from where."""
        return super().state() | self._ends.state()

    def restore(self, saved: Saved) -> None:
        super().restore(saved)
        self._ends.restore(saved)

    def begin_stage(self) -> None:
        """Supports turn from where they are now."""
        self._ends.begin_stage()

    def turn_support(self, node: int, rotation: Array) -> None:
        """Turn the support of the first or last node (0, -1) by a rotation vector (3,) in global axes, before anything
        moves.
        """
        self._ends.turn_support(node % self.nodes, rotation)

    def support(self, node: int, t: float) -> Array:
        """Orientation (3, 3) of the support of the first or last node."""
        return self._ends.support(node, t)

    def predict(self, guess: State) -> Array:
        """First guess of a step: the guess's increment, with the rest of the ends' motion spread along the line.

        Left to the last element alone, that remainder stretches it, and its false tension spoils the first
        iteration. The cube of the distance from the other end keeps the far part, often on the seabed, where it is.
        """
        predicted = guess.u.copy()
        self._ends.spread(guess.t, self.x, self.nodal(predicted), self._reach)
        return predicted

    @cached_property
    def _reach(self) -> dict[int, Array]:
        """Share of an end's motion that each node follows in a first guess (nn,)."""
        along = self.arc / self.arc[-1]
        return {0: (1.0 - along) ** 3, self.nodes - 1: along**3}

    def free_turns(self, state: State) -> Array:
        """Rigid motions (k, size) that the supports leave free, their largest displacement the line's length."""
        trial, prescribed = self.trial(state), self.prescribed.reshape(self.nodes, self.ndof)
        return free_turns(trial.x, trial.turn, prescribed, float(self.arc[-1])).reshape(-1, self.size)

    def in_newtons(self, forces: Array) -> Array:
        """Forces and moments (size,), moments over the line's length."""
        return forces * (unit_lengths(self.x.shape, self.ndof, float(self.arc[-1])) / self.arc[-1]).ravel()

    def inadmissible(self, state: State, before: State | None = None) -> str:
        """Where an element is folded (an end's tangent points against its chord) or wound up by whole turns; or swings
        too far to be followed in a time step from the accepted state `before`.

        A step of Newton's method that goes far astray ends in such a tangle; it balances the loads, even stably, but is
        not physical for a pipe, and an end spring would count the turns. A slack wire that is let go snaps into waves
        of its elements: steps that jump over these turn the tension's energy into a motion that there is not.
        """
        trials, elements = self.once(LineTrials), np.zeros(2, dtype=np.int64)
        trials.now.move(state)
        bound(write_folded, trials.now.at, trials.base.packed, Packed(elements))()
        folded, swung = as_list(elements)
        return self.folding(folded, self.length.size if before is None else swung)

    def folding(self, folded: int, swung: int) -> str:
        """What to say of the first element that is folded or wound up, and of the first that swings too far in a step;
        nothing where there is none, the number of elements.
        """
        if folded < self.length.size:
            ends = self.frames.turn(np.zeros((self.nodes, self.frames.dofs))).tangent[folded]
            sizes = self.arc[folded], self.length[folded], self.outer_diameter[folded]
            return line_kernels.folded(*sizes, ends, self.chord[folded])
        return line_kernels.swinging(self.arc[swung]) if swung < self.length.size else ""

    def to_global(self, x: Array) -> Array:
        """Global positions (…, 3) of in-plane (or global) coordinates (…, d)."""
        return np.asarray(self.origin + x @ self.basis.T)

    def positions3(self, state: State) -> Array:
        """Global node positions (nn, 3) at a state."""
        return self.to_global(self.trial(state).x)

    def prescribe(self, t: float, u: Array, v: Array, a: Array) -> None:
        """Write the increments, rates and accelerations of the prescribed ends into views of the field's slice."""
        self._ends.prescribe(t, self.x, u, v, a)

    def describe(self, entry: int) -> str:
        """ "riser node at arc 24 m, vertical force", by the line's name."""
        node, dof = divmod(entry, self.ndof)
        names = (
            ("force along the plane", "vertical force", "moment")
            if self.dimension == 2
            else ("force x", "force y", "vertical force", "moment 1", "moment 2", "moment 3")
        )
        return f"{self.name} node at arc {self.arc[node]:.6g} m, {names[dof]}"
