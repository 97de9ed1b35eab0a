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
from typing import Any, NamedTuple

from riser_soil.accuracy.error_bars import ComparisonRun, ErrorBar, RunValues, SoilOfRun, error_bars
from riser_soil.accuracy.fine_slice import has_many_slices, settlements_on_fine_cells
from riser_soil.assembly.motions import periods_of
from riser_soil.errors import MemoryShortageError, MeshError, SceneError, SolveError
from riser_soil.results.peaks import RunPeaks
from riser_soil.scene.scene import Scene
from riser_soil.scene.seabed import RigidSeabed
from riser_soil.scene.stages import DynamicStage, StaticStage
from riser_soil.variants.extreme_differences import extremes_of, without_windows
from riser_soil.variants.key_results import SETTLEMENT, KeyResult, key_results
from riser_soil.variants.peaks import peaks_of
from riser_soil.variants.settings import is_firm, refined, settings_of


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
LEAST_RATIO = 1.4  # least ratio of fineness of two runs whose difference is significant
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
    now = _without_output_times(scene)
    for source, factors in variations(scene) if varying is None else varying:
        own = {name: factor for name, factor in factors.items() if name in known}
        if not own:
            continue
        if any(before.extremes is None for before in chain):
            chain.append(ComparisonRun(source, own[next(iter(own))], None, "a coarser run before failed"))
            continue
        compared, now = _compared(now, source, own, comm)
        chain.append(compared)
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


def _compared(scene: Scene, source: str, factors: Mapping[str, float], comm: Any) -> tuple[ComparisonRun, Scene]:
    """Comparison run of a scene that is finer by factors, and its scene; the scene itself where it can't be varied."""
    first = next(setting for setting in settings_of(scene) if setting.name == next(iter(factors)))
    try:
        other = refined(scene, factors)
    except SceneError as err:
        return ComparisonRun(source, factors[first.name], None, str(err)), scene
    finer = first.fineness(other) / first.fineness(scene)
    if max(finer, 1.0 / finer) < LEAST_RATIO:
        return ComparisonRun(source, finer, None, f"{first.in_words(scene)} can't be varied"), scene
    try:
        return ComparisonRun(source, finer, extremes_of(peaks_of(other, comm))), other
    except (*OF_ALL, *OF_ONE) as err:
        if isinstance(err, OF_ONE) and comm.size > 1:
            raise  # the other ranks are still within the comparison run
        reason = str(err).partition("\n")[0]
    failed = ComparisonRun(source, finer, None, f"its coarser run failed: {reason}")
    if finer > 1.0:
        coarser = _compared(scene, source, {name: 1.0 / factor for name, factor in factors.items()}, comm)
        if coarser[0].extremes is not None:
            return coarser
    return failed, other


def _without_output_times(scene: Scene) -> Scene:
    """The scene without output times, by which automatic steps would be shortened."""
    output = scene.output.model_copy(update={"interval": None, "xdmf_interval": None})
    return scene.model_copy(update={"output": output})
