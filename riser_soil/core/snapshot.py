"""Results of states for the recorder, as plain arrays in SI units, global axes (z up): the record of a line, the soil.

nn riser nodes in the order of the arc length; nv points and nc cells of the soil's output mesh.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, IntArray


class ExtremeAlong(NamedTuple):
    """The largest or least value along the riser, largest ones between nodes too, and its arc length [m]."""

    value: Array | float
    arc: Array | float


@dataclass(frozen=True, eq=False)
class SoilSnapshot:
    """The soil at one instant; displacement relative to the geostatic start."""

    displacement: Array  # (nv, 3) m
    mean_stress: Array  # (nc,) Pa, cell averages, positive in compression, beyond the water pressure at rest
    von_mises: Array  # (nc,) Pa, cell averages
    strength_used: Array  # (nc,) equivalent stress over its limit, cell averages; 0 where there is no limit
    plastic_strain: Array  # (nc,) equivalent plastic strain, cell averages
    requested: Mapping[str, Array] = field(default_factory=dict)  # (nc,) or (nc, 9), cell averages: output.soil_fields


@dataclass(frozen=True, eq=False)
class SoilMesh:
    """The soil's output mesh: hexahedra, linear or quadratic tetrahedra, in VTK's node order."""

    points: Array  # (nv, 3) m
    cells: IntArray  # (nc, 8), (nc, 4) or (nc, 10)


class Record(Mapping[str, Array]):
    """All that is known of a line and its contact: each quantity by its name, an array with the instants in front.

    arc (nn,): unstressed arc length of the nodes from the start [m]. Quantities that `outputs` has are by its names,
    with its units, places and signs. Others, which these and the summary follow from:

    least_tension [N], largest_moment [N m], largest_curvature [1/m], largest_bend_utilisation: along the riser, between
    nodes too, each with its place `…_arc` [m]; tightest_radius [m]: where the bend utilisation is largest;
    start_tangent, end_tangent (3,): unit tangents in the direction of growing arc length; most_used_stress (nn,): von
    Mises' stress on the side with the larger utilisation [Pa]; code_largest, code_place (m,): the largest utilisation
    of each code check, and its arc length [m]; smooth_misfit, steep_misfit (ne,): of the elements' bending, see
    `results.bending_misfit` [N m].

    A quantity that is not known, or not wanted, is not there. Each may be had as an attribute, too: `record.position`.
    Of one instant the arrays have no axis for the instants.
    """

    def __init__(self, arc: Array, values: Mapping[str, Array | None]) -> None:
        self.arc = arc
        self._values = {name: value for name, value in values.items() if value is not None}

    def __getitem__(self, name: str) -> Array:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __getattr__(self, name: str) -> Array:
        if name.startswith("_") or name not in self._values:
            raise AttributeError(name)
        return self._values[name]

    def extreme(self, name: str) -> ExtremeAlong | None:
        """A largest or least value along the riser, with its place."""
        return ExtremeAlong(self[name], self[f"{name}_arc"]) if name in self else None

    def at(self, index: Any) -> Record:
        """The record of the instants, of many, that an index of their axis selects; one, by its number, without it."""
        return Record(self.arc, {name: value[index] for name, value in self.items()})


Records = Mapping[str, Record]
"""Records of all lines by their names, "" of the only one."""


def stacked(records: Sequence[Mapping[str, Array]]) -> dict[str, Array]:
    """Values of single instants, all of the same quantities, one after another."""
    return {name: np.stack([each[name] for each in records]) for name in records[0]}


class StepStatistics(NamedTuple):
    """Solver statistics of one accepted step."""

    newton_iterations: int
    time_step: float  # s; in a static stage the increment of the load factor
    energy_residual: float  # J, of this step's energy balance; nan in a static stage
    step_cuts: int  # failed attempts before this step was accepted
    local_error: float = 0.0  # m, largest local error of a place in this step; 0 in a static stage


@dataclass(frozen=True)
class Ledger:
    """Energy of the whole model [J]: stored now, and turned over since the stage began.

    numerical: removed by the time scheme, negative where it put energy in; see `riser_soil.results.energy_ledger`.
    ahead: removed by forces of contact and soil, which act with their value at the end of a step, beyond their mean.
    residual = change of (kinetic + strain + potential) + dissipated + numerical - work, positive when energy appears
    from nowhere; nan in a static stage, whose first shape need not be an equilibrium.
    turned_over: the largest yet of kinetic energy, strain energy, energy dissipated, and work, by their sizes; the
    potential's zero is anywhere.
    dissipated_by, work_by: what adds up to `dissipated` and `work`, by part; "supports" are the ends that move.
    """

    kinetic: float = 0.0
    strain: float = 0.0
    potential: float = 0.0
    dissipated: float = 0.0
    numerical: float = 0.0
    work: float = 0.0
    residual: float = 0.0
    turned_over: float = 0.0
    ahead: float = 0.0
    dissipated_by: Mapping[str, float] = field(default_factory=dict)
    work_by: Mapping[str, float] = field(default_factory=dict)

    @property
    def made(self) -> float:
        """Energy that the time scheme itself has removed [J], negative where it added some: `numerical`, less the share
        of the other sign that is due to forces ahead of their mean.
        """
        whole = self.numerical + self.ahead
        if self.numerical * self.ahead >= 0.0:
            return self.numerical
        return whole if whole * self.numerical > 0.0 else 0.0

    @property
    def stored(self) -> float:
        return self.kinetic + self.strain + self.potential

    @property
    def relative_residual(self) -> float:
        """Residual over the energy turned over; nan where there is none."""
        return self.residual / self.turned_over if self.turned_over > 0.0 else float("nan")


class StepRecord(NamedTuple):
    """Record of an accepted step."""

    t: float  # s since the stage began; in a static stage the load factor
    health: StepStatistics
    ledger: Ledger


@dataclass(frozen=True)
class CodeCheckFacts:
    """One check of one line type: its code, words, clause, and the variable of results.nc with its utilisation.

    limit_state: or design case; "" where the code knows none, as safety_class.
    """

    line_type: str
    code: str
    check: str
    clause: str
    variable: str
    limit_state: str
    safety_class: str


@dataclass(frozen=True)
class RunFacts:
    """Facts about a run, known before its first step."""

    title: str
    version: str
    ranks: int
    built: tuple[str, ...]  # names of the parts that were built
    left_out: dict[str, str] = field(default_factory=dict)  # part -> reason
    warnings: tuple[str, ...] = ()  # what was doubtful about the scene before its first step
    versions: dict[str, str] = field(default_factory=dict)  # of Python and the packages that the run uses
    dissipating: tuple[str, ...] = ()  # names that may stand in the ledger's dissipated_by
    working: tuple[str, ...] = ()  # names that may stand in the ledger's work_by
    riser_dofs: int = 0
    soil_dofs: int = 0
    diameter: float = float("nan")  # m, the riser's largest
    weight: float = float("nan")  # N, of the whole riser by its heaviest part
    contact_period: float = float("nan")  # s, of the riser on its contact's stiffness; nan where nothing touches
    on_soil: str = ""  # of several lines the one that lies on the soil
    sections: int = 0  # across the riser in which the soil's settlement is recorded
    offsets: tuple[float, ...] = ()  # m, places along the sections
    code_checks: Mapping[str, tuple[CodeCheckFacts, ...]] = field(default_factory=dict)  # by line
