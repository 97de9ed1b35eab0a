"""Breaks the package at the places of places.txt, one at a time, and counts those that the quick tests notice.

    python -m tests.robustness.mutants.run [--only TEXT]

Each mutant is made in a copy, in `build/mutants`, and the test files named beside its place run there until the first
failure; first without any mutant, when all must pass. A mutant that makes tests hang is noticed, too. Most of them take
seconds, those of compiled kernels a minute.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

REPOSITORY = Path(__file__).parents[3]
TESTS = REPOSITORY / "tests"
AT = REPOSITORY / "build" / "mutants"
COPY = AT / "copy"
LONGEST = 600.0  # s, of a mutant's tests
ENOUGH = 0.95  # of all mutants


class Place(NamedTuple):
    """A module of the package, text that it has once, what a mutant has instead, and the test files to notice it."""

    module: str
    old: str
    new: str
    tests: str

    @property
    def path(self) -> str:
        return f"riser_soil/{self.module}.py"

    @property
    def files(self) -> list[str]:
        """Tests of single pieces, but for those named with another folder; those that are not there by their names."""
        parts = [name.rpartition("/") for name in self.tests.split()]
        return [_found(TESTS / (folder or "unit"), f"test_{name}.py") for folder, _, name in parts]

    def mutated(self, text: str) -> str:
        """The module's text as the mutant has it; ValueError unless the place is there once."""
        if text.count(self.old) != 1:
            raise ValueError(f"{self.path} has {text.count(self.old)} times, not once: {self.old}")
        return text.replace(self.old, self.new)


def _found(folder: Path, name: str) -> str:
    path = next(folder.rglob(name), folder / name)
    return path.relative_to(REPOSITORY).as_posix()


def places() -> Iterator[Place]:
    for line in Path(__file__).with_name("places.txt").read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            yield Place(*line.split(" | "))


def not_copied(folder: str, names: list[str]) -> set[str]:
    """What was made from the sources; package and tests have folders of that name that were not."""
    sources = Path(folder).relative_to(REPOSITORY).parts[:1] in (("riser_soil",), ("tests",))
    made = {"build", "__pycache__"} | (set() if sources else {"results"})
    return {name for name in names if name in made or name.startswith(".")}


def outcome(files: Iterable[str], longest: float) -> str:
    """The first failure of test files in the copy, "" where all pass; RuntimeError where they don't run."""
    shutil.rmtree(COPY / ".hypothesis", ignore_errors=True)  # what it has found with another mutant
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "--hypothesis-seed=0", *files]
    own = {"PYTHONPATH": str(COPY), "PYTHONDONTWRITEBYTECODE": "1", "XDG_CACHE_HOME": str(AT / "cache")}
    with subprocess.Popen(
        command, cwd=COPY, env=os.environ | own, stdout=subprocess.PIPE, text=True, start_new_session=True
    ) as process:
        try:
            output = process.communicate(timeout=longest)[0]
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            return f"no end within {longest:g} s"
    failed = re.search(r"^(?:FAILED|ERROR) tests/(\S+)", output, re.MULTILINE)
    if process.returncode == 0 or (process.returncode == 1 and failed):
        return failed[1] if failed else ""
    raise RuntimeError(f"pytest ends with {process.returncode}: {output[-2000:]}")


def noticed(place: Place) -> str:
    """The first test that fails of the mutant, "" for none."""
    path = COPY / place.path
    kept = shutil.copy2(path, AT)
    path.write_text(place.mutated(path.read_text(encoding="utf-8")), encoding="utf-8")
    try:
        return outcome(place.files, LONGEST)
    finally:
        shutil.move(kept, path)  # with its time, by which compiled kernels are known


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="places with this text in their line")
    only = parser.parse_args().only
    chosen = [place for place in places() if only in " | ".join(place)]
    shutil.rmtree(COPY, ignore_errors=True)
    shutil.copytree(REPOSITORY, COPY, ignore=not_copied)
    if failed := outcome(sorted({file for place in chosen for file in place.files}), 10.0 * LONGEST):
        print(f"without any mutant: {failed}")
        return 1
    count = 0
    for place in chosen:
        by = noticed(place)
        count += bool(by)
        print(f"{place.path}: {place.old} -> {place.new}: {by or 'NOT NOTICED'}", flush=True)
    print(f"{count} of {len(chosen)} mutants are noticed")
    return int(count < ENOUGH * len(chosen))


if __name__ == "__main__":
    sys.exit(main())
