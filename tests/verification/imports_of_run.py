"""What a run imports and how long it takes, as JSON: python imports_of_run.py SCENE.yaml FOLDER."""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path


def main(scene: str, folder: Path) -> None:
    from riser_soil.run import run
    from riser_soil.scene.reader import read_scene

    run(read_scene(scene), folder, force=True)
    found = {"modules": sorted(sys.modules), "seconds": time.process_time()}
    (folder / "found.json").write_text(json.dumps(found), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
