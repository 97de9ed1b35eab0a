"""Versions of Python and of the packages that a run uses, for its summary."""

from __future__ import annotations

import platform
import sys

_PACKAGES = ("numpy", "scipy", "numba", "petsc4py", "mpi4py", "h5py", "dolfinx")


def versions() -> dict[str, str]:
    """Version by name; of the packages those that this process has imported: a riser without soil has no dolfinx."""
    there = {name: sys.modules[name] for name in _PACKAGES if name in sys.modules}
    return {"python": platform.python_version()} | {name: module.__version__ for name, module in there.items()}
