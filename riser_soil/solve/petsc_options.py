"""PETSc's options under the project's prefix, as -riser_soil_snes_monitor: of a scene, of PETSC_OPTIONS or of .petscrc.

They are in PETSc's own database, where its objects look for them. An option that no object has looked for is an error:
what is misspelt, or what the solvers in use don't have, is not passed over in silence.
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from difflib import get_close_matches
from typing import NamedTuple

from petsc4py import PETSc

from riser_soil.errors import SceneError

PREFIX = "riser_soil_"
WHERE = "(PETSC_OPTIONS or solver.petsc_options)"
OWN = {  # options that SNES would read and nothing would follow, and why
    "snes_convergence_test": "the test is the project's, by solver.tolerance; give snes_rtol, snes_atol or snes_stol",
    "snes_divergence_tolerance": "a step is given up where its residual has grown a million times; leave it out",
    "snes_max_funcs": "evaluations are not limited; give snes_max_it",
    "snes_force_iteration": "the project's test asks for an iteration where one is due; leave it out",
}
COMMON = (
    *("snes_monitor", "snes_converged_reason", "snes_view", "snes_rtol", "snes_atol", "snes_stol", "snes_max_it"),
    *("snes_type", "snes_linesearch_type", "snes_linesearch_monitor", "snes_lag_jacobian", "ksp_type", "ksp_rtol"),
    *("ksp_monitor", "ksp_converged_reason", "ksp_view", "pc_type", "pc_factor_mat_solver_type", "mat_mumps_icntl_14"),
)
_BARE = {None: None, True: None, False: "false"}


def user_options() -> dict[str, str | None]:
    """The user's options, without the prefix; None for those without a value."""
    options = PETSc.Options().getAll()
    return {name.removeprefix(PREFIX): value for name, value in options.items() if name.startswith(PREFIX)}


class UserOptions(NamedTuple):
    """What the user's options replace. any: whether there are some; tolerances: the program's test of convergence;
    line_search, linear_solver: its own; linear_tolerance: that of its linear systems.
    """

    any: bool
    tolerances: bool
    line_search: bool
    linear_solver: bool
    linear_tolerance: bool

    @classmethod
    def now(cls) -> UserOptions:
        """By the options in PETSc's database."""
        names = user_options().keys()
        one_of = (
            ("snes_rtol", "snes_atol", "snes_stol"),
            ("snes_linesearch_type", "snes_type"),
            ("ksp_type", "pc_type", "pc_factor_mat_solver_type"),
            ("ksp_rtol", "snes_ksp_ew"),
        )
        return cls(bool(names), *(not names.isdisjoint(some) for some in one_of))

    def small(self, snes: PETSc.SNES, iteration: int, x: float, step: float, f: float) -> bool:
        """Whether a residual is small by the tolerances of SNES, as its own test would have it. x, step, f: norms."""
        rtol, atol, stol, _ = snes.getTolerances()
        if iteration == 0:
            snes.setAttr("first", f)
        return f <= atol or (iteration > 0 and (f <= rtol * snes.getAttr("first") or step <= stol * x))


def as_text(options: Iterable[tuple[str, object]]) -> dict[str, str | None]:
    """Options of a scene as PETSc reads them: true, or no value, is an option by its name alone."""
    return {name: _BARE[value] if isinstance(value, bool | None) else str(value) for name, value in options}


@contextmanager
def defaults(options: Mapping[str, str | None]) -> Iterator[None]:
    """Options under the project's prefix while the block lasts; the user's own win."""
    database, of_user = PETSc.Options(), user_options()
    added = [PREFIX + name for name in options if name not in of_user]
    for name in added:
        database[name] = options[name.removeprefix(PREFIX)]
    try:
        yield
    finally:
        for name in added:
            database.delValue(name)


def set_from_options(snes: PETSc.SNES, options: Mapping[str, str | None]) -> None:
    """Set SNES, its line search, KSP and PC by the user's options, and by these where the user gives none of the name.

    SceneError where one is not the user's to choose, or has a value that PETSc refuses.
    """
    of_user = user_options()
    for name in OWN.keys() & of_user.keys():
        raise SceneError(f"-{PREFIX}{name} {WHERE}: {OWN[name]}")
    try:
        with defaults(options):
            snes.setFromOptions()
    except PETSc.Error as err:
        said = str(err).splitlines()[-1].partition("] ")[2]
        named = [f"{name} {value}" for name, value in of_user.items() if value and value in said.split()]
        raise SceneError(f"-{PREFIX}{', '.join(named) or '*'} {WHERE}: PETSc refuses the value: {said}") from err


def refuse_unread(snes: PETSc.SNES) -> None:
    """SceneError where no object has looked for one of the user's options, though SNES has solved something."""
    for name in user_options():
        if not _is_read(PREFIX + name):
            near = get_close_matches(name, [each for each in COMMON if each != name], n=1)
            meant = f"did you mean {near[0]}? " if near else "leave it out; "
            kinds = f"SNES {snes.getType()}, KSP {snes.getKSP().getType()}, PC {snes.getKSP().getPC().getType()}"
            raise SceneError(
                f"-{PREFIX}{name} {WHERE}: nothing reads it ({kinds}); {meant}PETSc's options of these count, such as "
                f"{', '.join(COMMON)}"
            )


def _is_read(name: str) -> bool:
    """Whether PETSc has looked for an option; petsc4py of PETSc 3.18 lacks this function of its library."""
    used = ctypes.c_int(0)
    ctypes.CDLL(PETSc.__file__).PetscOptionsUsed(None, name.encode(), ctypes.byref(used))
    return bool(used.value)

