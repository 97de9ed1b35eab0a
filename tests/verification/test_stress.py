"""All stress cases end as they are to: right, or told plainly where that is an answer, too."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.on_ranks import ROOT, environment


@pytest.mark.verify
def test_stiff_and_extreme_scenes(tmp_path: Path) -> None:
    call = [sys.executable, "-m", "tests.stress.run", "--keep", str(tmp_path)]
    done = subprocess.run(call, cwd=ROOT, env=environment(), capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
