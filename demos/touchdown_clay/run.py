"""A riser comes down on soft clay while the floater heaves: compute the scene beside this file, then draw it.

Usage: python run.py [FOLDER], by default `results` beside this file. Leaves the run's files and touchdown.png there.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from riser_soil.plots import picture
from riser_soil.run import run
from riser_soil.scene.reader import read_scene

HERE = Path(__file__).parent


def main(folder: Path) -> None:
    run(read_scene(HERE / "scene.yaml"), folder, force=True)
    picture(folder, folder / "touchdown.png")
    print(f"results and touchdown.png are in {folder}; open riser.xdmf and soil.xdmf in ParaView")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, nargs="?", default=HERE / "results", help="folder for the results")
    main(parser.parse_args().folder)
