"""Calibrate error bars: compute all scenes with comparison runs, and write the page docs/error_bars.md.

Run from the project's folder. `--references` computes the references anew first, which takes long; `--missing`
computes those that are not there, as after a stop; `--on-soil` takes the random scenes on soil alone, and writes their
block of the page.
"""

import argparse
from collections.abc import Iterable, Mapping

from benchmarks.error_bars import random_soils, references
from benchmarks.error_bars.calibration import JudgedScene, decided, judge
from benchmarks.error_bars.page import publish, publish_on_soil
from benchmarks.error_bars.random_risers import CALIBRATION, OUT_OF_SAMPLE
from benchmarks.error_bars.scenes import Mapping as SceneMapping
from benchmarks.error_bars.soil_page import soil_block
from riser_soil.errors import SolveError

ALL, SOILS = CALIBRATION | OUT_OF_SAMPLE, random_soils.SOILS
Known = Mapping[str, references.Reference]


def judged(scenes: Mapping[str, SceneMapping], known: Known) -> list[JudgedScene]:
    """Judged bars of the scenes that can be computed."""
    results = []
    for name, scene in scenes.items():
        try:
            results.append(judge(name, scene, known[name]))
        except SolveError as err:
            print(f"{name} fails: {str(err).partition(chr(10))[0]}", flush=True)
            continue
        bars = decided(results[-1].judged)
        print(f"{name}: {sum(each.inside for each in bars)} of {len(bars)} inside", flush=True)
    return results


def write_references(asked: Iterable[str], missing: bool = False) -> None:
    """Write references of the named scenes, else of all, or of those that have none; those on soil have a file of their
    own.
    """
    names = list(asked)
    for scenes, file in ((ALL, references.FILE), (SOILS, references.ON_SOIL)):
        there = references.read(file) if missing and file.exists() else {}
        wanted = [name for name in scenes if name in names or not names]
        references.write([name for name in wanted if name not in there], scenes, file)


def on_soil() -> str:
    known = references.read(references.ON_SOIL)
    columns = {"even numbers": random_soils.EVEN, "odd numbers": random_soils.ODD, "out of sample": random_soils.NEW}
    return soil_block({heading: judged(scenes, known) for heading, scenes in columns.items()}, known)


parser = argparse.ArgumentParser(prog="python -m benchmarks.error_bars", description=__doc__)
parser.add_argument("--references", nargs="*", metavar="SCENE", help="compute references anew: of these, else of all")
parser.add_argument("--missing", action="store_true", help="compute the references that are not there")
parser.add_argument("--on-soil", action="store_true", help="the random scenes on soil alone")
given = parser.parse_args()
if given.references is not None or given.missing:
    write_references(given.references or [], given.missing)
if given.on_soil:
    publish_on_soil(on_soil())
else:
    of_all = references.read()
    publish(judged(CALIBRATION, of_all), judged(OUT_OF_SAMPLE, of_all), on_soil())
