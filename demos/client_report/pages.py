"""The picture of a report's pages that docs/report.md shows: cover, summary, code checks and sensitivity side by side.

Usage, in the project's folder: python -m demos.client_report.pages [--report PDF] [--picture PNG]
Needs pdftoppm and pdftotext (Debian: poppler-utils). The report is by default that of this demo.
"""

from __future__ import annotations

import argparse
import io
import re
import subprocess
from pathlib import Path

from PIL import Image

from demos.client_report.run import HERE
from demos.page import ROOT
from riser_soil.errors import ResultsError

SHOWN = {  # what a page has at the beginning of a line, beside the cover
    "summary": r"1\s+Summary$",
    "code checks": r"Figure \d+\s+Utilisations of code checks",
    "sensitivity": r"\d+\s+Sensitivity$",
}
WIDTH, GAP, GREY = 600, 10, (200, 204, 208)  # pixels of a page, between pages


def main(report: Path, picture: Path) -> None:
    texts = pages_of(report)
    chosen = [0, *(page_with(texts, pattern, report) for pattern in SHOWN.values())]
    side_by_side([drawn(report, n) for n in chosen]).save(picture, optimize=True)
    print(f"pages {', '.join(str(n + 1) for n in chosen)} of {len(texts)} are in {picture}")


def pages_of(report: Path) -> list[str]:
    """Text of each page, the list of contents empty, as it has all headings."""
    text = _poppler("pdftotext", "-layout", str(report), "-").decode()
    return ["" if re.search(r"^\s*Contents$", page, re.MULTILINE) else page for page in text.split("\f")[:-1]]


def page_with(texts: list[str], pattern: str, report: Path) -> int:
    """Number from 0 of the first page that has a line which begins so; ResultsError without one."""
    line = re.compile(rf"^\s*{pattern}", re.MULTILINE)
    for n, text in enumerate(texts):
        if line.search(text):
            return n
    raise ResultsError(f"{report}: no page has a line {pattern!r}")


def drawn(report: Path, n: int) -> Image.Image:
    page = str(n + 1)
    size = ("-scale-to-x", str(WIDTH), "-scale-to-y", "-1")
    return Image.open(io.BytesIO(_poppler("pdftoppm", "-png", *size, "-f", page, "-l", page, str(report))))


def side_by_side(pages: list[Image.Image]) -> Image.Image:
    height = max(page.height for page in pages)
    whole = Image.new("RGB", (GAP + sum(page.width + GAP for page in pages), height + 2 * GAP), GREY)
    x = GAP
    for page in pages:
        whole.paste(page, (x, GAP))
        x += page.width + GAP
    return whole


def _poppler(*command: str) -> bytes:
    try:
        return subprocess.run(command, check=True, capture_output=True).stdout
    except FileNotFoundError as err:
        raise ResultsError(f"{command[0]} is not there; install poppler-utils") from err
    except subprocess.CalledProcessError as err:
        raise ResultsError(f"{command[0]}: {err.stderr.decode().strip()}") from err


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--report", type=Path, default=HERE / "results/report.pdf", help="of the demo by default")
    parser.add_argument("--picture", type=Path, default=ROOT / "docs/report.png", help="docs/report.png by default")
    given = parser.parse_args()
    main(given.report, given.picture)
