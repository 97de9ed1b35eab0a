"""From the parts' states to what the recorder is told; the same calls on every rank, files on rank 0 only."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from riser_soil import __version__
from riser_soil.arrays import Array
from riser_soil.balance import Balance
from riser_soil.build import World
from riser_soil.inventory import built, dissipating, left_out, unknowns, working
from riser_soil.march import Accepted, March
from riser_soil.part import Energy, Forces, Model, State
from riser_soil.progress import Progress
from riser_soil.record import Recorder
from riser_soil.relax import Relaxed
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
from riser_soil.schedule import Schedule
from riser_soil.screen import print_summary
from riser_soil.snapshot import RiserSnapshot, RunFacts, StepHealth
from riser_soil.system import Clock
from riser_soil.touchdown_zone import TouchdownZone


class Observer:
    """Follows a run: progress bar, energy ledger, files. recorder is None off rank 0."""

    def __init__(self, world: World, clock: Clock, recorder: Recorder | None, progress: Progress) -> None:
        self._world, self._clock, self._recorder, self._progress = world, clock, recorder, progress
        output = world.scene.output
        self._schedule = Schedule(output.interval, output.xdmf_interval)
        self._zone = TouchdownZone(world, _known_fields(world))

    @classmethod
    @contextmanager
    def open(cls, world: World, clock: Clock, folder: Path, force: bool) -> Iterator[Observer]:
        """Take the run's folder over; collective. What was written stays when the block is left early."""
        mesh = world.soil.output_mesh() if world.soil is not None else None
        known = facts(world)
        with Progress(enabled=world.comm.rank == 0) as progress:
            if world.comm.rank != 0:
                yield cls(world, clock, None, progress)
                return
            scene = world.scene
            with Recorder.open(
                folder, known, world.line.arc, mesh, dump_scene(scene), _known_fields(world), force
            ) as recorder:
                yield cls(world, clock, recorder, progress)

    def begin_stage(self, stage: Stage, energy: Energy) -> None:
        """energy: stored at the stage's beginning."""
        self._schedule.begin_stage(stage.kind)
        self._balance = Balance(energy, isinstance(stage, StaticStage))
        self._relaxed = 0
        if self._recorder is not None:
            self._recorder.begin_stage(stage.name, stage.kind)
        self._progress.begin_stage(stage.name, stage.kind, 1.0 if isinstance(stage, StaticStage) else stage.duration)

    def record(self, march: March, step: Accepted, last: bool) -> None:
        """Tell the recorder of a step that has been committed; collective."""
        since = time.perf_counter()
        due = self._schedule.due(step.t, last)
        wanted = due.pictures and self._world.soil is not None
        soil = self._world.soil.output_fields() if wanted and self._world.soil is not None else None
        change = self._balance.add(march.energy, step)
        self._progress.update(step.t, step.dt, step.solution.iterations)
        if self._recorder is not None:
            health = StepHealth(step.solution.iterations + self._relaxed, step.dt, change, step.cuts)
            riser, touching = riser_snapshot(self._world, march), self._zone.look(march.now)
            self._recorder.accept(step.t, due, riser, touching, health, self._balance.ledger, soil)
        self._relaxed = 0
        self._clock.add("output", since)

    def laid(self, slack: float, steps: int, relaxations: int) -> None:
        """Before the stages, the end of a slack riser was brought to its place from `slack` [m] beyond it."""
        if self._recorder is not None:
            self._recorder.summary.laying = {"slack": slack, "load_steps": steps, "relaxations": relaxations}
            helped = f" and {relaxations} dynamic relaxation(s)" if relaxations else ""
            print(f"the riser is slack: laid {slack:.4g} m too far, its end came back in {steps} step(s){helped}")

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
