"""Moorings with bodies, by riser_soil, MoorDyn and, at rest, CableDyn: table of docs/peers.md.

Usage: python -m benchmarks.peers.hung [--results FOLDER] [--page]
"""

from __future__ import annotations

import itertools
import json
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from benchmarks.peers.hung_decks import AT, CASES, DURATION, RECORDS, Moved
from benchmarks.peers.in_turn import ROOT, THEIRS
from demos.compute import timed
from demos.page import publish, script, table
from riser_soil.core.arrays import Array
from riser_soil.moordyn.deck import read_deck
from riser_soil.moordyn.whole_deck import whole_scene_of

OURS = (10, 0.1), (20, 0.05)  # segments of a part, step [s]
PEERS = (10, 0.0005), (20, 0.00025)


def scene_of(name: str, parts: int, time_step: float, folder: Path) -> dict[str, Any]:
    """The imported scene, shaken."""
    case, deck = CASES[name], folder / "deck.txt"
    deck.write_text(case.deck(parts, time_step), encoding="utf-8")
    scene = whole_scene_of(read_deck(deck)).data
    place = [*case.moved]
    ((line, end),) = (
        (line, end)
        for line, given in scene["lines"].items()
        for end in ("start", "end")
        if given[end] != "free" and given[end]["position"] == place
    )
    swing = {"amplitude": [*case.amplitude], "period": case.period, "ramp": case.period}
    moves = {"duration": DURATION, "time_step": time_step, "lines": {line: {"motion": {end: {"harmonic": swing}}}}}
    scene["stages"].append({"name": "shaken", "kind": "dynamic", **moves})
    return scene | {"output": {"interval": RECORDS, "fields": ["effective_tension"]}}


def by_us(name: str, parts: int, time_step: float) -> Moved:
    """The seconds to rest are those of a run with one step of motion, set-up and output included."""
    with TemporaryDirectory() as place:
        folder = Path(place)
        scene = folder / "scene.yaml"
        scene.write_text(json.dumps(scene_of(name, parts, time_step, folder)), encoding="utf-8")
        short = f"stages.1.duration={time_step}"
        to_rest = min(timed(scene, folder / "short", short)[1] for _ in range(2))
        done, seconds = timed(scene, folder / "run")
        last = int(np.flatnonzero(done["stage"] == 0)[-1])
        tension = np.stack([done.of_line(line)["effective_tension"][last:, AT] for line in done.lines], axis=1)
        return Moved(tension, to_rest, seconds - to_rest)


def by_moordyn(name: str, parts: int, time_step: float) -> Moved:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "run.npz"
        _save_theirs("moordyn", path, name, parts, time_step)
        with np.load(path) as stored:
            return Moved(**{key: stored[key] for key in Moved._fields})


def by_cabledyn(name: str, parts: int) -> Array:
    """Tensions at the lines' ends at rest (3, 2), the smaller one first [N]."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "rest.npy"
        _save_theirs("cabledyn", path, name, parts)
        return np.asarray(np.load(path))


def _save_theirs(program: str, path: Path, *given: object) -> None:
    arguments = ", ".join(repr(each) for each in (*given, str(path)))
    command = [str(THEIRS), "-c", f"from benchmarks.peers.hung_by_{program} import save; save({arguments})"]
    subprocess.run(command, cwd=ROOT, check=True, capture_output=True)


def off(motion: Moved, reference: Moved) -> Array:
    """Largest differences of tensions beside the ends over the line's largest there: at rest, of least and largest ones
    in motion.
    """
    mine, theirs = (each.tension[..., 1:-1] for each in (motion, reference))
    largest, pairs = theirs.max(axis=(0, 2))[:, None], zip(_looked_at(mine), _looked_at(theirs), strict=True)
    return np.array([np.max(np.abs(a - b) / largest) for a, b in pairs])


def _looked_at(tension: Array) -> tuple[Array, Array, Array]:
    return tension[0], tension.min(axis=0), tension.max(axis=0)


def main(results: Path, page: bool) -> None:
    results.mkdir(parents=True, exist_ok=True)
    rows = list[list[str]]()
    sizes = list(zip(OURS, PEERS, strict=True))
    for name, ((parts, ours), (_, theirs)) in itertools.product(CASES, sizes):
        motion, reference = by_us(name, parts, ours), by_moordyn(name, parts, theirs)
        apart = (f"{100.0 * share:.2f}" for share in off(motion, reference))
        seconds = (f"{a:.1f}/{b:.1f}" for a, b in zip(motion[-2:], reference[-2:], strict=True))
        beside = "–"
        if CASES[name].bodies:
            cabledyn = by_cabledyn(name, parts)
            beside = f"{100.0 * np.max(np.abs(np.sort(motion.tension[0, :, [0, -1]].T) / cabledyn - 1.0)):.4f}"
        rows.append([name, str(2 * parts), f"{ours:g}/{theirs:g}", *apart, beside, *seconds])
    off_moordyn = ["% off MoorDyn at rest", "least", "largest"]
    head = ["", "segments", "steps s", *off_moordyn, "CableDyn at rest", "processor s to rest", "in motion"]
    publish({"hung": table(head, rows)}, results, ROOT / "docs" / "peers.md" if page else None)


if __name__ == "__main__":
    script(main, __doc__, ROOT)
