"""Moorings with bodies by MoorDyn, in its own environment: its rest by dynamic relaxation, then an end moves."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

import moordyn
import numpy as np

from benchmarks.peers.hung_decks import AT, CASES, DURATION, RECORDS, Moved


def run(name: str, parts: int, time_step: float) -> Moved:
    case = CASES[name]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "deck.txt"
        path.write_text(case.deck(parts, time_step), encoding="utf-8")
        began = time.process_time()
        system = moordyn.Create(str(path))
        moordyn.SetVerbosity(system, moordyn.LEVEL_ERR)
        moordyn.Init(system, case.place(0.0), [0.0] * 3)
        to_rest = time.process_time() - began
        lines = [moordyn.GetLine(system, number) for number in (1, 2, 3)]

        def seen() -> list[list[float]]:
            """At an end, of the segment there."""
            nodes = ((line, moordyn.GetLineNumberNodes(line)) for line in lines)
            return [[float(np.linalg.norm(moordyn.GetLineNodeTen(line, at % n))) for at in AT] for line, n in nodes]

        rows, often, began = [seen()], round(RECORDS / time_step), time.process_time()
        for k in range(round(DURATION / time_step)):  # a jump of the end's speed would pull at the line
            before, after = (case.place(n * time_step) for n in (k, k + 1))
            speed = [(b - a) / time_step for a, b in zip(before, after, strict=True)]
            moordyn.Step(system, before, speed, k * time_step, time_step)
            if (k + 1) % often == 0:
                rows.append(seen())
        seconds = time.process_time() - began
        moordyn.Close(system)
    return Moved(np.array(rows), to_rest, seconds)


def save(name: str, parts: int, time_step: float, to: str) -> None:
    """Save the results to a file of numpy's."""
    np.savez(to, **run(name, parts, time_step)._asdict())
