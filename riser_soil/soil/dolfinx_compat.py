"""Compatibility with dolfinx 0.5, 0.9 and 0.11: the only module that knows how they differ, but for FFCx (ffcx_compat).

The soil needs three things of dolfinx: distribute a gmsh mesh over the ranks, number Lagrange nodes, and say
where they are. Everything else works on the arrays returned here.
"""

from __future__ import annotations

import importlib
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import dolfinx
import numpy as np
from dolfinx import fem, jit
from mpi4py import MPI

from riser_soil.core import compiled
from riser_soil.core.arrays import Array, IntArray
from riser_soil.soil.ffcx_compat import quiet_compiler_log

WORKSPACE = 1 << 22  # bytes that the code of one element needs, and more
STALE_AFTER = 120.0  # s; the code compiled for one element takes a few seconds


@dataclass(frozen=True, eq=False)
class Nodes:
    """Lagrange nodes of this rank's part of a mesh, owned ones first, then ghosts.

    cells (nc, nn): local node numbers of the cells this rank owns, in basix' order (vertices first). points
    (n, 3): m. number (n,): global node number; rank by rank, contiguous. owned: how many this rank owns.
    """

    comm: MPI.Intracomm
    cells: IntArray
    points: Array
    number: IntArray
    owned: int


def mesh_from_gmsh(model: Any, comm: MPI.Intracomm, unit: float = 1.0) -> tuple[Any, IntArray]:
    """dolfinx mesh [m] of the gmsh model that lives on rank 0, distributed over the ranks, and the physical group of
    each cell that this rank owns (nc,); collective. unit: the model's, of length [m].
    """
    made = _gmsh_module().model_to_mesh(model, comm, 0, gdim=3)
    mesh, tags = (made.mesh, made.cell_tags) if hasattr(made, "mesh") else made[:2]
    mesh.geometry.x[:] *= unit
    group = np.zeros(mesh.topology.index_map(mesh.topology.dim).size_local, dtype=np.int64)
    owned = tags.indices < len(group)
    group[tags.indices[owned]] = tags.values[owned]
    return mesh, group


def lagrange_nodes(mesh: Any, degree: int, comm: MPI.Intracomm) -> Nodes:
    """Nodes of the continuous Lagrange space of this degree (collective; 0.5 compiles code the first time).

    The arrays outlive the mesh; `comm` is the caller's, since the mesh frees its own copy.
    """
    quiet_compiler_log()
    cache = writable_cache(comm)
    remove_stale_locks(comm, cache)
    space = _function_space(mesh, degree, cache)
    index_map = space.dofmap.index_map
    owned_cells = mesh.topology.index_map(mesh.topology.dim).size_local
    local = np.arange(index_map.size_local + index_map.num_ghosts, dtype=np.int32)
    return Nodes(
        comm,
        _table(space.dofmap)[:owned_cells].astype(np.int64),
        np.array(space.tabulate_dof_coordinates(), dtype=np.float64),
        np.asarray(index_map.local_to_global(local), dtype=np.int64),
        int(index_map.size_local),
    )


def jit_cache() -> Path:
    """Folder in which dolfinx keeps its compiled code."""
    options = jit.get_options() if hasattr(jit, "get_options") else jit.get_parameters()
    return Path(options["cache_dir"])


def _gmsh_module() -> Any:
    name = "gmshio" if hasattr(dolfinx.io, "gmshio") or _release() < (0, 10) else "gmsh"
    return importlib.import_module(f"dolfinx.io.{name}")


def _release() -> tuple[int, int]:
    major, minor = dolfinx.__version__.split(".")[:2]
    return int(major), int(minor)


def _function_space(mesh: Any, degree: int, cache: Path) -> Any:
    options = {"cache_dir": str(cache)}
    if hasattr(fem, "functionspace"):
        return fem.functionspace(mesh, ("Lagrange", degree), jit_options=options)
    return fem.FunctionSpace(mesh, ("Lagrange", degree), jit_params=options)


def values_of_cells(mesh: Any, size: int) -> tuple[Any, IntArray]:
    """A function with `size` numbers in each cell of a mesh that one rank has alone, and where they stand in its array
    (nc, size).
    """
    quiet_compiler_log()
    if hasattr(fem, "functionspace"):
        space = fem.functionspace(mesh, ("DG", 0, (size,)))
    else:
        space = fem.VectorFunctionSpace(mesh, ("DG", 0), dim=size)
    return fem.Function(space), size * _table(space.dofmap) + np.arange(size)


class CellExpression:
    """A vector (k,) in UFL in the middle of each cell of a mesh that one rank has alone, compiled."""

    def __init__(self, mesh: Any, vector: Any) -> None:
        quiet_compiler_log()
        middle, cache = np.full((1, mesh.topology.dim), 0.5), {"cache_dir": str(writable_cache(MPI.COMM_SELF))}
        self._since_06 = hasattr(fem, "functionspace")
        options: dict[str, Any] = {"jit_options" if self._since_06 else "jit_params": cache}
        self._expression = fem.Expression(vector, middle, **options)
        self._mesh = mesh
        self._cells = np.arange(mesh.topology.index_map(mesh.topology.dim).size_local, dtype=np.int32)

    def values(self) -> Array:
        """(nc, k)."""
        where = (self._mesh, self._cells) if self._since_06 else (self._cells,)
        return np.asarray(self._expression.eval(*where)).reshape(len(self._cells), -1)


def _table(dofmap: Any) -> Any:
    """Dofs by cell as a 2-d array: an adjacency list in 0.5, an array since; a rank may have no cells."""
    dofs = dofmap.list.array if hasattr(dofmap.list, "array") else dofmap.list
    return np.asarray(dofs).reshape(-1, dofmap.dof_layout.num_dofs)


def writable_cache(comm: MPI.Intracomm) -> Path:
    """Where dolfinx keeps its code; the kernels' cache where it can't be written. The same on all ranks; collective."""
    cache = jit_cache()
    if comm.rank == 0:
        try:
            compiled.require_room(cache, WORKSPACE)
        except OSError as err:
            cache = compiled.FOLDER / "fenics"
            compiled.tell(f"the cache of compiled elements can't be written ({err}); {cache} is used")
    return Path(comm.bcast(str(cache)))


def remove_stale_locks(comm: MPI.Intracomm, cache: Path) -> None:
    """A process killed while it compiled leaves a lock on which every later run waits and then fails."""
    if comm.rank == 0:
        for source in cache.glob("libffcx_*.c"):
            if not source.with_suffix(".c.cached").exists() and _age(source) > STALE_AFTER:
                source.unlink(missing_ok=True)
    comm.barrier()


def _age(file: Path) -> float:
    """Seconds since the file was written; 0 if it has gone."""
    return time.time() - file.stat().st_mtime if file.exists() else 0.0
