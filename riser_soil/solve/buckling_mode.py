"""Buckling mode in which a riser leaves an unstable equilibrium.

With the tangent K and the drag D of dynamic relaxation it is the mode of the most negative eigenvalue w of
K m = w D m, the one that grows fastest. It is computed by inverse iteration on K + s D, where s is the least power of
two times any drag that makes this matrix positive definite: then w lies between -s and -s/2. The start vector is the
same for all risers, and the largest displacement is positive, so that the direction does not depend on round-off.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from typing import TYPE_CHECKING

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Part, State, Weights
from riser_soil.core.system import System
from riser_soil.errors import SolveError
from riser_soil.riser.line import Line
from riser_soil.solve.bordered_band import band_of
from riser_soil.solve.stability import judged_parts

if TYPE_CHECKING:
    from riser_soil.bodies.body import MovingBody

MOST_ITERATIONS = 200
SETTLED = 1e-12  # change of a mode's direction in an iteration, squared
AS_LARGE = 1.0 - 1e-6  # of the largest displacement
LEAST_DRAG, MOST_DRAG = 1e-12, 1e12  # over the drag that the search starts from
AXES = np.sqrt([1.0, 2.0, 3.0])  # of the start: no plane of symmetry holds it


def stabilising_drag(drag: float, stable: Callable[[float], bool]) -> float:
    """The least drag that is `drag` times a power of two and makes an unstable equilibrium stable."""
    least, most = LEAST_DRAG * drag, MOST_DRAG * drag
    while not stable(drag) and drag < most:
        drag *= 2.0
    while stable(0.5 * drag) and drag > least:
        drag *= 0.5
    return drag


def buckling_mode(
    system: System, part: Part, fields: Sequence[Line | MovingBody], state: State, weights: Weights
) -> Array:
    """Increments (size,) of the mode, its largest displacement of lines and bodies +1 m; `part` has the drag s.
    Collective.
    """
    parts = judged_parts(system)
    assert parts is not None
    system.assemble(state, weights, [part])
    drag, start = system.matrix.stored.diagonal(), _start(system, fields)
    if system.sum([float(start @ (drag * start))])[0] == 0.0:
        raise SolveError("the equilibrium found is unstable, and no node is free to leave it; take more elements")
    system.assemble(state, weights, parts)
    with _exact_solver(system) as solve:
        mode = _iterate(system, solve, drag, start)
    increments = np.zeros(system.numbering.size)
    system.numbering.to_local(mode, increments)
    return np.asarray(increments / _largest(np.concatenate([increments[field.translation_dofs] for field in fields])))


def _exact_solver(system: System) -> AbstractContextManager[Callable[[Array], Array]]:
    if (band := band_of(system)) is not None:
        return nullcontext(band.solve)
    from riser_soil.solve.direct_solver import exact_solver

    return exact_solver(system)


def _start(system: System, fields: Sequence[Line | MovingBody]) -> Array:
    """Displacements that grow along the lines and share no symmetry with them."""
    local = np.zeros(system.numbering.size)
    for field in fields:
        grows = field.arc / field.arc[-1] if isinstance(field, Line) else np.zeros(1)
        local[field.translation_dofs] = (1.0 + grows)[:, None] * AXES[: field.dimension]
    return system.numbering.to_global(local)


def _iterate(system: System, solve: Callable[[Array], Array], drag: Array, x: Array) -> Array:
    """Inverse iteration from x: the mode, of unit size in the drag's norm."""

    def product(one: Array, other: Array) -> float:
        return system.sum([float(one @ (drag * other))])[0]

    for _ in range(MOST_ITERATIONS):
        image = solve(drag * x)
        turn = image - x * (product(image, x) / product(x, x))
        turned, size = product(turn, turn), product(image, image)
        x = image * size**-0.5
        if turned < SETTLED * size:
            break
    return x


def _largest(displacements: Array) -> float:
    """The entry of largest size, with its sign; the first along the lines of those that are as large."""
    entries = displacements.ravel()
    sizes = np.abs(entries)
    return float(entries[np.flatnonzero(sizes >= AS_LARGE * sizes.max())[0]])
