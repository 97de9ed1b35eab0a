"""What stands beside a line in the compiled loop: its border, see `bordered_loop`."""

from __future__ import annotations

from riser_soil.core.bound import Bound
from riser_soil.core.packed import Packed
from riser_soil.solve import riser_loop as loop


class LoopBorder:
    """Nothing beside the line. One with unknowns of its own overrides all of this; kernels are bound to what they take.

    knows_round_off: whether a residual can be told from its round-off by `riser_loop.judge_round_off`; smooth: whether
    nothing touches it.
    """

    knows_round_off = smooth = True

    def forces(self, at: Packed, forces: Packed) -> list[Bound]:
        """Kernels that add to the line's residual, and write that of the border."""
        return []

    def judge(self, forces: Packed, dofs: Packed, limits: Packed, progress: Packed) -> Bound:
        """The kernel that tells whether all of the residual is small enough."""
        return Bound(loop.judge, forces, dofs, limits, progress)

    def tangent(self, at: Packed, K: Packed) -> list[Bound]:
        """Kernels that add to the line's tangent, and write that of the border."""
        return []

    def factorise(self, room: Packed, dofs: Packed, progress: Packed) -> Bound:
        """The kernel that factorises the line's band and the border."""
        return Bound(loop.factorise, room, progress)

    def improve(self, room: Packed, step: Packed, dofs: Packed) -> Bound:
        """The kernel that takes the factors' answer off all increments."""
        return Bound(loop.improve, room, step, dofs)

    def account(self, then: Packed, now: Packed) -> list[Bound]:
        """Kernels that account for a step."""
        return []
