"""Runs with outputs that the table gets for a while, one along the riser, one of the soil, one of each step:
python run_with_toys.py FOLDER leaves FOLDER/solved, FOLDER/told and FOLDER/schema.json, and the screen's tables.
"""

from __future__ import annotations

import sys
from pathlib import Path

from riser_soil.core import outputs, step_outputs
from riser_soil.core.output import OutputQuantity, Row, greatest
from riser_soil.core.snapshot import Record, SoilSnapshot, StepRecord

HEIGHT: OutputQuantity[Record] = OutputQuantity(
    "height",
    "z",
    "m",
    "height of the riser's axis",
    "nodes",
    "positive upwards",
    lambda record: record.position[..., 2],
    figures=(greatest("max_height", Row("greatest height", "km", 1e-3)),),
)
SETTLEMENT: OutputQuantity[SoilSnapshot] = OutputQuantity(
    "settlement", "s", "m", "settlement", "soil points", get=lambda soil: -soil.displacement[:, 2]
)
WHOLE_ENERGY: OutputQuantity[StepRecord] = OutputQuantity(
    "stored_energy", "", "J", "all energy stored", "step", get=lambda step: step.ledger.stored
)


def main(folder: Path) -> None:
    """The table is complete before anything that uses it is imported."""
    outputs.ALONG_RISER = (*outputs.ALONG_RISER, HEIGHT)
    outputs.OF_SOIL = (*outputs.OF_SOIL, SETTLEMENT)
    step_outputs.OF_STEP = (*step_outputs.OF_STEP, WHOLE_ENERGY)
    from riser_soil.scene.dump import schema_text
    from riser_soil.scene.reader import scene_from_mapping
    from riser_soil.whole_run import run
    from tests.support.recorded_run import block, record
    from tests.support.scenes import LAY, touchdown

    scene = touchdown(LAY, su=1000.0) | {"output": {"fields": ["height"]}}
    del scene["soil"]
    run(scene_from_mapping(scene), folder / "solved")
    record(folder / "told", mesh=block(4, 3, 2), duration=0.5)
    (folder / "schema.json").write_text(schema_text(), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
