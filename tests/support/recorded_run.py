"""A run as the recorder sees it, without a solver: a catenary comes down on a block of soil and heaves."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.snapshot import (
    CodeCheckFacts,
    Ledger,
    Record,
    RunFacts,
    SoilMesh,
    SoilSnapshot,
    StepRecord,
    StepStatistics,
)
from riser_soil.core.snapshot import stacked as stacked_values
from riser_soil.results.record import Recorder
from riser_soil.results.schedule import DueOutputs, Schedule

EI, WEIGHT, RADIUS = 5.0e4, 650.0, 0.15  # N.m2, N/m, m
CHECK = CodeCheckFacts(
    "flexible", "DNV-ST-F201", "combined loading", "sec. 5 D", "combined_loading_utilisation", "ULS", "high"
)
FACTS = RunFacts(
    title="Touchdown on soft clay",
    version="0.1.0",
    ranks=1,
    built=("riser", "soil", "contact"),
    left_out={"waves": "the scene has none"},
    riser_dofs=900,
    soil_dofs=9000,
    sections=1,
    offsets=(-1.0, -0.5, 0.0, 0.5, 1.0),
    code_checks={"": (CHECK,)},
)
SCENE = "title: Touchdown on soft clay\nline_types: {flexible: {outer_diameter: 0.3}}\n"


CRITERIA = (
    *("bursting", "hoop_buckling", "propagating_buckling", "combined_loading", "bend_radius"),
    *("tension_limit", "compression", "crushing", "capacity_curve"),
)


def _largest(name: str, arc: Array, values: Array) -> dict[str, Any]:
    return {name: values.max(), f"{name}_arc": arc[values.argmax()]}


def _code(arc: Array, used: Array) -> dict[str, Any]:
    """One check of one line type, as if it were all of them."""
    values = {f"{name}_utilisation": used for name in ("code", *CRITERIA)}
    return values | {"code_largest": np.array([used.max()]), "code_place": np.array([arc[used.argmax()]])}


def _wall(tension: Array, moment: Array) -> dict[str, Any]:
    axial, bending, nothing = tension / 0.02, moment / 1.0e-3, np.zeros_like(moment)
    return {
        "internal_pressure": nothing,
        "external_pressure": nothing,
        "bending_moment_y": -moment,
        "bending_moment_z": nothing,
        "torque": nothing,
        "wall_axial_stress": axial,
        "wall_bending_stress": bending,
        "wall_hoop_stress": nothing,
        "wall_von_mises_stress": axial + bending,
        "stress_utilisation": (axial + bending) / 3.0e8,
        "most_used_stress": axial + bending,
    }


def changed(record: Record, **values: Any) -> Record:
    """With other values, or further ones; None takes one out."""
    return Record(record.arc, {**record, **values})


def stacked(records: Sequence[Record]) -> Record:
    """Single instants as many."""
    return Record(records[0].arc, stacked_values(records))


@dataclass(frozen=True)
class Catenary:
    """Inextensible catenary of parameter a [m] in the plane y = 0 that leaves the seabed at arc s0 [m]."""

    a: float
    s0: float

    def riser(self, arc: Array) -> dict[str, Any]:
        s = np.maximum(0.0, arc - self.s0)
        a, zero = self.a, np.zeros_like(arc)
        x = np.where(arc < self.s0, arc, self.s0 + a * np.arcsinh(s / a))
        z = np.hypot(a, s) - a + RADIUS
        curvature = np.where(arc < self.s0, 0.0, a / (a**2 + s**2))
        tension = WEIGHT * np.hypot(a, s)
        moment = np.stack([zero, -EI * curvature, zero], axis=1)
        top = WEIGHT * np.array([a, 0.0, s[-1]])
        return dict(
            position=np.stack([x, zero, z], axis=1),
            effective_tension=tension,
            wall_tension=tension + 1.0e3,
            bending_moment=EI * curvature,
            curvature=curvature,
            bend_utilisation=20.0 * curvature,
            least_tension=tension.min(),
            least_tension_arc=arc[tension.argmin()],
            **_largest("largest_moment", arc, EI * curvature),
            **_largest("largest_curvature", arc, curvature),
            **_largest("largest_bend_utilisation", arc, 20.0 * curvature),
            tightest_radius=1.0 / curvature.max(),
            contact_force=np.where(arc < self.s0, WEIGHT, 0.0),
            moment_vector=moment,
            start_force=np.array([-WEIGHT * a, 0.0, 0.0]),
            end_force=top,
            start_moment=np.zeros(3),
            end_moment=np.zeros(3),
            start_tangent=np.array([1.0, 0.0, 0.0]),
            end_tangent=top / np.linalg.norm(top),
            tension_utilisation=tension / 2.0e5,
            **_wall(tension, EI * curvature),
            **_code(arc, tension / 3.0e5 + 10.0 * curvature),
        )

    def record(self, arc: Array) -> Record:
        return Record(arc, self.riser(arc) | self.touch(arc))

    def touch(self, arc: Array) -> dict[str, Any]:
        place, force = np.array([self.s0, 0.0, RADIUS]), np.array([0.0, 0.0, WEIGHT * self.s0])
        depth = np.where(arc < self.s0, 0.002, 0.0)
        on_soil = np.stack([0.0 * arc, 0.0 * arc, np.where(arc < self.s0, -WEIGHT, 0.0)], axis=1)
        return {
            "touchdown_arc": np.float64(self.s0),
            "touchdown_position": place,
            "touchdown_points": np.int64(1),
            "max_penetration": np.float64(0.003),
            "contact_force_sum": force,
            "penetration": depth,
            "embedment": 1.5 * depth,
            "slip": 0.1 * depth,
            "soil_settlement": 0.5 * depth,
            "force_on_soil": on_soil,
            **self.sections(),
        }

    def sections(self) -> dict[str, Any]:
        """One section, where the riser lies at first."""
        position, direction = np.array([[30.0, 0.0, RADIUS]]), np.array([[0.0, 1.0, 0.0]])
        trough = 0.002 * np.exp(-((np.array(FACTS.offsets) / 0.6) ** 2))
        return {
            "section_arc": np.array([30.0]),
            "section_position": position,
            "section_direction": direction,
            "settlement_across": trough[None] * (self.s0 > 29.0),
        }


def block(nx: int = 40, ny: int = 10, nz: int = 5, *, tetrahedra: bool = False) -> SoilMesh:
    """Block of 40 x 5 x 2.5 m whose top lies at z = 0."""
    x, y, z = np.linspace(10, 50, nx + 1), np.linspace(-2.5, 2.5, ny + 1), np.linspace(-2.5, 0, nz + 1)
    points = np.stack(np.meshgrid(x, y, z, indexing="ij"), axis=-1).reshape(-1, 3)
    number = np.arange(len(points)).reshape(nx + 1, ny + 1, nz + 1)
    low, high = slice(None, -1), slice(1, None)
    corners = [(low, low), (high, low), (high, high), (low, high)]
    cells = np.stack([number[i, j, k].ravel() for k in (low, high) for i, j in corners], axis=1)
    return SoilMesh(points, _split(cells) if tetrahedra else cells)


def _split(cells: IntArray) -> IntArray:
    """Six tetrahedra for each hexahedron, all around its diagonal 0-6."""
    around = [1, 2, 3, 7, 4, 5, 1]
    return np.concatenate([cells[:, [0, p, q, 6]] for p, q in pairwise(around)])


def soil(mesh: SoilMesh, s0: float) -> SoilSnapshot:
    """A trough of 4 cm below the riser, up to the touchdown point."""
    settlement, stress = _bowl(mesh.points, s0), _bowl(mesh.points[mesh.cells].mean(axis=1), s0)
    displacement = np.zeros_like(mesh.points)
    displacement[:, 2] = -0.04 * settlement
    plastic_strain = 0.02 * np.maximum(0.0, stress - 0.5)
    return SoilSnapshot(displacement, 2.0e3 * stress, 6.9e3 * stress, stress, plastic_strain)


def _bowl(points: Array, s0: float) -> Array:
    x, y, z = points.T
    along = 1.0 / (1.0 + np.exp(2.0 * (x - s0)))
    values: Array = along * np.exp(-((y / 0.6) ** 2)) * np.exp(z / 0.8)
    return values


def _ledger(heave: float) -> Ledger:
    residual = 1e-6 if heave else np.nan
    return Ledger(kinetic=heave, work=heave + 1.0, residual=residual, turned_over=heave + 1.0)


CATENARY_ARC = np.concatenate([np.arange(0.0, 50.0, 0.5), np.arange(50.0, 150.0, 2.0)])


EVERYWHERE, NOWHERE = DueOutputs(series=True, pictures=True), DueOutputs(series=False, pictures=False)


@contextmanager
def a_recorder(folder: Path, kind: str = "dynamic", mesh: SoilMesh | None = None) -> Iterator[Recorder]:
    """In its first stage."""
    with Recorder.open(folder, FACTS, {"": CATENARY_ARC}, mesh, SCENE) as recorder:
        recorder.begin_stage("only", kind)
        yield recorder


def step(
    recorder: Recorder, t: float, due: DueOutputs = EVERYWHERE, pictured: SoilSnapshot | None = None
) -> None:
    """Tells the recorder of an accepted step."""
    line, health = Catenary(32.0, 30.0 - 0.01 * t), StepStatistics(3, 0.1, 1e-6, 0)
    recorder.accept([StepRecord(t, health, _ledger(t))], [due], {"": stacked([line.record(CATENARY_ARC)])}, pictured)


def record(
    folder: Path,
    *,
    duration: float = 2.0,
    mesh: SoilMesh | None = None,
    interval: float | None = None,
    picture_interval: float | None = None,
    fields: tuple[str, ...] | None = None,
    force: bool = False,
    finish: bool = True,
    facts: RunFacts = FACTS,
    at_once: int = 1,
) -> Array:
    """Records a static stage and a dynamic stage of steps of 0.1 s, so many steps at once. Returns the arc lengths."""
    arc = CATENARY_ARC
    schedule = Schedule(interval, picture_interval)
    wanted = None if fields is None else {"": fields}
    with Recorder.open(folder, facts, {"": arc}, mesh, SCENE, wanted, force) as recorder:
        for name, kind, times in (
            ("lay", "static", [0.5, 1.0]),
            ("heave", "dynamic", list(0.1 * np.arange(1, round(duration / 0.1) + 1))),
        ):
            recorder.begin_stage(name, kind)
            schedule.begin_stage(kind)
            for first in range(0, len(times), at_once):
                now = [float(t) for t in times[first : first + at_once]]
                heaves = [t if kind == "dynamic" else 0.0 for t in now]
                lines = [Catenary(32.0 + np.sin(heave), 30.0 - 2.0 * np.sin(heave)) for heave in heaves]
                health = StepStatistics(3, 0.1, 1e-6, 0)
                recorder.accept(
                    [StepRecord(t, health, _ledger(heave)) for t, heave in zip(now, heaves, strict=True)],
                    [schedule.due(t, t == times[-1]) for t in now],
                    {"": stacked([line.record(arc) for line in lines])},
                    None if mesh is None else soil(mesh, lines[-1].s0),
                )
        recorder.add_seconds({"newton": 1.25})
        if finish:
            recorder.finish()
    return arc
