"""Let the calibration's scenes ask for an accuracy, and random ones, and write the page docs/asked_accuracy.md.

Run from the project's folder. `--by-hand` and `--references` first look for the best settings by hand, and compute the
random scenes' references, anew; each takes some ten minutes.
"""

import argparse

from benchmarks.asked_accuracy import by_hand
from benchmarks.asked_accuracy.asked import SOIL, asked
from benchmarks.asked_accuracy.other_scenes import FILE, OTHERS
from benchmarks.asked_accuracy.page import publish
from benchmarks.error_bars import references
from benchmarks.error_bars.calibration import judge

parser = argparse.ArgumentParser(prog="python -m benchmarks.asked_accuracy", description=__doc__)
parser.add_argument("--by-hand", nargs="*", metavar="SCENE", help="look for the best settings anew: of these, else all")
parser.add_argument("--references", nargs="*", metavar="SCENE", help="compute references anew: of these, else of all")
given = parser.parse_args()
known = references.read()
if given.by_hand is not None:
    by_hand.write(given.by_hand or list(by_hand.ASKED), known)
if given.references is not None:
    references.write(given.references or list(OTHERS), OTHERS, FILE)
hand, of_others = by_hand.read(), references.read(FILE)
scenes, others, judged, soil = [], [], [], []
for name, scene in by_hand.ASKED.items():
    scenes.append(asked(name, scene, known[name], hand[name]))
    print(f"{name}: {scenes[-1].outcome.value}", flush=True)
for name, scene in OTHERS.items():
    others.append(asked(name, scene, of_others[name]))
    judged.append(judge(name, scene, of_others[name]))
    inside = [each.inside for each in judged[-1].judged if each.decided]
    print(f"{name}: {others[-1].outcome.value}; {sum(inside)} of {len(inside)} error bars inside", flush=True)
for name, scene in SOIL.items():
    soil.append(asked(name, scene, known[name]))
    print(f"{name}: {soil[-1].outcome.value}", flush=True)
publish(scenes, others, judged, soil)
