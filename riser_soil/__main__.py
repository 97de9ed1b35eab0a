"""Command line interface: the commands of `riser_soil.commands.app`.

Exit status 0 done, 2 bad input, 3 the solve failed, 4 the disk or standard output took no more, 128 + n for signal n.
"""

import gc
import os
import sys
import tempfile

from riser_soil.commands.app import app
from riser_soil.core.environment import rank
from riser_soil.errors import Interruption, WriteError
from riser_soil.interruption import handling_signals, latest
from riser_soil.standard_output import failsafe_output

ALLOCATIONS = 400_000  # between two looks for unreachable objects, which a start makes few of; 700 by default


def main() -> None:
    """Entry point of the console script."""
    gc.set_threshold(ALLOCATIONS)
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")  # sought among all packages that are installed
    os.environ["PETSC_OPTIONS"] = f"-no_signal_handler {os.environ.get('PETSC_OPTIONS', '')}"
    with failsafe_output() as output:
        status = _status()
    if output.failure is not None:
        with failsafe_output():
            print(f"standard output: cannot be written: {output.failure.strerror}", file=sys.stderr)
        status = status or WriteError.exit_status
    gc.freeze()  # the process ends: nothing is gained by the last looks, which Python takes all the same
    sys.exit(status)


def _status() -> int:
    status = 0
    try:
        with handling_signals():
            _replace_missing_tmpdir()
            app()
    except Interruption:
        pass
    except SystemExit as leave:
        status = int(leave.code or 0)
    end = latest()
    if end is not None and not end.announced:
        print(end, file=sys.stderr)
        status = end.exit_status
    return status


def _replace_missing_tmpdir() -> None:
    """MPI and compilers end with pages of text where TMPDIR is no folder that can be written."""
    given = os.environ.get("TMPDIR")
    if given is not None and not os.access(given, os.W_OK | os.X_OK):
        del os.environ["TMPDIR"]
        if rank() == 0:
            print(f"TMPDIR={given}: is no folder that can be written; {tempfile.gettempdir()} is used", file=sys.stderr)


if __name__ == "__main__":
    main()
