"""Results of dynamic steps with contact balance like those of statics, although the scheme weighs contact apart."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from riser_soil.results import Run
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.whole_run import run

PIPE = {"outer_diameter": 0.2, "mass": 50.0, "EA": 1e7, "EI": 2e4}
NEWMARK = {"newmark": {"beta": 0.25, "gamma": 0.5}}


def test_a_riser_at_rest_on_the_seabed_has_the_reactions_and_moments_of_statics(tmp_path: Path) -> None:
    scene = {
        "line_types": {"pipe": PIPE},
        "riser": {
            "segments": [{"line_type": "pipe", "length": 60.0, "elements": 30}],
            "start": {"position": [0.0, 0.0, 0.1]},
            "end": {"position": [45.0, 0.0, 25.0]},
        },
        "seabed": {"kind": "rigid"},
        "stages": [
            {"name": "lay", "kind": "static"},
            {"name": "rest", "kind": "dynamic", "duration": 0.1, "time_step": 0.05, "scheme": NEWMARK},
        ],
        "solver": {"tolerance": 1e-10},
    }
    run(scene_from_mapping(scene), tmp_path)
    lay, rest = (stage["final"] for stage in Run(tmp_path).summary["stages"])
    for end in ("start", "end"):
        assert rest[end]["force"] == pytest.approx(lay[end]["force"], abs=1e-3)
    assert rest["max_bending_moment"]["value"] == pytest.approx(lay["max_bending_moment"]["value"], rel=1e-6)
    vertical = rest["start"]["force"][2] + rest["end"]["force"][2] + rest["contact_force"]
    assert vertical == pytest.approx(60.0 * 50.0 * 9.81, rel=1e-6)


def test_a_free_end_on_the_ground_has_no_reaction(tmp_path: Path) -> None:
    """Up to the turn of the pipe within a step; with the scheme's own acceleration it is the end's contact force."""
    scene = {
        "line_types": {"pipe": PIPE},
        "riser": {
            "segments": [{"line_type": "pipe", "length": 10.0, "elements": 10}],
            "start": "free",
            "end": "free",
            "unstressed": {"points": [[0.0, 0.0, 0.1], [10.0, 0.0, 0.1]]},
        },
        "seabed": {"kind": "spring", "stiffness": 1e4},
        "stages": [{"name": "settle", "kind": "dynamic", "duration": 0.5, "time_step": 0.05, "scheme": NEWMARK}],
    }
    run(scene_from_mapping(scene), tmp_path)
    results = Run(tmp_path)
    contact = np.abs(results["contact_force_sum"]).max()
    for name in ("start_force", "end_force", "start_moment", "end_moment"):
        assert np.abs(results[name]).max() < 1e-3 * contact
