"""The first steps of a scene, and what they were computed with, as JSON: python few_steps.py SCENE.yaml FOLDER.

last: rates of all dofs at the end of the last step; iterations of all; kernels: modules and names of those that Python
calls, bound to their arguments or not, which numba compiles with all that they call in turn. None of these are counted
with NUMBA_DISABLE_JIT=1.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any
from unittest.mock import patch


def main(scene: str, folder: Path) -> None:
    from riser_soil.core import bound, compiled
    from riser_soil.results.observer import Observer
    from riser_soil.scene.reader import read_scene
    from riser_soil.solve.time_stepper import TimeStepper
    from riser_soil.variants.short_runs import shortened
    from riser_soil.whole_run import run

    kernels, last, keeping = set[str](), list[float](), compiled.keeping
    iterations = []

    def kept(function: Callable[..., Any], *rest: Any) -> Any:
        kernels.add(f"{function.__module__}.{function.__name__}")
        return keeping(function, *rest)

    def recorded(observer: Observer, stepper: TimeStepper, step: Any, **more: Any) -> None:
        iterations.append(step.solution.iterations)
        last[:] = [*stepper.before.v.tolist(), *stepper.before.a.tolist()]
        record(observer, stepper, step, **more)

    record, kept_by = Observer.record, [patch.object(module, "keeping", kept) for module in (compiled, bound)]
    with kept_by[0], kept_by[1], patch.object(Observer, "record", recorded):
        run(shortened(read_scene(scene)), folder / "results", force=True)
    found = {"last": last, "iterations": iterations, "kernels": sorted(kernels)}
    (folder / "found.json").write_text(json.dumps(found), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
