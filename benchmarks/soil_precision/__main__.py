"""Work and precision of soil, docs/soil_precision.md: error against processor time, by method.

    python -m benchmarks.soil_precision

Runs that have left a file in results/soil_precision are not repeated.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from benchmarks.soil_precision.measure import measure
from benchmarks.soil_precision.page import write

argparse.ArgumentParser(
    prog="python -m benchmarks.soil_precision",
    description=__doc__,
    formatter_class=argparse.RawDescriptionHelpFormatter,
).parse_args()
write(measure(Path("results") / "soil_precision"))
