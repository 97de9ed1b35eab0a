"""The first steps of a scene, and what they were computed with, as JSON: python few_steps.py SCENE.yaml FOLDER [BARS].

BARS: what catenaries are cut into, by default as in any run. last: rates of all dofs at the end of the last step;
iterations of all; kernels: modules and names of those that Python calls, bound to their arguments or not, which are
compiled with all that they call in turn; late: places of those that wait for a call to be compiled, as no solver has
done it before.
"""

from __future__ import annotations

import json
import sys
from contextlib import nullcontext
from pathlib import Path
from typing import Any
from unittest.mock import patch


def main(scene: str, folder: Path, bars: int | None) -> None:
    from riser_soil.core import bound as binding
    from riser_soil.core.bound import Bound
    from riser_soil.core.compiled import Kernel
    from riser_soil.core.entries import WANTED
    from riser_soil.results.observer import Observer
    from riser_soil.scene.reader import read_scene
    from riser_soil.solve.time_stepper import TimeStepper
    from riser_soil.variants.short_runs import shortened
    from riser_soil.whole_run import run
    from tests.support.coarse_cables import coarse_cables

    kernels, late, last, iterations = set[str](), set[str](), list[float](), list[int]()
    call, bind, record = Kernel.__call__, Bound.__init__, Observer.record
    compile_wanted = binding.compile_wanted

    def name(kernel: Any) -> str:
        return f"{kernel.py_func.__module__}.{kernel.py_func.__name__}"

    def called(kernel: Kernel, *arguments: Any) -> Any:
        kernels.add(name(kernel))
        return call(kernel, *arguments)

    def bound(self: Bound, kernel: Any, *arguments: Any) -> None:
        kernels.add(name(kernel))
        bind(self, kernel, *arguments)

    def compiled_at_a_call() -> None:
        late.update(entry.place.name for entry in WANTED if "compiled" not in vars(entry))
        compile_wanted()

    def recorded(observer: Observer, stepper: TimeStepper, step: Any, **more: Any) -> None:
        iterations.append(step.solution.iterations)
        last[:] = [*stepper.before.v.tolist(), *stepper.before.a.tolist()]
        record(observer, stepper, step, **more)

    watched = patch.object(Kernel, "__call__", called), patch.object(Bound, "__init__", bound)
    watched_calls = patch.object(binding, "compile_wanted", compiled_at_a_call)
    cut = nullcontext() if bars is None else coarse_cables(bars)
    with watched[0], watched[1], watched_calls, patch.object(Observer, "record", recorded), cut:
        run(shortened(read_scene(scene)), folder / "results", force=True)
    data = {"last": last, "iterations": iterations, "kernels": sorted(kernels), "late": sorted(late)}
    (folder / "found.json").write_text(json.dumps(data), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), int(sys.argv[3]) if sys.argv[3:] else None)
