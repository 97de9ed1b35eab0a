"""What a run imports and how many kernels it compiles, as JSON: python imports_of_run.py SCENE.yaml FOLDER."""

from __future__ import annotations

import json
import sys
from pathlib import Path


def main(scene: str, folder: Path) -> None:
    from numba.core import event

    from riser_soil.scene.reader import read_scene
    from riser_soil.whole_run import run

    with event.install_recorder("numba:compile") as compiled:
        run(read_scene(scene), folder / "results", force=True)
    data = {"modules": sorted(sys.modules), "compiled": len(compiled.buffer)}
    (folder / "found.json").write_text(json.dumps(data), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
