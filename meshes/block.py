"""Write the mesh of a soil block, plain or with a trench or groove, to a .msh file.

    python meshes/block.py block.msh --x 10 50 --y -2.5 2.5 --depth 2.5 --size 0.5 --size-far 1.5 --kind hex

The soil of a scene builds the same mesh by itself from `soil.block` and `soil.mesh`; the file is a start for
one's own mesh (`soil.mesh.file`).
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path

import gmsh

from riser_soil.soil.block import BlockSpec, make_block
from riser_soil.soil.grid import silent_gmsh
from riser_soil.soil.seabed_feature import FeatureSpec, GrooveSpec, TrenchSpec


def main(arguments: list[str] | None = None) -> None:
    asked = _parser().parse_args(arguments)
    riser = ((asked.x[0], asked.riser_y), (asked.x[1], asked.riser_y))
    spec = BlockSpec(
        tuple(asked.x),
        tuple(asked.y),
        asked.depth,
        asked.size,
        asked.size_far,
        asked.level,
        asked.kind,
        riser,
        asked.along,
        asked.strip,
        feature=_feature(asked),
    )
    with silent_gmsh():
        unit = make_block(spec)
        gmsh.option.setNumber("Mesh.ScalingFactor", unit)
        gmsh.write(str(asked.file))


def _feature(asked: argparse.Namespace) -> FeatureSpec | None:
    if asked.trench:
        depth, width, slope = asked.trench
        return TrenchSpec(depth, width, depth / math.tan(math.radians(slope)))
    if asked.groove:
        embedment, diameter = asked.groove
        return GrooveSpec(embedment * diameter, 0.5 * diameter)
    return None


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description="Write the mesh of a plain soil block to a .msh file.")
    parser.add_argument("file", type=Path)
    parser.add_argument("--x", type=float, nargs=2, default=(0.0, 10.0), help="range in x [m]")
    parser.add_argument("--y", type=float, nargs=2, default=(-2.5, 2.5), help="range in y [m]")
    parser.add_argument("--depth", type=float, default=2.5, help="thickness [m]")
    parser.add_argument("--level", type=float, default=0.0, help="z of the top face [m]")
    parser.add_argument("--size", type=float, default=0.5, help="cell size under the riser [m]")
    parser.add_argument("--along", type=float, help="of hexahedra, length along the riser [m]; --size by default")
    parser.add_argument("--strip", type=float, default=0.0, help="width across the riser without growth [m]")
    parser.add_argument("--size-far", type=float, default=1.5, help="cell size at the far faces [m]")
    parser.add_argument("--riser-y", type=float, default=0.0, help="y of the riser, which lies along x [m]")
    parser.add_argument("--kind", choices=("hex", "tet"), default="hex")
    feature = parser.add_mutually_exclusive_group()
    trench, groove = ("DEPTH", "WIDTH", "SLOPE_DEG"), ("EMBEDMENT", "DIAMETER")
    feature.add_argument("--trench", type=float, nargs=3, metavar=trench, help="through the block, of kind tet")
    feature.add_argument("--groove", type=float, nargs=2, metavar=groove, help="of a pipe embedded by w/D, of kind tet")
    return parser


if __name__ == "__main__":
    main()
