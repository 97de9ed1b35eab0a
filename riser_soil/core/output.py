"""Definition of an output: a quantity with its name, unit, place and evaluation from the snapshots."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Generic, Literal, TypeVar, cast

from riser_soil.core.lazy import LazyModule

if TYPE_CHECKING:
    import numpy as np

    from riser_soil.core.arrays import Array
    from riser_soil.core.snapshot import Record
else:
    np = LazyModule("numpy")

RecordType = TypeVar("RecordType")
Where = Literal["nodes", "model", "summary", "sections", "across", "soil points", "soil cells", "step"]
Need = Literal[
    "",
    "pressures",
    "min_bend_radius",
    "max_tension",
    "wall",
    "wall in space",
    "yield stress",
    "ground",
    "friction",
    "soil",
    "code check",
    "bursting",
    "hoop buckling",
    "propagating buckling",
    "combined loading",
    "bend radius",
    "tension limit",
    "compression",
    "crushing",
    "capacity curve",
]


@dataclass(frozen=True)
class Row:
    """A row of the screen's table: its words, the unit shown, and how many of it are one of SI."""

    words: str
    unit: str = ""
    scale: float = 1.0


@dataclass(frozen=True)
class Figure:
    """A number or vector of the summary, whose extremes over a stage are kept as well.

    name: key in the summary, dotted where it is nested. of: the figure by the output's value. size: 1 or 3. node: index
    by the output's value of the node that it sits on; figures of the soil are largest values, and have the indices of
    all points or cells where they may sit. arc: arc length [m] by the output's value, where it sits between nodes. None
    where there is none. row: on the screen, None for none.
    Of many instants the output's value has one axis more in front, and so have figure, node and arc.
    """

    name: str
    of: Callable[[Any], Any] = lambda value: value
    size: int = 1
    node: Callable[[Any], Any] | None = None
    arc: Callable[[Any], Any] | None = None
    row: Row | None = None

    @property
    def path(self) -> tuple[str, ...]:
        return tuple(self.name.split("."))

    @property
    def placed(self) -> bool:
        """Whether it sits somewhere along the riser."""
        return self.node is not None or self.arc is not None


@dataclass(frozen=True)
class OutputQuantity(Generic[RecordType]):
    """A quantity of the results.

    units, text and sign (what its sign means, where it has one) go into results.nc, with units as UDUNITS writes them.
    get: the value by a `Record`, `SoilSnapshot` or `StepRecord`; without it, that of its name in a `Record`. It is
    (nn,) at nodes, (nv,) at points of the soil, (nc,) in its cells, (ns,) of sections, (ns, m) across them, one number
    in the rest; by three where it is a vector, in global axes. Of many instants all have one axis more in front:
    `position[..., 2]`, not `[:, 2]`.
    needs: what must be known for it. always: recorded along the riser even where the scene does not request it.
    """

    name: str
    symbol: str
    units: str
    text: str
    where: Where
    sign: str = ""
    get: Callable[[RecordType], Any] | None = None
    vector: bool = False
    dtype: str = "f8"
    needs: Need = ""
    always: bool = False
    figures: tuple[Figure, ...] = ()

    def value(self, record: RecordType) -> Any:
        """The quantity's value in a record, with its shape as at `get`; None where it is not known."""
        return cast("Record", record).get(self.name) if self.get is None else self.get(record)

    @property
    def chosen(self) -> bool:
        """Whether the scene says if it is recorded."""
        return self.where in ("nodes", "across", "soil points", "soil cells") and not self.always

    @property
    def numbers(self) -> int:
        """Number of components per node, cell or instant."""
        return 3 if self.vector else 1


def least(name: str, row: Row | None = None) -> Figure:
    """The smallest value along the riser, with its place."""
    return Figure(name, lambda along: along.min(axis=-1), node=lambda along: along.argmin(axis=-1), row=row)


def greatest(name: str, row: Row | None = None) -> Figure:
    """The largest value along the riser, with its place."""
    return Figure(name, lambda along: along.max(axis=-1), node=lambda along: along.argmax(axis=-1), row=row)


def greatest_known(name: str, row: Row | None = None) -> Figure:
    """The largest value along the riser but for nodes where it is nan, with its place."""
    return Figure(
        name, lambda along: np.nanmax(along, axis=-1), node=lambda along: np.nanargmax(along, axis=-1), row=row
    )


def extreme_along(name: str, row: Row | None = None) -> Figure:
    """The largest or least value along the riser where that is known, `ExtremeAlong`, with its place."""
    return Figure(name, lambda extreme: extreme.value, arc=lambda extreme: extreme.arc, row=row)


def greatest_in_soil(name: str, row: Row | None = None) -> Figure:
    """The largest value of the soil's cells, with their places."""
    return Figure(name, lambda cells: cells.max(), node=near_greatest, row=row)


def near_greatest(values: Array) -> Array:
    """Indices of the largest value and of those a millionth below: of equal ones round-off does not choose."""
    top = values.max()
    return (values >= top - 1e-6 * abs(top)).nonzero()[0]


def bend_radius(curvature: Array | float) -> Array:
    """Radius [m] of a curvature [1/m]; infinite for a straight pipe."""
    bent = np.asarray(curvature)
    return np.divide(1.0, bent, out=np.full(bent.shape, np.inf), where=bent > 0.0)


def angle_deg(tangent: Array) -> Array:
    """Angle of a tangent (..., 3) from the horizontal [deg]; positive where the riser rises with its arc."""
    x, y, z = np.moveaxis(tangent, -1, 0).copy()  # of strided numbers the last bit hangs on where numpy puts the result
    return np.asarray(np.degrees(np.arctan2(z, np.hypot(x, y))))


def resultant(vector: Array) -> Array:
    """Size of a vector (..., 3)."""
    x, y, z = np.moveaxis(vector, -1, 0)
    return np.asarray(np.hypot(np.hypot(x, y), z))
