"""Snapshots for the recorder: results of a state as plain arrays, SI units, global axes (z up).

nn riser nodes in the order of the arc length; nv points and nc cells of the soil's output mesh. Those of the riser and
its contact are of one state, or of many, by one axis more in front of all arrays.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from riser_soil.core.arrays import Array, IntArray


class ExtremeAlong(NamedTuple):
    """The largest or least value along the riser, largest ones between nodes too, and its arc length [m]."""

    value: Array | float
    arc: Array | float


class WallSnapshot(NamedTuple):
    """Loads and stress of the pipe's wall at the nodes (nn,); stresses are nan where there is no wall, and at a joint
    those of the side with the larger von Mises' stress. Moments about the section's axes, exerted by the part towards
    `end` on the part towards `start`.
    """

    internal_pressure: Array  # Pa
    external_pressure: Array  # Pa
    moment_y: Array  # N.m
    moment_z: Array  # N.m, 0 in a plane
    torque: Array  # N.m, 0 in a plane
    axial_stress: Array  # Pa, of the wall tension, positive in tension
    bending_stress: Array  # Pa >= 0, largest around the outer surface
    hoop_stress: Array  # Pa, at the inner surface, positive in tension
    von_mises_stress: Array  # Pa, largest around, inside and outside
    stress_utilisation: Array | None  # over the allowable stress; None where none is given
    most_used_stress: Array | None  # Pa, von Mises', of the side with the larger utilisation


class CodeSnapshot(NamedTuple):
    """Utilisations by codes at the nodes (nn,), nan where not checked; None where no line type is checked so.

    utilisation: the largest of all. largest (m,): of each check of each line type, and place (m,): its arc length [m].
    """

    utilisation: Array
    largest: Array
    place: Array
    bursting: Array | None = None
    hoop_buckling: Array | None = None
    propagating_buckling: Array | None = None
    combined_loading: Array | None = None
    bend_radius: Array | None = None
    tension_limit: Array | None = None
    compression: Array | None = None
    crushing: Array | None = None
    capacity_curve: Array | None = None


class RiserSnapshot(NamedTuple):
    """The riser at one instant.

    Forces and moments at the ends are exerted by the support on the riser; moments by the right-hand rule.
    """

    position: Array  # (nn, 3) m
    effective_tension: Array  # (nn,) N, positive in tension
    wall_tension: Array | None  # (nn,) N, positive in tension; None where the pressures are unknown
    bending_moment: Array  # (nn,) N.m, magnitude >= 0
    curvature: Array  # (nn,) 1/m, magnitude >= 0
    bend_utilisation: Array | None  # (nn,) curvature times the least bend radius allowed; None where none is given
    least_tension: ExtremeAlong  # N, effective
    largest_moment: ExtremeAlong  # N.m
    largest_curvature: ExtremeAlong  # 1/m
    largest_bend_utilisation: ExtremeAlong  # nan where no least bend radius is given
    tightest_radius: Array | float  # m, where the bend utilisation is largest; the same
    contact_force: Array  # (nn,) N/m, positive where the ground pushes, negative where it holds the riser by suction
    moment_vector: Array  # (nn, 3) N.m, exerted by the part towards `end` on the part towards `start`
    start_force: Array  # (3,) N
    end_force: Array  # (3,) N
    start_moment: Array  # (3,) N.m
    end_moment: Array  # (3,) N.m
    start_tangent: Array  # (3,) unit tangent at the start, in the direction of growing arc length
    end_tangent: Array  # (3,) the same at the end
    tension_utilisation: Array | None = None  # (nn,) effective tension over the largest allowed; None without one
    wall: WallSnapshot | None = None  # None where no wall is given
    code: CodeSnapshot | None = None  # None where no code check is made


@dataclass(frozen=True, eq=False)
class SoilSnapshot:
    """The soil at one instant; displacement relative to the geostatic start."""

    displacement: Array  # (nv, 3) m
    mean_stress: Array  # (nc,) Pa, cell averages, positive in compression, beyond the water pressure at rest
    von_mises: Array  # (nc,) Pa, cell averages
    strength_used: Array  # (nc,) equivalent stress over its limit, cell averages; 0 where there is no limit
    plastic_strain: Array  # (nc,) equivalent plastic strain, cell averages
    asked: Mapping[str, Array] = field(default_factory=dict)  # (nc,) or (nc, 9), cell averages: output.soil_fields


@dataclass(frozen=True, eq=False)
class SoilMesh:
    """The soil's output mesh: hexahedra, linear or quadratic tetrahedra, in VTK's node order."""

    points: Array  # (nv, 3) m
    cells: IntArray  # (nc, 8), (nc, 4) or (nc, 10)


class SectionSnapshot(NamedTuple):
    """The soil's settlement at m offsets across the riser, in ns sections; nan where no section is laid yet."""

    arc: Array  # (ns,) m, of the riser where it lay over the section
    position: Array  # (ns, 3) m, of the riser's axis there
    direction: Array  # (ns, 3) horizontal unit vector of growing offset
    settlement: Array  # (ns, m) m, positive downwards; nan beside the soil


class ContactSnapshot(NamedTuple):
    """Contact of the riser with seabed and soil: touchdown, penetration and contact force."""

    touchdown_arc: Array | float  # m, nan when nothing touches
    touchdown_position: Array  # (3,) m, of the riser's axis there; nan when nothing touches
    touchdown_points: IntArray | int  # places where the riser comes down or leaves the seabed; its ends don't count
    max_penetration: Array | float  # m, 0 when nothing touches
    contact_force: Array  # (3,) N, the sum over the riser, exerted on the riser
    penetration: Array | None = None  # (nn,) m, of the underside into the ground as it is now; None where not wanted
    embedment: Array | None = None  # (nn,) m, greatest depth yet below the ground as it lay at first; the same
    slip: Array | None = None  # (nn,) m, way slid over seabed and soil so far; None without friction, or not wanted
    settlement: Array | None = None  # (nn,) m, of the soil's surface below the nodes, nan beside it; None not wanted
    force_on_soil: Array | None = None  # (nn, 3) N/m, exerted by the riser on the soil; None where not wanted
    sections: SectionSnapshot | None = None  # None without soil, or where not wanted


class Instant(NamedTuple):
    """The riser and its contact at one instant. arc: (nn,) m, unstressed arc length of the nodes from the start."""

    arc: Array
    riser: RiserSnapshot
    touch: ContactSnapshot


Instants = Mapping[str, Instant]
"""Instants of all lines by their names, "" of the only one."""


def instants_at(instants: Instant, at: Any) -> Instant:
    """The instants, of many, that an index of their axis selects; one, by its number, without that axis."""
    both = instants.riser, instants.touch
    return Instant(instants.arc, *(mapped(lambda values: values[at], each) for each in both))


def mapped(change: Callable[..., Any], *values: Any) -> Any:
    """What a function makes of arrays of one place in nested tuples; None stays."""
    first = values[0]
    if first is None:
        return None
    if isinstance(first, tuple):
        return type(first)(*(mapped(change, *each) for each in zip(*values, strict=True)))
    return change(*values)


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

    numerical: taken out by the time scheme, negative where it put energy in; see `riser_soil.results.energy_ledger`.
    ahead: taken by forces of contact and soil, which act with their value at the end of a step, beyond their mean.
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
        """What the time scheme has truly taken out [J], or put in: `numerical`, less what forces ahead of their mean
        book with the other sign.
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
