"""Calibrate error bars: compute all scenes with companions, and write the page docs/error_bars.md.

Run from the project's folder. `--references` computes the references anew first, which takes about twenty minutes.
"""

import argparse

from benchmarks.error_bars import references
from benchmarks.error_bars.calibration import judge
from benchmarks.error_bars.page import PAGE, page
from benchmarks.error_bars.scenes import SCENES

parser = argparse.ArgumentParser(prog="python -m benchmarks.error_bars", description=__doc__)
parser.add_argument("--references", nargs="*", metavar="SCENE", help="compute references anew: of these, else of all")
asked = parser.parse_args().references
if asked is not None:
    references.write(asked or list(SCENES))
known = references.read()
judged = []
for name, scene in SCENES.items():
    judged.append(judge(name, scene, known[name]))
    print(f"{name}: {sum(each.inside for each in judged[-1].judged)} of {len(judged[-1].judged)} inside", flush=True)
PAGE.write_text(page(judged), encoding="utf-8")
