"""results.nc as an xarray dataset in memory: named axes, units, words instead of numbers for the stages."""

from __future__ import annotations

import fcntl
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import xarray as xr


def load(path: Path) -> xr.Dataset:
    """All that is in the file, which is free again then. Raises OSError or ValueError where it can't be read.

    HDF5 does not open the file itself: whoever else has it open, with locks or without, is no hindrance. A run that
    writes it sees the lock that is put on it meanwhile, and leaves this copy of the file as it is.
    """
    import xarray as xr

    with path.open("rb") as file:
        with suppress(OSError):  # a file system without locks
            fcntl.flock(file, fcntl.LOCK_SH)
        found = xr.load_dataset(file, engine="h5netcdf", decode_timedelta=False)
    for coordinate, of in {"stage_name": "stage", "step_stage_name": "step_stage"}.items():
        found = found.assign_coords({coordinate: (found[of].dims, _names(found[of]))})
    return found.set_coords(["stage", "step_stage", "step_time"])


def _names(stage: xr.DataArray) -> np.ndarray:
    """Of the stages by their numbers, blanks as underscores."""
    known = np.array(str(stage.attrs.get("flag_meanings", "")).split(), dtype=str)
    return known[stage.values] if stage.size else np.empty(0, dtype=str)
