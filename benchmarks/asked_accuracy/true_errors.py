"""True errors of a run's key results, against references, and the processor time that something takes."""

from __future__ import annotations

import contextlib
import io
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.error_bars.references import Reference
from riser_soil.core.compiled import seconds_of_work
from riser_soil.errors import SolveError
from riser_soil.scene.scene import Scene
from riser_soil.variants.key_results import key_results_in
from riser_soil.whole_run import run

ACCURACY, ON_SOIL = 0.01, 0.1  # asked; where there is soil
CERTAIN = 0.3  # of the accuracy: what a reference may be off to be judged by


@dataclass(frozen=True)
class TrueErrors:
    """by_key: relative errors of the quantities that are judged. left_out: how many have no certain reference.
    accuracy: asked.
    """

    by_key: Mapping[str, float]
    left_out: int
    accuracy: float = ACCURACY

    @property
    def largest(self) -> tuple[float, str]:
        """And the key of its quantity."""
        return max(((error, key) for key, error in self.by_key.items()), default=(math.nan, ""))

    @property
    def telling(self) -> bool:
        """Whether at most a third is left out: else a setting that reaches the rest says little."""
        return 2 * self.left_out <= len(self.by_key)

    @property
    def within(self) -> bool:
        return self.largest[0] <= self.accuracy


def accuracy_of(scene: Mapping[str, Any]) -> float:
    """Accuracy that a scene of the calibration asks for."""
    return ON_SOIL if "soil" in scene else ACCURACY


def true_errors(folder: Path, reference: Reference, accuracy: float = ACCURACY) -> TrueErrors:
    """True errors of the run in a folder; inf for a quantity that it lacks."""
    key_results = key_results_in(folder)
    errors, left_out = dict[str, float](), 0
    for key, (true, uncertainty) in reference.items():
        if key in key_results and key_results[key].relative(uncertainty) > CERTAIN * accuracy:
            left_out += 1
        else:
            errors[key] = key_results[key].relative(key_results[key].value - true) if key in key_results else math.inf
    return TrueErrors(errors, left_out, accuracy)


def run_errors(scene: Scene, folder: Path, reference: Reference) -> tuple[TrueErrors | None, float]:
    """True errors of the scene run as users do, and its processor time [s]; None where it fails."""
    try:
        seconds = seconds_of(lambda: run(scene, folder, force=True))
    except (SolveError, ArithmeticError):
        return None, math.inf
    return true_errors(folder, reference), seconds


def seconds_of(action: Callable[[], Any]) -> float:
    """Processor time [s] without compilation of kernels; what the action prints is left out."""
    since = seconds_of_work()
    with contextlib.redirect_stdout(io.StringIO()):
        action()
    return seconds_of_work() - since
