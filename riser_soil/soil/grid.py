"""Distributed mesh of the soil, from a block's description or a user's gmsh file."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import gmsh
import numpy as np
from mpi4py import MPI

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.errors import MeshError
from riser_soil.interruption import restoring_signal_handlers
from riser_soil.soil import dolfinx_compat
from riser_soil.soil.block import BlockSpec, make_block
from riser_soil.soil.dolfinx_compat import Nodes
from riser_soil.soil.families import HEX8, TET10, Family
from riser_soil.soil.mesh_file import HEXAHEDRON, cell_type, read_mesh
from riser_soil.soil.mirror import Mirror, mirror_of


@dataclass(frozen=True, eq=False)
class DistributedMesh:
    """This rank's nodes and cells, their element family, and the corners of the whole mesh's box [m].

    volume (nc,): of this rank's cells, number of the named volume that each lies in. mirror: the plane of a mesh that
    stands for a whole which is symmetric about it; the box is that of the whole. section (n,): of its nodes, number of
    the section that each lies in; None where these are joined.
    """

    family: Family
    nodes: Nodes
    low: Array
    high: Array
    volume: IntArray
    mirror: Mirror | None = None
    section: IntArray | None = None

    def fixed_directions(self, points: Array, boundary: bool = True) -> BoolArray:
        """Directions (n, 3) in which points don't move: all on the bottom, the normal one on the box' sides, in the
        mirror and of plane cells. boundary: whether bottom and sides are fixed.
        """
        near = 1e-6 * float(np.max(self.high - self.low))
        at_side = ((points < self.low + near) | (points > self.high - near)) & boundary
        bottom = (points[:, 2] < self.low[2] + near) & boundary
        prescribed: BoolArray = np.column_stack((at_side[:, 0] | bottom, at_side[:, 1] | bottom, bottom))
        prescribed[:, [axis for axis in range(3) if axis not in self.family.axes]] = True
        if self.mirror is not None:
            prescribed[:, self.mirror.axis] |= self.mirror.holds(points)
        return prescribed

    def twins(self) -> IntArray:
        """Number (n,) of the node of this rank whose dofs each of its nodes has: behind a mirror of its twin."""
        points = self.nodes.points
        return np.arange(len(points)) if self.mirror is None else self.mirror.twins(points)

    def signs(self) -> Array:
        """Signs (n, 3) of the components of each node's displacement, relative to its twin's across the plane of
        symmetry.
        """
        out = np.ones((len(self.nodes.points), 3))
        if self.mirror is not None:
            out[self.mirror.behind(self.nodes.points)] = self.mirror.signs
        return out

    def shares(self) -> Array:
        """Number of times that each of this rank's cells counts (nc,)."""
        out = np.ones(len(self.nodes.cells))
        if self.mirror is not None:
            out += ~self.mirror.behind(self.nodes.points)[self.nodes.cells].any(axis=1)
        return out


def block_grid(comm: MPI.Intracomm, spec: BlockSpec) -> DistributedMesh:
    """Mesh a plain block (collective)."""
    grid, mirror = _grid(comm, lambda: make_block(spec)), mirror_of(spec)
    if mirror is None:
        return grid
    return replace(grid, low=np.minimum(grid.low, mirror.images(grid.high[None])[0]), mirror=mirror)


def file_grid(comm: MPI.Intracomm, path: Path, volumes: Sequence[str] = ()) -> DistributedMesh:
    """Read a gmsh .msh file of first-order tetrahedra or hexahedra (collective); MeshError if it won't do.

    volumes: names of its physical groups by which the cells are numbered; each cell must lie in one of them.
    """
    return _grid(comm, lambda: read_mesh(path, volumes))


@contextmanager
def silent_gmsh() -> Iterator[None]:
    """A gmsh session that prints nothing and reads no settings of the user."""
    with restoring_signal_handlers():
        gmsh.initialize(readConfigFiles=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        yield
    finally:
        with restoring_signal_handlers():
            gmsh.finalize()


def _grid(comm: MPI.Intracomm, make: Callable[[], float]) -> DistributedMesh:
    if comm.rank == 0:
        with silent_gmsh():
            return _distribute(comm, make)
    return _distribute(comm, make)


def _distribute(comm: MPI.Intracomm, make: Callable[[], float]) -> DistributedMesh:
    """Make the model on rank 0; a failure there is raised on every rank, before the collective calls."""
    hexahedra, unit, failure = comm.bcast(_outcome(make) if comm.rank == 0 else None)
    if failure:
        raise MeshError(failure)
    family = HEX8 if hexahedra else TET10
    mesh, group = dolfinx_compat.mesh_from_gmsh(gmsh.model, comm, unit)
    nodes = dolfinx_compat.lagrange_nodes(mesh, family.degree, comm)
    low = np.array([comm.allreduce(x, MPI.MIN) for x in nodes.points.min(axis=0, initial=np.inf)])
    high = np.array([comm.allreduce(x, MPI.MAX) for x in nodes.points.max(axis=0, initial=-np.inf)])
    grid = DistributedMesh(family, nodes, low, high, group - 1)
    _check_box(grid)
    return grid


def _check_box(grid: DistributedMesh) -> None:
    """Bottom and upright sides must be planes with nodes on them, or nothing would hold the soil."""
    near = 1e-6 * float(np.max(grid.high - grid.low))
    mine = grid.nodes.points[: grid.nodes.owned]
    planes = [(axis, end[axis]) for axis in (0, 1) for end in (grid.low, grid.high)] + [(2, grid.low[2])]
    for axis, at in planes:
        count = grid.nodes.comm.allreduce(int(np.count_nonzero(np.abs(mine[:, axis] - at) < near)))
        if count < 3:
            raise MeshError(
                f"soil mesh: only {count} nodes on the plane {'xyz'[axis]} = {at:.4g} m; "
                "the bottom must be level and the upright sides plane and square to x and y"
            )


def _outcome(make: Callable[[], float]) -> tuple[bool, float, str]:
    """Whether the cells are hexahedra, the model's unit of length [m], and why it can't be used ("" if it can)."""
    try:
        unit = make()
        return cell_type() == HEXAHEDRON, unit, ""
    except MeshError as err:
        return False, 1.0, str(err)
    except Exception as err:  # gmsh raises nothing more specific, and the other ranks wait
        return False, 1.0, f"soil mesh: gmsh failed ({err})"
