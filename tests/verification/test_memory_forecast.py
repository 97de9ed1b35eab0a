"""The memory that a run on soil takes at its peak is what its size foretells, within 30 %."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from riser_soil.checks.estimate import WITHIN, size_of
from riser_soil.scene.reader import read_scene
from tests.support.on_ranks import ROOT, environment
from tests.support.scenes import ON_BLOCK

SHORT = ("stages.1.duration=0.2", "solver.tolerance=1e-4")
MESHES = {
    "small": (),
    "middling": ("soil.mesh={kind: hex, size_at_riser: {along: 0.5, across: 0.05, strip: 0.15}, size_far: 0.5}",),
    "middling, by iterations": (
        "soil.mesh={kind: hex, size_at_riser: {along: 0.5, across: 0.05, strip: 0.15}, size_far: 0.5}",
        "solver.linear=iterative",
    ),
    "automatic, in sections": ("soil.mesh=auto", "soil.model=sections"),
    "of tetrahedra": ("soil.mesh={kind: tet, size_at_riser: 0.2, size_far: 1.0}",),
}


# A process counts the memory of the one that it was forked from as its own: a small one stands between.
BETWEEN = """
import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
"""


def peak(overrides: tuple[str, ...], folder: Path) -> float:
    """Largest resident memory of a run [bytes]."""
    given = [word for override in overrides for word in ("--set", override)]
    run = [sys.executable, "-m", "riser_soil", "run", str(ON_BLOCK), "-o", str(folder), "--force", *given]
    call = [sys.executable, "-c", BETWEEN, *run]
    done = subprocess.run(call, check=True, cwd=ROOT, env=environment(), stdout=subprocess.PIPE, text=True)
    return 1024.0 * float(done.stdout)


@pytest.mark.verify
@pytest.mark.parametrize("mesh", MESHES)
def test_memory_is_foretold_within_thirty_per_cent(mesh: str, tmp_path: Path) -> None:
    """The second of two runs, as the first may compile kernels."""
    overrides = SHORT + MESHES[mesh]
    foretold = size_of(read_scene(ON_BLOCK, overrides)).memory(1)
    peak(overrides, tmp_path / "out")
    memory = peak(overrides, tmp_path / "out")
    assert foretold / WITHIN < memory < foretold * WITHIN, f"{foretold / 1e6:.0f} MB foretold, {memory / 1e6:.0f} taken"
