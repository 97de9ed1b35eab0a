"""Mutated scenes end in results or in one of the program's own messages: no traceback, no hang, no crash."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.robustness.fuzz.mutations import cases
from tests.support.on_ranks import ROOT, environment

COUNT, SEED = 600, 1


def test_a_seed_gives_the_same_scenes() -> None:
    few, more = list(cases(3, SEED)), list(cases(5, SEED))
    assert few == more[:3]
    assert few != list(cases(3, SEED + 1))


@pytest.mark.verify
def test_mutated_scenes_end_well(tmp_path: Path) -> None:
    options = ["--count", str(COUNT), "--seed", str(SEED), "--keep", str(tmp_path)]
    call = [sys.executable, "-m", "tests.robustness.fuzz.run", *options]
    done = subprocess.run(call, cwd=ROOT, env=environment(), capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
