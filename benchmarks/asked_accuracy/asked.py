"""Scenes that ask for an accuracy in place of elements, steps, mesh and penalty: what they reach, what it costs."""

from __future__ import annotations

import copy
import math
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from statistics import median

from benchmarks.asked_accuracy.by_hand import HandSetting
from benchmarks.asked_accuracy.true_errors import TrueErrors, accuracy_of, run_errors, seconds_of, true_errors
from benchmarks.error_bars.references import Reference
from benchmarks.error_bars.scenes import SCENES, Mapping
from riser_soil.accuracy.target_run import run_to_accuracy
from riser_soil.errors import SolveError
from riser_soil.results.folder import SCENE
from riser_soil.scene.reader import read_scene, scene_from_mapping
from riser_soil.variants.settings import refined, settings_in_words

SOIL = {name: scene for name, scene in SCENES.items() if "soil" in scene}


class Outcome(Enum):
    """How a scene that asks for an accuracy ended."""

    REACHED = "reached"
    REPORTED = "told that it is not reached"
    MISSED = "MISSED"


@dataclass(frozen=True)
class HandCost:
    """Processor seconds, one after the other: everything asked for, the run of the setting chosen, the best by hand."""

    everything: float
    chosen: float
    by_hand: float


@dataclass(frozen=True)
class AskedScene:
    """errors: true ones; None where no run was left. said: why the accuracy was not reached, empty where it was.

    setting: the one chosen, in words. seconds: of the processor, for all runs taken for it. cost: None where it is not
    compared with a setting by hand.
    """

    name: str
    errors: TrueErrors | None
    said: str
    setting: str
    cost: HandCost | None = None
    seconds: float = math.nan

    @property
    def outcome(self) -> Outcome:
        if self.said:
            return Outcome.REPORTED
        return Outcome.REACHED if self.errors is not None and self.errors.within else Outcome.MISSED


def asking(mapping: Mapping, accuracy: str | float | None = None) -> Mapping:
    """The scene without what an accuracy chooses, and with one: the calibration's, if none is given."""
    mapping = copy.deepcopy(mapping)
    for segment in mapping["riser"]["segments"]:
        _without(segment, "elements", "element_length")
    for stage in mapping["stages"]:
        _without(stage, "time_step", "tolerance")
    _without(mapping.get("contact", {}), "stiffness")
    _without(mapping.get("soil", {}), "mesh")
    return mapping | {"accuracy": accuracy_of(mapping) if accuracy is None else accuracy}


def asked(
    name: str, mapping: Mapping, reference: Reference, hand: HandSetting | None = None, accuracy: float | None = None
) -> AskedScene:
    """The scene as it asks for an accuracy, by default the calibration's; beside the best by hand, if that is given."""
    accuracy = accuracy_of(mapping) if accuracy is None else accuracy
    with tempfile.TemporaryDirectory() as place:
        folder, beside = Path(place) / "asked", Path(place) / "beside"
        if hand is not None:  # also for what is imported and loaded once
            run_errors(refined(scene_from_mapping(mapping), hand.factors), beside, reference)
        said, everything = _run(asking(mapping, accuracy), folder)
        if not (folder / SCENE).exists():
            return AskedScene(name, None, said, "none", None, everything)
        errors, scene = true_errors(folder, reference, accuracy), read_scene(folder / SCENE)
        setting = settings_in_words(scene)
        if hand is None or said:
            return AskedScene(name, errors, said, setting, None, everything)
        _, chosen = run_errors(scene, beside, reference)
        _, by_hand = run_errors(refined(scene_from_mapping(mapping), hand.factors), beside, reference)
        return AskedScene(name, errors, said, setting, HandCost(everything, chosen, by_hand), everything)


def share_of_claims(scenes: Iterable[AskedScene]) -> float:
    """Number of scenes that claim to reach the accuracy and truly do."""
    claimed = [each.outcome for each in scenes if each.outcome is not Outcome.REPORTED]
    return claimed.count(Outcome.REACHED) / len(claimed)


def share_of_all(scenes: Iterable[AskedScene]) -> float:
    outcomes = [each.outcome for each in scenes]
    return outcomes.count(Outcome.REACHED) / len(outcomes)


def median_error(scenes: Iterable[AskedScene]) -> float:
    """Largest true error of a scene over the accuracy, where it claims to reach it."""
    claimed = [each for each in scenes if each.outcome is not Outcome.REPORTED]
    return median(each.errors.largest[0] / each.errors.accuracy for each in claimed if each.errors is not None)


def costs(scenes: Iterable[AskedScene]) -> list[HandCost]:
    """Costs of the scenes that reach the accuracy, where a setting by hand does, too."""
    return [each.cost for each in scenes if each.outcome is Outcome.REACHED and each.cost is not None]


def _run(mapping: Mapping, folder: Path) -> tuple[str, float]:
    """Message of a run that does not reach the accuracy, and processor seconds."""
    said = ""

    def to_accuracy() -> None:
        nonlocal said
        try:
            run_to_accuracy(scene_from_mapping(mapping), folder)
        except SolveError as err:
            said = str(err).replace(str(folder), "the folder").partition("\n")[0]

    seconds = seconds_of(to_accuracy)
    return said, seconds


def _without(part: Mapping, *keys: str) -> None:
    for key in keys:
        part.pop(key, None)
