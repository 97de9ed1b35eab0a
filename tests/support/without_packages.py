"""riser-soil as it runs where packages are not installed: python -m tests.support.without_packages NAMES COMMAND …"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from typing import Any

from tests.support.on_ranks import ROOT, environment

SOIL = ("dolfinx", "petsc4py", "mpi4py", "gmsh", "ufl", "basix")
FOR_USERS = ("scipy", "matplotlib", "pyvista", "vtk", "fatpack", "xarray", "distributed", "jinja2")  # of the extras


class Without:
    """A finder of modules that does not see some packages."""

    def __init__(self, finder: Any, hidden: Sequence[str]) -> None:
        self._finder, self._hidden = finder, hidden

    def find_spec(self, name: str, path: Any = None, target: Any = None) -> Any:
        return None if name.partition(".")[0] in self._hidden else self._finder.find_spec(name, path, target)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._finder, name)


def riser_soil_without(hidden: Sequence[str], *arguments: str) -> subprocess.CompletedProcess[str]:
    """A command of riser-soil in a process that can't import some packages."""
    command = [sys.executable, "-m", "tests.support.without_packages", ",".join(hidden), *arguments]
    return subprocess.run(command, cwd=ROOT, env=environment(), capture_output=True, text=True)


if __name__ == "__main__":
    hidden = sys.argv[1].split(",")
    sys.meta_path[:] = [Without(finder, hidden) for finder in sys.meta_path]
    sys.argv[:] = ["riser-soil", *sys.argv[2:]]
    from riser_soil.__main__ import main

    main()
