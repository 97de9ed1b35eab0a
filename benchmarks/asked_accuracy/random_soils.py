"""Random scenes on soil, those of the error bars' calibration, that ask for 5 %: what they reach, and for how long.

Each takes minutes, so `random_soils.json` keeps what each has reached: python -m benchmarks.asked_accuracy.random_soils
[SCENE...] computes those named, else those that are not there yet, one after the other, each in a process of its own
that has an hour of the processor.
"""

from __future__ import annotations

import argparse
import json
import resource
import signal
import subprocess
import sys
from pathlib import Path
from statistics import median
from typing import Any

from benchmarks.asked_accuracy.asked import Outcome, asked
from benchmarks.error_bars import references
from benchmarks.error_bars.random_soils import EVEN, KINDS, ODD
from demos.page import csv_table, table

FILE = Path(__file__).with_name("random_soils.json")
ACCURACY, ALLOWED = 0.05, 3600  # asked; s of the processor for everything
SCENES = EVEN | ODD
UNFINISHED = "not ended in the time given"

Reached = dict[str, Any]  # of a scene: outcome, error, setting, seconds, left_out, judged, said


def read() -> dict[str, Reached]:
    kept: dict[str, Reached] = json.loads(FILE.read_text(encoding="utf-8")) if FILE.exists() else {}
    return {name: kept[name] for name in SCENES if name in kept}


def figures() -> str:
    """Figures of the scenes so far, for the page."""
    kept = read()
    outcomes = [each["outcome"] for each in kept.values()]
    claimed = [each for each in kept.values() if each["outcome"] in (Outcome.REACHED.value, Outcome.MISSED.value)]
    rows = [
        ["truly reached, of those that claim it", _share(outcomes, len(claimed))],
        [f"of {len(outcomes)} scenes so far, of {len(SCENES)}", _share(outcomes, len(outcomes))],
        *([f"of it {kind}", _of_kind(kept, kind)] for kind in KINDS),
        ["told that it is not reached", str(outcomes.count(Outcome.REPORTED.value))],
        [UNFINISHED, str(outcomes.count(UNFINISHED))],
        ["largest true error over it, median", f"{median(each['error'] for each in claimed) / ACCURACY:.2f}"],
        ["processor time, median", f"{median(each['seconds'] for each in claimed):.0f} s"],
    ]
    return table([f"{ACCURACY:.0%} on soil", ""], rows)


def _share(outcomes: list[str], of: int) -> str:
    return f"{outcomes.count(Outcome.REACHED.value) / of:.1%}"


def _of_kind(kept: dict[str, Reached], kind: str) -> str:
    outcomes = [each["outcome"] for name, each in kept.items() if name.startswith(kind)]
    return f"{outcomes.count(Outcome.REACHED.value)} of {len(outcomes)}"


def rows_page() -> str:
    head = ["scene", "outcome", "true error", "setting", "everything s", "not judged", "reason"]
    return csv_table(head, [_row(name, each) for name, each in read().items()])


def _row(name: str, each: Reached) -> list[str]:
    if each["outcome"] == UNFINISHED:
        return [name, UNFINISHED, "", "", f"{each['seconds']:.1f}", "", ""]
    left_out = f"{each['left_out']} of {each['left_out'] + each['judged']}"
    seconds = f"{each['seconds']:.1f}"
    return [name, each["outcome"], f"{each['error']:.2%}", each["setting"], seconds, left_out, each["said"]]


def reached(name: str) -> Reached:
    """The scene as it asks for the accuracy."""
    result = asked(name, SCENES[name], references.read(references.ON_SOIL)[name], accuracy=ACCURACY)
    errors = result.errors
    of_errors: dict[str, float | None] = {"error": None, "left_out": 0, "judged": 0}
    if errors is not None:
        of_errors = {"error": errors.largest[0], "left_out": errors.left_out, "judged": len(errors.by_key)}
    known = {"outcome": result.outcome.value, "setting": result.setting, "seconds": result.seconds, "said": result.said}
    return known | of_errors


def in_time(name: str) -> Reached:
    """Like `reached`, in a process that is ended after a while."""
    call = [sys.executable, "-m", "benchmarks.asked_accuracy.random_soils", "--one", name]
    done = subprocess.run(call, capture_output=True, text=True, check=False, preexec_fn=_limit_processor)
    if done.returncode == -signal.SIGXCPU:
        return {"outcome": UNFINISHED, "seconds": ALLOWED}
    done.check_returncode()
    reached: Reached = json.loads(done.stdout.splitlines()[-1])
    return reached


def _limit_processor() -> None:
    """Limit the processor time of the process that begins."""
    resource.setrlimit(resource.RLIMIT_CPU, (ALLOWED, ALLOWED + 60))


def write(names: list[str]) -> None:
    """Write what scenes reach; results of other scenes are kept."""
    for name in names:
        known = read() | {name: in_time(name)}
        text = ",\n".join(f"{json.dumps(each)}: {json.dumps(known[each])}" for each in SCENES if each in known)
        FILE.write_text(f"{{\n{text}\n}}\n", encoding="utf-8")
        print(f"{name}: {known[name]['outcome']}", flush=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="python -m benchmarks.asked_accuracy.random_soils", description=__doc__)
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help="else those that are not there yet")
    parser.add_argument("--one", metavar="SCENE", help="this one alone, in this process: its figures as JSON")
    given = parser.parse_args()
    if given.one is not None:
        print(json.dumps(reached(given.one)))
    else:
        write(given.scenes or [name for name in SCENES if name not in read()])
