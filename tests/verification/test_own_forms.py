"""The terms that docs/weak_form.md shows, added to the soil under a riser that heaves."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.results import Run
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.whole_run import run
from tests.support.on_ranks import ROOT
from tests.support.pages import blocks
from tests.support.scenes import LAY, heave, touchdown

(SHOWN,) = blocks(ROOT / "docs/weak_form.md", "python")
WAYS = {"none": None, "shown": SHOWN, "viscous": SHOWN.replace("PULL = 2.0e4, 120.0", "PULL = 2.0e4, 0.0")}


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Run]:
    results = {}
    for way, text in WAYS.items():
        folder = tmp_path_factory.mktemp("run")
        given = touchdown(LAY, heave(0.9), su=1000.0, tolerance=1e-9)
        given["soil"] |= {"strain": "small", "symmetry": "whole"}
        if text is not None:
            (folder / "my_terms.py").write_text(text, encoding="utf-8")
            given["soil"] |= {"forms": "my_terms.py"}
        run(scene_from_mapping(given, folder), folder / "out")
        results[way] = Run(folder / "out")
    return results


def test_viscous_clay_takes_energy_and_the_ledger_closes(runs: dict[str, Run]) -> None:
    without, viscous = (runs[way].summary["stages"][1]["energy"] for way in ("none", "viscous"))
    assert "soil_forms" not in without["work_by"]
    assert viscous["work_by"]["soil_forms"] < 0.0
    assert abs(viscous["relative_residual"]) < 2.0 * abs(without["relative_residual"]) + 1e-5


def test_at_rest_viscosity_does_nothing(runs: dict[str, Run]) -> None:
    """What moves is another thing, and so is soil that is pulled along."""
    none, shown, viscous = (runs[way]["position"] for way in WAYS)
    np.testing.assert_allclose(viscous[0], none[0], atol=1e-6)
    assert np.abs(viscous[-1] - none[-1]).max() > 1e-6
    assert np.abs(shown[0] - none[0]).max() > 1e-6


def test_soil_is_pulled_along_as_elastic_soil_would_be(runs: dict[str, Run]) -> None:
    """Between its ends, which are held along x, the soil moves along x where nothing else moves it."""
    frames = [runs[way].soil_frame() for way in ("none", "shown")]
    moved = frames[1].fields["displacement"][:, 0] - frames[0].fields["displacement"][:, 0]
    assert moved.max() > 10.0 * -moved.min() >= 0.0
