"""Page "How accurate, how fast, how stable", docs/quality.md, from what the commands have found.

    python -m benchmarks.quality

Runs `riser-soil study` of the first scene, or takes what it has left in results/quality, and gathers what `make bars`,
`make asked` and `make stress` have written.
"""

from __future__ import annotations

import argparse
import base64
import json
import re
from pathlib import Path

from demos.page import block, filled, table
from riser_soil.accuracy.study import study
from riser_soil.scene.reader import read_scene

ROOT = Path(__file__).parent.parent
DOCS = ROOT / "docs"
SCENE = "demos/first_scene.yaml"
PAGE, PLOT = DOCS / "quality.md", DOCS / "study.svg"
VERDICTS = ("passed", "reported", "QUIETLY WRONG")
INSIDE, REACHED = "true error inside its bar", "scenes that truly reach what they ask, of those that claim it"
COST = "processor time of the chosen setting's run over the best by hand, median"
SUMMARY = (  # page, block and row of a figure; what it is
    ("error_bars", "error bars", INSIDE, "true errors inside their error bars, in the calibration"),
    ("error_bars", "error bars out of sample", INSIDE, "the same, out of sample"),
    ("asked_accuracy", "asked accuracy", REACHED, "scenes that truly reach 1 %, of those that claim it"),
    ("asked_accuracy", "asked accuracy", COST, COST),
)


def studied(folder: Path) -> str:
    """Words of the study; its plot goes into a file."""
    study(read_scene(ROOT / SCENE), folder)
    data = json.loads((folder / "study.json").read_text(encoding="utf-8"))
    page = (folder / "study.html").read_text(encoding="utf-8")
    match = re.search(r'data:image/svg\+xml;base64,([^"]+)"', page)
    assert match is not None
    PLOT.write_bytes(base64.b64decode(match[1]))
    said = "\n".join(f"- {sentence[0].upper()}{sentence[1:]}." for sentence in data["words"])
    machine = f"{data['machine']['cores']} cores ({data['machine']['processor']}), {data['date']}"
    return f"{said}\n\nMade by `riser-soil study {SCENE}` on {machine}, which leaves a table of all key results."


def summary() -> str:
    """How often error bars and accuracies asked hold, from their pages."""
    rows = []
    for page, name, label, what in SUMMARY:
        text = block((DOCS / f"{page}.md").read_text(encoding="utf-8"), name)
        values = dict(_cells(row) for row in text.splitlines())
        rows.append([f"[{what}]({page}.md)", values[label]])
    return table(["on scenes of known answers", ""], rows)


def _cells(row: str) -> tuple[str, str]:
    first, second = (cell.strip() for cell in row.strip("|").split("|"))
    return first, second


def stressed() -> str:
    """How the stress cases ended."""
    rows = json.loads((DOCS / "stress.json").read_text(encoding="utf-8"))["cases"]
    counts = [sum(row["verdict"] == verdict for row in rows) for verdict in VERDICTS]
    others = len(rows) - sum(counts)
    missed = ", ".join(row["name"] for row in rows if not row["as_hoped"]) or "none"
    seconds = f"{sum(row['seconds'] for row in rows):.0f}"
    head = ("stress cases", *VERDICTS, "ended otherwise", "processor time s")
    counted = table(head, [[str(len(rows)), *map(str, counts), str(others), seconds]])
    return f"{counted}\n\nNot as they are to end: {missed}."


def main() -> None:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.quality", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.parse_args()
    blocks = {"study": studied(ROOT / "results" / "quality"), "summary": summary(), "stress": stressed()}
    PAGE.write_text(filled(PAGE.read_text(encoding="utf-8"), blocks), encoding="utf-8")


if __name__ == "__main__":
    main()
