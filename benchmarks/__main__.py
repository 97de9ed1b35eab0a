"""Run all benchmarks and print their figures; --page writes those of docs/speed.md there, too."""

import argparse

from benchmarks import (
    adaptive,
    condensed,
    coupled,
    impact,
    length,
    plastic,
    riser_only,
    sections,
    storm,
    tank,
    twins,
    waves,
)

parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
parser.add_argument("--page", action="store_true", help="write the tables of docs/speed.md into it, too")
page = parser.parse_args().page
for each in (riser_only, length, condensed, plastic, sections, storm, waves):
    each.report(page)
for other in (twins, coupled, adaptive, impact, tank):
    other.report()
