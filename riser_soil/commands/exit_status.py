"""How commands end: expected errors by their message alone, told once under mpirun, with their exit status."""

import os
import sys
import time
import traceback
from collections.abc import Iterator
from contextlib import contextmanager

import typer

from riser_soil.core.environment import rank, size
from riser_soil.errors import Interruption, RiserSoilError, SceneError, WriteError, is_full
from riser_soil.interruption import default_signal_handlers, unmasked

# Packages beyond those of a riser alone that PyPI has, and the extras of the project that bring them. A command tells
# the extra of its own, which brings what else it needs, where that is among them; else the first.
EXTRAS = {
    "scipy": ("tables", "cases"),
    "matplotlib": ("plots", "cases", "report"),
    "PIL": ("plots", "cases", "report"),
    "pyvista": ("plots",),
    "fatpack": ("fatigue",),
    "xarray": ("cases", "fatigue"),
    "dask": ("cases",),
    "distributed": ("cases",),
    "jinja2": ("report",),
    "markupsafe": ("report",),
    "docx": ("report",),
    "weasyprint": ("report",),
    "raschii": ("waves",),
}
# Packages that PyPI has none of that work together.
ELSEWHERE = ("petsc4py", "mpi4py", "dolfinx", "basix", "ufl", "ffcx", "cffi", "gmsh")

# Seconds that a rank leaves to the first one to tell an error that both have met.
_PATIENCE = 5.0


@contextmanager
def expected_errors(extra: str = "") -> Iterator[None]:
    """Tell expected errors by their message alone and leave with their status. extra: the command's own, see EXTRAS."""
    try:
        with unmasked():
            yield
    except RiserSoilError as err:
        _print_once(str(err))
        _end_other_ranks(err.exit_status)
        raise typer.Exit(err.exit_status) from err
    except Interruption as err:
        err.announced = True
        if rank() == 0 or not err.together:
            _print_once(str(err))
        if not err.together:
            _leave_other_ranks(err.exit_status)
        raise typer.Exit(err.exit_status) from err
    except ModuleNotFoundError as err:
        if not (way := _way_to(err.name or "", extra)):
            raise
        _print_once(f"{err.name}: is needed here and not installed; {way}")
        _end_other_ranks(SceneError.exit_status)
        raise typer.Exit(SceneError.exit_status) from err
    except OSError as err:
        if not is_full(err):
            raise
        _print_once(f"{err.filename or 'a file'}: cannot be written: {err.strerror}")
        _end_other_ranks(WriteError.exit_status)
        raise typer.Exit(WriteError.exit_status) from err
    except Exception:
        if size() > 1:
            traceback.print_exc()
        _end_other_ranks(1)
        raise


def _way_to(module: str, extra: str) -> str:
    """The way to install a package that may be absent; "" for those that are always there. extra: the command's own."""
    package = module.partition(".")[0]
    if package in ELSEWHERE:
        return "Debian, conda-forge or the project's Docker image bring it (docs/running.md)"
    if package not in EXTRAS:
        return ""
    bringing = extra if extra in EXTRAS[package] else EXTRAS[package][0]
    return f"pip install 'riser_soil[{bringing}]' brings it"


def _print_once(message: str) -> None:
    """Print an error. As a rule all ranks meet it: the first tells it and ends the job, the others wait."""
    if rank() > 0:
        default_signal_handlers()
        time.sleep(_PATIENCE)
    typer.echo(message, err=True)


def _end_other_ranks(status: int) -> None:
    """Ranks that wait in a collective call for this one would wait for ever."""
    mpi = sys.modules.get("mpi4py.MPI")
    if mpi is not None and size() > 1:
        sys.stderr.flush()
        mpi.COMM_WORLD.Abort(status)


def _leave_other_ranks(status: int) -> None:
    """mpirun ends them, if it is not ending all of them already; an orderly end would wait for them."""
    if size() > 1:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)
