"""One run of a study, a process of its own: python -m riser_soil.accuracy.point_run SCENE FOLDER.

Its processor time goes from the scene read to the results written: assembly, solution and output, without the
interpreter's start, imports of what each run needs, and the compilation of kernels.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from riser_soil.accuracy.study_points import COST
from riser_soil.core import compiled
from riser_soil.errors import Interruption, RiserSoilError
from riser_soil.scene.reader import read_scene
from riser_soil.whole_run import run


def main(file: Path, folder: Path) -> int:
    """Run the scene and leave its cost beside its results; the exit status is that of `riser-soil run`."""
    scene = read_scene(file)
    since = compiled.seconds_of_work()
    status, reason = 0, ""
    try:
        run(scene, folder, force=True)
    except (RiserSoilError, Interruption) as err:
        status, reason = err.exit_status, str(err)
    cost = {"status": status, "reason": reason, "cpu": compiled.seconds_of_work() - since}
    (folder / COST).write_text(json.dumps(cost), encoding="utf-8")
    return status


if __name__ == "__main__":
    arguments = argparse.ArgumentParser(description="one run of a study, and its processor time")
    arguments.add_argument("scene", type=Path, help="scene file")
    arguments.add_argument("folder", type=Path, help="folder for its results")
    given = arguments.parse_args()
    sys.exit(main(given.scene, given.folder))
