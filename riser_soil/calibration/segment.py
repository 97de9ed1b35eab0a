"""Pipe segment: a scene with a short pipe over soil, driven up and down, and the resistance that it meets."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from riser_soil.assembly import Assembly, build
from riser_soil.assembly.packages import communicator_of
from riser_soil.calibration.path import PenetrationPath
from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError, SolveError
from riser_soil.scene.riser import Support
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import Stage
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import StatelessObserver, solve_stages
from riser_soil.variants.variant import BaseScene

TABLE = "path.csv"
STEP = 1.0  # step of the count by which the table is read


@dataclass(frozen=True)
class PipeSegment:
    """A scene, of which the stages are replaced by a path of penetration."""

    base: BaseScene

    def scene(self, parameters: Mapping[str, float], table: Path | str, steps: int) -> Scene:
        """The scene that follows a table of so many steps, with numbers by their paths in it."""
        motion = {"table": str(table)}
        stage = {"name": "penetration", "kind": "quasi-static", "duration": STEP * steps, "time_step": STEP}
        stages = {"stages": [stage | {"motion": {"start": motion, "end": motion}}]}
        return self.base.with_values({**stages, **parameters}, "--fit", again=True)

    def resistance(self, parameters: Mapping[str, float], path: PenetrationPath, table: Path) -> Array:
        """Vertical resistance (m,) at the steps of a path [N/m], > 0 where the soil pushes the pipe up."""
        scene = self.scene(parameters, table, len(path.w) - 1)
        assembly = build(scene, communicator_of(scene))
        log = ContactForceLog(assembly)
        try:
            solve_stages(assembly, log)
        except SolveError as err:
            given = ", ".join(f"{name} = {value:.6g}" for name, value in parameters.items())
            raise SolveError(f"with {given}: {err}") from err
        V = np.interp(STEP * np.arange(len(path.w)), log.times, log.forces)
        return np.asarray(V / contact_length(assembly))


@dataclass
class ContactForceLog(StatelessObserver):
    """Vertical force of all ground on the riser [N] after each step of a stage, by its t."""

    assembly: Assembly
    times: list[float] = field(default_factory=list)
    forces: list[float] = field(default_factory=list)

    def begin_stage(self, stage: Stage, stepper: TimeStepper) -> None:
        self._log(stepper)

    def record(self, stepper: TimeStepper, step: AcceptedStep, last: bool) -> None:
        self._log(stepper)

    def _log(self, stepper: TimeStepper) -> None:
        self.times.append(stepper.now.t)
        self.forces.append(self.assembly.ground_force(stepper.now))


def first_penetration(scene: Scene) -> float:
    """Depth of the pipe's underside below the seabed as the scene has it [m]; SceneError where it is no segment."""
    ends = scene.line.start, scene.line.end
    if scene.soil is None:
        raise SceneError("soil: missing: a pipe segment is pressed into soil; add soil")
    if scene.soil.reference_rate is not None:
        raise SceneError("soil.law.rate: a measured path has no times; leave rate out: su is that at the test's speed")
    for name, end in zip(("start", "end"), ends, strict=True):
        if not isinstance(end, Support) or end.rotation == "free":
            remedy = "give position and rotation: fixed"
            raise SceneError(f"riser.{name}: both ends of a pipe segment are driven and do not turn; {remedy}")
    levels = [end.position[2] for end in ends if isinstance(end, Support)]
    if levels[0] != levels[1]:
        high = f"z is {levels[1]:g} m and {levels[0]:g} m at the start"
        raise SceneError(f"riser.end.position: {high}; lay the pipe level")
    return scene.seabed_level - (levels[0] - 0.5 * diameter(scene))


def diameter(scene: Scene) -> float:
    """Outer diameter of a pipe segment [m]."""
    diameters = {line_type.outer_diameter for line_type in scene.used_line_types.values()}
    only = diameters.pop()
    if diameters or only is None:
        raise SceneError("riser.segments: a pipe segment has one outer_diameter, all along; take one line type")
    return only


def contact_length(assembly: Assembly) -> float:
    """Length of the pipe over the soil, along its direction in plan [m]."""
    line, soil = assembly.riser.line, assembly.soil
    assert soil is not None
    grid = soil.whole.grid
    axis = int(np.argmax(np.abs(line.direction[:2])))
    ends = sorted(float(line.to_global(line.x[node])[axis]) for node in (0, -1))
    low, high = max(ends[0], grid.low[axis]), min(ends[1], grid.high[axis])
    if high <= low or not np.isclose(abs(line.direction[axis]), 1.0):
        raise SceneError("soil.block: a pipe segment lies over the soil, along x or y; move or turn the pipe")
    return float(high - low)


def write_table(path: PenetrationPath, first: float, file: Path) -> None:
    """The path as a table of motion for both ends; first: penetration as the scene begins [m]."""
    rows = [f"{STEP * n:.10g}, 0, 0, {float(first - w)!r}" for n, w in enumerate(path.w)]
    file.write_text("\n".join(["t [-], x [m], y [m], z [m]", *rows]) + "\n", encoding="utf-8")
