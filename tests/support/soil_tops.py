"""Level soil surfaces of squares or pairs of triangles, as contact sees them."""

from __future__ import annotations

import numpy as np

from riser_soil.soil.surface import SoilTop


def top(kind: str, nx: int = 6, ny: int = 4, size: float = 0.5) -> SoilTop:
    """Level surface over [0, nx·size] × [−ny·size/2, ny·size/2], of squares or pairs of triangles."""
    n = 1 if kind == "quad4" else 2
    x = np.linspace(0.0, nx * size, n * nx + 1)
    y = np.linspace(-0.5 * ny * size, 0.5 * ny * size, n * ny + 1)
    points = np.array([[a, b, 0.0] for a in x for b in y])
    number = np.arange(len(points)).reshape(len(x), len(y))
    cells = [number[n * i : n * i + n + 1, n * j : n * j + n + 1] for i in range(nx) for j in range(ny)]
    quads = [[c[0, 0], c[1, 0], c[1, 1], c[0, 1]] for c in cells]
    lower = [[c[0, 0], c[-1, 0], c[-1, -1], c[n // 2, 0], c[-1, n // 2], c[n // 2, n // 2]] for c in cells]
    upper = [[c[0, 0], c[-1, -1], c[0, -1], c[n // 2, n // 2], c[n // 2, -1], c[0, n // 2]] for c in cells]
    facets = np.array(quads if kind == "quad4" else lower + upper)
    free, one = np.zeros(points.size, dtype=bool), np.zeros(len(facets), dtype=np.int64)
    return SoilTop(points, facets, np.arange(points.size), np.ones(points.size), free, one)
