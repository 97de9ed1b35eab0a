"""What becomes of each deck below a folder: imported, which checks it, and hung, each in a process with limits."""

from __future__ import annotations

import hashlib
import json
import math
import re
import subprocess
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from riser_soil.results.read import Run
from tests.robustness.limited_process import FORKING, Ending, Limits, ended, import_all

LIMITS = Limits(cpu=180, wall=600.0)
ENDINGS = (".dat", ".txt", ".yml", ".yaml", ".map", ".inp", ".ipt")
WORDS = re.compile(
    rb"UnstrLen|UnstretchedLen|NumSegs|LINE (TYPES|DICTIONARY|PROPERTIES)\b"
    rb"|^\s*SeabedModel:|^\s*RefCurrentSpeed:|^# Program: OrcaFlex",
    re.IGNORECASE | re.MULTILINE,
)
LARGEST = 2_000_000  # bytes of a deck
SAME_PLACE = 0.02  # m
NO_TENSION = 1e-3  # N: of a catenary with no more there is none
FREE = re.compile(rb"\bfree\b", re.IGNORECASE)  # points or bodies
MOST_OTHERS = 3  # lines of a deck apart
HERE = Path(__file__).parent


@dataclass(frozen=True)
class Survey:
    """A riser of a deck, or the whole of one, and what became of it. tension, reference: at the top [N].

    line: as `import` takes it; empty for the line that it takes by itself. bends: a line of its scene has bending
    stiffness, so that a catenary is no measure.
    """

    repository: str
    deck: str
    line: str
    outcome: str  # scene | refused | no solution | how its process ended
    reason: str = ""
    remarks: int = 0
    warnings: tuple[str, ...] = ()
    tension: float | None = None
    reference: float | None = None
    why_no_reference: str = ""
    bends: bool = False

    @property
    def difference(self) -> float | None:
        """Relative difference of the tension from the catenary's."""
        if self.tension is None or self.reference is None or self.reference < NO_TENSION:
            return None
        return self.tension / self.reference - 1


def decks_below(folder: Path, without: Sequence[str] = ()) -> Iterator[Path]:
    """Files that look like decks, each content once."""
    seen = set[str]()
    for path in sorted(folder.rglob("*")):
        name = str(path.relative_to(folder))
        if path.suffix.lower() not in ENDINGS or "/.git/" in name or any(word in name for word in without):
            continue
        if not path.is_file() or path.stat().st_size > LARGEST:
            continue
        content = path.read_bytes()
        key = hashlib.sha256(b" ".join(content.split())).hexdigest()
        if WORDS.search(content) and key not in seen:
            seen.add(key)
            yield path


def survey(
    folder: Path, work: Path, python: str, without: Sequence[str] = (), workers: int = 1
) -> Iterator[list[Survey]]:
    """All that is found of each deck, a list for each, in their order. python: an interpreter that has moorpy. workers:
    decks at a time.
    """
    import_all()
    decks = list(decks_below(folder, without))
    places = [work / f"{number:03d}" for number in range(len(decks))]
    with ThreadPoolExecutor(workers) as pool:
        yield from pool.map(lambda deck, place: _of_deck(folder, deck, place, python), decks, places)


def _of_deck(folder: Path, deck: Path, work: Path, python: str) -> list[Survey]:
    """The line that `import` takes by itself; the whole deck, where that is refused or other lines and something free
    may act on it; some of the others, where the whole is refused.
    """
    repository, *rest = deck.relative_to(folder).parts
    name = (repository.replace("+", "/"), "/".join(rest))
    if deck.suffix.lower() in (".yml", ".yaml"):
        return [_beside(_of_line(deck, name, "", work), {}, work)]
    first, reference = _of_line(deck, name, "", work), _by_moorpy(deck, python)
    decks = [first]
    if first.outcome == "refused" or (_other_lines(work / "first") and FREE.search(deck.read_bytes())):
        decks.append(_of_line(deck, name, "all", work))
        if decks[-1].outcome == "refused":
            decks += _others(deck, name, work)
    if all(each.outcome == "refused" and each.reason == first.reason for each in decks):
        decks = [first]
    return [_beside(each, reference, work) for each in decks]


def _other_lines(place: Path) -> list[str]:
    """Lines that the import says it has left out."""
    return re.findall(r"--line (\w+) imports", _output(place / "import"))


def _others(deck: Path, name: tuple[str, str], work: Path) -> Iterator[Survey]:
    """Decks of the lines that neither the first riser has nor one that came before."""
    remaining = _other_lines(work / "first")
    for _ in range(MOST_OTHERS):
        if not remaining:
            return
        line = remaining.pop(0)
        yield _of_line(deck, name, line, work)
        others = _other_lines(work / line)
        remaining = [each for each in remaining if each in others] if others else remaining


def _of_line(deck: Path, name: tuple[str, str], line: str, work: Path) -> Survey:
    place = work / (line or "first")
    asked = ["--line", line] if line else []
    imported = _command(place / "import", ["import", str(deck), "-o", "scene.yaml", "--force", *asked])
    remarks, said = imported.output.count("not carried over: "), _reason(imported)
    if not imported.well:
        return Survey(*name, line, imported.word, said)
    if not imported.finished:
        return Survey(*name, line, "refused", said)
    scene = str(place / "import" / "scene.yaml")
    warnings = tuple(row for row in imported.output.splitlines() if row.startswith("warning:"))
    static = "stages=[{name: hang, kind: static}]"
    run = _command(place / "run", ["run", scene, "-o", "out", "--force", "--set", static])
    if not run.finished:
        outcome = "no solution" if run.well else run.word
        return Survey(*name, line, outcome, _reason(run), remarks, warnings)
    known = tuple(re.sub(r"^warning: \S+:\d+: ", "warning: ", row) for row in warnings)
    warnings += tuple(row for row in run.output.splitlines() if row.startswith("warning:") and row not in known)
    bends = any(float(EI) > 0.0 for EI in re.findall(r"\bEI: ([-+.\deE]+)", Path(scene).read_text(encoding="utf-8")))
    return Survey(*name, line, "scene", "", remarks, tuple(dict.fromkeys(warnings)), bends=bends)


def _command(place: Path, arguments: list[str]) -> Ending:
    place.mkdir(parents=True, exist_ok=True)

    def job() -> int:
        from riser_soil.__main__ import app

        return int(app(arguments, standalone_mode=False) or 0)

    return ended(job, place, LIMITS)


def _output(place: Path) -> str:
    path = place / "output"
    return path.read_text(errors="replace") if path.exists() else ""


def _reason(ending: Ending) -> str:
    """The last line of its output, without the files' folder."""
    rows = [row.strip() for row in ending.output.splitlines() if row.strip() and "not carried over:" not in row]
    rows = [re.sub(r"\S*/(?=[^/\s]+:)", "", row) for row in rows]
    return rows[-1] if rows and ending.word == "traceback" else " ".join(rows)[:600]


def _by_moorpy(deck: Path, python: str) -> dict[str, Any]:
    command = [python, str(HERE / "by_moorpy.py"), str(deck)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
        return dict(json.loads(done.stdout.strip().splitlines()[-1]))
    except (subprocess.TimeoutExpired, ValueError, IndexError) as trouble:
        return {"held": f"MoorPy: {type(trouble).__name__}", "free": f"MoorPy: {type(trouble).__name__}"}


def _beside(deck: Survey, reference: dict[str, Any], work: Path) -> Survey:
    if deck.outcome != "scene":
        return deck
    folder = work / (deck.line or "first") / "run" / "out"
    final = json.loads((folder / "summary.json").read_text())["stages"][-1]["final"]
    if deck.line == "all":
        return _whole_beside(deck, folder, reference.get("free", "none"))
    tension, place = final["end"]["effective_tension"], final["end"]["position"]
    lines = reference.get("held", "none")
    if isinstance(lines, str):
        return Survey(**asdict(deck) | {"tension": tension, "why_no_reference": lines})
    closest = _at_top(lines, place, tension)
    why = "" if closest is not None else f"no line of MoorPy's has its top at {place}"
    return Survey(**asdict(deck) | {"tension": tension, "reference": closest, "why_no_reference": why})


def _at_top(lines: list[dict[str, Any]], place: Sequence[float], tension: float) -> float | None:
    """Tension [N] of MoorPy's line whose top is there; of several the one nearest to a tension."""
    near = [line["tensions"][1] for line in lines if math.dist(line["ends"][1], place) < SAME_PLACE]
    return min(near, key=lambda other: abs(other - tension), default=None)


def _whole_beside(deck: Survey, folder: Path, lines: Any) -> Survey:
    """That line whose tension differs most, of those whose tops MoorPy has at the same place."""
    with FORKING:
        runs = Run(folder).of_lines.values()
        ours = [(float(run["effective_tension"][-1, -1]), run["position"][-1, -1]) for run in runs]
    if isinstance(lines, str):
        return Survey(**asdict(deck) | {"tension": max(tension for tension, _ in ours), "why_no_reference": lines})
    pairs = [(tension, other) for tension, place in ours if (other := _at_top(lines, place, tension))]
    if not pairs:
        why = "no line of MoorPy's has its top at the same place"
        return Survey(**asdict(deck) | {"tension": max(tension for tension, _ in ours), "why_no_reference": why})
    tension, other = max(pairs, key=lambda pair: abs(pair[0] / pair[1] - 1))
    return Survey(**asdict(deck) | {"tension": tension, "reference": other})
