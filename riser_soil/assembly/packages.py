"""Packages that a scene needs beyond those of lines alone: asked for before anything is built, told in one line."""

from __future__ import annotations

import importlib.util
from collections.abc import Sequence

from riser_soil.core.communicator import Communicator, world
from riser_soil.errors import SceneError
from riser_soil.scene.scene import Scene
from riser_soil.solve.newton_settings import MOST_JOINTS

FOR_SOIL = {"dolfinx": "dolfinx", "petsc4py": "PETSc", "mpi4py": "MPI", "gmsh": "gmsh", "scipy": "scipy"}
FOR_SNES = {"petsc4py": "PETSc", "mpi4py": "MPI"}
PROVIDED = (
    "Debian: apt install {debian}; conda-forge: conda install {conda}; Docker: the project's image (docs/running.md)"
)
DEBIAN = {name: f"python3-{name}" for name in FOR_SOIL}
CONDA = {"dolfinx": "fenics-dolfinx", "gmsh": "python-gmsh"}


def communicator_of(scene: Scene) -> Communicator:
    """The processes that a scene is solved on; SceneError where packages are missing that it needs."""
    if scene.soil is not None:
        require("soil", FOR_SOIL)
    elif scene.solver.by_snes:
        require("solver.newton: snes" if scene.solver.newton == "snes" else "solver.petsc_options", FOR_SNES)
    elif len(scene.joints) > MOST_JOINTS:
        require("joints", FOR_SNES)
    elif scene.joints:
        require("joints", {"scipy": "scipy"})
    return world(with_mpi=needs_petsc(scene))


def needs_petsc(scene: Scene) -> bool:
    """Whether a scene is solved with PETSc; lines and bodies alone are not, unless SNES is asked for."""
    return scene.soil is not None or scene.solver.by_snes or len(scene.joints) > MOST_JOINTS


def require(key: str, packages: dict[str, str]) -> None:
    """Raise SceneError where any of the packages can't be found."""
    missing = [name for name in packages if importlib.util.find_spec(name) is None]
    if missing:
        raise SceneError(f"{key}: needs {_listed([*packages.values()])}; {_said(missing, packages)}. {_way(missing)}")


def _said(missing: Sequence[str], packages: dict[str, str]) -> str:
    names = _listed([packages[name] for name in missing])
    return f"{names} {'is' if len(missing) == 1 else 'are'} not installed"


def _way(missing: Sequence[str]) -> str:
    debian, conda = (" ".join(names.get(each, each) for each in missing) for names in (DEBIAN, CONDA))
    return PROVIDED.format(debian=debian, conda=conda)


def _listed(names: Sequence[str]) -> str:
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last
