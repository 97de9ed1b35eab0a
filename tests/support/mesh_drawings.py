"""Mesh files of a few boxes, good and bad."""

from __future__ import annotations

from collections.abc import Callable

Point = tuple[float, float, float]
Cells = list[list[int]]

LEFT, RIGHT = (0.0, 1.0, 0.0, 1.0, -1.0, 0.0), (1.0, 2.0, 0.0, 1.0, -1.0, 0.0)


class Drawing:
    """Boxes that share the nodes at their corners."""

    def __init__(self, *boxes: tuple[float, float, float, float, float, float]) -> None:
        """boxes: x0, x1, y0, y1, z0, z1 of each."""
        self.points: list[Point] = []
        self.cells: Cells = [[self._node(p) for p in _corners(*box)] for box in boxes]

    def _node(self, point: Point) -> int:
        if point not in self.points:
            self.points.append(point)
        return self.points.index(point)

    def torn(self, x: float) -> Drawing:
        """The last box with nodes of its own at this x."""
        for k, node in enumerate(self.cells[-1]):
            if self.points[node][0] == x:
                self.points.append(self.points[node])
                self.cells[-1][k] = len(self.points) - 1
        return self


def _corners(x0: float, x1: float, y0: float, y1: float, z0: float, z1: float) -> list[Point]:
    return [(x, y, z) for z in (z0, z1) for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))]


def msh(drawing: Drawing, number: Callable[[int], int] = lambda n: n + 1, extra: tuple[str, ...] = ()) -> str:
    """A file of format 2.2. number: a node's number; extra: more lines of nodes."""
    nodes = [f"{number(n)} {x} {y} {z}" for n, (x, y, z) in enumerate(drawing.points)]
    cells = [f"{n} 5 2 1 1 {' '.join(str(number(c)) for c in cell)}" for n, cell in enumerate(drawing.cells, start=1)]
    return (
        f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{len(nodes) + len(extra)}\n"
        + "\n".join([*nodes, *extra])
        + f"\n$EndNodes\n$Elements\n{len(cells)}\n"
        + "\n".join(cells)
        + "\n$EndElements\n"
    )
