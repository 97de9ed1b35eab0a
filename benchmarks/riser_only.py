"""Lines and bodies in motion: steps of the line solver against those of SNES, and against the Newton steps in them.

Everything is measured in turn, step by step, in processor time, so that a machine that is busy or whose speed drifts
changes all figures alike.
"""

from __future__ import annotations

import functools
import tempfile
import time
from collections import defaultdict
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from statistics import mean, median
from unittest.mock import patch

from benchmarks.speed_page import parser_of, tell
from benchmarks.stage import TimedStage, last_stage
from riser_soil.core.system import Timer
from riser_soil.results.observer import Observer
from riser_soil.results.record import Recorder
from riser_soil.results.run_clock import RunClock
from riser_soil.solve.step import NotConvergedError

ROOT = Path(__file__).parent.parent
SCENES, LINES = ROOT / "tests" / "scenes", ROOT / "demos" / "lines"
CATENARY, TANK, STORM = (SCENES / f"{name}.yaml" for name in ("catenary", "tank", "storm"))
ELEMENTS = "riser.segments.0.elements={}"
CASES: dict[str, tuple[Path, tuple[str, ...]]] = {
    "2D, 35 elements": (CATENARY, ("dimension=2", ELEMENTS.format(35))),
    "2D, 100 elements": (CATENARY, ("dimension=2", ELEMENTS.format(100))),
    "3D, 100 elements": (CATENARY, ("dimension=3", ELEMENTS.format(100), "line_types.flexible.GJ=2.0e4")),
    "3D, 400 elements": (CATENARY, ("dimension=3", ELEMENTS.format(400), "line_types.flexible.GJ=2.0e4")),
    "hose in a tank, 200 elements": (TANK, ()),
    "storm over clay, 3D, 96 elements, 200 wave components": (STORM, ()),
    "a buoy on three lines, 120 elements": (LINES / "mooring.yaml", ()),
    "a lazy S over an arch, 108 elements": (LINES / "lazy_s.yaml", ()),
}
RAMP, STEPS = 150, 140  # steps until the surge has grown; steps of one period


HEAD = (
    *("riser", "step of [s]", "Newton iterations", "takes [ms]", "with results [ms]", "times as fast as real time"),
    *("by SNES [ms]", "SNES over compiled", "step over its Newton steps"),
)


def report(page: bool = False) -> None:
    rows = (row(case, measure(scene, *overrides)) for case, (scene, overrides) in CASES.items())
    tell("riser_only", HEAD, rows, page)


def row(case: str, us: Mapping[str, float]) -> list[str]:
    """A row of the table, from what `measure` returns."""
    step, recorded, snes = (us[name] / 1e3 for name in ("step", "recorded", "snes"))
    real = [f"{1e3 * us['time step'] / each:.0f}" for each in (step, recorded)]
    return [
        case, f"{us['time step']:.3g}", f"{us['iterations']:.2f}", f"{step:.2f}", f"{recorded:.2f}", " and ".join(real),
        f"{snes:.2f}", f"{snes / step:.1f}", f"{us['step'] / us['bare']:.2f}",
    ]  # fmt: skip


def measure(scene: Path, *overrides: str) -> dict[str, float]:
    """Medians in us of a step that is solved, accounted for and committed, by the line solver ("step") and by SNES;
    told to the results, too ("recorded"); of its Newton steps alone ("bare"). Mean number of iterations; time step [s].
    """
    compiled, snes = (surging(scene, *overrides, f"solver.newton={kind}") for kind in ("compiled", "snes"))
    seconds = defaultdict[str, list[float]](list)
    opened = functools.partial(Observer.open, compiled.assembly, RunClock(), force=True)
    unwritten = patch.multiple(Recorder, flush=lambda recorder: None, flush_is_due=False)
    with tempfile.TemporaryDirectory() as folder, opened(Path(folder)) as seen, unwritten:
        seen.begin_stage(compiled.stage, compiled.stepper)
        for stage in (compiled, snes):
            stage.walk(1)
        compiled.tell(seen)
        seen.flush()  # which reads kernels
        began = compiled.stepper.now.t
        for _ in range(STEPS):
            step = compiled.stepper.next_step(compiled.control)
            with suppress(NotConvergedError):  # a step that is cut
                seconds["bare"].append(1e6 * timed(functools.partial(compiled.newton.solve, step)))
            compiled.iterations = 0
            seconds["step"].append(1e6 * timed(lambda: compiled.walk(1)))
            seconds["iterations"].append(compiled.iterations)
            seconds["snes"].append(1e6 * timed(lambda: snes.walk(1)))
            seconds["told"].append(1e6 * timed(lambda: compiled.tell(seen)))
        seconds["told"][-1] += 1e6 * timed(seen.flush)
    medians = {name: median(values) for name, values in seconds.items()} | {"iterations": mean(seconds["iterations"])}
    medians["time step"] = (compiled.stepper.now.t - began) / STEPS
    for stage in (compiled, snes):
        stage.destroy()
    return medians | {"recorded": medians["step"] + mean(seconds["told"])}  # told of many at once


def surging(scene: Path, *overrides: str) -> TimedStage:
    """The last stage of a scene, grown to its full amplitude."""
    stage = last_stage(scene, overrides, Timer.new())
    stage.walk(RAMP)
    return stage


def timed(action: Callable[[], object]) -> float:
    """Processor seconds of an action."""
    began = time.process_time()
    action()
    return time.process_time() - began


if __name__ == "__main__":
    report(parser_of("riser_only", __doc__).parse_args().page)
