"""Files of waves: a record of the surface's elevation."""

import math
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

from riser_soil.core.lazy import LazyModule
from riser_soil.scene.columns import LENGTH, TIME, increasing, read_columns
from riser_soil.scene.files import wrong_file

if TYPE_CHECKING:
    import numpy as np
else:
    np = LazyModule("numpy")

_UNEVEN = 1e-3  # of the mean step: what rounding of the times in a file may leave
_LEAST_ROWS = 16


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
        """With the waves alone that have these numbers of periods in the record."""
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
