"""Companions of a run in a chain: coarser soil, once more, then longer steps too, fewer elements, a softer penalty."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from riser_soil.accuracy.companions import peaks_of
from riser_soil.accuracy.error_bars import SOURCES, Companion, RunValues
from riser_soil.accuracy.headlines import Headline, headlines
from riser_soil.accuracy.knobs import Knob, knobs_of, varied
from riser_soil.errors import MemoryShortageError, MeshError, SceneError, SolveError
from riser_soil.results.peaks import RunPeaks
from riser_soil.scene.scene import Scene

Ratios = Mapping[str, Sequence[float]]  # by knob, in order

# The dearest first. Contact with soil grows cell by cell: cells a little coarser tell by how much that jumps, coarse
# ones whether two that agree do so by chance.
COARSER: Ratios = {"soil_mesh": (2.0**0.5, 2.0), "time_step": (5.0,), "elements": (2.0,), "penalty": (4.0,)}
LEAST_RATIO = 1.4  # below it two runs are too much alike
# Errors that a companion may fail with: those that all ranks meet, and those that one may meet alone.
OF_ALL, OF_ONE = (SolveError, MemoryShortageError, SceneError, MeshError), (ArithmeticError, ValueError)


def companions(scene: Scene, comm: Any, coarser: Ratios = COARSER) -> list[Companion]:
    """Those of a scene, run one after the other; collective, their values on rank 0.

    One that fails leaves nothing to compare the next ones with: they are not run.
    """
    chain: list[Companion] = []
    if scene.soil is not None and "soil_mesh" not in {knob.name for knob in knobs_of(scene)}:
        chain.append(Companion("soil", 1.0, None, "cells of a mesh file can't be coarsened"))
    for step in _coarser(scene, coarser):
        if any(before.values is None for before in chain):
            chain.append(Companion(step.source, step.ratio, None, "a companion before failed"))
        else:
            chain.append(_run(step, comm))
    return chain


def run_values(told: Mapping[str, Headline], peaks: RunPeaks) -> RunValues:
    """Of a run whose peaks were gathered on the way; of the soil, whose peaks may not be, as told."""
    known = {key: headline.value for key, headline in told.items()}
    of_nodes, between_steps, smooth = (known | values_of(peaks, which) for which in ("of_nodes", "peaks", "smooth"))
    return RunValues(told, of_nodes, between_steps, smooth)


def values_of(peaks: RunPeaks, which: str) -> dict[str, float]:
    """Of headline quantities by their keys; which: sampled, of_nodes, peaks or smooth."""
    return {key: headline.value for key, headline in headlines(peaks.told(which)).items()}


@dataclass(frozen=True)
class CoarserScene:
    """What a companion runs: None where it can't be, for the `reason`. ratio: to the scene before."""

    source: str
    ratio: float
    scene: Scene | None
    reason: str = ""


def _coarser(scene: Scene, coarser: Ratios) -> Iterator[CoarserScene]:
    """Scenes ever coarser; one that can't be is None, and the next ones follow the one before it."""
    now = _recording_all(scene)
    knobs = {knob.name: knob for knob in knobs_of(scene)}
    for name, ratios in coarser.items():
        for ratio in ratios if name in knobs else ():
            step = _step(now, knobs[name], ratio)
            yield step
            now = step.scene or now


def _step(scene: Scene, knob: Knob, ratio: float) -> CoarserScene:
    source = SOURCES[knob.name]
    try:
        coarse = varied(scene, knob, 1.0 / ratio)
    except SceneError as err:
        return CoarserScene(source, ratio, None, str(err))
    reached = knob.fineness(scene) / knob.fineness(coarse)
    if reached < LEAST_RATIO:
        return CoarserScene(source, ratio, None, f"{knob.told(scene)} can't be coarsened")
    return CoarserScene(source, reached, coarse)


def _run(step: CoarserScene, comm: Any) -> Companion:
    if step.scene is None:
        return Companion(step.source, step.ratio, None, step.reason)
    try:
        return Companion(step.source, step.ratio, values_of(peaks_of(step.scene, comm), "peaks"))
    except (*OF_ALL, *OF_ONE) as err:
        if isinstance(err, OF_ONE) and comm.size > 1:
            raise  # the others are within the companion still
        reason = str(err).partition("\n")[0]
        return Companion(step.source, step.ratio, None, f"its coarser companion failed: {reason}")


def _recording_all(scene: Scene) -> Scene:
    """Automatic steps are not held back by output times."""
    output = scene.output.model_copy(update={"interval": None, "xdmf_interval": None})
    return scene.model_copy(update={"output": output})
