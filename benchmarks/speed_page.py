"""The tables of docs/speed.md, each written by the benchmark that measures it, with its command and the machine."""

from __future__ import annotations

import argparse
import platform
from collections.abc import Iterable, Sequence
from datetime import date

from demos.page import ROOT, filled, table

PAGE = ROOT / "docs" / "speed.md"


def tell(name: str, head: Sequence[str], rows: Iterable[Sequence[str]], page: bool) -> None:
    """The table of `benchmarks.NAME` on the screen; also to its place in the page, if that is wanted."""
    text = f"{table(head, rows)}\n\nMade by `python -m benchmarks.{name} --page` on {machine()}."
    print(f"{name}:\n{text}\n", flush=True)
    if page:
        PAGE.write_text(filled(PAGE.read_text(encoding="utf-8"), {name: text}), encoding="utf-8")


def machine() -> str:
    """The machine of the run, with the day."""
    return f"{platform.machine()}, one core, Python {platform.python_version()}, {date.today():%Y-%m-%d}"


def parser_of(name: str, description: str | None) -> argparse.ArgumentParser:
    """Command line of `benchmarks.NAME`."""
    parser = argparse.ArgumentParser(prog=f"python -m benchmarks.{name}", description=description)
    parser.add_argument("--page", action="store_true", help=f"write the table into {PAGE.name}, too")
    return parser
