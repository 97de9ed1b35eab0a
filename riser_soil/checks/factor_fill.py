"""Fill of the soil's factor, predicted from the block's grid of nodes, before there is a matrix.

Nested dissection (George, SIAM J. Numer. Anal. 10 (1973), 345-363, from memory): a plane of nodes across the longest
side parts the block, another one each half, and so on; planes are eliminated after what they part. A plane of s
unknowns, on whose piece b unknowns of earlier planes border, has s²/2 + s b entries in a symmetric matrix' factor.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

# Entries by PORD, MUMPS' ordering, over those of planes: 1.29 to 1.59 on grids of 4,600 to 140,000 unknowns, cubes,
# slabs and strips. Bytes that MUMPS works in for each of them: 9 to 11.
AS_ORDERED, PER_ENTRY = 1.4, 10.0
UNPARTED = 8.0  # nodes of a piece that is eliminated at once
AT_A_NODE = 3  # unknowns


def factor_memory(sides: tuple[float, float, float], unknowns: float, symmetric: bool) -> float:
    """Bytes of a factorisation, all ranks; sides: in proportion to the nodes along x, y and z."""
    if unknowns <= 0.0:
        return 0.0
    return PER_ENTRY * AS_ORDERED * entries(*nodes_of(sides, unknowns)) * (1.0 if symmetric else 2.0)


def nodes_of(sides: tuple[float, float, float], unknowns: float) -> tuple[float, float, float]:
    """Nodes along sides in that proportion, with so many unknowns in all."""
    per_unit = (unknowns / (AT_A_NODE * math.prod(sides))) ** (1.0 / 3.0)
    x, y, z = (side * per_unit for side in sides)
    return x, y, z


def entries(x: float, y: float, z: float) -> float:
    """Entries of a symmetric factor on a grid of so many nodes along its sides, by nested dissection."""
    return AT_A_NODE**2 * sum(n * s * (0.5 * s + b) for n, s, b in _eliminated(x, y, z))


def operations(x: float, y: float, z: float) -> float:
    """Multiplications and additions that make it, as many of each."""
    return AT_A_NODE**3 * sum(n * s * (s**2 / 3.0 + s * b + b**2) for n, s, b in _eliminated(x, y, z))


def _eliminated(x: float, y: float, z: float) -> Iterator[tuple[float, float, float]]:
    """What nested dissection eliminates at once on a grid of so many nodes: how many of them, and the nodes of each and
    on its border.
    """
    sides, borders, pieces = [x, y, z], [0.0, 0.0, 0.0], 1.0
    while (nodes := math.prod(sides)) > UNPARTED:
        across = max(range(3), key=lambda axis: sides[axis])
        yield pieces, nodes / sides[across], _beside(sides, borders)
        sides[across] = 0.5 * (sides[across] - 1.0)
        borders[across] = 1.0 + 0.5 * borders[across]
        pieces *= 2.0
    yield pieces, nodes, _beside(sides, borders)


def _beside(sides: list[float], borders: list[float]) -> float:
    """Nodes on the border of a piece with these sides and so many borders across each."""
    return sum(border * math.prod(sides) / side for border, side in zip(borders, sides, strict=True))
