"""Heights of the seabed over a grid, read from a file."""

from bisect import bisect_right
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from riser_soil.core.quantities import SHORTEST
from riser_soil.scene.columns import LENGTH, CsvColumns, read_columns
from riser_soil.scene.files import wrong_file


@dataclass(frozen=True)
class HeightGrid:
    """Heights z [m], (nx, ny), at increasing x and y [m], at least two of each."""

    x: tuple[float, ...]
    y: tuple[float, ...]
    z: tuple[tuple[float, ...], ...]

    def holds(self, x: float, y: float) -> bool:
        """Whether a point lies within the grid or on its edge."""
        return self.x[0] <= x <= self.x[-1] and self.y[0] <= y <= self.y[-1]

    def height(self, x: float, y: float) -> float:
        """Height z [m] at a point, bilinear between the grid's points and straight beyond."""
        (i, u), (j, v) = _between(self.x, x), _between(self.y, y)
        first, last = ((1.0 - v) * row[j] + v * row[j + 1] for row in self.z[i : i + 2])
        return (1.0 - u) * first + u * last

    @property
    def extent(self) -> str:
        """Where the grid lies, in words."""
        return f"x from {self.x[0]:g} to {self.x[-1]:g} m, y from {self.y[0]:g} to {self.y[-1]:g} m"


def _between(points: tuple[float, ...], at: float) -> tuple[int, float]:
    """Number of the point before a place, and how far the place is from there to the next one."""
    i = min(max(bisect_right(points, at) - 1, 0), len(points) - 2)
    return i, (at - points[i]) / (points[i + 1] - points[i])


def read_heights(file: Path) -> HeightGrid:
    """Read a table of x, y and z, a row for each point of a grid, in any order; PydanticCustomError, with the file and
    its line, for what is wrong."""
    columns = read_columns(file, dict.fromkeys("xyz", LENGTH), required=("x", "y", "z"))
    found = _points(columns)
    x, y = (tuple(sorted(set(columns.values[name]))) for name in "xy")
    for name, points in (("x", x), ("y", y)):
        if len(points) < 2:
            raise wrong_file(f"{file}: the points have {len(points)} different {name}; a grid needs two at least")
        if min(b - a for a, b in pairwise(points)) < SHORTEST:
            raise wrong_file(f"{file}: two {name} are nearer than {SHORTEST:g} m; round them to the same number")
    if len(found) < len(x) * len(y):
        missing = next((a, b) for a in x for b in y if (a, b) not in found)
        text = f"its {len(found)} points have {len(x)} different x and {len(y)} different y, but there is none at"
        remedy = f"a grid has a row for each x with each y: fill the {len(x) * len(y) - len(found)} gaps"
        raise wrong_file(f"{file}: {text} x = {missing[0]:.10g}, y = {missing[1]:.10g} m; {remedy}")
    return HeightGrid(x, y, tuple(tuple(found[a, b] for b in y) for a in x))


def _points(columns: CsvColumns) -> dict[tuple[float, float], float]:
    """Heights by x and y."""
    found: dict[tuple[float, float], float] = {}
    for line, *at, z in zip(columns.lines, *(columns.values[name] for name in "xyz"), strict=True):
        if (at[0], at[1]) in found:
            text = f"there is a row for x = {at[0]:.10g}, y = {at[1]:.10g} m already; remove one of the two"
            raise wrong_file(f"{columns.file}:{line}: {text}")
        found[at[0], at[1]] = z
    return found
