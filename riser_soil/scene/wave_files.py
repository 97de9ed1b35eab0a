"""Files of waves: spectra as tables or netCDF, and records of the surface's elevation."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

from riser_soil.core.lazy import LazyModule
from riser_soil.core.quantities import NEAREST
from riser_soil.scene.columns import LENGTH, TIME, increasing, read_columns
from riser_soil.scene.files import wrong_file
from riser_soil.scene.netcdf_variables import NetcdfVariable, is_netcdf, read_variables

if TYPE_CHECKING:
    import numpy as np
else:
    np = LazyModule("numpy")

TURN = 2.0 * math.pi
_FREQUENCY = {"Hz": TURN, "rad/s": 1.0}
_DENSITY = {"m2/Hz": 1.0 / TURN, "m2 s/rad": 1.0}
_UNEVEN = 1e-3  # of the step of directions
_MOST_DIRECTIONS = 360
_LEAST_ROWS = 16


@dataclass(frozen=True)
class SpectrumTable:
    """Spectral density of the surface [m2 s/rad] by increasing frequency [rad/s], linear between the rows, 0 beyond.

    toward: (m,) directions towards which the waves travel [rad] from x towards y, where the file has some, and by
    frequency the part of the density (n, m) that each has.
    """

    frequency: tuple[float, ...]
    density: tuple[float, ...]
    toward: tuple[float, ...] = ()
    parts: tuple[tuple[float, ...], ...] = ()

    @cached_property
    def energy(self) -> float:
        """Variance of the surface [m2], by the trapezoidal rule, which is exact for straight pieces."""
        pieces = zip(pairwise(self.frequency), pairwise(self.density), strict=True)
        return math.fsum(0.5 * (b - a) * (p + q) for (a, b), (p, q) in pieces)

    @property
    def peak(self) -> float:
        """Frequency of the largest density [rad/s]."""
        return self.frequency[self.density.index(max(self.density))]


def read_spectrum(file: Path, at: Mapping[str, int], north: float) -> SpectrumTable:
    """PydanticCustomError, with the file and its line or variable, for what is wrong.

    at: place of other dimensions, such as time, of a netCDF file. north: its direction in the scene [rad].
    """
    if is_netcdf(file):
        return _by_direction(file, at, north)
    columns = read_columns(file, {"frequency": _FREQUENCY, "density": _DENSITY}, ("frequency", "density"))
    w, density = columns.values["frequency"], columns.values["density"]
    increasing(columns, w, "frequency")
    if columns.rows and w[0] < NEAREST:
        raise wrong_file(f"{file}:{columns.lines[0]}: frequencies must be greater than 0; leave the row out")
    for line, value in zip(columns.lines, density, strict=True):
        if value < 0.0:
            raise wrong_file(f"{file}:{line}: density {value:g} is negative; correct it")
    return _sea(file, SpectrumTable(w, density))


def _sea(file: Path, table: SpectrumTable) -> SpectrumTable:
    if len(table.frequency) < 2:
        raise wrong_file(f"{file}: a spectrum of {len(table.frequency)} rows; it takes two at least")
    if not any(table.density):
        raise wrong_file(f"{file}: all densities are 0: that is no sea; correct them")
    return table


def _by_direction(file: Path, at: Mapping[str, int], north: float) -> SpectrumTable:
    """Spectrum from the variables freq [Hz], dir [deg] and efth [m2 s/deg], or m2 s without dir, as wavespectra writes
    them.

    A direction is that from which waves come, clockwise from north, unless its standard name says `to_direction`.
    """
    variables = read_variables(file)
    for name in ("freq", "efth"):
        if name not in variables:
            raise wrong_file(f"{file}: has no variable {name}; write it by wavespectra, with freq, dir and efth")
    w = TURN * np.atleast_1d(variables["freq"].values)
    if not (np.diff(w) >= NEAREST).all() or not w[0] >= NEAREST:
        raise wrong_file(f"{file}: freq must be greater than 0 and increase; sort the frequencies")
    efth = _one_sea(file, variables["efth"], at)
    if "dir" not in efth.dims:
        return _sea(file, SpectrumTable(_tuple(w), _tuple(_checked(file, efth.along("freq")) / TURN)))
    toward, width = _toward(file, variables["dir"], north)
    per_degree = math.degrees(1.0) if "rad" in str(efth.attributes.get("units", "")) else 1.0
    parts = _checked(file, efth.along("freq", "dir")) * width / per_degree / TURN
    some = parts.any(axis=0)
    rows = tuple(_tuple(row) for row in parts[:, some])
    return _sea(file, SpectrumTable(_tuple(w), _tuple(parts.sum(axis=1)), _tuple(toward[some]), rows))


def _one_sea(file: Path, efth: NetcdfVariable, at: Mapping[str, int]) -> NetcdfVariable:
    """Density at the places that are asked for; a dimension of one place needs none."""
    if "freq" not in efth.dims:
        raise wrong_file(f"{file}: efth has no dimension freq, but {', '.join(efth.dims)}; write it by wavespectra")
    others = {dim: size for dim, size in zip(efth.dims, efth.values.shape, strict=True) if dim not in ("freq", "dir")}
    for dim in at:
        if dim not in others:
            raise wrong_file(f"{file}: efth has no dimension {dim}, but {', '.join(efth.dims)}; correct at")
    for dim, size in others.items():
        if dim not in at and size != 1:
            raise wrong_file(f"{file}: has {size} seas along {dim}; choose one by at: {{{dim}: 0}} to {size - 1}")
        if not 0 <= at.get(dim, 0) < size:
            raise wrong_file(f"{file}: has no {dim} {at[dim]}; choose 0 to {size - 1}")
    return efth.at({dim: at.get(dim, 0) for dim in others})


def _toward(file: Path, direction: NetcdfVariable, north: float) -> tuple["np.ndarray", float]:
    """Directions of travel (m,) [rad] in the scene, and the width [deg] that each stands for."""
    given = np.atleast_1d(direction.values)
    ordered = np.sort(given % 360.0)
    steps = np.diff(ordered, append=ordered[0] + 360.0)
    width = float(steps.min())
    even = np.abs(np.sort(steps)[:-1] - width).max(initial=0.0) <= _UNEVEN * width  # but for a gap beside a sector
    if not 2 <= given.size <= _MOST_DIRECTIONS or width <= 0.0 or not even:
        raise wrong_file(f"{file}: dir must be 2 to {_MOST_DIRECTIONS} directions at even steps; interpolate them")
    to = "to_direction" in str(direction.attributes.get("standard_name", ""))
    return north - np.radians(given + (0.0 if to else 180.0)), width


def _checked(file: Path, density: "np.ndarray") -> "np.ndarray":
    if not (density >= 0.0).all():
        raise wrong_file(f"{file}: efth has negative or missing densities; correct them, or choose another sea")
    return density


def _tuple(values: "np.ndarray") -> tuple[float, ...]:
    return tuple(map(float, values))


@dataclass(frozen=True)
class ElevationRecord:
    """Elevation [m] above its mean, (n,) at even steps of time [s]."""

    step: float
    elevation: tuple[float, ...]

    @property
    def duration(self) -> float:
        """Time [s] after which the record's waves repeat themselves."""
        return self.step * len(self.elevation)

    @property
    def significant_height(self) -> float:
        """Four standard deviations [m]."""
        return 4.0 * math.sqrt(math.fsum(z * z for z in self.elevation) / len(self.elevation))

    @property
    def mean_period(self) -> float:
        """Duration over the number of times that the mean is crossed upwards [s]."""
        return self.duration / max(1, sum(a < 0.0 <= b for a, b in pairwise(self.elevation)))

    def of_waves(self, numbers: range) -> "ElevationRecord":
        """A spectrum with the waves alone that have these numbers of periods in the record."""
        waves = np.fft.rfft(self.elevation)
        waves[: numbers.start] = waves[numbers.stop :] = 0.0
        return ElevationRecord(self.step, tuple(map(float, np.fft.irfft(waves, len(self.elevation)))))


def read_elevation(file: Path) -> ElevationRecord:
    """PydanticCustomError, with the file and its line, for what is wrong."""
    columns = read_columns(file, {"t": TIME, "elevation": LENGTH}, ("t", "elevation"))
    t, z = columns.values["t"], columns.values["elevation"]
    if columns.rows < _LEAST_ROWS:
        raise wrong_file(f"{file}: a record of {columns.rows} rows; it takes {_LEAST_ROWS} at least")
    increasing(columns, t, "t")
    step = (t[-1] - t[0]) / (len(t) - 1)
    for line, (a, b) in zip(columns.lines[1:], pairwise(t), strict=True):
        if abs(b - a - step) > _UNEVEN * step:
            how = f"a step of {b - a:g} s among steps of {step:g} s"
            raise wrong_file(f"{file}:{line}: {how}; sample the record at even steps")
    mean = math.fsum(z) / len(z)
    if not any(value != mean for value in z):
        raise wrong_file(f"{file}: all elevations are the same: that is no sea; correct them")
    return ElevationRecord(step, tuple(value - mean for value in z))
