"""Variables of netCDF-4 files that scenes name, decoded as the CF conventions have it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from riser_soil.core.lazy import LazyModule
from riser_soil.scene.files import wrong_file

if TYPE_CHECKING:
    import h5netcdf
    import numpy as np
else:
    h5netcdf = LazyModule("h5netcdf")
    np = LazyModule("numpy")

_MOST_VALUES = 20_000_000


@dataclass(frozen=True)
class NetcdfVariable:
    """An array with the names of its dimensions, nan where a value is missing; and its attributes."""

    dims: tuple[str, ...]
    values: Any
    attributes: Mapping[str, Any]

    def at(self, places: Mapping[str, int]) -> NetcdfVariable:
        """The variable at these places of dimensions, counted from 0; IndexError where there is none."""
        index = tuple(places.get(dim, slice(None)) for dim in self.dims)
        rest = tuple(dim for dim in self.dims if dim not in places)
        return NetcdfVariable(rest, self.values[index], self.attributes)

    def along(self, *dims: str) -> Any:
        """The array with the dimensions in this order."""
        return np.transpose(self.values, [self.dims.index(dim) for dim in dims])


def is_netcdf(file: Path) -> bool:
    """Whether it is a netCDF file, by its name."""
    return file.suffix.lower() in (".nc", ".nc4", ".h5")


def read_variables(file: Path) -> dict[str, NetcdfVariable]:
    """All variables of numbers or text, by name; PydanticCustomError where the file can't be read."""
    try:
        with h5netcdf.File(file, "r") as opened:
            big = sum(int(np.prod(each.shape, dtype=float)) for each in opened.variables.values())
            if big > _MOST_VALUES:
                raise wrong_file(f"{file}: has {big} values, more than {_MOST_VALUES}; cut it to what the scene needs")
            return {name: _decoded(each) for name, each in opened.variables.items()}
    except (OSError, ValueError, KeyError, RuntimeError) as err:
        what = "classic netCDF-3" if file.read_bytes()[:3] == b"CDF" else f"can't be read ({str(err).splitlines()[0]})"
        raise wrong_file(f"{file}: {what}; write it as netCDF-4 (format NETCDF4)") from err


def _decoded(variable: Any) -> NetcdfVariable:
    attributes, values = dict(variable.attrs), np.asarray(variable[...])
    if values.dtype.kind in "iuf":
        missing = np.isin(values, [attributes.get(key, np.nan) for key in ("_FillValue", "missing_value")])
        values = values * float(_one(attributes, "scale_factor", 1.0)) + float(_one(attributes, "add_offset", 0.0))
        values = np.where(missing, np.nan, values)
    dims = tuple(variable.dimensions)
    if values.dtype == "S1" and dims:  # words by their letters, along the last dimension
        dims, values = dims[:-1], np.char.rstrip(np.ascontiguousarray(values).view(f"S{values.shape[-1]}")[..., 0])
    return NetcdfVariable(dims, values, attributes)


def _one(attributes: Mapping[str, Any], name: str, default: float) -> Any:
    return np.ravel(attributes.get(name, default))[0]
