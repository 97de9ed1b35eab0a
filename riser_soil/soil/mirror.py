"""Half of a soil that is symmetric about a vertical plane: what is computed, and the whole that it stands for.

Cells beyond the plane are meshed, and those that it cuts in the middle. Of these the nodes behind the plane are
images: they view the dofs of their twins beyond it, those across the plane with the sign turned. A cell that is cut
counts once, all others twice, so that forces, energies and all else that is summed over cells are those of the whole.
Where the plane cuts no cells but is one of nodes, these stay in it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.soil.grading import BlockSpec

T = TypeVar("T", bound=np.generic)

NEAR = 1e-9  # of the block's longest side: distance that is none
AXES = "xyz"


@dataclass(frozen=True)
class Mirror:
    """The plane: square to `axis`, x (0) or y (1), `at` a place along it [m]. near: distance that is none [m]."""

    axis: int
    at: float
    near: float

    @property
    def signs(self) -> Array:
        """Signs (3,) of the components of a vector's image."""
        return np.where(np.arange(3) == self.axis, -1.0, 1.0)

    def images(self, points: Array) -> Array:
        """Images of points (n, 3) [m]."""
        out = points.copy()
        out[:, self.axis] = 2.0 * self.at - out[:, self.axis]
        return out

    def behind(self, points: Array) -> BoolArray:
        """Which of points (n, 3) lie behind the plane."""
        return np.asarray(points[:, self.axis] < self.at - self.near)

    def holds(self, points: Array) -> BoolArray:
        """Which of points (n, 3) lie in the plane."""
        return np.asarray(np.abs(points[:, self.axis] - self.at) <= self.near)

    def twins(self, points: Array) -> IntArray:
        """Number (n,) of the point beyond the plane whose image each of points (n, 3) is; of the others their own."""
        twin, behind = np.arange(len(points)), self.behind(points)
        if behind.any():
            twin[behind] = cKDTree(points).query(self.images(points[behind]))[1]
        return twin

    def turned(self, columns: Sequence[str]) -> Array:
        """Signs (nh,) that the image of a row of numbers has, by their names: those of components of vectors and
        tensors end on _x to _z and _xx to _yz.
        """
        own = AXES[self.axis]
        across = {own, *("".join(sorted(own + other)) for other in AXES if other != own)}
        return np.where([name.rpartition("_")[2] in across for name in columns], -1.0, 1.0)


def mirror_of(spec: BlockSpec) -> Mirror | None:
    """Mirror of a block of which half is meshed."""
    return Mirror(1 - spec.axis, spec.line, NEAR * spec.span) if spec.half else None


@dataclass(frozen=True, eq=False)
class Unfolding:
    """From the nodes and cells that are computed to all of them: those first, then the images of some.

    nodes, cells: those whose images are added. source (n,): of all nodes, the one whose dofs each views; sign (n, 3) of
    their components.
    """

    mirror: Mirror | None
    nodes: IntArray
    cells: IntArray
    source: IntArray
    sign: Array

    @classmethod
    def of(cls, mirror: Mirror | None, points: Array, cells: IntArray) -> Unfolding:
        """The unfolding of nodes at points (n, 3) and their cells (nc, nn)."""
        own, signs = np.arange(len(points)), np.ones((len(points), 3))
        if mirror is None:
            return cls(None, own[:0], own[:0], own, signs)
        twin, behind = mirror.twins(points), mirror.behind(points)
        signs[behind] = mirror.signs
        there = behind | mirror.holds(points)
        there[twin[behind]] = True
        copied = np.flatnonzero(~there)
        source, sign = np.append(twin, copied), np.concatenate([signs, np.tile(mirror.signs, (len(copied), 1))])
        return cls(mirror, copied, np.flatnonzero(~behind[cells].any(axis=1)), source, sign)

    def points(self, points: Array) -> Array:
        """All nodes' places (n, 3), of those computed."""
        return points if self.mirror is None else np.concatenate([points, self.mirror.images(points[self.nodes])])

    def vectors(self, nodal: Array) -> Array:
        """All nodes' vectors (n, 3), of those computed."""
        return np.concatenate([nodal, self.sign[len(nodal) :] * nodal[self.nodes]])

    def of_cells(self, rows: npt.NDArray[T]) -> npt.NDArray[T]:
        """All cells' rows, of those computed."""
        return np.concatenate([rows, rows[self.cells]])

    def tensors(self, rows: Array) -> Array:
        """All cells' tensors (nc, 9), row by row, of those computed."""
        if self.mirror is None:
            return rows
        signs = np.outer(self.mirror.signs, self.mirror.signs).ravel()
        return np.concatenate([rows, signs * rows[self.cells]])

    def connected(self, cells: IntArray) -> IntArray:
        """All cells (nc, nn), of those computed: an image has its nodes in the order that turns it right side out, one
        reference axis run the other way.
        """
        computed = len(self.source) - len(self.nodes)
        image = np.arange(computed)
        behind = np.flatnonzero(self.source[:computed] != image)
        image[self.source[behind]] = behind
        image[self.nodes] = computed + np.arange(len(self.nodes))
        turned = np.arange(cells.shape[1]) ^ 1
        return np.concatenate([cells, image[cells[self.cells]][:, turned]])
