"""Statics over lengths, slopes, stiffnesses, meshes and grounds: all find a balance, or say why there is none."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from riser_soil.errors import SolveError
from riser_soil.results import Run
from riser_soil.scene.reader import read_scene, scene_from_mapping
from riser_soil.whole_run import run
from tests.support.scenes import Mapping, prescribed, riser_scene, static

SCENES = Path(__file__).parents[1] / "scenes"
DISTANCE, W = 100.0, 500.0
ENDS = {
    "level": (DISTANCE, 0.0, 0.0),
    "inclined": (0.6 * DISTANCE, 0.0, 0.8 * DISTANCE),
    "steep": (1.0, 0.0, np.sqrt(DISTANCE**2 - 1.0)),
    "vertical": (0.0, 0.0, DISTANCE),
}
LENGTHS = (0.999, 1.00001, 1.01, 1.2, 2.0, 5.0)
GROUNDS: dict[str, Mapping | None] = {
    "none": None,
    "rigid": {"kind": "rigid", "level": 0.0, "contact_at": "axis"},
    "spring": {"kind": "spring", "level": 0.0, "stiffness": 2e4, "contact_at": "axis"},
}


@dataclass(frozen=True)
class Pipe:
    EI: float
    EA: float
    elements: int
    dimension: int = 2


ROPE, SOFT, HOSE = Pipe(1.0, 1e5, 50), Pipe(1e3, 1e8, 50), Pipe(1e5, 1e10, 50)
STIFF, SPATIAL, FINE = Pipe(1e7, 1e9, 20), Pipe(1e3, 1e9, 60, 3), Pipe(1e5, 1e8, 200, 3)
PIPES = (Pipe(1.0, 1e9, 20), ROPE, SOFT, HOSE, STIFF, SPATIAL, FINE)


@dataclass(frozen=True)
class Case:
    length: float
    end: str
    ground: str
    pipe: Pipe
    refined: int = 1

    @property
    def scene(self) -> Mapping:
        given, pipe = self.pipe, {"EA": self.pipe.EA, "EI": self.pipe.EI, "GJ": self.pipe.EI, "submerged_weight": W}
        more: dict[str, Any] = {"dimension": given.dimension, "gravity": 9.81, "solver": {"tolerance": 1e-10}}
        if GROUNDS[self.ground] is not None:
            more["seabed"] = GROUNDS[self.ground]
        start, elements = prescribed(0.0, 0.0, 0.0), given.elements * self.refined
        options: Mapping = {"pipe": pipe | {"outer_diameter": 0.2}, "start": start, "end": prescribed(*ENDS[self.end])}
        return riser_scene(static(), length=self.length * DISTANCE, elements=elements, **options, **more)

    @property
    def bends_finely(self) -> bool:
        """Whether the elements can follow a bend of the pipe under its own weight."""
        return self.length * DISTANCE / self.pipe.elements < 0.5 * float(np.cbrt(self.pipe.EI / W))

    @property
    def may_fold(self) -> bool:
        """On the ground, and kept in its plane: the slack of a line would have to lie on itself."""
        return self.ground != "none" and self.pipe.dimension == 2

    def solved(self, folder: Path) -> Run:
        run(scene_from_mapping(self.scene), folder, force=True)
        return Run(folder)


def require_balance(run: Run, weight: float) -> None:
    total = run["start_force"][-1] + run["end_force"][-1] + run["contact_force_sum"][-1]
    assert np.abs(total - [0.0, 0.0, weight]).max() < 1e-8 * max(weight, np.abs(run["end_force"][-1]).max())


def check(case: Case, folder: Path) -> str:
    """Solve, judge, and tell the method."""
    try:
        run = case.solved(folder)
    except SolveError as err:
        too_long = str(err).startswith("the riser is slack")
        if not too_long or (case.bends_finely and not case.may_fold):
            raise
        return "told"
    require_balance(run, W * case.length * DISTANCE)
    if "laying" in run.summary:
        return "laid"
    method: str = run.summary["stages"][0]["method"]
    assert method == "newton" or case.ground == "rigid", "a catenary under tension is near enough, but for a hard floor"
    return method


def compare_with_finer(case: Case, folder: Path) -> None:
    coarse = case.solved(folder)
    finer = Case(case.length, case.end, case.ground, case.pipe, refined=2).solved(folder / "finer")
    scale = float(np.linalg.norm(finer["end_force"][-1]))
    assert coarse["end_force"][-1] == pytest.approx(finer["end_force"][-1], abs=2e-3 * scale)
    assert coarse["effective_tension"][-1, -1] == pytest.approx(finer["effective_tension"][-1, -1], abs=2e-3 * scale)


QUICK = (
    *(Case(length, "level", "none", SOFT) for length in LENGTHS),
    *(Case(1.2, end, "none", HOSE) for end in ENDS),
    *(Case(1.01, "inclined", ground, pipe) for ground in GROUNDS for pipe in (ROPE, STIFF, SPATIAL)),
    Case(1.00001, "vertical", "none", SOFT),
    Case(0.999, "vertical", "rigid", STIFF),
    *(Case(length, "vertical", "none", FINE) for length in (1.00001, 1.01, 2.0)),  # it may turn about the vertical
)


@pytest.mark.parametrize("case", QUICK, ids=repr)
def test_quick(case: Case, tmp_path: Path) -> None:
    check(case, tmp_path)


REFINED = Case(1.2, "level", "none", SOFT), Case(1.2, "inclined", "rigid", HOSE), Case(0.999, "inclined", "none", ROPE)


@pytest.mark.parametrize("case", REFINED)
def test_finer_elements_change_little(case: Case, tmp_path: Path) -> None:
    compare_with_finer(case, tmp_path)


@pytest.mark.verify
@pytest.mark.parametrize("end", ENDS)
@pytest.mark.parametrize("length", LENGTHS)
def test_all(length: float, end: str, tmp_path: Path) -> None:
    for ground, pipe in product(GROUNDS, PIPES):
        case = Case(length, end, ground, pipe)
        print(check(case, tmp_path), case)


@pytest.mark.parametrize("profile", ["[[0, 0.8, 0.0], [150, 1.5, 0.0]]", "[[-150, 1.0, 2.0], [150, 1.0, 2.5]]"])
def test_a_current_leads_from_any_start_to_the_same_state(profile: str, tmp_path: Path) -> None:
    """From straight in two stages and from the catenary at once; in the plane, and far out of it."""
    changes = (f"water.current={{profile: {profile}}}", "line_types.flexible.GJ=2.0e4", "solver.tolerance=1e-10")
    positions = []
    for name in ("catenary-three-stages.yaml", "catenary.yaml"):
        scene = read_scene(SCENES / name, changes)
        statics = tuple(stage for stage in scene.stages if stage.kind == "static")
        run(scene.model_copy(update={"stages": statics}), tmp_path / name)
        positions.append(Run(tmp_path / name))
    by_stages, at_once = (done["end_force"][-1] for done in positions)
    assert by_stages == pytest.approx(at_once, rel=1e-6)
    assert by_stages[0] < 0.0, "the current carries the riser past its end"
    assert positions[0].summary["stages"][0]["method"] == "relaxation"
    assert positions[1].summary["stages"][0]["method"] == "load steps"
