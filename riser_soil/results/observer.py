"""From the parts' states to what the recorder is told; the same calls on every rank, files on rank 0 only."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from mpi4py import MPI

from riser_soil import __version__
from riser_soil.assembly import World
from riser_soil.checks.inventory import built, dissipating, left_out, unknowns, working
from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, Model, State
from riser_soil.core.snapshot import RiserSnapshot, RunFacts, SoilSnapshot, StepHealth, Touch
from riser_soil.core.system import Clock
from riser_soil.errors import Interruption, RiserSoilError, SolveError
from riser_soil.interruption import undivided
from riser_soil.results.energy_ledger import Balance
from riser_soil.results.plausibility import Plausibility
from riser_soil.results.progress import Progress
from riser_soil.results.record import Recorder
from riser_soil.results.schedule import Schedule
from riser_soil.results.screen import print_summary
from riser_soil.results.touchdown_zone import TouchdownZone
from riser_soil.riser.section_forces import (
    HasElementForces,
    HasNodalForces,
    HasViscousForces,
    at_most,
    element_residual,
    end_reactions,
    section_forces,
    viscous_residual,
)
from riser_soil.scene.dump import dump_scene
from riser_soil.scene.stages import Stage, StaticStage
from riser_soil.solve.dynamic_relaxation import Relaxed
from riser_soil.solve.time_stepper import Accepted, March


class Observer:
    """Follows a run: progress bar, energy ledger, files. recorder is None off rank 0."""

    def __init__(self, world: World, clock: Clock, recorder: Recorder | None, progress: Progress) -> None:
        self._world, self._clock, self._recorder, self._progress = world, clock, recorder, progress
        output = world.scene.output
        self._schedule = Schedule(output.interval, output.xdmf_interval)
        self._zone = TouchdownZone(world, _known_fields(world))
        self._plausibility = Plausibility(world)

    @classmethod
    @contextmanager
    def open(cls, world: World, clock: Clock, folder: Path, force: bool) -> Iterator[Observer]:
        """Take the run's folder over; collective. What was written stays when the block is left early."""
        mesh = world.soil.output_mesh() if world.soil is not None else None
        known = facts(world)
        with Progress(enabled=world.comm.rank == 0) as progress:
            recorder = None
            with _on_all_ranks(world.comm), undivided():
                if world.comm.rank == 0:
                    text, fields = dump_scene(world.scene), _known_fields(world)
                    recorder = Recorder.open(folder, known, world.line.arc, mesh, text, fields, force)
            with recorder or nullcontext():
                yield cls(world, clock, recorder, progress)

    def begin_stage(self, stage: Stage, march: March) -> None:
        """march: at the stage's beginning; collective."""
        self._stage = stage
        self._schedule.begin_stage(stage.kind)
        scene = self._world.scene
        self._balance = Balance(march.energy, isinstance(stage, StaticStage), dissipating(scene), working(scene))
        self._relaxed = 0
        self._plausibility.begin_stage(stage)
        if self._recorder is not None:
            self._recorder.begin_stage(stage.name, stage.kind)
        if stage is self._world.scene.stages[0] and not isinstance(stage, StaticStage):
            self._begin_at(march)
        self._progress.begin_stage(stage.name, stage.kind, 1.0 if isinstance(stage, StaticStage) else stage.duration)

    def _begin_at(self, march: March) -> None:
        """Records the state before all stages, which no static stage has brought about."""
        soil = self._soil()
        if self._recorder is not None:
            self._recorder.begin_at(riser_snapshot(self._world, march), self._zone.look(march.now), soil)

    def record(self, march: March, step: Accepted, last: bool) -> None:
        """Tell the recorder of a step that has been committed; collective."""
        since = time.perf_counter()
        due = self._schedule.due(step.t, last)
        # Relaxation, in statics, commits states that are no steps: the soil must be known before it.
        soil = self._soil() if due.pictures or isinstance(self._stage, StaticStage) else None
        change = self._balance.add(march.energy, step)
        self._progress.update(step.t, step.dt, step.solution.iterations)
        if self._recorder is not None:
            health = StepHealth(step.solution.iterations + self._relaxed, step.dt, change, step.cuts)
            riser, touching = riser_snapshot(self._world, march), self._zone.look(march.now)
            self._recorder.accept(step.t, due, riser, touching, health, self._balance.ledger, soil)
            if due.series:
                self._judge(self._recorder, march, riser, touching, closely=due.pictures)
        self._relaxed = 0
        self._clock.add("output", since)

    def _judge(
        self, recorder: Recorder, march: March, riser: RiserSnapshot, touching: Touch, closely: bool
    ) -> None:
        """Look whether what was recorded is plausible; closely where it costs no more than what is written."""
        self._plausibility.look(recorder.now, march.now, riser, touching)
        if closely:
            self._plausibility.look_closely(recorder.now, march.now, elastic_residual(self._world, march))
        recorder.summary.stages[-1].doubts = self._plausibility.warnings()

    def record_last(self, end: SolveError | Interruption) -> None:
        """The run ends before its time: write the last accepted step; collective where the ranks end together."""
        together = self._world.comm.size == 1 or not isinstance(end, Interruption) or end.together
        with undivided():
            soil = self._soil() if together else None
            if self._recorder is not None:
                self._recorder.record_last(soil)
                if isinstance(end, Interruption):
                    end.place = self._recorder.reached

    def _soil(self) -> SoilSnapshot | None:
        """Collective where there is soil."""
        return None if self._world.soil is None else self._world.soil.output_fields()

    def laid(self, slack: float, steps: int, relaxations: int) -> None:
        """Before the stages, the end of a slack or steep riser was brought to its place from `slack` [m] beyond it."""
        if self._recorder is not None:
            self._recorder.summary.laying = {"slack": slack, "load_steps": steps, "relaxations": relaxations}
            helped = f" and {relaxations} dynamic relaxation(s)" if relaxations else ""
            print(f"{self._world.hanging}: laid {slack:.4g} m too far, its end came back in {steps} step(s){helped}")

    def relaxed(self, relaxed: Relaxed) -> None:
        """Dynamic relaxation was needed; its Newton iterations count with the next step."""
        self._relaxed += relaxed.iterations
        if self._recorder is not None:
            tally = self._recorder.summary.stages[-1]
            tally.relaxations += 1
            tally.branch_switches += relaxed.branch_switches
            took = f"it took {relaxed.iterations} Newton iterations, counted with the next step"
            print(f"dynamic relaxation was needed; {took}")
            if relaxed.branch_switches:
                print(f"it left {relaxed.branch_switches} unstable equilibrium(s) in the mode of buckling")

    def finish(self) -> None:
        if self._recorder is not None:
            self._recorder.add_seconds(self._clock.seconds)
            self._recorder.finish()
            print_summary(self._recorder.summary.as_dict(), self._recorder.settlement)


@contextmanager
def _on_all_ranks(comm: MPI.Intracomm) -> Iterator[None]:
    """An error that one rank meets in the block is raised by all."""
    failure: RiserSoilError | None = None
    try:
        yield
    except RiserSoilError as err:
        failure = err
    for met in comm.allgather(failure):
        if met is not None:
            raise met


def _known_fields(world: World) -> tuple[str, ...]:
    """What the scene wants to be told of, as far as it is known."""
    unknown = set()
    if world.pressures is None:
        unknown |= {"wall_tension"}
    if not world.elements.min_bend_radius.any():
        unknown |= {"bend_utilisation"}
    if not world.contacts:
        unknown |= {"penetration", "embedment"}
    if world.friction is None:
        unknown |= {"slip"}
    return tuple(name for name in world.scene.output.fields if name not in unknown)


class Acting(NamedTuple):
    """Parts of a model whose forces are told apart."""

    within: list[HasElementForces]
    viscous: list[HasViscousForces]
    on_nodes: list[HasNodalForces]


@lru_cache(maxsize=1)
def _acting(model: Model) -> Acting:
    """Looked for once a stage, as the question takes longer than the answer's use."""
    return Acting(
        [p for p in model.parts if isinstance(p, HasElementForces)],
        [p for p in model.parts if isinstance(p, HasElementForces) and isinstance(p, HasViscousForces)],
        [p for p in model.parts if isinstance(p, HasNodalForces)],
    )


def riser_snapshot(world: World, march: March) -> RiserSnapshot:
    """The riser at the accepted state; on the rank that holds it."""
    line, state = world.line, march.now
    parts = _acting(march.system.model)
    residual = element_residual(line, parts.within, state)
    inside = section_forces(line, world.elements, state, residual, viscous_residual(line, parts.viscous, state))
    start, end = end_reactions(line, state, residual, _on_nodes(world, march))
    tangent, position = line.trial(state).turn.tangent @ line.basis.T, line.positions3(state)
    return RiserSnapshot(
        position=position,
        effective_tension=inside.effective_tension,
        wall_tension=_wall_tension(world, inside.effective_tension, position[:, 2]),
        bending_moment=inside.bending_moment,
        curvature=inside.curvature,
        bend_utilisation=_bend_utilisation(world, inside.curvature_beside),
        contact_force=_contact_force(world, state),
        moment_vector=inside.moment,
        start_force=start.force,
        end_force=end.force,
        start_moment=start.moment,
        end_moment=end.moment,
        start_tangent=tangent[0, 0],
        end_tangent=tangent[-1, 1],
    )


def elastic_residual(world: World, march: March) -> Array:
    """Of the elements (ne, 2 ndof), less what follows from strain rates."""
    parts = _acting(march.system.model)
    residual = element_residual(world.line, parts.within, march.now)
    viscous = viscous_residual(world.line, parts.viscous, march.now)
    return residual if viscous is None else residual - viscous


def _bend_utilisation(world: World, curvature: Array) -> Array:
    """curvature (ne, 2): at the elements' ends."""
    allowed = world.elements.min_bend_radius
    return at_most(allowed[:, None] * curvature) if allowed.any() else np.full(world.line.nodes, np.nan)


def _wall_tension(world: World, effective: Array, z: Array) -> Array:
    if world.pressures is None:
        return np.full(world.line.nodes, np.nan)
    return world.pressures.wall_tension(effective, z)


def _on_nodes(world: World, march: March) -> Array:
    """Residual (nn, ndof) of what acts on nodes but isn't a support: contact with soil, and loads at nodes."""
    forces = Forces.zeros(march.now.u.size)
    if world.soil_contact is not None:
        world.soil_contact.residual(march.now, forces)
    loads = [p.nodal_forces(march.now) for p in _acting(march.system.model).on_nodes]
    return np.asarray(sum(loads, world.line.nodal(forces.end)))


def _contact_force(world: World, state: State) -> Array:
    forces = (contact.force_per_length(state) for contact in world.contacts)
    return np.asarray(sum(forces, np.zeros(world.line.nodes)))


def facts(world: World) -> RunFacts:
    """What is known of a run before its first step; collective."""
    return RunFacts(
        title=world.scene.title,
        version=__version__,
        ranks=world.comm.size,
        built=built(world.scene),
        left_out=left_out(world.scene),
        dissipating=dissipating(world.scene),
        working=working(world.scene),
        riser_dofs=unknowns(world.comm, world.line),
        soil_dofs=unknowns(world.comm, world.soil.field) if world.soil is not None else 0,
    )
