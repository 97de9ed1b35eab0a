"""Tensions of a deck's lines at rest by MoorPy's catenaries, which it reads by its own reader.

    python -m benchmarks.decks.by_moorpy DECK

Prints JSON: {"held": …, "free": …}, with all bodies held where the deck has them, and with free bodies free. Each is a
list of lines, {"line": "1", "ends": [[x, y, z], [x, y, z]], "tensions": [N, N]}, the lower end first, or words of why
there is none. Runs where moorpy is, not with the project.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import json
import math
import tempfile
from pathlib import Path
from typing import Any

TOLERANCE = 1e-4  # m, of the places of free points
BALANCE = 0.005  # of the largest tension
GRAVITY = 9.80665  # m/s2, of MoorDyn where a deck has none
BY = ("g", "gravity"), ("rho", "wtrdnsty", "rhow")


def read(file: str) -> Any:
    """MoorPy's system of a deck; without a depth the seabed is that of its deepest held point, as MoorDyn has it."""
    import moorpy

    with tempfile.TemporaryDirectory() as folder:
        bare = Path(folder) / "deck.txt"  # some decks have no line after their last, at which MoorPy stops
        text = Path(file).read_text(encoding="utf-8-sig", errors="replace")
        kept = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
        bare.write_text("\n".join([*kept, "--------- end ---------"]) + "\n", encoding="utf-8")
        system = moorpy.System(file=str(bare))
    given = {key.lower(): value for key, value in system.MDoptions.items()}
    system.g = GRAVITY
    for name, keys in zip(("g", "rho"), BY, strict=True):
        setattr(system, name, next((float(given[key]) for key in keys if key in given), getattr(system, name)))
    if not system.depth:
        system.depth = -min(point.r[2] for point in system.pointList if point.type != 0)
    for kind in system.lineTypes.values():  # MoorPy weighs them before it knows the water
        kind["w"] = (kind["m"] - math.pi / 4 * kind["d_vol"] ** 2 * system.rho) * system.g
    return system


def tensions(file: str, bodies_free: bool) -> list[dict[str, Any]]:
    system = read(file)
    bodies_free = bodies_free and any(body.type == 0 for body in system.bodyList)
    for body in system.bodyList:
        body.type = body.type if bodies_free and body.type == 0 else 1
    for point in system.pointList:
        point.type = max(point.type, 0) if point.type != -1 else 1
    system.initialize()
    if not system.solveEquilibrium(DOFtype="free", tol=TOLERANCE, maxIter=2000, finite_difference=bodies_free):
        raise RuntimeError("it finds no equilibrium")
    _refuse_imbalance(system)
    values = []
    for line in system.lineList:
        ends = sorted([(line.rA, line.TA), (line.rB, line.TB)], key=lambda end: end[0][2])
        values.append({
            "line": str(line.number),
            "ends": [[float(x) for x in place] for place, _ in ends],
            "tensions": [float(tension) for _, tension in ends],
        })  # fmt: skip
    return values


def _refuse_imbalance(system: Any) -> None:
    """Free ends may come out folded up to the other end, or far from vertical by little weight."""
    largest = max(max(line.TA, line.TB) for line in system.lineList)
    for point in system.pointList:
        force = point.getForces(xyz=True)
        net = math.hypot(*(float(component) for component in force))
        if point.type == 0 and net > BALANCE * largest:
            raise RuntimeError(f"its point {point.number} is out of balance by {net:.3g} N")


def main(deck: str) -> None:
    """Print what is found of a deck's file."""
    results: dict[str, Any] = {}
    for name, bodies_free in (("held", False), ("free", True)):
        try:
            with contextlib.redirect_stdout(io.StringIO()):
                results[name] = tensions(deck, bodies_free)
        except Exception as trouble:  # whatever it trips over is an answer
            results[name] = f"{type(trouble).__name__}: {trouble}"
    print(json.dumps(results))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("deck", help="a deck of MoorDyn")
    main(parser.parse_args().deck)
