"""Dense assembly and Newton for a riser without a solver library: what the tests of riser parts stand on."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, Part, State, Weights
from riser_soil.riser.line import Line

STATIC = Weights(inertia=0.0, force=1.0, shift_v=0.0, shift_a=0.0)


def residual(parts: Sequence[Part], state: State, weights: Weights = STATIC) -> Array:
    """Weighted residual of all parts (n,)."""
    forces = Forces.zeros(state.u.size)
    for part in parts:
        part.residual(state, forces)
    return np.asarray(weights.inertia * forces.inertia + weights.force * forces.force + forces.end)


def tangent(parts: Sequence[Part], state: State, weights: Weights = STATIC) -> Array:
    """Weighted tangent of all parts (n, n), absent entries left out."""
    size = state.u.size
    K = np.zeros((size, size))
    for part in parts:
        blocks = part.blocks()
        values = {key: block.zeros() for key, block in blocks.items()}
        part.tangent(state, weights, values)
        for key, block in blocks.items():
            np.add.at(K, (block.rows[:, :, None], block.cols[:, None, :]), values[key])
    return K


def solve(line: Line, parts: Sequence[Part], t: float = 1.0, tolerance: float = 1e-10, most: int = 60) -> int:
    """Newton from the committed configuration to static balance at load factor t, then commit; its
    iterations.

    tolerance: of the free residual, relative to the largest single force in the line.
    """
    free = ~line.prescribed
    u = np.zeros(line.size)
    line.prescribe(t, u, np.zeros(line.size), np.zeros(line.size))
    for iteration in range(most):
        state = State(t, u, np.zeros(line.size), np.zeros(line.size))
        r = residual(parts, state)
        scale = max(np.abs(part_force(parts, state)).max(), 1e-300)
        if np.abs(r[free]).max() < tolerance * scale:
            line.commit(state)
            return iteration
        K = tangent(parts, state)[np.ix_(free, free)]
        step = np.zeros(line.size)
        step[free] = np.linalg.solve(K, -r[free])
        turn = np.abs(line.nodal(step)[:, line.dimension :]).max()
        u = u + min(1.0, 0.5 / max(turn, 1e-9)) * step
    raise AssertionError(
        f"no balance after {most} iterations: residual {np.abs(r[free]).max():.3g} of {scale:.3g}"
    )


def part_force(parts: Sequence[Part], state: State) -> Array:
    """Largest element forces of the parts that have elements."""
    forces = [p.element_forces(state) for p in parts if hasattr(p, "element_forces")]
    return np.concatenate([np.ravel(f) for f in forces if f is not None])
