"""Small netCDF files in the forms of other programs."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import h5netcdf
import numpy as np

Variables = Mapping[str, tuple[tuple[str, ...], Any]]


def write_netcdf(file: Path, variables: Variables, attributes: Mapping[str, Mapping[str, Any]] | None = None) -> None:
    """Variables by name with their dimensions, whose sizes are those of the arrays."""
    with h5netcdf.File(file, "w") as out:
        out.dimensions = {
            dim: size
            for dims, values in variables.values()
            for dim, size in zip(dims, np.shape(values), strict=True)
        }
        for name, (dims, values) in variables.items():
            array = np.asarray(values)
            stored = array.astype(object) if array.dtype.kind == "U" else array
            dtype = h5netcdf.core.h5py.string_dtype() if array.dtype.kind == "U" else array.dtype
            written = out.create_variable(name, dims, dtype, data=stored)
            written.attrs.update((attributes or {}).get(name, {}))
