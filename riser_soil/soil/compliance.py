"""Compliance of linear elastic soil: the displacements that forces on its top cause, from one factorisation at most.

Its columns are kept on disk from one run to the next, in the folder of the compiled kernels. A soil has a folder, named
by a hash of all that decides its columns to the last bit, and each group of columns a file in it, which begins with a
checksum: a damaged file counts as none. Files are written beside their place and moved there, so that runs at once
don't meet half a file. With RISER_SOIL_COMPLIANCE=off nothing is kept or read.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import tempfile
from collections import deque
from collections.abc import Iterable
from contextlib import suppress
from functools import cached_property
from pathlib import Path

import numpy as np
from petsc4py import PETSc

from riser_soil.core import compiled
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.environment import processor
from riser_soil.core.factor_memory import Workspace
from riser_soil.core.matrix import Matrix
from riser_soil.core.numbering import Numbering
from riser_soil.core.part import State, Weights
from riser_soil.errors import SolveError
from riser_soil.soil.soil import Soil

AT_ONCE = 16  # nodes whose columns are solved for in one call
MEMORY = 1 << 28  # bytes of columns in memory, where they can't be written to disk; others are solved for again
SAME_ROW = 1e-6  # of the top's longer side: how far points of a row are apart across it
FORMAT = 1  # number of the files' format, and of how columns are computed and grouped
SWITCH = "RISER_SOIL_COMPLIANCE"
DISK = 1 << 30  # bytes of all files; those of the soils used least recently are removed first
FREE_DISK = 1 << 30  # bytes of the disk that stay free
CHECKSUM = 64  # bytes, at the beginning of a file


class Compliance:
    """Inverse of the stiffness of soil in linear elasticity, as far as it is asked for; on one rank.

    columns: displacements of the top by unit forces on a node's three dofs; those of supported dofs are zero. They are
    solved for by groups of nodes, in the whole soil. The stiffness is factorised, once, where a group is not on disk.
    on_disk: whether an earlier run has written any.
    """

    def __init__(self, soil: Soil) -> None:
        self._soil, self._known, self._groups = soil, dict[int, Array](), dict[int, Array]()
        self._in_memory = deque[int]()  # groups that could not be written to disk
        self._numbering = Numbering(soil.grid.nodes.comm, [soil.field])
        rows = np.full(int(soil.field.global_index.max()) + 1, -1, dtype=np.int64)
        rows[soil.field.global_index] = self._numbering.index
        self.top: IntArray = rows[soil.surface.global_index]
        rank = np.argsort(_in_rows(soil.surface.points[:, :2]))
        self._group: IntArray = rank // AT_ONCE
        self._files = ColumnFiles(self._key())
        self.on_disk = self._files.any_on_disk()

    def _key(self) -> str:
        """Key by the cells' matrices, which follow from mesh and law, their places in the system, and the top's."""
        block = self._soil.blocks()["soil"]
        values = {"soil": block.zeros()}
        _add_stiffness(self._soil, self._numbering.size, values)
        return key_of((values["soil"], self._numbering.index, block.rows, self.top, self._group))

    @cached_property
    def _solver(self) -> PETSc.PC:
        return self._factorised()

    def _factorised(self) -> PETSc.PC:
        soil, size = self._soil, self._numbering.size
        matrix = Matrix(self._numbering, soil.blocks(), symmetric=True)
        _add_stiffness(soil, size, matrix.values)
        matrix.assemble()
        workspace = Workspace()
        while True:
            solver = PETSc.PC().create(self._numbering.comm)
            solver.setOperators(matrix.mat)
            solver.setType("cholesky")
            solver.setFactorSolverType("mumps")
            solver.setFactorSetUpSolverType()
            for control, value in workspace.controls.items():
                solver.getFactorMatrix().setMumpsIcntl(control, value)
            try:
                solver.setUp()
            except PETSc.Error as err:
                raise SolveError(f"the stiffness of the elastic soil can't be factorised: {err}") from err
            if not workspace.grows_after(solver):
                return solver
            solver.destroy()

    def columns(self, nodes: IntArray) -> Array:
        """Displacements (3 np, n, 3) [m/N] of the top's dofs by unit forces on the three dofs of some of its nodes."""
        for node in nodes:
            if int(node) not in self._known:
                at_top = self._whole(int(node)).T[self.top]
                self._known[int(node)] = np.where((self.top >= 0)[:, None], at_top, 0.0)
        if not len(nodes):
            return np.zeros((len(self.top), 0, 3))
        return np.stack([self._known[int(node)] for node in nodes], axis=1)

    def _whole(self, node: int) -> Array:
        """Displacements (3, n) of the system's dofs by unit forces on a node of the top."""
        group = int(self._group[node])
        nodes = np.flatnonzero(self._group == group)
        if group not in self._groups:
            self._groups[group] = self._columns_of_group(group, nodes)
        first = 3 * int(np.searchsorted(nodes, node))
        return self._groups[group][first : first + 3]

    def _columns_of_group(self, group: int, nodes: IntArray) -> Array:
        """Columns (3 nn, n) of a group: on disk, else in memory in the place of the oldest there."""
        columns = self._files.read(group, (3 * len(nodes), self._numbering.free))
        if columns is not None:
            return columns
        reordered = self._computed(nodes)
        columns = self._files.write(group, reordered)
        if columns is reordered:
            while self._in_memory and (len(self._in_memory) + 1) * reordered.nbytes > MEMORY:
                del self._groups[self._in_memory.popleft()]
            self._in_memory.append(group)
        return columns

    def _computed(self, nodes: IntArray) -> Array:
        """Columns (3 nn, n) of nodes of the top, by a solve."""
        rows = self.top.reshape(-1, 3)[nodes].ravel()
        loads = np.zeros((self._numbering.free, len(rows)), order="F")
        free = np.flatnonzero(rows >= 0)
        loads[rows[free], free] = 1.0
        return np.ascontiguousarray(self._solved(loads).T)

    def _solved(self, loads: Array) -> Array:
        """Displacements (n, k) by loads (n, k), of the free dofs."""
        right = PETSc.Mat().createDense(loads.shape, array=loads, comm=PETSc.COMM_SELF)
        solutions = PETSc.Mat().createDense(loads.shape, comm=PETSc.COMM_SELF)
        solutions.setUp()
        self._solver.getFactorMatrix().matSolve(right, solutions)
        out: Array = solutions.getDenseArray().copy()
        right.destroy()
        solutions.destroy()
        return out

    def displacement(self, on_top: Array) -> Array:
        """Displacement (size,) of the whole field [m] by forces (3 np,) on the top's dofs [N]: a sum of columns."""
        forces = np.where(self.top >= 0, on_top, 0.0).reshape(-1, 3)
        values, out = np.zeros(self._numbering.free), np.zeros(self._numbering.size)
        for node in np.flatnonzero(forces.any(axis=1)):
            for force, column in zip(forces[node], self._whole(int(node)), strict=True):
                values += force * column
        moving = self._numbering.index >= 0
        out[moving] = values[self._numbering.index[moving]]
        return out


def _add_stiffness(soil: Soil, size: int, values: dict[str, Array]) -> None:
    soil.tangent(State.at_rest(0.0, size), Weights(0.0, 1.0, 0.0, 0.0), values)


def _in_rows(xy: Array) -> IntArray:
    """Order of points (n, 2): row by row along the longer side of their box, which is most often the riser's."""
    extent = np.ptp(xy, axis=0)
    along = int(extent.argmax())
    rows = np.round(xy[:, 1 - along] / (SAME_ROW * float(extent.max())))
    return np.lexsort((xy[:, along], rows))


def key_of(arrays: Iterable[Array | IntArray]) -> str:
    """Name of a soil by arrays that decide its columns, and by what decides their last digits: solver, processor and
    threads.
    """
    threads = os.environ.get("OMP_NUM_THREADS", os.cpu_count())
    made_by = (FORMAT, PETSc.Sys.getVersion(), processor(), threads)
    digest = hashlib.sha256(repr(made_by).encode())
    for array in arrays:
        digest.update(f"{array.dtype}{array.shape}".encode())
        digest.update(np.ascontiguousarray(array).data)
    return digest.hexdigest()[:32]


class ColumnFiles:
    """Groups of columns (k, n) of the soil of a key, by number."""

    def __init__(self, key: str) -> None:
        self._folder = _root() / key
        self._reads = self._writes = os.environ.get(SWITCH) != "off"

    def read(self, group: int, shape: tuple[int, int]) -> Array | None:
        """A group of columns, mapped from its file; None where there is no whole file."""
        if not self._reads:
            return None
        try:
            with self._file(group).open("rb") as file:
                checksum = file.read(CHECKSUM)
                columns: Array = np.asarray(np.memmap(file, float, mode="r", offset=CHECKSUM, shape=shape))
        except (OSError, ValueError):  # ValueError: the file is too short
            return None
        if checksum != self._checksum(group, columns):
            return None
        with suppress(OSError):
            os.utime(self._folder)
        return columns

    def write(self, group: int, columns: Array) -> Array:
        """Write columns to a file where possible; the columns mapped from it, which take no memory, or else the ones
        given.
        """
        if self._writes:
            try:
                self._write(group, columns)
            except OSError as err:
                self._writes = False
                compiled.tell(f"the soil's compliance is not kept for other runs ({err})")
        mapped = self.read(group, (columns.shape[0], columns.shape[1]))
        return columns if mapped is None else mapped

    def any_on_disk(self) -> bool:
        """Whether columns are there, whole or not."""
        return self._reads and any(self._folder.glob("*.columns"))

    def _write(self, group: int, columns: Array) -> None:
        self._folder.mkdir(parents=True, exist_ok=True)
        _make_workspace(self._folder, columns.nbytes)
        with tempfile.TemporaryDirectory(dir=self._folder, prefix=".") as place:
            part = Path(place) / "part"
            with part.open("wb") as file:
                file.write(self._checksum(group, columns))
                file.write(columns.data)
            part.replace(self._file(group))

    def _file(self, group: int) -> Path:
        return self._folder / f"{group}.columns"

    def _checksum(self, group: int, columns: Array) -> bytes:
        digest = hashlib.sha256(f"{self._folder.name}/{group}".encode())
        digest.update(columns.data)
        return digest.hexdigest().encode()


def _root() -> Path:
    """Folder beside those of the kernels' versions; in the kernels' own where that is a temporary one, alone."""
    beside = compiled.FOLDER.parent
    return (beside if beside.name.startswith(compiled.NAME) else compiled.FOLDER) / "compliance"


def _make_workspace(folder: Path, size: int) -> None:
    """Remove other soils' folders, those that were not used for longest first, until so many bytes more may be kept;
    OSError where they may not.
    """
    others = sorted((path for path in folder.parent.iterdir() if path != folder), key=_last_use)
    while _size_below(folder.parent) + size > DISK and others:
        shutil.rmtree(others.pop(0), ignore_errors=True)
    if _size_below(folder.parent) + size > DISK or shutil.disk_usage(folder).free < size + FREE_DISK:
        raise OSError(f"{folder.parent} may take {DISK >> 20} MB and leaves {FREE_DISK >> 20} MB of the disk free")


def _last_use(path: Path) -> float:
    """Time of the last use; another run may have removed the file meanwhile."""
    with suppress(OSError):
        return path.stat().st_mtime
    return 0.0


def _size_below(root: Path) -> int:
    sizes = 0
    for place, _, names in os.walk(root):
        for name in names:
            with suppress(OSError):
                sizes += (Path(place) / name).stat().st_size
    return sizes
