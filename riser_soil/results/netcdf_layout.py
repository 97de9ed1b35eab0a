"""Layout of a netCDF-4 file, which is one of HDF5: its dimensions are scales, which its variables point to.

Written by h5py, as h5netcdf and the netCDF library do, and as they read it. h5netcdf itself looks through all variables
of a growing dimension whenever it gets another one, and takes a twentieth of the time of a start for that.
Source: Unidata, "NetCDF-4 File Format" (dimensions without a variable, numbers of dimensions).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import h5py
import numpy as np

_CHUNK_BYTES = 65536
_NO_VARIABLE = "This is a netCDF dimension but not a netCDF variable."


@dataclass(frozen=True)
class Variable:
    """One variable; `sign` says what its sign means, where it has one."""

    dims: tuple[str, ...]
    units: str
    long_name: str
    sign: str = ""
    dtype: str | np.dtype[np.object_] = "f8"

    @property
    def attributes(self) -> dict[str, str]:
        """Attributes of the variable that are not empty."""
        words = {"units": self.units, "long_name": self.long_name, "sign_convention": self.sign}
        return {name: text for name, text in words.items() if text}


def lay_out(file: h5py.File, sizes: Mapping[str, int | None], variables: Mapping[str, Variable]) -> None:
    """Add dimensions and variables, which are empty. sizes: of the dimensions, None where one grows."""
    file.attrs["_NCProperties"] = np.bytes_(f"version=2,h5py={h5py.__version__},hdf5={h5py.version.hdf5_version}")
    numbers = {name: np.int32(number) for number, name in enumerate(sizes)}
    paths = (name.split("/")[:-1] for name in [*sizes, *variables])
    for path in dict.fromkeys("/".join(parts[: n + 1]) for parts in paths for n in range(len(parts))):
        file.create_group(path, track_order=True)
    for name, number in numbers.items():
        if name in variables:
            scale, title = _add(file, name, variables[name], sizes, numbers), name
        else:
            size = sizes[name] or 0
            scale = file.create_dataset(name, (size,), ">f4", maxshape=(sizes[name],), track_order=True)
            title = f"{_NO_VARIABLE}{size:10}"
        scale.attrs["_Netcdf4Dimid"] = number
        scale.make_scale(title.rpartition("/")[2])
    for name in [name for name in variables if name not in numbers]:
        made = _add(file, name, variables[name], sizes, numbers)
        for axis, dim in enumerate(variables[name].dims):
            made.dims[axis].attach_scale(file[dim])


def values_in(variable: Variable, sizes: Mapping[str, int | None]) -> int:
    """Count of numbers in one row of a variable."""
    return math.prod(sizes[dim] or 0 for dim in variable.dims[1:])


def _add(
    file: h5py.File,
    name: str,
    variable: Variable,
    sizes: Mapping[str, int | None],
    numbers: Mapping[str, np.int32],
) -> h5py.Dataset:
    most = tuple(sizes[dim] for dim in variable.dims)
    shape = tuple(size or 0 for size in most)
    grows = {"maxshape": most, "chunks": (_rows_in_chunk(variable, sizes), *shape[1:])} if None in most else {}
    made = file.create_dataset(name, shape, variable.dtype, track_order=True, **grows)
    made.attrs["_Netcdf4Coordinates"] = np.array([numbers[dim] for dim in variable.dims])
    for attribute, text in variable.attributes.items():
        made.attrs[attribute] = text
    return made


def _rows_in_chunk(variable: Variable, sizes: Mapping[str, int | None]) -> int:
    rows = _CHUNK_BYTES // (8 * max(1, values_in(variable, sizes)))
    return min(1024, max(1, rows))
