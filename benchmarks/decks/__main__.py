"""Decks and files of public repositories, each imported, checked and hung: tables of docs/decks.md.

    python -m benchmarks.decks FOLDER [--results FOLDER] [--without WORD]… [--workers N] [--again] [--page]

FOLDER has clones of the repositories, each named OWNER+NAME. The catenaries are MoorPy's, of the environment
build/peers (`scripts/peers.sh`); without it the tables lack them.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import asdict
from itertools import chain, groupby
from pathlib import Path

from benchmarks.decks.survey import Survey, survey
from benchmarks.peers.in_turn import ROOT, THEIRS
from demos.page import publish, table

PAGE = ROOT / "docs" / "decks.md"
ALIKE = 0.005  # of the catenary's tension
LONGEST = 160  # characters of a reason
WITHOUT_TENSION = "its tension is 0 there"


def verdict(deck: Survey) -> str:
    """A deck's outcome in a few words."""
    if deck.outcome != "scene":
        return deck.outcome
    if deck.difference is None:
        return "scene, no catenary"
    if abs(deck.difference) <= ALIKE:
        return "scene, as the catenary"
    if deck.bends:
        return "scene that bends"
    return "differs, with a warning" if deck.warnings else "DIFFERS"


def summary(decks: Sequence[Survey]) -> str:
    counts = Counter(verdict(each) for each in decks)
    return table(["what becomes of it", "lines and decks"], [[word, str(n)] for word, n in counts.most_common()])


def sources(known_decks: Sequence[Survey], folder: Path) -> str:
    rows = []
    for repository, group in groupby(known_decks, key=lambda each: each.repository):
        decks = len({each.deck for each in group})
        rows.append([f"github.com/{repository}", _commit(folder / repository.replace("/", "+")), str(decks)])
    return table(["repository", "commit", "files"], rows)


def _commit(clone: Path) -> str:
    done = subprocess.run(["git", "-C", str(clone), "rev-parse", "HEAD"], capture_output=True, text=True, check=False)
    return done.stdout.strip()[:10] or "-"


def all_rows(decks: Sequence[Survey]) -> str:
    rows = []
    for each in decks:
        name = f"{each.repository}: {each.deck}" + (f", `--line {each.line}`" if each.line else "")
        numbers = [_kN(each.tension), _kN(each.reference), _percent(each)]
        rows.append([name, _words(each), str(each.remarks), *numbers])
    return table(["deck", "outcome", "remarks", "top tension kN", "catenary kN", "difference %"], rows)


def _words(each: Survey) -> str:
    """The outcome, and why: words of the refusal, of what warns where it differs, or of why there is no catenary."""
    word = verdict(each)
    no_catenary = each.why_no_reference or WITHOUT_TENSION
    said = {"differs, with a warning": " ".join(each.warnings), "scene, no catenary": no_catenary}
    reason = (each.reason if each.outcome != "scene" else said.get(word, "")).replace("|", "/")
    word = "no catenary" if word == "scene, no catenary" else word
    return f"{word}: {reason[:LONGEST]}{'…' if len(reason) > LONGEST else ''}" if reason else word


def _kN(value: float | None) -> str:
    return "-" if value is None else f"{value / 1e3:.5g}"


def _percent(each: Survey) -> str:
    return "-" if each.difference is None else f"{100 * each.difference:.2f}"


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.decks", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)  # fmt: skip
    parser.add_argument("folder", type=Path, help="clones of repositories, each OWNER+NAME")
    parser.add_argument("--results", type=Path, default=ROOT / "results" / "decks", help="scenes and runs")
    parser.add_argument("--python", default=str(THEIRS), help="interpreter that has moorpy")
    parser.add_argument("--without", action="append", default=[], help="leave out files with this in their path")
    parser.add_argument("--workers", type=int, default=1, help="decks at a time")
    parser.add_argument("--again", action="store_true", help="tables of what an earlier survey has left in the results")
    parser.add_argument("--page", action="store_true", help="write the tables into docs/decks.md, too")
    asked = parser.parse_args()
    log = asked.results / "found.jsonl"
    if not asked.again:
        asked.results.mkdir(parents=True, exist_ok=True)
        work = asked.results.absolute()
        _survey_into(log, survey(asked.folder.absolute(), work, asked.python, asked.without, asked.workers))
    read = [_read(row) for row in log.read_text(encoding="utf-8").splitlines()]
    decks = sorted(read, key=lambda each: (each.repository.lower(), each.deck))
    blocks = {"sources": sources(decks, asked.folder), "outcomes": summary(decks), "decks": all_rows(decks)}
    publish(blocks, asked.results, PAGE if asked.page else None)


def _survey_into(log: Path, groups: Iterable[list[Survey]]) -> None:
    with log.open("w", encoding="utf-8") as rows:
        for each in chain.from_iterable(groups):
            print(json.dumps(asdict(each)), file=rows, flush=True)
            print(verdict(each), each.repository, each.deck, each.line, file=sys.stderr, flush=True)


def _read(row: str) -> Survey:
    given = json.loads(row)
    return Survey(**given | {"warnings": tuple(given["warnings"])})


if __name__ == "__main__":
    main()
