"""A headless Chromium that opens a page of this machine and tells what it met."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

NAMES = ("chromium-headless-shell", "chromium")
QUIET = (
    *("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-sync"),
    *("--disable-background-networking", "--disable-component-update", "--enable-logging=stderr", "--v=0"),
)


@dataclass(frozen=True)
class Visit:
    """What the browser printed, and the messages of its console."""

    printed: str
    console: list[str]


def visit(page: Path, *options: str) -> Visit:
    """Opens a page in an empty profile, by options such as --dump-dom, --screenshot=FILE and --print-to-pdf=FILE."""
    program = next((path for name in NAMES if (path := shutil.which(name))), None)
    assert program is not None, f"none of {', '.join(NAMES)} is installed; make setup does it"
    with tempfile.TemporaryDirectory() as profile:
        call = [program, *QUIET, f"--user-data-dir={profile}", *options, page.resolve().as_uri()]
        done = subprocess.run(call, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return Visit(done.stdout, [line for line in done.stderr.splitlines() if "CONSOLE" in line])
