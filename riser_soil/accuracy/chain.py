"""Comparison runs of a run in a chain, each varied in one source of error: longer steps, then also more elements.

On a rigid floor the penalty is varied with the elements: 16 times as stiff with elements half as long, so that both
halve the length over which a riser sinks in beside an end, (4 EI/k)^(1/4).

On soil one run is coarser in all its settings, as each takes nearly half of the first one's time, however coarse it is;
finer cells are those of a slice (`fine_slice`). On a block, where a coarser run costs little compared with the run, the
next one has the run's own steps again: errors of longer steps and of coarser cells may cancel. For soil of a few slices
the cells are coarsened twice, as contact grows cell by cell and two runs may agree by chance. Then elements are finer,
as they cost little there, and the penalty is varied with them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from riser_soil.accuracy.element_sizes import CurveEnvelope
from riser_soil.accuracy.error_bars import ComparisonRun, ErrorBar, RunValues, SoilOfRun, error_bars
from riser_soil.accuracy.extreme_differences import extremes_of, without_windows
from riser_soil.accuracy.fine_slice import has_many_slices, settlements_on_fine_cells
from riser_soil.assembly import Assembly, build, sized
from riser_soil.assembly.motions import periods_of
from riser_soil.core.snapshot import Instants, SoilSnapshot, instants_at
from riser_soil.errors import MemoryShortageError, MeshError, SceneError, SolveError
from riser_soil.results.hung_figures import hung_reader, looked_at
from riser_soil.results.instants import InstantReader
from riser_soil.results.peaks import RunPeaks
from riser_soil.results.schedule import Schedule
from riser_soil.scene.scene import Scene
from riser_soil.scene.seabed import RigidSeabed
from riser_soil.scene.stages import DynamicStage, Stage, StaticStage
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import StatelessObserver, solve_stages
from riser_soil.variants.key_results import SETTLEMENT, KeyResult, key_results
from riser_soil.variants.settings import is_firm, refined, settings_of

Envelopes = dict[str, CurveEnvelope]  # of moments and tensions, by line


class Variation(NamedTuple):
    """Difference of a comparison run from the run before. source: of error.

    factors: of fineness by setting; the first one is that of the error bar.
    """

    source: str
    factors: Mapping[str, float]


COARSER_SOIL = Variation("soil", {"soil_mesh": 0.6})
ALL_COARSER = Variation("soil", {"soil_mesh": 0.5, "time_step": 2.0 / 3.0, "elements": 0.5, "penalty": 0.25})
OWN_STEPS = Variation("time", {"time_step": 1.0 / ALL_COARSER.factors["time_step"]})  # after all was coarser
FINER_MESH = Variation("mesh", {"elements": 2.0, "penalty": 16.0})
FINER_MESH_ON_SOIL = Variation("mesh", {"elements": 2.0, "penalty": 4.0})
# Least number of steps in the shortest period, as the mesh has little effect with longer ones; least and largest ratio
# of step sizes, and the ratio where nothing has a period.
STEPS_OF_PERIOD, LONGER, LONGEST, USUAL = 20.0, 2.0, 4.0, 3.0
LEAST_RATIO = 1.4  # of fineness of two runs whose difference is significant
# Errors that end a comparison run: those that all ranks raise together, and those that one may raise alone.
OF_ALL, OF_ONE = (SolveError, MemoryShortageError, SceneError, MeshError), (ArithmeticError, ValueError)


def comparison_runs(scene: Scene, comm: Any, varying: Sequence[Variation] | None = None) -> list[ComparisonRun]:
    """Comparison runs of a scene, one after the other; collective, their values on rank 0.

    varying: the variations of error bars by default. On soil a penalty that is firm (`is_firm`) is not varied. If a
    finer run fails, one that is coarser by the same factors takes its place. If that fails, too, the next ones have no
    run to be compared with, and are not computed.
    """
    chain: list[ComparisonRun] = []
    known = {setting.name for setting in settings_of(scene)} - ({"penalty"} if is_firm(scene) else set())
    if scene.soil is not None and "soil_mesh" not in known:
        chain.append(ComparisonRun("soil", 1.0, None, "cells of a mesh file can't be coarsened"))
    now = _recording_all(scene)
    for source, factors in variations(scene) if varying is None else varying:
        varied_by = {name: factor for name, factor in factors.items() if name in known}
        step = _step(now, source, varied_by)
        if step is None:
            continue
        if any(before.extremes is None for before in chain):
            chain.append(ComparisonRun(source, step.finer, None, "a coarser run before failed"))
            continue
        computed = _run(step, comm)
        if computed.extremes is None and step.scene is not None and step.finer > 1.0:
            coarser = _step(now, source, {name: 1.0 / factor for name, factor in varied_by.items()})
            assert coarser is not None
            if (other := _run(coarser, comm)).extremes is not None:
                computed, step = other, coarser
        chain.append(computed)
        now = step.scene or now
    return chain


def variations(scene: Scene) -> Sequence[Variation]:
    """Variations for error bars of a run, as cheap as possible."""
    longer = Variation("time", {"time_step": 1.0 / _longer(scene)})
    if scene.soil is None:
        return longer, FINER_MESH
    if not has_many_slices(scene):
        return COARSER_SOIL, COARSER_SOIL, longer, FINER_MESH_ON_SOIL
    return (ALL_COARSER, OWN_STEPS) if scene.soil.model == "block" else (ALL_COARSER,)


def _longer(scene: Scene) -> float:
    """Ratio of a comparison run's time steps to the run's."""
    steps = [
        period / stage.time_step
        for stage in scene.stages
        if isinstance(stage, DynamicStage) and stage.time_step != "auto"
        for _, period in periods_of(scene, stage)
    ]
    return min(max(min(steps, default=USUAL * STEPS_OF_PERIOD) / STEPS_OF_PERIOD, LONGER), LONGEST)


def bars_of(scene: Scene, run: RunValues, chain: Sequence[ComparisonRun]) -> list[ErrorBar]:
    """Error bars of a run of the scene by its comparison runs; on soil a slice is computed, too."""
    rigid = scene.soil is None and isinstance(scene.seabed, RigidSeabed)
    return error_bars(run, chain, rigid, None if scene.soil is None else _cells(scene, run))


def _cells(scene: Scene, run: RunValues) -> SoilOfRun:
    if not has_many_slices(scene):
        return SoilOfRun(scene.has_path_dependent_soil)
    settled = {key: each.value for key, each in run.key_results.items() if each.name == SETTLEMENT}
    try:
        fine = settlements_on_fine_cells(scene, list(settled.values()))
    except (*OF_ALL, *OF_ONE):
        fine = None
    moving = frozenset(stage.name for stage in scene.stages if not isinstance(stage, StaticStage))
    return SoilOfRun(scene.has_path_dependent_soil, dict(zip(settled, fine or (), strict=fine is not None)), moving)


def run_values(recorded: Mapping[str, KeyResult], peaks: RunPeaks) -> RunValues:
    """Values of a run by its recorded key results and its peaks. Where peaks are missing, as of the soil, they are the
    recorded values.
    """
    known = {key: key_result.value for key, key_result in recorded.items()}
    of_nodes, smooth = (known | values_of(peaks, which) for which in ("of_nodes", "smooth"))
    extremes = {key: without_windows(value) for key, value in known.items()} | extremes_of(peaks)
    return RunValues(recorded, of_nodes, extremes, smooth)


def values_of(peaks: RunPeaks, which: str) -> dict[str, float]:
    """Values of key results by their keys; which: sampled, of_nodes, peaks or smooth."""
    return {key: key_result.value for key, key_result in key_results(peaks.as_summary(which)).items()}


@dataclass(frozen=True)
class NextScene:
    """Next scene of a chain; None where it can't be varied, for the `reason`. finer: its ratio of fineness."""

    source: str
    finer: float
    scene: Scene | None
    reason: str = ""


def _step(scene: Scene, source: str, factors: Mapping[str, float]) -> NextScene | None:
    """The next scene; None where it has none of the settings."""
    if not factors:
        return None
    first = next(setting for setting in settings_of(scene) if setting.name == next(iter(factors)))
    try:
        other = refined(scene, factors)
    except SceneError as err:
        return NextScene(source, factors[first.name], None, str(err))
    reached = first.fineness(other) / first.fineness(scene)
    if max(reached, 1.0 / reached) < LEAST_RATIO:
        return NextScene(source, reached, None, f"{first.in_words(scene)} can't be varied")
    return NextScene(source, reached, other)


def _run(step: NextScene, comm: Any) -> ComparisonRun:
    if step.scene is None:
        return ComparisonRun(step.source, step.finer, None, step.reason)
    try:
        return ComparisonRun(step.source, step.finer, extremes_of(peaks_of(step.scene, comm)))
    except (*OF_ALL, *OF_ONE) as err:
        if isinstance(err, OF_ONE) and comm.size > 1:
            raise  # the others are within the comparison run still
        reason = str(err).partition("\n")[0]
        return ComparisonRun(step.source, step.finer, None, f"its coarser run failed: {reason}")


def _recording_all(scene: Scene) -> Scene:
    """The scene without output times, by which automatic steps would be shortened."""
    output = scene.output.model_copy(update={"interval": None, "xdmf_interval": None})
    return scene.model_copy(update={"output": output})


def peaks_of(scene: Scene, comm: Any, envelopes: Envelopes | None = None) -> RunPeaks:
    """Peaks of a scene, computed without a results folder, on rank 0; collective. Raises the errors of a run.

    envelopes: to be filled on rank 0, by lines, where they are wanted.
    """
    assembly = build(sized(scene), comm)
    observer = PeakObserver(assembly, envelopes)
    solve_stages(assembly, observer)
    return observer.peaks


class PeakObserver(StatelessObserver):
    """Observer of a comparison run. peaks: those that the summary of a run would have, on rank 0."""

    def __init__(self, assembly: Assembly, envelopes: Envelopes | None = None) -> None:
        self._assembly = assembly
        self._instants = {line: InstantReader(own) for line, own in assembly.lines.items()}
        self._hung = hung_reader(assembly)
        output, soil = assembly.scene.output, assembly.soil
        self._schedule = Schedule(output.interval, output.xdmf_interval)
        self.peaks = RunPeaks(None if soil is None else soil.whole.output_mesh(), assembly.name_on_soil)
        self._envelopes = envelopes
        if envelopes is not None:
            envelopes.update({line: CurveEnvelope() for line in self._instants})

    def begin_stage(self, stage: Stage, stepper: TimeStepper) -> None:
        first = not self.peaks.stages
        self._schedule.begin_stage(stage.kind)
        self.peaks.begin_stage(stage.name, stage.kind, stage.end, self._instants)
        if first and not isinstance(stage, StaticStage) and self._assembly.comm.rank == 0:
            self._record(0.0, stepper)  # not in envelopes, as it is the result of no step

    def record(self, stepper: TimeStepper, step: AcceptedStep, last: bool) -> None:
        """Record a committed step; collective where there is soil."""
        known = self._assembly.soil if self._schedule.due(step.t, last).pictures else None
        soil = None if known is None else known.recovered().output_fields()
        if self._assembly.comm.rank == 0:
            instants = self._record(step.t, stepper, soil)
            if self._envelopes is not None and (last or not isinstance(self._assembly.stage, StaticStage)):
                for line, instant in instants.items():
                    self._envelopes[line].add(instants_at(instant, 0))

    def _record(self, t: float, stepper: TimeStepper, soil: SoilSnapshot | None = None) -> Instants:
        instants = {line: reader.instant_of([reader.look(stepper)]) for line, reader in self._instants.items()}
        self.peaks.record([t], instants, soil, looked_at(self._hung, stepper.now))
        return instants
