"""Calibrate error bars: compute all scenes with comparison runs, and write the page docs/error_bars.md.

Run from the project's folder. `--references` computes the references anew first, which takes about an hour.
"""

import argparse

from benchmarks.error_bars import references
from benchmarks.error_bars.calibration import JudgedScene, decided, judge
from benchmarks.error_bars.page import publish
from benchmarks.error_bars.random_risers import CALIBRATION, OUT_OF_SAMPLE
from benchmarks.error_bars.scenes import Mapping
from riser_soil.errors import SolveError

parser = argparse.ArgumentParser(prog="python -m benchmarks.error_bars", description=__doc__)
parser.add_argument("--references", nargs="*", metavar="SCENE", help="compute references anew: of these, else of all")
asked = parser.parse_args().references
if asked is not None:
    references.write(asked or [*CALIBRATION, *OUT_OF_SAMPLE], CALIBRATION | OUT_OF_SAMPLE)
known = references.read()


def judged(scenes: dict[str, Mapping]) -> list[JudgedScene]:
    """Those that can be computed."""
    found = []
    for name, scene in scenes.items():
        try:
            found.append(judge(name, scene, known[name]))
        except SolveError as err:
            print(f"{name} fails: {str(err).partition(chr(10))[0]}", flush=True)
            continue
        reported = decided(found[-1].judged)
        print(f"{name}: {sum(each.inside for each in reported)} of {len(reported)} inside", flush=True)
    return found


publish(judged(CALIBRATION), judged(OUT_OF_SAMPLE))
